//! Which job runs when, and on which thread.

use std::collections::BTreeSet;
use std::sync::{Condvar, Mutex};

use super::database::Database;

/// Jobs by number, and for each those that it waits for.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// For every job, the numbers of the jobs whose values it needs; there is no cycle.
    pub needs: Vec<BTreeSet<usize>>,
}

struct State {
    ready: BTreeSet<usize>,
    waiting: Vec<usize>,
    unfinished: usize,
}

/// Runs every job of `plan` after those it needs, the ready ones in order of their numbers, on
/// `threads` threads with a clone of the database each.
///
/// These threads are not those on which a stage spreads its own work: a stolen piece of a stage
/// must never wait for the query that it belongs to.
pub fn run(
    database: &Database,
    plan: &Plan,
    threads: usize,
    run_job: impl Fn(&Database, usize) + Sync,
) {
    let mut needed_by: Vec<Vec<usize>> = vec![Vec::new(); plan.needs.len()];
    for (job, needs) in plan.needs.iter().enumerate() {
        needs.iter().for_each(|&n| needed_by[n].push(job));
    }
    let waiting: Vec<usize> = plan.needs.iter().map(BTreeSet::len).collect();
    let ready = (0..waiting.len())
        .filter(|&job| waiting[job] == 0)
        .collect();
    let state = Mutex::new(State {
        ready,
        unfinished: waiting.len(),
        waiting,
    });
    let changed = Condvar::new();
    let work = |database: Database| {
        let mut guard = Guard {
            state: &state,
            changed: &changed,
            needed_by: &needed_by,
        };
        while let Some(job) = guard.next() {
            run_job(&database, job);
            guard.finish(job);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.min(plan.needs.len()) {
            let database = database.clone();
            let thread = std::thread::Builder::new();
            // Where the system gives no more threads, fewer do the work.
            if thread.spawn_scoped(scope, || work(database)).is_err() {
                break;
            }
        }
        work(database.clone());
    });
}

struct Guard<'a> {
    state: &'a Mutex<State>,
    changed: &'a Condvar,
    needed_by: &'a [Vec<usize>],
}

const UNPOISONED: &str = "no code panics while it holds the schedule";

impl Guard<'_> {
    fn next(&mut self) -> Option<usize> {
        let mut state = self.state.lock().expect(UNPOISONED);
        loop {
            if state.unfinished == 0 {
                return None;
            }
            if let Some(job) = state.ready.pop_first() {
                return Some(job);
            }
            state = self.changed.wait(state).expect(UNPOISONED);
        }
    }

    fn finish(&mut self, job: usize) {
        let mut state = self.state.lock().expect(UNPOISONED);
        state.unfinished -= 1;
        for &next in &self.needed_by[job] {
            state.waiting[next] -= 1;
            if state.waiting[next] == 0 {
                state.ready.insert(next);
            }
        }
        self.changed.notify_all();
    }
}

impl Drop for Guard<'_> {
    /// A thread that unwinds releases the others, which would wait for its job for ever.
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.state.lock().expect(UNPOISONED).unfinished = 0;
            self.changed.notify_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::world::MemoryWorld;
    use super::*;

    #[test]
    fn every_job_runs_once_and_after_what_it_needs() {
        let database = Database::new(Arc::new(MemoryWorld::default()), None, true);
        let needs: Vec<BTreeSet<usize>> = (0..60)
            .map(|i| (0..i).filter(|j| i % (j + 2) == 0).collect())
            .collect();
        let plan = Plan { needs };
        for threads in [1, 2, 5] {
            let done = Mutex::new(Vec::new());
            run(&database, &plan, threads, |_, job| {
                let mut done = done.lock().unwrap();
                assert!(
                    plan.needs[job].iter().all(|n| done.contains(n)),
                    "{job} ran too early"
                );
                done.push(job);
            });
            let mut done = done.into_inner().unwrap();
            done.sort_unstable();
            assert_eq!(done, (0..60).collect::<Vec<_>>());
        }
    }
}
