//! Any bytes as a picture: reading them must end without a panic, in memory and time that the size which is claimed
//! bounds.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz image tests/pictures`
#![no_main]

use fretwork::source::image::{colors, luma};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(picture) = luma(bytes) {
        assert!(picture.width > 0 && picture.values.len() % picture.width == 0);
        assert!(picture.values.iter().all(|v| (0.0..=1.0).contains(v)));
        let colors = colors(bytes).expect("what has luma has colours");
        assert_eq!((colors.width, colors.values.len()), (picture.width, picture.values.len()));
    }
});
