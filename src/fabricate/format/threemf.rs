//! 3MF (core specification 1.3), in millimetres: an object for each part, named, in its colour, and
//! one object of them all where there are several.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

use super::xml::escaped;
use super::zip;
use crate::check::model_check::check;
use crate::origin::{NAMESPACE, Origin};
use crate::sheet::fixed_point;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::{Affine3, Mesh, Model, Point3, mesh::Part};

/// Coordinates are whole millionths of a millimetre, nearest to 32-bit floats: readers keep no
/// more.
const PER_MM: f64 = 1e6;

const CONTENT_TYPES: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    "\n",
    r#"<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">"#,
    r#"<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>"#,
    r#"<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>"#,
    "</Types>\n"
);

const RELATIONSHIPS: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    "\n",
    r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">"#,
    r#"<Relationship Target="/3D/3dmodel.model" Id="rel0" "#,
    r#"Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>"#,
    "</Relationships>\n"
);

/// The archive with all parts, `unit_mm` millimetres to a unit. Parts with the same body, name and
/// material are one object that is placed several times, unless they are mirrored. Several parts
/// are the components of one object.
///
/// # Errors
/// What [`check`] finds.
pub fn write(model: &Model, unit_mm: f64, origin: Option<&Origin>) -> Result<Vec<u8>, Diagnostic> {
    check(model, unit_mm)?;
    let text = document(model, unit_mm, origin);
    let files = [
        ("[Content_Types].xml", CONTENT_TYPES.as_bytes()),
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", text.as_bytes()),
    ];
    zip::archive(&files)
        .map_err(|e| Diagnostic::error(format!("the package cannot be written: {e}")))
}

fn document(model: &Model, unit: f64, origin: Option<&Origin>) -> String {
    let mut resources = Resources {
        model,
        unit,
        text: String::new(),
        known: BTreeMap::new(),
        count: 0,
    };
    resources.push_materials();
    let placed = resources.push_parts();
    let item = match placed[..] {
        [(id, place)] => reference("item", id, &place, unit),
        _ => {
            let id = resources.push_assembly(&placed);
            reference("item", id, &Affine3::IDENTITY, unit)
        }
    };
    let mut text =
        String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" ");
    text +=
        "xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";
    if let Some(origin) = origin {
        text += &format!(" xmlns:fretwork=\"{NAMESPACE}\">\n");
        let line = escaped(&origin.line());
        text += &format!("<metadata name=\"fretwork:origin\" preserve=\"1\">{line}</metadata>\n");
    } else {
        text += ">\n";
    }
    text += "<resources>\n";
    text += &resources.text;
    text += "</resources>\n<build>\n";
    text += &item;
    text += "</build>\n</model>\n";
    text
}

/// What makes two parts one object.
type Key = (u32, Arc<str>, Option<u32>);

fn key(part: &Part) -> Key {
    (part.body, part.name.clone(), part.material)
}

/// The resources of a document as they grow.
struct Resources<'a> {
    model: &'a Model,
    unit: f64,
    text: String,
    /// The objects that stand in several places.
    known: BTreeMap<Key, usize>,
    /// How many there are; they are numbered from 1.
    count: usize,
}

