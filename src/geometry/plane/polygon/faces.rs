//! Faces of a planar map as polygons.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::{Polygon, Ring, signed_area};
use crate::numeric::UnionFind;
use crate::planar_map::{FaceId, HalfEdge, PlanarMap, VertexId};

/// The area of a bounded face: its outer ring and its holes, without the edges that dangle into it. Rings that touch
/// themselves at a vertex are taken apart there. Nothing for the unbounded face. O(n) in the edges around the face.
///
/// ```
/// use fretwork_geometry::planar_map::{PlanarMap, resolution};
/// use fretwork_geometry::{FaceId, Point, Region, polygon};
/// let square = Region::rectangle(Point::new(0.0, 0.0), Point::new(2.0, 3.0)).contour;
/// let map = PlanarMap::build(&square, resolution(3.0)).unwrap();
/// assert_eq!(polygon::of_face(&map, FaceId(1))[0].area(), 6.0);
/// ```
pub fn of_face(map: &PlanarMap, face: FaceId) -> Vec<Polygon> {
    let around = map
        .outer_boundary(face)
        .chain(map.inner_boundaries(face).flatten());
    let is_side = |h: HalfEdge| map.face(h.twin()) != face;
    let rings = rings(map, around, is_side);
    nested(rings.into_iter().map(|(_, ring)| ring).collect())
}

/// The area that all faces for which `holds` is true cover together, edges between two of them left out. Where two parts
/// touch at a vertex only they stay apart. O(n log n) in the edges of the map.
pub fn of_faces(map: &PlanarMap, holds: impl Fn(FaceId) -> bool) -> Vec<Polygon> {
    let mut parts = UnionFind::new(map.face_count() + 1);
    let mut sides: Vec<HalfEdge> = Vec::new();
    for edge in map.edges() {
        let (left, right) = (map.left(edge), map.right(edge));
        match (holds(left), holds(right)) {
            (true, true) => {
                parts.unite(left.0, right.0);
            }
            (false, false) => {}
            (on_left, _) => sides.push(HalfEdge {
                edge,
                reversed: !on_left,
            }),
        }
    }
    let is_side = |h: HalfEdge| !holds(map.face(h.twin()));
    let mut of_part: BTreeMap<u32, Vec<Ring>> = BTreeMap::new();
    for (face, ring) in rings(map, sides.into_iter(), is_side) {
        of_part.entry(parts.find(face.0)).or_default().push(ring);
    }
    of_part.into_values().flat_map(nested).collect()
}

/// The rings of one connected area: one outer ring, and the holes in it.
fn nested(rings: Vec<Ring>) -> Vec<Polygon> {
    let (outer, holes): (Vec<Ring>, Vec<Ring>) =
        rings.into_iter().partition(|ring| signed_area(ring) > 0.0);
    let polygon = |outer| Polygon {
        outer,
        holes: Vec::new(),
    };
    let mut polygons: Vec<Polygon> = outer.into_iter().map(polygon).collect();
    if let Some(polygon) = polygons.first_mut() {
        polygon.holes = holes;
    }
    polygons
}

/// The simple rings with an area on their left that the half-edges `sides` are on, each with a face of the area. `is_side`
/// says of a half-edge with the area on its left whether the area ends there.
///
/// A ring follows the border of the area through its vertices: from one side it turns clockwise, over edges with
/// the area on both sides, to the next side. So it stays in one sector of the area at every vertex, and two parts that
/// touch there do not get mixed up. Where it comes to a vertex for the second time, what lies between is a
/// ring of its own.
fn rings(
    map: &PlanarMap,
    sides: impl Iterator<Item = HalfEdge>,
    is_side: impl Fn(HalfEdge) -> bool,
) -> Vec<(FaceId, Ring)> {
    let mut done: HashSet<HalfEdge> = HashSet::new();
    let mut rings = Vec::new();
    for first in sides.filter(|h| is_side(*h)) {
        let mut way: Vec<HalfEdge> = Vec::new();
        let mut visited: HashMap<VertexId, usize> = HashMap::new();
        let mut h = first;
        while done.insert(h) {
            visited.insert(map.origin(h), way.len());
            way.push(h);
            if let Some(&at) = visited.get(&map.origin(h.twin())) {
                let ring = way.split_off(at);
                for side in &ring {
                    visited.remove(&map.origin(*side));
                }
                rings.push((map.face(first), points(map, &ring)));
            }
            h = map.next(h);
            while !is_side(h) {
                h = map.next(h.twin());
            }
        }
    }
    rings
}

