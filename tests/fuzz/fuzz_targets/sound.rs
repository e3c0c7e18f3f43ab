//! What holds for whatever a reader of meshes makes of any bytes.

use fretwork::geometry::Mesh;

/// Panics where a message is empty, or a mesh is larger than its bytes allow or not sound.
pub fn check(bytes: &[u8], read: Result<Mesh, String>) {
    match read {
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
}
