//! Closed meshes cut by parallel planes.

use rayon::prelude::*;

use super::Mesh;
use crate::budget::{self, Meter};
use crate::polygon::{AreaError, fill};
use crate::{FillRule, Point, Polygon, Ring, View};

/// Steps for a triangle that a plane meets.
const CROSSING: u64 = 20;

/// Why a mesh has no section.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SectionError {
    /// An outline does not close.
    #[error("the body is open near ({}, {}) of the section", .0.x, .0.y)]
    Open(Point),
    /// The area could not be computed.
    #[error(transparent)]
    Area(#[from] AreaError),
}

/// What of a closed `mesh` lies in each of the planes across `view` at the nearnesses `levels`, which ascend; drawn as the
/// view draws it. Where bodies overlap they are one, and what is hollow stays open.
///
/// A corner in a plane counts as above it: a plane through a face that looks at the viewer gives this face, and one
/// through a face that looks away from him gives nothing. A level takes O(n log n) for the n triangles that it meets.
///
/// # Errors
/// [`SectionError`], where the mesh is not closed.
pub fn sections(
    mesh: &Mesh,
    view: &View,
    levels: &[f64],
) -> Result<Vec<Vec<Polygon>>, SectionError> {
    let nearness: Vec<f64> = mesh.positions.iter().map(|p| view.nearness(*p)).collect();
    let flat: Vec<Point> = mesh.positions.iter().map(|p| view.flat(*p)).collect();
    let mut met: Vec<Vec<u32>> = vec![Vec::new(); levels.len()];
    for (triangle, number) in mesh.triangles.iter().zip(0..) {
        let at = triangle.map(|corner| nearness[corner as usize]);
        let low = at.into_iter().fold(f64::INFINITY, f64::min);
        let high = at.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let first = levels.partition_point(|level| *level <= low);
        let last = levels.partition_point(|level| *level <= high);
        budget::spend("triangles in sections", CROSSING * (last - first) as u64);
        met[first..last].iter_mut().for_each(|own| own.push(number));
    }
    let meter = Meter::current();
    let section = |(level, triangles): (&f64, &Vec<u32>)| {
        meter.during(|| {
            let cut = Cut {
                nearness: &nearness,
                flat: &flat,
                level: *level,
            };
            let triangles = triangles.iter().map(|n| mesh.triangles[*n as usize]);
            Ok(fill(&cut.rings(triangles)?, FillRule::NonZero)?)
        })
    };
    levels.par_iter().zip(&met).map(section).collect()
}

/// An edge of the mesh, with the lower number first.
type Edge = [u32; 2];

/// One plane.
struct Cut<'a> {
    nearness: &'a [f64],
    flat: &'a [Point],
    level: f64,
}

