//! A pattern pressed into a surface and engraved: the surface made thick, and lower by a depth where the pattern is, or
//! where it is not. As for `inlay`, the surface is divided already, so that nothing has to be cut.

use std::collections::{BTreeMap, BTreeSet};

use fretwork_geometry::mesh::open_sides;
use fretwork_geometry::progress::step;
use fretwork_geometry::{Imprint, Mesh, Point3, SurfaceMesh};

use super::SolidError;
use super::carving::{Carving, Keep};
use super::frame::framed;
use super::inlay::{Fans, check, compact, moved, with_most};
use super::shell::between;

/// The surface made thick, `depth` lower on its outer face where it is engraved.
///
/// # Errors
/// Another surface than that of the imprint, rims where the surface has none, and bends sharper than the thickness. That the
/// depth is less than the thickness is up to the caller.
pub fn engrave_imprint(
    surface: &SurfaceMesh,
    imprint: &Imprint,
    carving: &Carving,
    depth: f64,
) -> Result<Mesh, SolidError> {
    if surface.mesh != imprint.surface {
        return Err(SolidError::OtherSurface);
    }
    step(|| "engraving a surface".to_owned());
    let divided;
    let (imprint, is_inside) = match carving.keep {
        Keep::Ground => (imprint, true),
        Keep::Pattern { frame: 0.0 } => (imprint, false),
        Keep::Pattern { frame } => {
            divided = framed(surface, imprint, frame)?;
            (&divided, false)
        }
    };
    let [low, high] = between(carving.thickness, carving.side);
    let lowered = imprint.part(is_inside);
    let copies = |part: f64| [low, high, high - depth].map(|out| moved(imprint, part * out));
    let before = imprint.positions();
    let checked = |[inner, outer, floor]: &[Vec<Point3>; 3]| {
        check(&before, inner, &imprint.triangles)?;
        check(&before, outer, &imprint.part(!is_inside))?;
        check(&before, floor, &lowered)
    };
    let made = copies(1.0);
    checked(&made)
        .map_err(|error| with_most(error, high - low, |part| checked(&copies(part)).is_ok()))?;
    let mesh = Engraving::new(imprint, &lowered, imprint.part(!is_inside)).body(&made);
    mesh.check_closed()?;
    Ok(mesh)
}

/// The parts of an engraved body. Its corners are those of the imprint on the inner face, then those on the outer face, then
/// those of the floor, where parts of the floor that meet in a point have corners of their own.
struct Engraving<'a> {
    imprint: &'a Imprint,
    ground: Vec<[u32; 3]>,
    floor: Fans,
    /// The sides of the imprint that no other triangle has.
    rim: BTreeSet<[u32; 2]>,
}

