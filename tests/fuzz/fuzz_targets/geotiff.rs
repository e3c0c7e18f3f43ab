//! Any bytes as a GeoTIFF: opening it and reading samples must end without a panic, in memory that the length bounds.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz geotiff specs/maps/data`
#![no_main]

use std::io::Cursor;

use fretwork::geometry::Samples;
use fretwork::source::geo::geotiff::open;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(raster) = open(Cursor::new(bytes.to_vec()), 1) {
        let [width, height] = raster.blocks.size();
        assert!(width > 0 && height > 0);
        for k in 0..64 {
            raster.blocks.sample(k * (width - 1) / 63, (k * 37 % 64) * (height - 1) / 63);
        }
    }
});
