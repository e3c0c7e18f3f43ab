//! A progress bar on a terminal, for builds that take long enough to wonder.

use std::io::{self, IsTerminal as _};
use std::sync::Mutex;
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use fretwork_diagnostic::shown;
use fretwork_engine::Progress;

/// Builds that are over before this show no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// A bar; hidden where standard error is no terminal.
pub struct Bar {
    bar: ProgressBar,
    running: Mutex<Vec<String>>,
    /// When to show it, until it is shown.
    shown_at: Mutex<Option<Instant>>,
}

impl Bar {
    /// A bar that begins to count when it is told how much there is.
    pub fn new() -> Bar {
        let bar = ProgressBar::no_length();
        bar.set_draw_target(ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{bar:24} {pos}/{len} {wide_msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        let shown_at = io::stderr()
            .is_terminal()
            .then(|| Instant::now() + PATIENCE);
        Bar {
            bar,
            running: Mutex::default(),
            shown_at: Mutex::new(shown_at),
        }
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn show(&self, change: impl FnOnce(&mut Vec<String>)) {
        if let Ok(mut shown_at) = self.shown_at.lock()
            && shown_at.take_if(|at| *at <= Instant::now()).is_some()
        {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            // Its tick has a thread, which there may not be.
            if thread::Builder::new().spawn(|| ()).is_ok() {
                self.bar.enable_steady_tick(Duration::from_millis(100));
            }
        }
        if let Ok(mut running) = self.running.lock() {
            change(&mut running);
            self.bar
                .set_message(shown(&running.join(", ")).into_owned());
        }
    }
}

impl Progress for Bar {
    fn total(&self, jobs: usize) {
        self.bar.set_length(jobs as u64);
    }

    fn started(&self, name: &str) {
        self.show(|running| running.push(name.to_string()));
    }

    fn finished(&self, name: &str) {
        self.show(|running| running.retain(|r| r != name));
        self.bar.inc(1);
    }
}
