//! How a build goes on, for the terminal and for the page: the page hears of it a few times a second.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::json;

use super::super::progress::Bar;
use super::board::Board;
use fretwork_engine::{Progress, Steps};

/// The page hears of it not more often than this.
const PAUSE: Duration = Duration::from_millis(100);

/// Tells both.
pub struct Feed<'a> {
    bar: Bar,
    board: &'a Board,
    state: Mutex<State>,
}

struct State {
    total: usize,
    done: usize,
    running: Vec<String>,
    told: Instant,
}

impl<'a> Feed<'a> {
    /// A feed for a build that begins now.
    pub fn new(board: &'a Board) -> Feed<'a> {
        Feed {
            bar: Bar::new(),
            board,
            state: Mutex::new(State {
                total: 0,
                done: 0,
                running: Vec::new(),
                told: Instant::now(),
            }),
        }
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut state);
        if state.told.elapsed() >= PAUSE {
            state.told = Instant::now();
            let (done, total) = (state.done, state.total);
            let progress = json!({ "done": done, "total": total, "running": state.running });
            self.board.tell(progress.to_string());
        }
    }
}

impl Progress for Feed<'_> {
    fn total(&self, jobs: usize) {
        self.bar.total(jobs);
        self.change(|state| state.total = jobs);
    }

    fn started(&self, name: &str, steps: &Arc<Steps>) {
        self.bar.started(name, steps);
        self.change(|state| state.running.push(name.to_owned()));
    }

    fn finished(&self, name: &str) {
        self.bar.finished(name);
        self.change(|state| {
            if let Some(at) = state.running.iter().position(|job| job == name) {
                state.running.remove(at);
            }
            state.done += 1;
        });
    }
}
