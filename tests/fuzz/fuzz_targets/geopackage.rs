//! Any bytes as a GeoPackage: reading them must end without a panic, in memory and time that their length bounds.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz geopackage specs/maps/data`
#![no_main]

use fretwork::source::geo::geopackage;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for layer in [None, Some("faces")] {
        if let Ok(layer) = geopackage::read(bytes, layer) {
            assert!(layer.features.len() <= bytes.len());
        }
    }
});
