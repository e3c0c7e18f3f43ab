//! Any text as a drawing: reading it must end without a panic, in memory and time that its length bounds,
//! and what was read must be finite and within its own box.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz svg tests/drawings`
#![no_main]

use std::sync::Arc;

use fretwork::source::svg::{SvgOptions, decode, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let file: Arc<str> = "drawing.svg".into();
    let Ok(text) = decode(bytes, &file) else { return };
    let options = SvgOptions { tolerance: 0.1, unit_mm: 1.0 };
    match read(text, &file, &options) {
        Err(diagnostics) => assert!(!diagnostics.is_empty()),
        Ok((drawing, _)) => {
            let bounds = drawing.bounds();
            let points = drawing.shapes.iter().flat_map(|shape| shape.paths.iter().flatten());
            assert!(points.clone().all(|p| p.is_finite() && bounds.contains(*p)));
            drawing.curves();
            // Areas of many shapes are slow, not wrong.
            if points.count() < 2000 {
                let _ = drawing.areas(0.1);
                let _ = drawing.region();
            }
        }
    }
});
