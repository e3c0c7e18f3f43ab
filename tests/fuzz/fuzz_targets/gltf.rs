//! Any bytes as a mesh: reading them must end without a panic, in memory and time that their length bounds,
//! and what was read must be sound.
//!
//! `RUSTC_BOOTSTRAP=1 cargo fuzz run -s none --fuzz-dir tests/fuzz gltf`
#![no_main]

use fretwork::source::mesh::gltf;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut alone = |_: &str| Err("there is no other file".to_string());
    match gltf::read(bytes, &mut alone) {
        Err(message) => assert!(!message.is_empty()),
        Ok((model, _)) => assert!(model.bodies.iter().all(|body| body.mesh.triangles.len() <= bytes.len())),
    }
});