impl Resources<'_> {
    fn next(&mut self) -> usize {
        self.count += 1;
        self.count
    }

    fn push_materials(&mut self) {
        if self.model.materials.is_empty() {
            return;
        }
        let id = self.next();
        self.text += &format!("<basematerials id=\"{id}\">");
        for material in &self.model.materials {
            let [r, g, b] = material.color;
            let alpha = (material.opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
            self.text += &format!(
                "<base name=\"{}\" displaycolor=\"#{r:02X}{g:02X}{b:02X}{alpha:02X}\"/>",
                escaped(&material.name)
            );
        }
        self.text += "</basematerials>\n";
    }

    /// Writes the objects of all parts, and gives the number and the place of each part's object.
    fn push_parts(&mut self) -> Vec<(usize, Affine3)> {
        let model = self.model;
        let mut uses: BTreeMap<Key, usize> = BTreeMap::new();
        for part in &model.parts {
            *uses.entry(key(part)).or_default() += 1;
        }
        let mut placed = Vec::with_capacity(model.parts.len());
        for part in &model.parts {
            let mesh = &model.bodies[part.body as usize].mesh;
            // The format allows no places that mirror.
            if uses[&key(part)] == 1 || part.place.determinant() < 0.0 {
                let id = self.push_object(part, &mesh.transformed(&part.place));
                placed.push((id, Affine3::IDENTITY));
                continue;
            }
            let id = match self.known.get(&key(part)) {
                Some(id) => *id,
                None => self.push_object(part, mesh),
            };
            self.known.insert(key(part), id);
            placed.push((id, part.place));
        }
        placed
    }

    fn push_object(&mut self, part: &Part, mesh: &Mesh) -> usize {
        let id = self.next();
        let name = escaped(&part.name);
        self.text += &format!("<object id=\"{id}\" type=\"model\" name=\"{name}\"");
        if let Some(material) = part.material {
            self.text += &format!(" pid=\"1\" pindex=\"{material}\"");
        }
        self.text += "><mesh><vertices>\n";
        let (cells, triangles) = rounded(mesh, self.unit);
        for cell in cells {
            self.text += "<vertex";
            for (axis, v) in ["x", "y", "z"].into_iter().zip(cell) {
                put(&mut self.text, format_args!(" {axis}=\""));
                push_decimal(&mut self.text, v);
                self.text.push('"');
            }
            self.text += "/>\n";
        }
        self.text += "</vertices><triangles>\n";
        for [a, b, c] in triangles {
            put(
                &mut self.text,
                format_args!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>\n"),
            );
        }
        self.text += "</triangles></mesh></object>\n";
        id
    }

    /// An object made of others: slicers keep it together, while they would lay objects of their
    /// own on the bed one by one.
    fn push_assembly(&mut self, placed: &[(usize, Affine3)]) -> usize {
        let id = self.next();
        self.text += &format!("<object id=\"{id}\" type=\"model\"><components>\n");
        for (part, place) in placed {
            self.text += &reference("component", *part, place, self.unit);
        }
        self.text += "</components></object>\n";
        id
    }
}

/// An element that puts an object in a place.
fn reference(element: &str, id: usize, place: &Affine3, unit: f64) -> String {
    if *place == Affine3::IDENTITY {
        return format!("<{element} objectid=\"{id}\"/>\n");
    }
    let rows = [place.x, place.y, place.z, place.origin * unit].map(<[f64; 3]>::from);
    let numbers = rows.iter().flatten().map(|v| (v + 0.0).to_string());
    let numbers = numbers.collect::<Vec<_>>().join(" ");
    format!("<{element} objectid=\"{id}\" transform=\"{numbers}\"/>\n")
}

/// The corners in millionths of a millimetre, nearest to 32-bit floats. Neighbours that rounding
/// puts in one place become one corner, and their triangles are left out, so that what was closed
/// stays closed.
fn rounded(mesh: &Mesh, unit: f64) -> (Vec<[i64; 3]>, Vec<[u32; 3]>) {
    let cell = |p: &Point3| {
        [p.x, p.y, p.z].map(|v| (f64::from((v * unit) as f32) * PER_MM).round() as i64)
    };
    let cells: Vec<[i64; 3]> = mesh.positions.iter().map(cell).collect();
    let mut same = UnionFind::new(cells.len());
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if cells[a as usize] == cells[b as usize] {
                same.unite(a, b);
            }
        }
    }
    let mut number = vec![u32::MAX; cells.len()];
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for t in mesh
        .triangles
        .iter()
        .map(|t| t.map(|corner| same.find(corner)))
    {
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            continue;
        }
        triangles.push(t.map(|corner| {
            let slot = &mut number[corner as usize];
            if *slot == u32::MAX {
                *slot = corners.len() as u32;
                corners.push(cells[corner as usize]);
            }
            *slot
        }));
    }
    (corners, triangles)
}

/// Appends a number of millionths.
fn push_decimal(out: &mut String, whole: i64) {
    fixed_point::push_scaled(out, whole, 6);
}

