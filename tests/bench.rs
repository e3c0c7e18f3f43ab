//! Timings by hand: `cargo bench --bench bench -- planar_map` runs the benchmarks whose names
//! contain `planar_map`, without an argument all. No thresholds and no statistics beyond the
//! fastest of some runs live here; figures of other programs are in the comments of each benchmark.

// Benchmarks read the shipped specs and write copies of them.
#![allow(clippy::disallowed_methods)]

mod bench {
    pub mod analyse;
    pub mod arrangement;
    pub mod band;
    pub mod build;
    pub mod diff;
    pub mod facade;
    pub mod jobs;
    pub mod map;
    pub mod page;
    pub mod planar_map;
    pub mod shell;
    pub mod shell_job;
    pub mod shell_loop;
    pub mod shell_pictures;
    pub mod shell_table;
    pub mod solid;
    pub mod wall;
}

use std::time::{Duration, Instant};

/// What a benchmark prints beside its time, such as counts that must stay the same.
pub type Note = String;

/// Runs benchmarks whose names contain one of the arguments.
pub struct Bench {
    filters: Vec<String>,
}

impl Bench {
    /// Times `work` on what `prepare` gives, which is not timed: the fastest of up to ten runs within three seconds.
    pub fn run<T>(&self, name: &str, prepare: impl FnOnce() -> T, work: impl Fn(&T) -> Note) {
        if !self.filters.is_empty() && !self.filters.iter().any(|f| name.contains(f.as_str())) {
            return;
        }
        let input = prepare();
        let (begin, mut best, mut note, mut runs) = (Instant::now(), Duration::MAX, Note::new(), 0);
        while runs == 0 || (runs < 10 && begin.elapsed() < Duration::from_secs(3)) {
            let start = Instant::now();
            note = std::hint::black_box(work(&input));
            best = best.min(start.elapsed());
            runs += 1;
        }
        println!("{name:40} {:>10.4} s  {note}", best.as_secs_f64());
    }
}

fn main() {
    // Cargo passes `--bench` on.
    let filters = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let bench = Bench { filters };
    bench::analyse::run(&bench);
    bench::arrangement::run(&bench);
    bench::band::run(&bench);
    bench::build::run(&bench);
    bench::diff::run(&bench);
    bench::facade::run(&bench);
    bench::jobs::run(&bench);
    bench::map::run(&bench);
    bench::page::run(&bench);
    bench::planar_map::run(&bench);
    bench::shell::run(&bench);
    bench::shell_job::run(&bench);
    bench::shell_loop::run(&bench);
    bench::shell_table::run(&bench);
    bench::solid::run(&bench);
    bench::wall::run(&bench);
}
