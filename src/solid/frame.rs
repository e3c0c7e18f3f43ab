//! Rims of a surface, so wide along it: an imprint divided where they end, with them filled.

use std::collections::BTreeMap;

use fretwork_geometry::mesh::open_sides;
use fretwork_geometry::{Form, Imprint, OnMesh, Point3, SurfaceMesh, Swept, Turned};

use super::SolidError;

/// Corners within this part of the width of where a rim ends lie there.
const AT_END: f64 = 1e-6;

/// The imprint with every rim of its surface filled as far as `width`.
///
/// On turned surfaces and walls the width is measured along the profile and upward; on others straight to the rim.
///
/// # Errors
/// A surface without rims.
pub fn framed(surface: &SurfaceMesh, imprint: &Imprint, width: f64) -> Result<Imprint, SolidError> {
    let distances = distances(surface);
    if distances.is_empty() {
        return Err(SolidError::NoRim);
    }
    let mut made = imprint.clone();
    for from_rim in &distances {
        fill(&mut made, from_rim, width);
    }
    Ok(made)
}

/// How far a pattern is from the rim that it is farthest from; none where the surface has no rims. A frame that is wider
/// reaches the pattern from every rim.
pub fn farthest_rim(surface: &SurfaceMesh, imprint: &Imprint) -> Option<f64> {
    let filled = imprint.part(true);
    let nearest = |from_rim: &Vec<f64>| {
        let corners = filled.iter().flatten();
        let places = corners.map(|corner| &imprint.places[*corner as usize]);
        let distances = places.map(|place| place.blend_numbers(from_rim));
        distances.fold(f64::INFINITY, f64::min)
    };
    let rims = distances(surface);
    rims.iter().map(nearest).reduce(f64::max)
}

/// The place where a pattern comes nearest to an open rim that it does not run along, and how far it is from it, where that is
/// at most `least`: what is left between them there is no wider.
pub fn near_rim(surface: &SurfaceMesh, imprint: &Imprint, least: f64) -> Option<(Point3, f64)> {
    let border = open_sides(&imprint.part(true));
    let mut found: Option<(u32, f64)> = None;
    for from_rim in distances(surface) {
        let distance = |corner: u32| imprint.places[corner as usize].blend_numbers(&from_rim);
        let runs_along = border
            .iter()
            .any(|side| side.iter().all(|corner| distance(*corner) == 0.0));
        if runs_along {
            continue;
        }
        for corner in border.iter().flatten() {
            let away = distance(*corner);
            if away <= least && found.is_none_or(|(_, known)| away < known) {
                found = Some((*corner, away));
            }
        }
    }
    let (corner, away) = found?;
    let place = imprint.places[corner as usize];
    Some((place.blend(&imprint.surface.positions), away))
}

/// For each rim of a surface how far its corners are from it.
fn distances(surface: &SurfaceMesh) -> Vec<Vec<f64>> {
    match &surface.form {
        Form::Turned(form) => of_turned(form),
        Form::Swept(form) => of_swept(form),
        Form::Free => rims(surface)
            .iter()
            .map(|rim| {
                let to_rim = |p: &Point3| straight(*p, rim);
                surface.positions.iter().map(to_rim).collect()
            })
            .collect(),
    }
}

fn of_turned(form: &Turned) -> Vec<Vec<f64>> {
    let points = &form.profile;
    let mut s = vec![0.0];
    for pair in points.windows(2) {
        s.push(s[s.len() - 1] + pair[0].distance(pair[1]));
    }
    let length = s[s.len() - 1];
    let at_corners = |distance: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let of_point = |(i, p): (usize, &fretwork_geometry::Point)| {
            let count = if p.x == 0.0 {
                1
            } else {
                form.segments as usize
            };
            std::iter::repeat_n(distance(i), count)
        };
        points.iter().enumerate().flat_map(of_point).collect()
    };
    let mut rims = Vec::new();
    if !form.closed && points[0].x > 0.0 {
        rims.push(at_corners(&|i| s[i]));
    }
    if !form.closed && points[points.len() - 1].x > 0.0 {
        rims.push(at_corners(&|i| length - s[i]));
    }
    rims
}