fn points(map: &PlanarMap, way: &[HalfEdge]) -> Ring {
    let mut ring = Ring::new();
    for h in way {
        ring.extend(map.half_edge_points(*h));
        // The last point of a half-edge is the first of the next.
        ring.pop();
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar_map::resolution;
    use crate::{CurveLabels, Curves, Point, Seed};

    fn map(lines: &[&[[f64; 2]]]) -> PlanarMap {
        let mut curves = Curves::new();
        for line in lines {
            curves.push(line.iter().map(|p| Point::from(*p)), CurveLabels::default());
        }
        PlanarMap::build(&curves, resolution(10.0)).unwrap()
    }

    const SQUARE: &[[f64; 2]] = &[[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0], [0.0, 0.0]];
    const HOLE: &[[f64; 2]] = &[[3.0, 3.0], [5.0, 3.0], [5.0, 5.0], [3.0, 5.0], [3.0, 3.0]];
    const MIDDLE: &[[f64; 2]] = &[[4.0, 0.0], [4.0, 8.0]];

    #[test]
    fn faces_are_united_and_parts_that_touch_at_a_corner_stay_apart() {
        let map = map(&[SQUARE, HOLE, MIDDLE]);
        let hole = [Point::new(3.5, 4.0), Point::new(4.5, 4.0)].map(|p| map.face_at(p));
        let around = of_faces(&map, |f| f != FaceId::UNBOUNDED && !hole.contains(&f));
        assert_eq!((around.len(), around[0].holes.len()), (1, 1));
        assert_eq!(around[0].area(), 60.0);
        let all = of_faces(&map, |f| f != FaceId::UNBOUNDED);
        assert_eq!((all.len(), all[0].holes.len(), all[0].area()), (1, 0, 64.0));
        assert!(of_faces(&map, |_| false).is_empty());
        let quarters = self::map(&[SQUARE, MIDDLE, &[[0.0, 4.0], [8.0, 4.0]]]);
        let ends = [Point::new(1.0, 1.0), Point::new(7.0, 7.0)].map(|p| quarters.face_at(p));
        assert_eq!(of_faces(&quarters, |f| ends.contains(&f)).len(), 2);
    }

    #[test]
    fn areas_are_those_of_the_faces() {
        for case in 0..20 {
            let seed = Seed::root(case);
            let mut curves = Curves::new();
            for i in 0..12 {
                let at = |k: u64| seed.range(8 * i + k, 0.0, 10.0);
                let corners = [0, 2, 4, 0].map(|k| Point::new(at(k), at(k + 1)));
                curves.push(corners, CurveLabels::default());
            }
            let map = PlanarMap::build(&curves, resolution(10.0)).unwrap();
            let holds = |f: FaceId| f.0 > 0 && seed.unit(1000 + u64::from(f.0)) < 0.6;
            let of = |f: FaceId| if holds(f) { map.face_area(f) } else { 0.0 };
            let whole: f64 = map.bounded_faces().map(of).sum();
            let polygons = of_faces(&map, holds);
            let area: f64 = polygons.iter().map(Polygon::area).sum();
            assert!((area - whole).abs() < 1e-9, "case {case}");
            for i in 0..200 {
                let p = Point::new(
                    seed.range(2000 + i, 0.0, 10.0),
                    seed.range(3000 + i, 0.0, 10.0),
                );
                let inside = polygons.iter().any(|polygon| polygon.contains(p));
                assert_eq!(inside, holds(map.face_at(p)), "case {case} {p:?}");
            }
        }
    }
}
