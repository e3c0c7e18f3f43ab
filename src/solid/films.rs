//! Faces of one body that lie in those of another but for rounding. Taken as they are, such a pair leaves films and shreds where
//! there should be one face; here the body that is taken away or added is moved a little through the other's surface, so that the
//! other's faces alone decide.

use std::collections::BTreeMap;

use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::mesh::doubled_normal;
use fretwork_geometry::{Bounds3, Mesh, Point3};

/// Corners within this part of the size of a body's surface lie in it.
const IN_SURFACE: f64 = 1e-9;
/// How far corners are moved through the surface, as a part of the size: more than rounding, and less than shows in files.
const MOVED: f64 = 1e-6;
/// The cosine between two faces that lie in one another.
const PARALLEL: f64 = 0.999;

/// What becomes of the second body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meeting {
    /// It is taken away: where its face is a face of the first, it goes out of it.
    Taken,
    /// It is added: where its face lies against one of the first, it goes into it.
    Added,
}

/// `other` with the corners moved of its faces that lie in those of `of` but for rounding; none where there are no such. Faces
/// that lie in one another exactly are left: there the engine knows what to do.
pub(crate) fn moved_through(of: &Mesh, other: &Mesh, meeting: Meeting) -> Option<Mesh> {
    let faces = Faces::new(of, other.bounds())?;
    let wanted = match meeting {
        Meeting::Taken => 1.0,
        Meeting::Added => -1.0,
    };
    let mut touching: BTreeMap<u32, Option<Touch>> = BTreeMap::new();
    let (mut corners, mut is_inexact) = (Vec::new(), false);
    for triangle in &other.triangles {
        let mut touch = |corner: u32| {
            let at = other.positions[corner as usize];
            let known = touching.entry(corner).or_insert_with(|| faces.touch(at));
            known.clone()
        };
        let [Some(a), Some(b), Some(c)] = triangle.map(&mut touch) else {
            continue;
        };
        let normal = doubled_normal(other.corners(*triangle)).unit();
        if normal.is_some_and(|normal| a.lie_in_one([&b, &c], normal * wanted)) {
            is_inexact |= [&a, &b, &c].iter().any(|touch| touch.is_inexact);
            corners.extend(triangle);
        }
    }
    if !is_inexact {
        return None;
    }
    let mut moved = other.clone();
    corners.sort_unstable();
    corners.dedup();
    for corner in corners {
        if let Some(Some(touch)) = touching.get(&corner) {
            let way = touch.outward() * (MOVED * faces.size * wanted);
            moved.positions[corner as usize] = moved.positions[corner as usize] + way;
        }
    }
    Some(moved)
}

/// Where a corner touches a body: the normals of the faces that it lies in.
#[derive(Clone, Debug)]
struct Touch {
    normals: Vec<Point3>,
    is_inexact: bool,
}

impl Touch {
    /// Whether this corner and two others lie in one face that faces along `normal`.
    fn lie_in_one(&self, others: [&Touch; 2], normal: Point3) -> bool {
        let has = |touch: &Touch, n: Point3| touch.normals.iter().any(|own| own.dot(n) > PARALLEL);
        let faces = self.normals.iter().filter(|n| n.dot(normal) > PARALLEL);
        faces
            .into_iter()
            .any(|n| others.iter().all(|other| has(other, *n)))
    }

    /// The way out of all the faces, at least as far as 1 out of each where they are not opposed.
    fn outward(&self) -> Point3 {
        let sum = self.normals.iter().fold(Point3::ORIGIN, |sum, n| sum + *n);
        let Some(way) = sum.unit() else {
            return Point3::ORIGIN;
        };
        let least = self.normals.iter().map(|n| n.dot(way)).fold(1.0, f64::min);
        way * (1.0 / least.max(0.25))
    }
}

/// The faces of a body near another one.
struct Faces<'a> {
    of: &'a Mesh,
    near: Vec<[u32; 3]>,
    tree: BoxTree<3>,
    size: f64,
}