fn of_swept(form: &Swept) -> Vec<Vec<f64>> {
    let height = form.heights[1] - form.heights[0];
    let count = form.points.len();
    let rows = |low: f64, high: f64| [vec![low; count], vec![high; count]].concat();
    let mut rims = vec![rows(0.0, height), rows(height, 0.0)];
    if !form.closed {
        let mut s = vec![0.0];
        for pair in form.points.windows(2) {
            s.push(s[s.len() - 1] + pair[0].distance(pair[1]));
        }
        let length = s[count - 1];
        let back: Vec<f64> = s.iter().map(|s| length - s).collect();
        rims.push([&s[..], &s].concat());
        rims.push([&back[..], &back].concat());
    }
    rims
}

/// The segments of each open loop of a mesh.
fn rims(surface: &SurfaceMesh) -> Vec<Vec<[Point3; 2]>> {
    let open = open_sides(&surface.triangles);
    let mut sets = fretwork_geometry::numeric::UnionFind::new(surface.positions.len());
    for [a, b] in &open {
        sets.unite(*a, *b);
    }
    let mut loops: BTreeMap<u32, Vec<[Point3; 2]>> = BTreeMap::new();
    for [a, b] in open {
        let ends = [a, b].map(|corner| surface.positions[corner as usize]);
        loops.entry(sets.find(a)).or_default().push(ends);
    }
    loops.into_values().collect()
}

/// The distance of a place from segments.
fn straight(p: Point3, segments: &[[Point3; 2]]) -> f64 {
    let to = |[a, b]: &[Point3; 2]| {
        let way = *b - *a;
        let t = ((p - *a).dot(way) / way.dot(way).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        a.lerp(*b, t).distance(p)
    };
    segments.iter().map(to).fold(f64::INFINITY, f64::min)
}

/// Divides triangles where the distance is `width`, and fills what is nearer.
fn fill(imprint: &mut Imprint, from_rim: &[f64], width: f64) {
    let near = AT_END * width;
    let place = |place: &OnMesh| {
        let off = place.blend_numbers(from_rim) - width;
        if off.abs() < near { 0.0 } else { off }
    };
    let mut off: Vec<f64> = imprint.places.iter().map(place).collect();
    let mut between: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let (old, was_inside) = (
        std::mem::take(&mut imprint.triangles),
        std::mem::take(&mut imprint.inside),
    );
    for (triangle, inside) in old.into_iter().zip(was_inside) {
        for (part, is_near) in parts(triangle, &mut off, &mut imprint.places, &mut between) {
            imprint.triangles.push(part);
            imprint.inside.push(inside || is_near);
        }
    }
}

/// A triangle divided by the sign of a value at its corners, with whether each part is below 0.
fn parts(
    triangle: [u32; 3],
    off: &mut Vec<f64>,
    places: &mut Vec<OnMesh>,
    between: &mut BTreeMap<[u32; 2], u32>,
) -> Vec<([u32; 3], bool)> {
    let mut rings = [Vec::new(), Vec::new()];
    for i in 0..3 {
        let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
        let (va, vb) = (off[a as usize], off[b as usize]);
        if va <= 0.0 {
            rings[0].push(a);
        }
        if va >= 0.0 {
            rings[1].push(a);
        }
        if va * vb < 0.0 {
            let (low, high) = (a.min(b), a.max(b));
            let cut = *between.entry([low, high]).or_insert_with(|| {
                let (vl, vh) = (off[low as usize], off[high as usize]);
                let place = places[low as usize].toward(&places[high as usize], vl / (vl - vh));
                places.push(place);
                off.push(0.0);
                (places.len() - 1) as u32
            });
            rings[0].push(cut);
            rings[1].push(cut);
        }
    }
    let is_flat = |ring: &[u32]| ring.iter().all(|corner| off[*corner as usize] == 0.0);
    let mut made = Vec::with_capacity(3);
    for (ring, is_near) in rings.iter().zip([true, false]) {
        // What touches the line by a corner or a side only is no part; a triangle on it counts as near.
        if ring.len() < 3 || (is_flat(ring) && !is_near) {
            continue;
        }
        for k in 1..ring.len() - 1 {
            made.push(([ring[0], ring[k], ring[k + 1]], is_near));
        }
    }
    made
}
