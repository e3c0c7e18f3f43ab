//! How long the steps of shells and analyses take, as people ask for it. Files never hold it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use fretwork_engine::{Progress, Steps};

/// What takes long enough to be told.
const TIMED: [&str; 2] = ["shells.", "analyses."];

const UNPOISONED: &str = "no code panics while it holds the times";

/// Passes on what it hears of jobs, and keeps how long some of them took.
pub struct Clock<'a> {
    listener: &'a dyn Progress,
    jobs: Mutex<BTreeMap<String, (Instant, Option<f64>)>>,
}

impl<'a> Clock<'a> {
    /// A clock before somebody who hears of jobs too.
    pub fn before(listener: &'a dyn Progress) -> Clock<'a> {
        Clock {
            listener,
            jobs: Mutex::default(),
        }
    }

    /// The seconds that each job took, by name, to a thousandth. Those whose results were there are not among them.
    pub fn times(&self) -> BTreeMap<String, f64> {
        let jobs = self.jobs.lock().expect(UNPOISONED);
        let taken = jobs.iter().filter_map(|(name, (_, took))| {
            let rounded = (took.as_ref()? * 1e3).round() / 1e3;
            (rounded > 0.0).then(|| (name.clone(), rounded))
        });
        taken.collect()
    }
}

impl Progress for Clock<'_> {
    fn total(&self, jobs: usize) {
        self.listener.total(jobs);
    }

    fn started(&self, name: &str, steps: &Arc<Steps>) {
        if TIMED.iter().any(|section| name.starts_with(section)) {
            let mut jobs = self.jobs.lock().expect(UNPOISONED);
            jobs.insert(name.to_owned(), (Instant::now(), None));
        }
        self.listener.started(name, steps);
    }

    fn finished(&self, name: &str) {
        if let Some((start, took)) = self.jobs.lock().expect(UNPOISONED).get_mut(name) {
            *took = Some(start.elapsed().as_secs_f64());
        }
        self.listener.finished(name);
    }
}
