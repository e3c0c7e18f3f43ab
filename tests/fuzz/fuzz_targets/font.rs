//! Any bytes as a font, plain or packed as WOFF: reading it and setting a text in it must end without a panic, in memory and
//! time that its length bounds, and what is set must be sound.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz font`
#![no_main]

use fretwork::source::font::set;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    // What is left out most often would never be found: the signatures.
    for head in [&b""[..], b"wOFF", b"wOF2"] {
        let font = [head, bytes].concat();
        if let Ok(set) = set(&font, "OB\nAV", 10.0, 0.5) {
            assert!(set.lines.iter().all(|line| line.width.is_finite()));
        }
    }
});
