//! What a build is doing, for those who wait: a bar on a terminal, lines elsewhere. Both come from a thread that looks at the
//! running jobs, so that one long job is seen as well as many short ones.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use fretwork_diagnostic::shown;
use fretwork_engine::{Progress, Steps};

/// What is over before this is not shown.
const PATIENCE: Duration = Duration::from_millis(500);
/// How often the bar is drawn.
const TICK: Duration = Duration::from_millis(100);
/// A job that goes on has one line in so much time.
const PAUSE: Duration = Duration::from_secs(5);

/// What is running, as the bar shows it.
pub struct Bar {
    shared: Arc<Shared>,
    watcher: Mutex<Option<JoinHandle<()>>>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    ended: Condvar,
}

#[derive(Default)]
struct State {
    total: usize,
    done: usize,
    running: Vec<Running>,
    is_over: bool,
}

/// A job that has begun.
struct Running {
    name: String,
    steps: Arc<Steps>,
    since: Instant,
    /// When its last line was written.
    told: Option<Instant>,
}

impl Running {
    /// Its name and what it is doing.
    fn label(&self) -> String {
        let step = self.steps.now();
        if step.is_empty() {
            self.name.clone()
        } else {
            format!("{}: {step}", self.name)
        }
    }
}

impl Bar {
    /// A bar for a build that begins now.
    pub fn new() -> Bar {
        let shared = Arc::<Shared>::default();
        let watched = shared.clone();
        let is_terminal = io::stderr().is_terminal();
        // Where the system gives no thread, the build goes on in silence.
        let watcher = thread::Builder::new().spawn(move || {
            if is_terminal {
                draw(&watched);
            } else {
                tell(&watched);
            }
        });
        Bar {
            shared,
            watcher: Mutex::new(watcher.ok()),
        }
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        self.shared.change(|state| state.is_over = true);
        self.shared.ended.notify_all();
        let mut watcher = self.watcher.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(watcher) = watcher.take() {
            // It ends by itself; one that has panicked has drawn enough.
            let _ = watcher.join();
        }
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Shared {
    fn change<T>(&self, change: impl FnOnce(&mut State) -> T) -> T {
        change(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Waits for so long, or until the build is over; whether it is.
    fn wait(&self, time: Duration) -> bool {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let waited = self
            .ended
            .wait_timeout_while(state, time, |state| !state.is_over);
        waited.is_ok_and(|(state, _)| state.is_over)
    }
}

/// Draws the bar until the build is over.
fn draw(shared: &Shared) {
    if shared.wait(PATIENCE) {
        return;
    }
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len} {wide_msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    bar.set_style(style);
    loop {
        let (total, done, labels) = shared.change(|state| {
            let labels: Vec<String> = state.running.iter().map(Running::label).collect();
            (state.total, state.done, labels)
        });
        bar.set_length(total as u64);
        bar.set_position(done as u64);
        bar.set_message(shown(&labels.join(", ")).into_owned());
        bar.tick();
        if shared.wait(TICK) {
            break;
        }
    }
    bar.finish_and_clear();
}

/// Writes a line for each job that takes long, until the build is over.
fn tell(shared: &Shared) {
    while !shared.wait(TICK) {
        let lines = shared.change(|state| {
            let now = Instant::now();
            let due = state.running.iter_mut().filter(|job| match job.told {
                None => now - job.since >= PATIENCE,
                Some(told) => now - told >= PAUSE,
            });
            due.map(|job| {
                job.told = Some(now);
                job.label()
            })
            .collect::<Vec<String>>()
        });
        for line in lines {
            // Nobody waits where nobody reads.
            let _ = writeln!(io::stderr(), "… {}", shown(&line));
        }
    }
}

impl Progress for Bar {
    fn total(&self, jobs: usize) {
        self.shared.change(|state| state.total = jobs);
    }

    fn started(&self, name: &str, steps: &Arc<Steps>) {
        let job = Running {
            name: name.to_owned(),
            steps: steps.clone(),
            since: Instant::now(),
            told: None,
        };
        self.shared.change(|state| state.running.push(job));
    }

    fn finished(&self, name: &str) {
        self.shared.change(|state| {
            if let Some(at) = state.running.iter().position(|job| job.name == name) {
                state.running.remove(at);
            }
            state.done += 1;
        });
    }
}
