//! A progress bar on a terminal, for builds that take long enough to wonder.

use std::io::{self, IsTerminal as _};
use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::build::Progress;

/// A bar; hidden where standard error is no terminal.
pub struct Bar {
    bar: ProgressBar,
    running: Mutex<Vec<String>>,
}

impl Bar {
    /// A bar that begins to count when it is told how much there is.
    pub fn new() -> Bar {
        let bar = ProgressBar::no_length();
        bar.set_draw_target(if io::stderr().is_terminal() {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        });
        let style = ProgressStyle::with_template("{bar:24} {pos}/{len} {wide_msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style);
        Bar { bar, running: Mutex::default() }
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn show(&self, change: impl FnOnce(&mut Vec<String>)) {
        if let Ok(mut running) = self.running.lock() {
            change(&mut running);
            self.bar.set_message(running.join(", "));
        }
    }
}

impl Progress for Bar {
    fn total(&self, jobs: usize) {
        self.bar.set_length(jobs as u64);
        self.bar.enable_steady_tick(Duration::from_millis(100));
    }

    fn started(&self, name: &str) {
        self.show(|running| running.push(name.to_string()));
    }

    fn finished(&self, name: &str) {
        self.show(|running| running.retain(|r| r != name));
        self.bar.inc(1);
    }
}
