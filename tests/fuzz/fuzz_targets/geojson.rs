//! Any bytes as GeoJSON: reading them must end without a panic, in memory and time that their length bounds.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz geojson specs/maps/data`
#![no_main]

use fretwork::source::geo::geojson;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(layer) = geojson::read(bytes) {
        assert!(layer.features.len() <= bytes.len());
        if let Ok(placed) = layer.placed(None) {
            let points = placed.features.iter().flat_map(|record| record.rings.iter().flatten());
            assert!(points.clone().all(|p| p.is_finite()));
        }
    }
});
