//! How many threads there are to be had, which in a container may be fewer than are asked for.

use std::sync::{Condvar, Mutex, OnceLock, PoisonError};
use std::thread::{self, Builder};

/// Threads that are left for what a build starts besides its own: scripts and the progress bar.
const SPARE: usize = 3;

/// The stack of a thread that only waits.
const STACK: usize = 1 << 16;

/// How many threads to use: `asked`, or as many as the machine has cores.
pub fn threads(asked: Option<usize>) -> usize {
    asked.unwrap_or_else(cores)
}

fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// How many jobs may run at once where `asked` are wanted: fewer where the system does not give as
/// many threads. The pool on which stages spread their work must get its threads too, since it can be
/// made only once. Where there is none for it, the calling thread is the pool and does all the work, so this is
/// called by the thread that runs the jobs.
pub fn available(asked: usize) -> usize {
    static LIMITED: OnceLock<bool> = OnceLock::new();
    let pool = pool_size();
    let startable = startable(pool + asked.saturating_sub(1) + SPARE);
    if *LIMITED.get_or_init(|| startable < pool + SPARE) {
        make_small_pool(startable);
        return 1;
    }
    asked.min(1 + startable.saturating_sub(pool + SPARE))
}

/// Makes the pool of one thread; of the calling one where there is no other. Then no script can run
/// either, whose thread would wait for the pool while the caller waits for the script.
fn make_small_pool(startable: usize) {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(1);
    let builder = if startable == 0 {
        builder.use_current_thread()
    } else {
        builder
    };
    // That there is a pool already is as good.
    let _ = builder.build_global();
}

/// The size that the pool takes by itself.
fn pool_size() -> usize {
    let given = std::env::var("RAYON_NUM_THREADS").ok();
    given
        .and_then(|text| text.parse().ok())
        .filter(|&n| n > 0)
        .unwrap_or_else(cores)
}

/// How many of `wanted` threads can be started so that all live at the same time. They have ended when this returns.
fn startable(wanted: usize) -> usize {
    let (done, changed) = (Mutex::new(false), Condvar::new());
    let wait = || {
        let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
        while !*done {
            done = changed.wait(done).unwrap_or_else(PoisonError::into_inner);
        }
    };
    thread::scope(|scope| {
        let start = |_| {
            Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, wait)
                .ok()
        };
        let started: Vec<_> = (0..wanted).map_while(start).collect();
        *done.lock().unwrap_or_else(PoisonError::into_inner) = true;
        changed.notify_all();
        let count = started.len();
        // A joined thread no longer counts for the system, one that has only left the scope does.
        started.into_iter().for_each(|thread| drop(thread.join()));
        count
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_threads_are_given_where_nothing_limits_them() {
        assert_eq!(startable(20), 20);
        assert_eq!(available(1), 1);
        assert_eq!(available(7), 7);
    }
}