impl Cut<'_> {
    /// The outlines, with the body on their left in the drawing.
    ///
    /// Every triangle that the plane meets gives a side between two of its edges, the same edge is the end of a side and the
    /// beginning of the next, and so numbers of corners join them and no coordinates.
    fn rings(&self, triangles: impl Iterator<Item = [u32; 3]>) -> Result<Vec<Ring>, SectionError> {
        let mut sides: Vec<(Edge, Edge)> = triangles.filter_map(|t| self.side(t)).collect();
        sides.sort_unstable();
        let mut used = vec![false; sides.len()];
        let mut rings = Vec::new();
        for first in 0..sides.len() {
            if used[first] {
                continue;
            }
            let (mut ring, mut at) = (Ring::new(), first);
            loop {
                used[at] = true;
                let (from, to) = sides[at];
                let p = self.crossing(from);
                if ring.last() != Some(&p) {
                    ring.push(p);
                }
                if to == sides[first].0 {
                    break;
                }
                let next = sides.partition_point(|side| side.0 < to);
                let same = sides[next..].iter().take_while(|side| side.0 == to);
                let free = (next..next + same.count()).find(|n| !used[*n]);
                at = free.ok_or(SectionError::Open(self.crossing(to)))?;
            }
            rings.push(ring);
        }
        Ok(rings)
    }

    fn is_above(&self, corner: u32) -> bool {
        self.nearness[corner as usize] >= self.level
    }

    /// The edges that a side of the section begins and ends on, where the triangle has one. The drawing plane is mirrored, so that
    /// it begins where the way around the triangle comes up.
    fn side(&self, t: [u32; 3]) -> Option<(Edge, Edge)> {
        let (mut up, mut down) = (None, None);
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            match (self.is_above(a), self.is_above(b)) {
                (false, true) => up = Some([a.min(b), a.max(b)]),
                (true, false) => down = Some([a.min(b), a.max(b)]),
                _ => {}
            }
        }
        up.zip(down)
    }

    /// Where an edge meets the plane.
    fn crossing(&self, [a, b]: Edge) -> Point {
        let (a, b) = (a as usize, b as usize);
        let t = (self.level - self.nearness[a]) / (self.nearness[b] - self.nearness[a]);
        self.flat[a].lerp(self.flat[b], t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::revolve;
    use crate::{Point3, Seed};

    fn cube(at: Point3, size: f64) -> Mesh {
        Mesh::cuboid(at, at + Point3::new(size, size, size))
    }

    fn area(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    fn above() -> View {
        View::from(Point3::new(0.0, 0.0, 1.0)).unwrap()
    }

    #[test]
    fn a_cube_has_square_sections_and_its_upper_face_belongs_to_it() {
        let mesh = cube(Point3::new(1.0, 2.0, 3.0), 2.0);
        assert!(mesh.volume() > 0.0);
        let found = sections(&mesh, &above(), &[2.9, 3.0, 3.1, 4.0, 5.0, 5.1]).unwrap();
        let areas: Vec<f64> = found.iter().map(|section| area(section)).collect();
        assert_eq!(areas, [0.0, 0.0, 4.0, 4.0, 4.0, 0.0]);
        let bounds = found[2][0].bounds();
        assert_eq!(
            (bounds.min, bounds.max),
            (Point::new(1.0, -4.0), Point::new(3.0, -2.0))
        );
        // Across the corner the section is a hexagon.
        let slanted = View::from(Point3::new(1.0, 1.0, 1.0)).unwrap();
        let middle = slanted.nearness(Point3::new(2.0, 3.0, 4.0));
        let hexagon = sections(&mesh, &slanted, &[middle]).unwrap();
        assert!((area(&hexagon[0]) - 3.0 * 3f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn hollows_stay_open_and_what_overlaps_is_one() {
        let mut mesh = cube(Point3::ORIGIN, 4.0);
        mesh.append(&cube(Point3::new(1.0, 1.0, 1.0), 2.0).reversed());
        mesh.append(&cube(Point3::new(3.0, 3.0, 0.0), 4.0));
        let found = sections(&mesh, &above(), &[2.0]).unwrap();
        assert!((area(&found[0]) - (16.0 - 4.0 + 16.0 - 1.0)).abs() < 1e-6);
    }

    #[test]
    fn slices_of_a_cone_sum_up_to_its_volume() {
        let profile = [[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]].map(Point::from);
        let mesh = revolve(&profile, false, 64).unwrap();
        assert!(mesh.check_closed().is_ok());
        let count = 200;
        let height = |i: usize| 10.0 * (i as f64 + 0.5) / count as f64;
        let levels: Vec<f64> = (0..count).map(height).collect();
        let found = sections(&mesh, &above(), &levels).unwrap();
        let sum: f64 = found.iter().map(|section| area(section)).sum();
        let volume = sum * 10.0 / count as f64;
        assert!((volume / mesh.volume().abs() - 1.0).abs() < 1e-4);
        let of_disc = |level: f64| {
            let radius = 10.0 - level;
            32.0 * radius * radius * libm::sin(std::f64::consts::TAU / 64.0)
        };
        for (section, level) in found.iter().zip(&levels) {
            assert!((area(section) - of_disc(*level)).abs() < 1e-6);
        }
    }

    #[test]
    fn an_open_mesh_has_no_section() {
        let mut mesh = cube(Point3::ORIGIN, 1.0);
        mesh.triangles.pop();
        let side = View::from(Point3::new(1.0, 0.3, 0.2)).unwrap();
        let at = side.nearness(Point3::new(0.9, 0.5, 0.5));
        assert!(matches!(
            sections(&mesh, &side, &[at]),
            Err(SectionError::Open(_))
        ));
    }

    /// A point is in the section where a ray from it crosses the surface an odd number of times.
    #[test]
    fn sections_hold_what_rays_say() {
        let seed = Seed::root(8);
        let mut mesh = cube(Point3::ORIGIN, 3.0);
        for i in 0..4 {
            let at = |k: u64| seed.range(10 * i + k, 4.0, 9.0) * i as f64;
            mesh.append(&cube(Point3::new(at(1), at(2), 0.3 * i as f64), 3.0));
        }
        let view = View::from(Point3::new(0.3, -0.5, 0.8)).unwrap();
        let levels = [0.5, 1.7, 2.9];
        let found = sections(&mesh, &view, &levels).unwrap();
        for (section, level) in found.iter().zip(levels) {
            for i in 0..400 {
                let p = Point3::new(
                    seed.range(1000 + 3 * i, -1.0, 12.0),
                    seed.range(1001 + 3 * i, -1.0, 12.0),
                    seed.range(1002 + 3 * i, -1.0, 5.0),
                );
                let p = p + view.toward() * (level - view.nearness(p));
                let inside = section.iter().any(|s| s.contains(view.flat(p)));
                assert_eq!(inside, is_inside(&mesh, p), "{p:?}");
            }
        }
    }

    fn is_inside(mesh: &Mesh, p: Point3) -> bool {
        let pieces = mesh.components();
        let winding = |piece: &Mesh| {
            let solid = |t: &[u32; 3]| {
                let [a, b, c] = piece.corners(*t).map(|corner| corner - p);
                let (la, lb, lc) = (a.length(), b.length(), c.length());
                let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
                2.0 * libm::atan2(a.dot(b.cross(c)), below)
            };
            piece.triangles.iter().map(solid).sum::<f64>()
        };
        pieces.iter().map(winding).sum::<f64>() > std::f64::consts::TAU
    }
}
