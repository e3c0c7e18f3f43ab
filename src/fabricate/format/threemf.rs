//! 3MF (core specification 1.3), in millimetres: an object for each part, named, in its colour.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

use super::zip;
use crate::check::model_check::check;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine3, Mesh, Model, Point3, mesh::Part};

/// Coordinates are whole millionths of a millimetre, nearest to 32-bit floats: readers keep no more.
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

/// The archive with all parts, `unit_mm` millimetres to a unit. Parts with the same body, name and material are
/// one object that is placed several times, unless they are mirrored.
///
/// # Errors
/// What [`check`] finds.
pub fn write(model: &Model, unit_mm: f64) -> Result<Vec<u8>, Diagnostic> {
    check(model, unit_mm)?;
    let text = document(model, unit_mm);
    let files = [
        ("[Content_Types].xml", CONTENT_TYPES.as_bytes()),
        ("_rels/.rels", RELATIONSHIPS.as_bytes()),
        ("3D/3dmodel.model", text.as_bytes()),
    ];
    zip::archive(&files)
        .map_err(|e| Diagnostic::error(format!("the package cannot be written: {e}")))
}

/// What makes two parts one object.
type Key<'a> = (u32, &'a Arc<str>, Option<u32>);

fn document(model: &Model, unit: f64) -> String {
    let mut objects = String::new();
    let mut items = String::new();
    let mut uses: BTreeMap<Key<'_>, usize> = BTreeMap::new();
    model
        .parts
        .iter()
        .for_each(|part| *uses.entry(key(part)).or_default() += 1);
    let mut known: BTreeMap<Key<'_>, usize> = BTreeMap::new();
    let mut next = if model.materials.is_empty() { 1 } else { 2 };
    for part in &model.parts {
        let is_shared = uses[&key(part)] > 1 && part.place.determinant() > 0.0;
        let id = known
            .get(&key(part))
            .copied()
            .filter(|_| is_shared)
            .unwrap_or_else(|| {
                let place = if is_shared {
                    &Affine3::IDENTITY
                } else {
                    &part.place
                };
                let mesh = model.bodies[part.body as usize].mesh.transformed(place);
                push_object(&mut objects, next, part, &mesh, unit);
                if is_shared {
                    known.insert(key(part), next);
                }
                next += 1;
                next - 1
            });
        let place = if is_shared {
            &part.place
        } else {
            &Affine3::IDENTITY
        };
        push_item(&mut items, id, place, unit);
    }
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" ",
    );
    text.push_str(
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n",
    );
    push_materials(&mut text, model);
    text.push_str(&objects);
    text.push_str("</resources>\n<build>\n");
    text.push_str(&items);
    text.push_str("</build>\n</model>\n");
    text
}

fn key(part: &Part) -> Key<'_> {
    (part.body, &part.name, part.material)
}

fn push_materials(out: &mut String, model: &Model) {
    if model.materials.is_empty() {
        return;
    }
    out.push_str("<basematerials id=\"1\">");
    for material in &model.materials {
        let [r, g, b] = material.color;
        let alpha = (material.opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
        put(
            out,
            format_args!(
                "<base name=\"{}\" displaycolor=\"#{r:02X}{g:02X}{b:02X}{alpha:02X}\"/>",
                escaped(&material.name)
            ),
        );
    }
    out.push_str("</basematerials>\n");
}

fn push_object(out: &mut String, id: usize, part: &Part, mesh: &Mesh, unit: f64) {
    put(
        out,
        format_args!(
            "<object id=\"{id}\" type=\"model\" name=\"{}\"",
            escaped(&part.name)
        ),
    );
    if let Some(material) = part.material {
        put(out, format_args!(" pid=\"1\" pindex=\"{material}\""));
    }
    out.push_str("><mesh><vertices>\n");
    let (cells, triangles) = rounded(mesh, unit);
    for [x, y, z] in cells {
        out.push_str("<vertex x=\"");
        push_decimal(out, x);
        out.push_str("\" y=\"");
        push_decimal(out, y);
        out.push_str("\" z=\"");
        push_decimal(out, z);
        out.push_str("\"/>\n");
    }
    out.push_str("</vertices><triangles>\n");
    for [a, b, c] in triangles {
        put(
            out,
            format_args!("<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>\n"),
        );
    }
    out.push_str("</triangles></mesh></object>\n");
}

fn push_item(out: &mut String, id: usize, place: &Affine3, unit: f64) {
    put(out, format_args!("<item objectid=\"{id}\""));
    if *place != Affine3::IDENTITY {
        let rows = [place.x, place.y, place.z, place.origin * unit].map(<[f64; 3]>::from);
        let numbers: Vec<String> = rows
            .iter()
            .flatten()
            .map(|v| (v + 0.0).to_string())
            .collect();
        put(out, format_args!(" transform=\"{}\"", numbers.join(" ")));
    }
    out.push_str("/>\n");
}

/// The corners in millionths of a millimetre, nearest to 32-bit floats. Neighbours that rounding puts in one place become one corner, and
/// their triangles are left out, so that what was closed stays closed.
fn rounded(mesh: &Mesh, unit: f64) -> (Vec<[i64; 3]>, Vec<[u32; 3]>) {
    let cell = |p: &Point3| {
        [p.x, p.y, p.z].map(|v| (f64::from((v * unit) as f32) * PER_MM).round() as i64)
    };
    let cells: Vec<[i64; 3]> = mesh.positions.iter().map(cell).collect();
    let mut same: Vec<u32> = (0..cells.len() as u32).collect();
    let find = |same: &[u32], mut i: u32| {
        while same[i as usize] != i {
            i = same[i as usize];
        }
        i
    };
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if cells[a as usize] == cells[b as usize] {
                let (a, b) = (find(&same, a), find(&same, b));
                same[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut number = vec![u32::MAX; cells.len()];
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for t in mesh
        .triangles
        .iter()
        .map(|t| t.map(|corner| find(&same, corner)))
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

/// A number of millionths, with no more digits than it has.
fn push_decimal(out: &mut String, whole: i64) {
    let (sign, size) = (if whole < 0 { "-" } else { "" }, whole.unsigned_abs());
    let (units, mut rest, mut digits) = (size / 1_000_000, size % 1_000_000, 6);
    put(out, format_args!("{sign}{units}"));
    if rest > 0 {
        while rest.is_multiple_of(10) {
            rest /= 10;
            digits -= 1;
        }
        put(out, format_args!(".{rest:0digits$}"));
    }
}

fn put(out: &mut String, text: std::fmt::Arguments<'_>) {
    out.write_fmt(text)
        .expect("a string takes all that is written");
}

/// Text for an attribute; what XML cannot hold is left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => {}
            c if c.is_control() => {}
            c => out.push(c),
        }
    }
    out
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
        let text = document(&model(), 10.0);
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
                .map(|o| o.attribute("name").unwrap())
                .collect::<Vec<_>>(),
            ["a <b>", "a <b>"]
        );
        assert_eq!(objects[0].attribute("pindex"), Some("0"));
        let items: Vec<_> = all("item")
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
            write(&model(), 10.0).unwrap(),
            write(&model(), 10.0).unwrap()
        );
    }

    #[test]
    fn rounding_keeps_a_closed_mesh_closed() {
        // Far from the origin 32-bit floats are what rounds: two corners were one to readers and two in the file.
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
