//! Any bytes as a mesh: reading them must end without a panic, in memory and time that their length bounds,
//! and what was read must be sound.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz obj`
#![no_main]

use fretwork::source::obj;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match obj::read(bytes) {
        Err(message) => assert!(!message.is_empty()),
        Ok(mesh) => {
            assert!(mesh.triangles.len() <= bytes.len() && mesh.positions.len() <= bytes.len());
            if mesh.validate().is_ok() {
                let welded = mesh.welded();
                assert!(welded.triangles.len() <= mesh.triangles.len());
                welded.topology();
                assert!(welded.triangles.is_empty() || welded.validate().is_ok());
            }
        }
    }
});
