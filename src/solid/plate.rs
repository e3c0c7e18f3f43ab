//! Flat surfaces: their outline in their own plane, where rims of any width are exact.

use std::collections::BTreeMap;

use fretwork_geometry::drawing::Join;
use fretwork_geometry::mesh::{doubled_normal, open_sides};
use fretwork_geometry::polygon::{fill, offset};
use fretwork_geometry::{FillRule, Mesh, Point, Point3, Polygon, Ring};

use super::{SolidError, extrude};

/// Corners within this part of the size of a surface lie in its plane, and corners of a rim are within this part of where they belong.
const FLAT: f64 = 1e-9;
/// How far the rounding of an offset may be off, as a part of the width.
const ROUND: f64 = 1e-3;

/// A flat surface.
pub(crate) struct Plate {
    origin: Point3,
    /// Along x and y of its plane, and out of it.
    axes: [Point3; 3],
    /// In its plane, y down.
    outline: Vec<Polygon>,
}

impl Plate {
    /// None where the surface is not flat, faces both ways, or has no outline.
    pub fn of(surface: &Mesh) -> Option<Plate> {
        let first = surface.corners(*surface.triangles.first()?);
        let normal = doubled_normal(first).unit()?;
        let size = surface.bounds().longest_side();
        let is_flat = |p: &Point3| (*p - first[0]).dot(normal).abs() <= FLAT * size;
        let faces = |t: &[u32; 3]| doubled_normal(surface.corners(*t)).dot(normal) > 0.0;
        if !(surface.positions.iter().all(is_flat) && surface.triangles.iter().all(faces)) {
            return None;
        }
        let x = (first[1] - first[0]).unit()?;
        let mut plate = Plate {
            origin: first[0],
            axes: [x, normal.cross(x), normal],
            outline: Vec::new(),
        };
        let flat = |corner: u32| plate.flat(surface.positions[corner as usize]);
        let rings: Vec<Ring> = loops(surface)?
            .iter()
            .map(|rim| rim.iter().map(|corner| flat(*corner)).collect())
            .collect();
        plate.outline = fill(&rings, FillRule::EvenOdd).ok()?;
        Some(plate)
    }

    fn flat(&self, p: Point3) -> Point {
        let [x, y, _] = self.axes;
        let way = p - self.origin;
        Point::new(way.dot(x), -way.dot(y))
    }

    /// All of it but rims that are so wide, between two distances out of it. None where the rims are all of it. Without rims it goes a
    /// little beyond the outline, so that its walls are not those of the plate.
    ///
    /// # Errors
    /// An outline that is too small for its numbers, distances that are not in order.
    pub fn ground(&self, frame: f64, low: f64, high: f64) -> Result<Option<Mesh>, SolidError> {
        let by = if frame > 0.0 { -frame } else { high - low };
        let tolerance = ROUND * by.abs();
        let join = if frame > 0.0 {
            Join::Round
        } else {
            Join::Miter(4.0)
        };
        let inner = offset(&self.outline, by, join, tolerance);
        let inner = inner.map_err(|error| SolidError::Combination(error.to_string()))?;
        if inner.is_empty() {
            return Ok(None);
        }
        let mesh = extrude(&inner, low, high)?;
        let [x, y, out] = self.axes;
        let place = |p: &Point3| self.origin + x * p.x + y * p.y + out * p.z;
        Ok(Some(Mesh {
            positions: mesh.positions.iter().map(place).collect(),
            triangles: mesh.triangles,
        }))
    }
}

/// The rims of a surface, corner by corner; none where rims meet in a corner.
fn loops(surface: &Mesh) -> Option<Vec<Vec<u32>>> {
    let open = open_sides(&surface.triangles);
    let mut next: BTreeMap<u32, u32> = open.iter().map(|[a, b]| (*a, *b)).collect();
    if next.len() != open.len() {
        return None;
    }
    let mut loops = Vec::new();
    while let Some((first, mut corner)) = next.pop_first() {
        let mut rim = vec![first];
        while corner != first {
            rim.push(corner);
            corner = next.remove(&corner)?;
        }
        loops.push(rim);
    }
    Some(loops)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Affine3;

    /// A square of side 10 of two triangles, turned about x.
    fn square() -> Mesh {
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
        let mesh = Mesh {
            positions: corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        mesh.transformed(&Affine3::rotation(Point3::new(1.0, 0.0, 0.0), 0.4))
    }

    #[test]
    fn the_ground_of_a_plate_is_inside_of_its_rims() {
        let mesh = square();
        let plate = Plate::of(&mesh).unwrap();
        let ground = plate.ground(2.0, -1.0, 3.0).unwrap().unwrap();
        assert_eq!(ground.check_closed().unwrap().genus, Some(0));
        assert!(
            (ground.volume() - 36.0 * 4.0).abs() < 1e-6,
            "{}",
            ground.volume()
        );
        // It stands where the plate does.
        let middle = mesh.positions[0].lerp(mesh.positions[2], 0.5);
        let normal = doubled_normal(mesh.corners(mesh.triangles[0]))
            .unit()
            .unwrap();
        let center = ground.bounds().center();
        assert!(center.distance(middle + normal * 1.0) < 1e-6);
        assert!(plate.ground(5.5, -1.0, 3.0).unwrap().is_none());
        let beyond = plate.ground(0.0, -1.0, 3.0).unwrap().unwrap();
        assert!((beyond.volume() - 18.0 * 18.0 * 4.0).abs() < 1e-6);
    }

    #[test]
    fn a_bent_surface_is_no_plate() {
        let mut mesh = square();
        mesh.positions[1].z += 0.1;
        assert!(Plate::of(&mesh).is_none());
        let mut both = square();
        both.triangles[1] = [0, 3, 2];
        assert!(Plate::of(&both).is_none());
    }
}
