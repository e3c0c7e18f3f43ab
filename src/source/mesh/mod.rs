//! Meshes from files, a module per format; the file's extension chooses.
//!
//! ```text
//! stl, obj, ply  one mesh;  gltf: bodies in their places, with materials
//! face           a face of any number of corners → triangles
//! lines          text → lines, whatever ends them
//! ```

mod face;
pub mod gltf;
mod limit;
mod lines;
pub mod obj;
pub mod ply;
pub mod stl;

use std::sync::Arc;

use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Affine3, Mesh, Model, Point3};

pub use limit::{MOST_TRIANGLES, Sibling};

/// The formats of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// STL, binary or text.
    Stl,
    /// glTF 2.0 as text or GLB.
    Gltf,
    /// Wavefront OBJ.
    Obj,
    /// PLY, binary or text.
    Ply,
}

/// The extensions of the formats.
const EXTENSIONS: [(&str, MeshFormat); 5] = [
    ("stl", MeshFormat::Stl),
    ("glb", MeshFormat::Gltf),
    ("gltf", MeshFormat::Gltf),
    ("obj", MeshFormat::Obj),
    ("ply", MeshFormat::Ply),
];

impl MeshFormat {
    /// The format of the files with this extension, in letters of either case.
    pub fn of_extension(extension: &str) -> Option<MeshFormat> {
        let mut all = EXTENSIONS.iter();
        all.find(|(known, _)| known.eq_ignore_ascii_case(extension))
            .map(|(_, format)| *format)
    }

    /// The bodies in `bytes`, in units of `unit_mm` millimetres, with what was not read. A file of one
    /// body calls it `stem`.
    fn read(
        self,
        bytes: &[u8],
        stem: &str,
        unit_mm: f64,
        sibling: Sibling<'_>,
    ) -> Result<(Model, Vec<String>), String> {
        let one = |(mesh, told): (Mesh, Vec<String>)| (Model::of(stem, mesh), told);
        match self {
            MeshFormat::Stl => stl::read(bytes).map(|(mesh, told)| one((mesh.welded(), told))),
            MeshFormat::Obj => obj::read(bytes).map(|(mesh, told)| one((joined(mesh), told))),
            MeshFormat::Ply => ply::read(bytes).map(|(mesh, told)| one((joined(mesh), told))),
            MeshFormat::Gltf => {
                let metre = 1000.0 / unit_mm;
                let to_units = Affine3::scale(Point3::new(metre, metre, metre));
                let (model, told) = gltf::read(bytes, sibling)?;
                Ok((model.transformed(&to_units), told))
            }
        }
    }
}

/// A mesh whose corners in the same place are one, unless its bodies are closed as they are and would share edges then.
fn joined(mesh: Mesh) -> Mesh {
    let welded = mesh.welded();
    let bodies_touch = || welded.check_closed().is_err() && mesh.check_closed().is_ok();
    if bodies_touch() { mesh } else { welded }
}

/// The bodies in a file, z up, in units of `unit_mm` millimetres, and warnings about what was not
/// read. glTF is in metres; other files have the unit of the spec. Corners in the same place are
/// joined, but in glTF, whose bodies may carry pictures, and where closed bodies touch.
///
/// # Errors
/// A format that is not known, a file that is broken or cut off, coordinates that are not finite, a mesh without triangles.
pub fn read(
    bytes: &[u8],
    file: &Arc<str>,
    unit_mm: f64,
    sibling: Sibling<'_>,
) -> Result<(Model, Vec<Diagnostic>), Diagnostic> {
    let name = file.rsplit('/').next().unwrap_or(file);
    let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
    let broken = |message: String| {
        Diagnostic::error(format!("`{file}` cannot be read as a mesh: {message}"))
    };
    let format = MeshFormat::of_extension(extension).ok_or_else(|| {
        let known = EXTENSIONS.map(|(extension, _)| extension).join(", ");
        broken(format!(
            "its extension is that of no mesh: the formats are {known}"
        ))
    })?;
    let (model, told) = format.read(bytes, stem, unit_mm, sibling).map_err(broken)?;
    if model.triangle_count() == 0 {
        return Err(broken("it has no triangles".into()));
    }
    let unsound = model.bodies.iter().find_map(|b| b.mesh.validate().err());
    if let Some(error) = unsound {
        return Err(broken(error.to_string()));
    }
    let warning = |what: String| {
        Diagnostic::warning(format!("`{file}`: {what}")).at(Span::File(file.clone()), "")
    };
    Ok((model, told.into_iter().map(warning).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_chooses_the_format() {
        let error = |name: &str| {
            let alone = &mut |_: &str| Err(String::new());
            read(b"", &name.into(), 1.0, alone).unwrap_err().message
        };
        assert_eq!(MeshFormat::of_extension("GLB"), Some(MeshFormat::Gltf));
        assert!(error("a/b.STL").ends_with("it is too short for an STL file"));
        assert!(error("b.step").ends_with("the formats are stl, glb, gltf, obj, ply"));
        assert!(error("stl").contains("its extension is that of no mesh"));
    }

    /// Two boxes whose corners are written for each of them, and that share an edge.
    #[test]
    fn closed_bodies_that_touch_keep_their_own_corners() {
        let mut text = String::new();
        for (number, at) in [(0, 0), (1, 1)] {
            for i in 0..8 {
                text += &format!("v {} {} {}\n", at + (i & 1), at + (i >> 1 & 1), i >> 2);
            }
            for face in [
                [1, 3, 4, 2],
                [5, 6, 8, 7],
                [1, 2, 6, 5],
                [3, 7, 8, 4],
                [1, 5, 7, 3],
                [2, 4, 8, 6],
            ] {
                let [a, b, c, d] = face.map(|corner| corner + 8 * number);
                text += &format!("f {a} {b} {c} {d}\n");
            }
        }
        let read = |text: &str| {
            let (model, _) = read(text.as_bytes(), &"boxes.obj".into(), 1.0, &mut |_| {
                Err(String::new())
            })
            .unwrap();
            model.bodies[0].mesh.clone()
        };
        let topology = read(&text).check_closed().unwrap();
        assert_eq!((topology.components, read(&text).positions.len()), (2, 16));
        // Apart, or open, they are as any other file.
        assert_eq!(
            read(&text.replacen("f 1 3 4 2", "f 1 3 4", 1))
                .positions
                .len(),
            14
        );
    }
}
