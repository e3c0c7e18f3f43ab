//! Meshes from files of any of the formats, chosen by the file's extension.

use std::sync::Arc;

use super::{gltf, obj, ply, stl};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine3, Model, Point3};

/// More triangles than this are refused.
pub const MOST_TRIANGLES: usize = 50_000_000;

/// Reads a file that a file names, by its path relative to that one; a message when it cannot be read.
pub type Sibling<'a> = &'a mut dyn FnMut(&str) -> Result<Arc<[u8]>, String>;

/// The bodies in a file, z up, in units of `unit_mm` millimetres. glTF is in metres; other files have the unit of the
/// spec. Corners in the same place are joined, but in glTF, whose bodies may carry pictures.
///
/// # Errors
/// A format that is not known, a file that is broken or cut off, coordinates that are not finite, a mesh without triangles.
pub fn read(
    bytes: &[u8],
    file: &Arc<str>,
    unit_mm: f64,
    sibling: Sibling<'_>,
) -> Result<Model, Diagnostic> {
    let name = file.rsplit('/').next().unwrap_or(file);
    let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
    let one = |mesh: Result<fretwork_geometry::Mesh, String>| {
        mesh.map(|mesh| Model::of(stem, mesh.welded()))
    };
    let model = match &*extension.to_ascii_lowercase() {
        "stl" => one(stl::read(bytes)),
        "obj" => one(obj::read(bytes)),
        "ply" => one(ply::read(bytes)),
        "glb" | "gltf" => {
            let metre = 1000.0 / unit_mm;
            gltf::read(bytes, sibling)
                .map(|model| model.transformed(&Affine3::scale(Point3::new(metre, metre, metre))))
        }
        _ => Err("its extension is that of no mesh: stl, glb, gltf, obj or ply".into()),
    };
    let broken = |message: String| {
        Diagnostic::error(format!("`{file}` cannot be read as a mesh: {message}"))
    };
    let model = model.map_err(broken)?;
    if model.triangle_count() == 0 {
        return Err(broken("it has no triangles".into()));
    }
    let mut bodies = model
        .bodies
        .iter()
        .filter_map(|body| body.mesh.validate().err());
    match bodies.next() {
        Some(error) => Err(broken(error.to_string())),
        None => Ok(model),
    }
}