impl<'a> Engraving<'a> {
    fn new(imprint: &'a Imprint, lowered: &[[u32; 3]], ground: Vec<[u32; 3]>) -> Engraving<'a> {
        let rim: BTreeSet<[u32; 2]> = open_sides(&imprint.triangles).into_iter().collect();
        let mut floor = Fans::new(lowered);
        join_at_rim(&mut floor, &rim);
        Engraving {
            imprint,
            ground,
            floor,
            rim,
        }
    }

    fn body(&self, [inner, outer, floor]: &[Vec<Point3>; 3]) -> Mesh {
        let count = self.imprint.places.len() as u32;
        let mut positions = inner.clone();
        positions.extend(outer);
        let floor_corners = self.floor.corners.iter();
        positions.extend(floor_corners.map(|corner| floor[*corner as usize]));
        let inner = self.imprint.triangles.iter().map(|[a, b, c]| [*a, *c, *b]);
        let mut triangles: Vec<[u32; 3]> = inner.collect();
        triangles.extend(self.ground.iter().map(|t| t.map(|corner| corner + count)));
        let floor = self.floor.triangles.iter();
        triangles.extend(floor.map(|t| t.map(|corner| corner + 2 * count)));
        self.push_floor_walls(count, &mut triangles);
        self.push_rim_walls(count, &mut triangles);
        compact(Mesh {
            positions,
            triangles,
        })
    }

    /// Walls around the floor: up to the outer face, and down to the inner one at rims of the surface.
    fn push_floor_walls(&self, count: u32, triangles: &mut Vec<[u32; 3]>) {
        for side in open_sides(&self.floor.triangles) {
            let old = side.map(|corner| self.floor.corners[corner as usize]);
            let [a, b] = side.map(|corner| corner + 2 * count);
            if self.rim.contains(&old) {
                triangles.push([b, a, old[0]]);
                triangles.push([b, old[0], old[1]]);
            } else {
                let [over_a, over_b] = old.map(|corner| corner + count);
                triangles.push([over_a, over_b, b]);
                triangles.push([over_a, b, a]);
            }
        }
    }

    /// Walls at rims beside the floor. Where the floor begins, its corner lies on the edge of the wall.
    fn push_rim_walls(&self, count: u32, triangles: &mut Vec<[u32; 3]>) {
        let mut ends: BTreeMap<u32, u32> = BTreeMap::new();
        for side in open_sides(&self.floor.triangles) {
            let old = side.map(|corner| self.floor.corners[corner as usize]);
            if self.rim.contains(&old) {
                ends.extend(old.into_iter().zip(side));
            }
        }
        for [a, b] in open_sides(&self.ground) {
            if !self.rim.contains(&[a, b]) {
                continue;
            }
            let on_floor = |corner: &u32| ends.get(corner).map(|end| end + 2 * count);
            let (over_a, over_b) = (a + count, b + count);
            let mut down_a = over_a;
            if let Some(floor_a) = on_floor(&a) {
                triangles.push([over_b, over_a, floor_a]);
                down_a = floor_a;
            }
            let mut down_b = over_b;
            if let Some(floor_b) = on_floor(&b) {
                triangles.push([over_b, down_a, floor_b]);
                down_b = floor_b;
            }
            triangles.push([down_b, down_a, a]);
            triangles.push([down_b, a, b]);
        }
    }
}

/// Gives the floor one corner where it reaches a corner of the rim from both sides: a wall that stands there between two parts
/// of the floor has no breadth.
fn join_at_rim(floor: &mut Fans, rim: &BTreeSet<[u32; 2]>) {
    let mut first: BTreeMap<u32, u32> = BTreeMap::new();
    let mut instead: BTreeMap<u32, u32> = BTreeMap::new();
    for side in open_sides(&floor.triangles) {
        let old = side.map(|corner| floor.corners[corner as usize]);
        if !rim.contains(&old) {
            continue;
        }
        for (old, corner) in old.into_iter().zip(side) {
            let known = *first.entry(old).or_insert(corner);
            if known != corner {
                instead.insert(corner, known);
            }
        }
    }
    for corner in floor.triangles.iter_mut().flatten() {
        *corner = *instead.get(corner).unwrap_or(corner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::mesh::revolve;
    use fretwork_geometry::{Form, OnMesh, Point, Side};

    /// A tube of 24 by 6 squares of two triangles each, with some of them filled.
    fn pressed(is_filled: impl Fn(usize, usize) -> bool) -> (SurfaceMesh, Imprint) {
        let profile: Vec<Point> = (0..=6).map(|i| Point::new(10.0, f64::from(i))).collect();
        let mesh = revolve(&profile, false, 24).unwrap();
        let squares = |t: &[u32; 3]| {
            let middle = t.iter().fold(Point3::ORIGIN, |sum, corner| {
                sum + mesh.positions[*corner as usize] * (1.0 / 3.0)
            });
            let turn = libm::atan2(middle.y, middle.x) / std::f64::consts::TAU + 1.0;
            ((turn * 24.0) as usize % 24, middle.z as usize)
        };
        let inside = mesh.triangles.iter().map(|t| {
            let (column, row) = squares(t);
            is_filled(column, row)
        });
        let imprint = Imprint {
            inside: inside.collect(),
            places: (0..mesh.positions.len() as u32)
                .map(OnMesh::corner)
                .collect(),
            triangles: mesh.triangles.clone(),
            surface: mesh.clone(),
        };
        let form = Form::Free;
        (SurfaceMesh { mesh, form }, imprint)
    }

    fn carving(keep: Keep) -> Carving {
        Carving {
            keep,
            thickness: 2.0,
            side: Side::Inside,
            depth: None,
        }
    }

    /// The volume under one square as far as a depth.
    fn square(depth: f64) -> f64 {
        let half = std::f64::consts::PI / 24.0;
        let outer = 10.0 * libm::cos(half);
        libm::tan(half) * (outer * outer - (outer - depth) * (outer - depth))
    }

    #[test]
    fn what_is_engraved_is_so_much_lower_wherever_it_lies() {
        // Apart, meeting in a point, at a rim, from rim to rim, around, and all of it in many places.
        let patterns: [&dyn Fn(usize, usize) -> bool; 7] = [
            &|c, r| c == 3 && (r == 2 || r == 3),
            &|c, r| (c, r) == (3, 2) || (c, r) == (4, 3),
            &|c, r| c == 5 && r < 2,
            &|c, _| c == 5 || c == 9,
            &|_, r| r == 2,
            &|c, r| (c + r) % 2 == 0,
            &|c, r| c % 3 == 0 || r == 0 || r == 5 && c != 7,
        ];
        for (number, is_filled) in patterns.into_iter().enumerate() {
            let (surface, imprint) = pressed(is_filled);
            for keep in [Keep::Ground, Keep::Pattern { frame: 0.0 }] {
                let mesh = engrave_imprint(&surface, &imprint, &carving(keep), 0.5).unwrap();
                let topology = mesh.check_closed().unwrap();
                assert_eq!(
                    (topology.components, topology.genus),
                    (1, Some(1)),
                    "{number}"
                );
                let filled = (0..24 * 6).filter(|i| is_filled(i % 24, i / 24)).count();
                let lowered = if keep == Keep::Ground {
                    filled
                } else {
                    144 - filled
                };
                let expected = 144.0 * square(2.0) - lowered as f64 * square(0.5);
                let off = mesh.volume() / expected - 1.0;
                assert!(off.abs() < 1e-9, "{number} {keep:?}: {off}");
            }
        }
    }
    #[test]
    fn ground_that_meets_a_rim_in_a_point_stands_there() {
        let (surface, mut imprint) = pressed(|_, _| true);
        let rim: BTreeSet<u32> = open_sides(&imprint.triangles)
            .into_iter()
            .flatten()
            .collect();
        let touches = |t: &&[u32; 3]| t.iter().filter(|corner| rim.contains(corner)).count() == 1;
        let only = *imprint.triangles.iter().find(touches).unwrap();
        imprint.inside = imprint.triangles.iter().map(|t| *t != only).collect();
        let mesh = engrave_imprint(&surface, &imprint, &carving(Keep::Ground), 0.5).unwrap();
        assert_eq!(mesh.check_closed().unwrap().components, 1);
        let lowered = 144.0 * (square(2.0) - square(0.5));
        let stands = mesh.volume() - lowered;
        assert!(
            stands > 0.4 * square(0.5) && stands < 0.6 * square(0.5),
            "{stands}"
        );
    }
}
