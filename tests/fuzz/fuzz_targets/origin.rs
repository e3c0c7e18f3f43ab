//! Any bytes, of which an origin is asked: what is found can be written and read again.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz origin`

#![no_main]

use fretwork::fabricate::Origin;
use fretwork::fabricate::origin::read;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Some(origin) = read(bytes) {
        assert_eq!(Origin::of_line(&origin.line()), Some(origin));
    }
});