fn put(out: &mut String, text: std::fmt::Arguments<'_>) {
    out.write_fmt(text)
        .expect("a string takes all that is written");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::model_check::tests::cube;
    use fretwork_geometry::mesh::Material;

    fn model() -> Model {
        let mut model = Model::of("a <b>", cube(2.0));
        let material = model.add_material(Material::of("wood", [0xc9, 0xa2, 0x7a]));
        model.parts[0].material = Some(material);
        let again = model.parts[0].clone();
        let right = Affine3::translation(Point3::new(5.0, 0.0, 0.5));
        let turned = Affine3::scale(Point3::new(-1.0, 1.0, 1.0));
        model.parts.push(Part {
            place: right,
            ..again.clone()
        });
        model.parts.push(Part {
            place: turned,
            ..again
        });
        model
    }

    #[test]
    fn objects_are_named_and_shared() {
        let text = document(&model(), 10.0, None);
        let tree = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(tree.root_element().attribute("unit"), Some("millimeter"));
        let all = |name: &str| {
            tree.descendants()
                .filter(|n| n.has_tag_name(name))
                .collect::<Vec<_>>()
        };
        let objects = all("object");
        assert_eq!(
            objects
                .iter()
                .map(|o| o.attribute("name"))
                .collect::<Vec<_>>(),
            [Some("a <b>"), Some("a <b>"), None]
        );
        assert_eq!(objects[0].attribute("pindex"), Some("0"));
        // All parts are one object, so that slicers keep them in their places.
        let built: Vec<_> = all("item")
            .iter()
            .map(|i| (i.attribute("objectid").unwrap(), i.attribute("transform")))
            .collect();
        assert_eq!(built, [("4", None)]);
        let items: Vec<_> = all("component")
            .iter()
            .map(|i| (i.attribute("objectid").unwrap(), i.attribute("transform")))
            .collect();
        assert_eq!(
            items,
            [
                ("2", None),
                ("2", Some("1 0 0 0 1 0 0 0 1 50 0 5")),
                ("3", None)
            ]
        );
        assert_eq!((all("vertex").len(), all("triangle").len()), (16, 24));
        assert!(all("vertex").iter().any(|v| v.attribute("x") == Some("20")));
        assert_eq!(all("base")[0].attribute("displaycolor"), Some("#C9A27AFF"));
        assert_eq!(
            write(&model(), 10.0, None).unwrap(),
            write(&model(), 10.0, None).unwrap()
        );
    }

    #[test]
    fn rounding_keeps_a_closed_mesh_closed() {
        // Far from the origin 32-bit floats are what rounds: two corners were one to readers and
        // two in the file.
        for (side, step) in [(1.0, 1e-9), (800.0, 1e-5)] {
            let mut mesh = cube(side);
            mesh.positions
                .push(mesh.positions[7] + Point3::new(step, 0.0, 0.0));
            let side = mesh.triangles.iter().position(|t| *t == [1, 3, 7]).unwrap();
            mesh.triangles[side] = [1, 3, 8];
            mesh.triangles.extend([[1, 8, 7], [3, 7, 8]]);
            assert!(mesh.check_closed().is_ok());
            let (corners, triangles) = rounded(&mesh, 1.0);
            assert_eq!((corners.len(), triangles.len()), (8, 12));
            let point = |c: &[i64; 3]| Point3::from(c.map(|v| v as f64 / PER_MM));
            let back = Mesh {
                positions: corners.iter().map(point).collect(),
                triangles,
            };
            assert!(back.check_closed().is_ok());
        }
    }

    #[test]
    fn readers_see_as_many_places_as_there_are_corners() {
        let seed = fretwork_geometry::Seed::root(4);
        for k in 0..20_000 {
            // Neighbouring floats of all sizes.
            let near = (libm::exp2(seed.range(k, -12.0, 14.0)) as f32).to_bits();
            let [a, b] = [0, 1].map(|i| f32::from_bits(near + i));
            let text = [a, b].map(|v| {
                let mut out = String::new();
                push_decimal(&mut out, (f64::from(v) * PER_MM).round() as i64);
                out
            });
            let read = text.each_ref().map(|t| t.parse::<f32>().unwrap());
            assert_eq!(text[0] == text[1], read[0] == read[1], "{a} {b}");
        }
    }

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        for (whole, text) in [
            (0, "0"),
            (-1_500_000, "-1.5"),
            (1, "0.000001"),
            (20_000_000, "20"),
            (-30, "-0.00003"),
        ] {
            let mut out = String::new();
            push_decimal(&mut out, whole);
            assert_eq!(out, text);
        }
    }
}
