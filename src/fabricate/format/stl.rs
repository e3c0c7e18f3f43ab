//! Binary STL, in millimetres. The format knows no parts: all stand in one list of triangles.

use rayon::prelude::*;

use crate::check::model_check::check;
use crate::origin::{Origin, STL_HEAD};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Model, Point3, budget};

/// The bytes of a triangle: its normal, its corners, two unused.
const TRIANGLE: usize = 50;

/// What stands before the triangles of a file that names no origin; it must not begin with `solid`, the word of the text format.
const HEADER: [u8; STL_HEAD] = {
    let mut header = [b' '; STL_HEAD];
    let text = b"fretwork binary STL, millimetres";
    let mut i = 0;
    while i < text.len() {
        header[i] = text[i];
        i += 1;
    }
    header
};

/// The triangles of all parts, `unit_mm` millimetres to a unit. Coordinates are rounded to 32-bit
/// floats. A triangle that loses a corner by that is left out, and its neighbours meet in its place;
/// two triangles that come to lie back to back are left out together.
///
/// # Errors
/// What [`check`] finds.
pub fn write(model: &Model, unit_mm: f64, origin: Option<&Origin>) -> Result<Vec<u8>, Diagnostic> {
    check(model, unit_mm)?;
    // Bodies that stand in many places are written in each of them.
    budget::make("triangles of a file", model.triangle_count(), TRIANGLE);
    let mut out = Vec::with_capacity(84 + TRIANGLE * model.triangle_count());
    out.extend(origin.map_or(HEADER, Origin::head));
    out.extend([0; 4]);
    let mut count: u32 = 0;
    for part in &model.parts {
        let mesh = model.mesh(part);
        let rounded: Vec<[f32; 3]> = mesh.positions.iter().map(|p| round(*p, unit_mm)).collect();
        let corners = mesh
            .triangles
            .iter()
            .map(|t| t.map(|corner| rounded[corner as usize]));
        for corners in without_folds(corners.collect()) {
            count += 1;
            let floats = [normal(corners)].into_iter().chain(corners).flatten();
            floats.for_each(|v| out.extend(v.to_le_bytes()));
            out.extend([0; 2]);
        }
    }
    out[80..84].copy_from_slice(&count.to_le_bytes());
    Ok(out)
}

/// Three rounded corners.
type Corners = [[f32; 3]; 3];

/// The triangles that rounding leaves: those with three corners, without pairs of the same corners in
/// opposite senses, which are a fold without thickness.
fn without_folds(triangles: Vec<Corners>) -> Vec<Corners> {
    let is_flat = |[a, b, c]: &Corners| a == b || b == c || c == a;
    let key = |corners: &Corners| {
        let bits = corners.map(|corner| corner.map(f32::to_bits));
        let mut order = [0, 1, 2];
        order.sort_by_key(|&i| bits[i]);
        let is_even = matches!(order, [0, 1, 2] | [1, 2, 0] | [2, 0, 1]);
        (order.map(|i| bits[i]), is_even)
    };
    let mut is_kept: Vec<bool> = triangles.iter().map(|t| !is_flat(t)).collect();
    let numbered = triangles.par_iter().enumerate();
    let mut keys: Vec<_> = numbered
        .filter(|(number, _)| is_kept[*number])
        .map(|(number, corners)| {
            let (corners, is_even) = key(corners);
            (corners, number, is_even)
        })
        .collect();
    keys.par_sort_unstable();
    for same in keys
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|same| same.len() > 1)
    {
        let mut single: Vec<(usize, bool)> = Vec::new();
        for &(_, number, is_even) in same {
            match single.pop_if(|(_, other)| *other != is_even) {
                Some((opposite, _)) => {
                    is_kept[number] = false;
                    is_kept[opposite] = false;
                }
                None => single.push((number, is_even)),
            }
        }
    }
    let kept = triangles.into_iter().zip(is_kept);
    kept.filter_map(|(corners, is_kept)| is_kept.then_some(corners))
        .collect()
}

/// Negative zero becomes zero.
fn round(p: Point3, unit: f64) -> [f32; 3] {
    [p.x, p.y, p.z].map(|v| (v * unit) as f32 + 0.0)
}

/// The unit normal of the rounded corners; zeros where there is none, which readers replace.
fn normal(corners: Corners) -> [f32; 3] {
    let [a, b, c] = corners.map(|c| Point3::from(c.map(f64::from)));
    let unit = (b - a).cross(c - a).unit().unwrap_or_default();
    round(unit, 1.0)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::check::model_check::tests::cube;
    use fretwork_geometry::{Affine3, Mesh};

    #[test]
    fn a_foreign_reader_sees_the_same_closed_mesh() {
        let mut model = Model::of("a", cube(2.0));
        model.place("b", 0, Affine3::translation(Point3::new(5.0, 0.0, 0.0)));
        let bytes = write(&model, 10.0, None).unwrap();
        assert_eq!(bytes.len(), 84 + 24 * 50);
        let read = stl_io::read_stl(&mut Cursor::new(&bytes)).unwrap();
        read.validate().unwrap();
        let position =
            |v: &stl_io::Vertex| Point3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
        let mesh = Mesh {
            positions: read.vertices.iter().map(position).collect(),
            triangles: read
                .faces
                .iter()
                .map(|f| f.vertices.map(|v| v as u32))
                .collect(),
        };
        assert_eq!(mesh.check_closed().map(|t| t.components), Ok(2));
        assert_eq!(mesh.volume(), 16_000.0);
        assert!(
            read.faces
                .iter()
                .all(|f| f.normal[0].abs() + f.normal[1].abs() + f.normal[2].abs() == 1.0)
        );
        assert_eq!(bytes, write(&model, 10.0, None).unwrap());
    }

    #[test]
    fn triangles_that_rounding_closes_are_left_out() {
        // One corner of the cube is drawn out into an edge that is shorter than a float's last
        // digit.
        let mut mesh = cube(1000.0);
        mesh.positions
            .push(mesh.positions[7] + Point3::new(1e-7, 0.0, 0.0));
        let side = mesh.triangles.iter().position(|t| *t == [1, 3, 7]).unwrap();
        mesh.triangles[side] = [1, 3, 8];
        mesh.triangles.extend([[1, 8, 7], [3, 7, 8]]);
        assert!(mesh.check_closed().is_ok());
        let bytes = write(&Model::of("a", mesh), 1.0, None).unwrap();
        let read = stl_io::read_stl(&mut Cursor::new(&bytes)).unwrap();
        assert_eq!(read.faces.len(), 12);
        read.validate().unwrap();
    }
}
