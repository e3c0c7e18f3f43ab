//! Any bytes as a Shapefile and the table beside it, cut apart at a place that the first two bytes say: reading them must
//! end without a panic, in memory and time that their length bounds.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz shapefile`
#![no_main]

use fretwork::source::geo::simple::unusual;
use fretwork::source::geo::{dbf, shapefile};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((cut, rest)) = bytes.split_first_chunk::<2>() else {
        return;
    };
    let cut = usize::from(u16::from_le_bytes(*cut)).min(rest.len());
    let (shapes, table) = rest.split_at(cut);
    let table = dbf::read(table, None).ok();
    if let Ok(layer) = shapefile::read(shapes, table) {
        assert!(layer.features.len() <= shapes.len());
        for record in &layer.features {
            unusual(&record.rings);
        }
    }
});
