//! Any text as the style sheet, the `style` and the `transform` of a drawing: reading it must end without a panic, in time that its length bounds.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz css`
#![no_main]

use std::sync::Arc;

use fretwork::source::svg::{SvgOptions, read};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|css: &str| {
    let file: Arc<str> = "drawing.svg".into();
    let options = SvgOptions { tolerance: 0.1, unit_mm: 1.0 };
    let escaped = css.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    let text = format!(
        "<svg><style>{escaped}</style><g class='a' style=\"{escaped}\"><g><path id='b' d='M0 0h9v9'/><rect class='b' width='9' height='9'/></g></g></svg>"
    );
    match read(&text, &file, &options) {
        Err(diagnostics) => assert!(!diagnostics.is_empty()),
        Ok((drawing, _)) => assert!(drawing.bounds().min.is_finite()),
    }
});
