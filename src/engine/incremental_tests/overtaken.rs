//! Builds that are given up in the middle.

use std::sync::Arc;

use super::super::{Progress, Report, Request, Settings, Steps, Stop};
use super::{Bench, SPEC, digests, evaluated};

const TWO: &str = "fretwork: 1
regions:
  page: { rectangle: { width: 40, height: 30 } }
partitions:
  cells: { uniform: { cell_size: 5 } }
artifacts:
  page.svg: { from: page }
  cells.svg: { from: cells, region: page }
";

/// Somebody who loses interest as soon as a job of some name begins.
struct Impatient(&'static str, Stop);

impl Progress for Impatient {
    fn total(&self, _: usize) {}

    fn started(&self, name: &str, _: &Arc<Steps>) {
        if name == self.0 {
            self.1.set();
        }
    }

    fn finished(&self, _: &str) {}
}

fn build(bench: &Bench, until: &'static str, threads: usize) -> Option<Report> {
    let compiler = &bench.compiler;
    compiler.stop().clear();
    compiler.unless_stopped(|compiler| {
        compiler.build(&Request {
            specs: vec![SPEC.to_string()],
            settings: Settings::default(),
            only: Vec::new(),
            windows: Vec::new(),
            threads,
            progress: &Impatient(until, compiler.stop()),
        })
    })
}

#[test]
fn what_was_given_up_is_as_if_it_had_never_begun() {
    for threads in [1, 3] {
        let bench = Bench::new(TWO);
        assert!(build(&bench, "partitions.cells", threads).is_none());
        // A second build that is given up has no other start.
        assert!(build(&bench, "artifacts.cells.svg", threads).is_none());
        let report = build(&bench, "", threads).expect("nobody gives it up");
        assert_eq!(report.diagnostics, []);
        assert_eq!(digests(&report), digests(&Bench::new(TWO).build(&[])));
    }
}

#[test]
fn what_had_been_finished_is_not_done_again() {
    let bench = Bench::new(TWO);
    assert!(build(&bench, "artifacts.cells.svg", 1).is_none());
    let report = build(&bench, "", 1).expect("nobody gives it up");
    // Of the two artifacts the one that was begun is the first.
    let artifacts = ["artifacts.cells.svg", "artifacts.page.svg"];
    assert_eq!(evaluated(&report), artifacts);
}

#[test]
fn other_panics_are_not_taken_for_it() {
    let bench = Bench::new(TWO);
    bench.compiler.stop().set();
    let panics = || bench.compiler.unless_stopped(|_| panic!("a mistake"));
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(panics));
    assert!(result.is_err_and(|payload| payload.is::<&str>()));
}

#[test]
fn a_view_is_given_up_and_had_again() {
    use fretwork_language::kinds::artifacts::Format;
    let bench = Bench::new(TWO);
    let report = bench.build(&[]);
    let view = || {
        let compiler = &bench.compiler;
        compiler.unless_stopped(|compiler| compiler.view(&report.artifacts[0], Format::Png))
    };
    bench.compiler.stop().set();
    assert!(view().is_none());
    bench.compiler.stop().clear();
    let png = view().flatten().expect("a page can be drawn");
    assert!(png.bytes.starts_with(b"\x89PNG"));
}
