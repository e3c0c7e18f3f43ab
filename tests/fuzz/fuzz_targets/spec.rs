//! Any bytes as a spec: checking it must end without a panic, every diagnostic must have a place in the
//! text, and checking again must say the same.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz spec`
#![no_main]

use std::sync::Arc;

use fretwork::engine::{Compiler, MemoryWorld, Settings};
use fretwork::diagnostic::render::{position, render};
use libfuzzer_sys::fuzz_target;

const PATH: &str = "specs/spec.yaml";

fuzz_target!(|bytes: &[u8]| {
    let mut world = MemoryWorld::default();
    world.files.insert(PATH.into(), bytes.to_vec());
    world.files.insert("specs/other.yaml".into(), b"fretwork: 1\nregions: { disc: { circle: { radius: 3 } } }\n".to_vec());
    let compiler = Compiler::new(Arc::new(world), None, true);
    let settings = Settings::default();
    let diagnostics = compiler.check(PATH, &settings);
    for label in diagnostics.iter().flat_map(|d| &d.labels) {
        assert!(position(&label.span, &compiler.sources()).is_some(), "{label:?} is nowhere");
    }
    render(&diagnostics, &compiler.sources(), false);
    assert_eq!(diagnostics, compiler.check(PATH, &settings));
    if diagnostics.iter().all(|d| !d.is_error()) {
        compiler.check_scripts(PATH, &settings);
        compiler.params(PATH, &Settings::default());
    }
});