impl<'a> Faces<'a> {
    fn new(of: &'a Mesh, room: Bounds3) -> Option<Faces<'a>> {
        let size = of.bounds().union(room).longest_side();
        let room = widened(room.into(), IN_SURFACE * size);
        let bounds = |t: &[u32; 3]| -> Extent<3> {
            let corners = of.corners(*t);
            Bounds3::of(corners).into()
        };
        let near: Vec<[u32; 3]> = of
            .triangles
            .iter()
            .filter(|t| bounds(t).meets(&room))
            .copied()
            .collect();
        if near.is_empty() {
            return None;
        }
        let boxes: Vec<Extent<3>> = near
            .iter()
            .map(|t| widened(bounds(t), IN_SURFACE * size))
            .collect();
        let tree = BoxTree::new(&boxes);
        Some(Faces {
            of,
            near,
            tree,
            size,
        })
    }

    /// The faces that a place lies in, if it lies in any.
    fn touch(&self, at: Point3) -> Option<Touch> {
        let (mut normals, mut is_inexact) = (Vec::<Point3>::new(), false);
        self.tree
            .for_meeting(&Extent::from([at.x, at.y, at.z]), |number| {
                let corners = self.of.corners(self.near[number as usize]);
                let Some((normal, off)) = height(corners, at, IN_SURFACE * self.size) else {
                    return;
                };
                is_inexact |= off != 0.0;
                if normals.iter().all(|known| known.dot(normal) < PARALLEL) {
                    normals.push(normal);
                }
            });
        (!normals.is_empty()).then_some(Touch {
            normals,
            is_inexact,
        })
    }
}

/// The normal of a triangle and how far above it a place is that lies in it, within `near`.
fn height(corners: [Point3; 3], at: Point3, near: f64) -> Option<(Point3, f64)> {
    let normal = doubled_normal(corners).unit()?;
    let off = (at - corners[0]).dot(normal);
    if off.abs() > near {
        return None;
    }
    let is_within = (0..3).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        let side = b - a;
        normal.cross(side).dot(at - a) >= -near * side.length()
    });
    is_within.then_some((normal, off))
}

fn widened(mut extent: Extent<3>, by: f64) -> Extent<3> {
    for axis in 0..3 {
        extent.min[axis] -= by;
        extent.max[axis] += by;
    }
    extent
}

#[cfg(test)]
mod tests {
    use super::super::{Operation, combine, cuboid};
    use super::*;
    use fretwork_geometry::Affine3;

    /// A cube of side 2 and a smaller block on or in its upper face, both turned so that no corner is exact.
    fn pair(block: [f64; 3]) -> [Mesh; 2] {
        let axis = Point3::new(0.3, 0.7, 0.2).unit().unwrap();
        let turn = Affine3::rotation(axis, 0.61);
        let cube = cuboid(Point3::new(2.0, 2.0, 2.0)).unwrap();
        let small = cuboid(Point3::new(1.0, 0.7, 0.5)).unwrap();
        let small = small.transformed(&Affine3::translation(block.into()));
        [cube.transformed(&turn), small.transformed(&turn)]
    }

    #[test]
    fn a_pocket_that_is_flush_but_for_rounding_leaves_no_film() {
        let [cube, block] = pair([0.4, 0.6, 1.5]);
        assert!(moved_through(&cube, &block, Meeting::Taken).is_some());
        assert!(moved_through(&cube, &block, Meeting::Added).is_none());
        let rest = combine(Operation::Difference, &[cube, block]).unwrap();
        assert!((rest.volume() - (8.0 - 0.35)).abs() < 1e-5);
        let topology = rest.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(0)));
        // The walls of the pocket are added to the faces of the cube. A film would count twice.
        assert!((rest.area() - (24.0 + 1.7)).abs() < 1e-4);
    }

    #[test]
    fn a_block_that_stands_on_a_body_but_for_rounding_hangs_together_with_it() {
        let [cube, block] = pair([0.4, 0.6, 2.0]);
        assert!(moved_through(&cube, &block, Meeting::Added).is_some());
        let whole = combine(Operation::Union, &[cube, block]).unwrap();
        assert!((whole.volume() - (8.0 + 0.35)).abs() < 1e-5);
        let topology = whole.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(0)));
        assert!((whole.area() - (24.0 + 1.7)).abs() < 1e-4);
    }

    #[test]
    fn what_meets_exactly_or_nowhere_is_left_as_it_is() {
        let cube = cuboid(Point3::new(2.0, 2.0, 2.0)).unwrap();
        let on = cube.transformed(&Affine3::translation(Point3::new(0.0, 0.0, 2.0)));
        assert_eq!(moved_through(&cube, &on, Meeting::Added), None);
        let far = cube.transformed(&Affine3::translation(Point3::new(9.0, 0.0, 2.0)));
        assert_eq!(moved_through(&cube, &far, Meeting::Added), None);
        assert_eq!(moved_through(&cube, &far, Meeting::Taken), None);
    }
}
