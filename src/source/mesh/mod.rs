//! Meshes from files, a module per format; the file's extension chooses.
//!
//! ```text
//! stl, ply       one mesh;  obj, mtl: a body for each material;  gltf: bodies in their places, with materials
//! face           a face of any number of corners → triangles
//! lines          text → lines, whatever ends them
//! ```

mod face;
pub mod gltf;
mod limit;
mod lines;
mod mtl;
pub mod obj;
pub mod ply;
pub mod stl;

use std::sync::Arc;

use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::mesh::Material;
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
            MeshFormat::Stl => stl::read(bytes).map(|(mesh, mut told)| {
                told.extend(collapsed(&mesh));
                one((mesh.welded(), told))
            }),
            MeshFormat::Obj => colored(obj::read_parts(bytes)?, stem, sibling),
            MeshFormat::Ply => ply::read(bytes).map(|(mesh, mut told)| {
                told.extend(collapsed(&mesh));
                one((joined(mesh), told))
            }),
            MeshFormat::Gltf => {
                let metre = 1000.0 / unit_mm;
                let to_units = Affine3::scale(Point3::new(metre, metre, metre));
                let (model, told) = gltf::read(bytes, sibling)?;
                Ok((model.transformed(&to_units), told))
            }
        }
    }
}

/// An OBJ file as a body for each of its materials, or as one where its libraries know none of them.
fn colored(
    read: obj::Parts,
    stem: &str,
    sibling: Sibling<'_>,
) -> Result<(Model, Vec<String>), String> {
    let mut told = read.told;
    told.extend(collapsed(&read.whole));
    let mut known: Vec<Material> = Vec::new();
    for library in &read.libraries {
        match sibling(library).and_then(|bytes| mtl::read(&bytes)) {
            Ok(materials) => known.extend(materials),
            Err(error) => told.push(format!("its materials are not read: {error}")),
        }
    }
    let named = |name: &str| known.iter().find(|material| &*material.name == name);
    if read.parts.iter().all(|(name, _)| named(name).is_none()) {
        return Ok((Model::of(stem, joined(read.whole)), told));
    }
    let mut model = Model::default();
    let is_alone = read.parts.len() == 1;
    for (name, mesh) in read.parts {
        let material = named(&name).map(|found| model.add_material(found.clone()));
        let part = if is_alone || name.is_empty() {
            stem.to_owned()
        } else {
            format!("{stem}.{name}")
        };
        model.push(part, joined(mesh)).material = material;
    }
    Ok((model, told))
}

/// What is told where triangles have two corners in one place, by which they vanish; nothing where all do.
fn collapsed(mesh: &Mesh) -> Option<String> {
    let all = mesh.triangles.iter().map(|t| mesh.corners(*t));
    let mut found = all.filter(|[a, b, c]| a == b || b == c || c == a);
    let [a, b, c] = found.next()?;
    let count = 1 + found.count();
    let at = (a + b + c) * (1.0 / 3.0);
    let (are, verb) = match count {
        1 => ("triangle has two corners in one place,", "it is"),
        _ => ("triangles have two corners in one place, one", "they are"),
    };
    (count < mesh.triangles.len()).then(|| {
        format!(
            "{count} {are} near ({:.3}, {:.3}, {:.3}) of the file; {verb} left out",
            at.x, at.y, at.z
        )
    })
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

    #[test]
    fn the_materials_of_an_obj_are_kept() {
        let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\nusemtl red\nf 1 4 2\n";
        let read = |text: &str, library: Result<&'static str, &str>| {
            let mut sibling = |name: &str| {
                assert_eq!(name, "a.mtl");
                let found = library.map_err(str::to_owned)?;
                Ok(Arc::from(found.as_bytes()))
            };
            read(text.as_bytes(), &"a.obj".into(), 1.0, &mut sibling).unwrap()
        };
        let (model, told) = read(text, Ok("newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n"));
        assert_eq!(told, []);
        let colors = model.parts.iter().map(|part| {
            let material = &model.materials[part.material.unwrap() as usize];
            (
                &*part.name,
                model.mesh(part).triangles.len(),
                material.color,
            )
        });
        let expected = [("a.red", 2, [255, 0, 0]), ("a.blue", 1, [0, 0, 255])];
        assert_eq!(colors.collect::<Vec<_>>(), expected);
        // Without a library it is one body, and that is told.
        let (model, told) = read(text, Err("no such file"));
        assert_eq!((model.parts.len(), model.triangle_count()), (1, 3));
        assert!(
            told[0]
                .message
                .contains("materials are not read: no such file")
        );
        let (model, _) = read(text, Ok("newmtl green\n"));
        assert_eq!((model.parts.len(), model.parts[0].material), (1, None));
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
