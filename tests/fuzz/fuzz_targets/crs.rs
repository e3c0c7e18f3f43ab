//! Any text as a coordinate system: reading it must end without a panic, and so must transforming a place with it.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz crs`
#![no_main]

use fretwork::geometry::Point;
use fretwork::source::geo::crs::{Crs, Transform};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let (Ok(crs), Ok(wgs84)) = (Crs::parse(text), Crs::wgs84()) else {
        return;
    };
    let to = Transform::new(wgs84, crs);
    for place in [[0.0, 0.0], [-84.3, 36.6], [180.0, -90.0]] {
        if let Some(p) = to.apply(Point::from(place)) {
            assert!(p.is_finite());
            to.inverse().apply(p);
        }
    }
});
