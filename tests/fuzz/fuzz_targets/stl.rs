//! Any bytes as a mesh: reading them must end without a panic, in memory and time that their length bounds,
//! and what was read must be sound.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz stl`
#![no_main]

mod sound;

use fretwork::source::mesh::stl;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| sound::check(bytes, stl::read(bytes).map(|(mesh, _)| mesh)));
