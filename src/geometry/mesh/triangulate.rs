//! Polygons with holes to triangles, over exactly the corners that they have.

use std::collections::BTreeMap;

use super::TriangulationError;
use super::delaunay::{Constrained, Delaunay, Edge};
use crate::{Point, Polygon, budget};

/// Steps for a corner.
const CORNER: u64 = 150;

/// The triangles of `polygon`, counter-clockwise (+x toward +y), over the corners of its rings, which are numbered
/// through: the outer ring's first. No corner is added, and every side of a ring is a side of exactly one triangle: the
/// [`open_sides`], on which walls can be put. A constrained Delaunay triangulation; O(n log n). The inside lies
/// on the left of the rings, which may touch in corners, not elsewhere. Where they do, the parts of the inside on both sides
/// of the place have corners of their own there, so that walls on the sides touch but are not joined.
///
/// # Errors
/// Coordinates out of range; rings that cross or touch.
pub fn triangulate(polygon: &Polygon) -> Result<Vec<[u32; 3]>, TriangulationError> {
    let corners: Vec<Point> = polygon.rings().flatten().copied().collect();
    budget::spend("corners to be triangulated", CORNER * corners.len() as u64);
    let mut delaunay = Delaunay::new(&corners)?;
    let mut first = 0;
    for ring in polygon.rings() {
        for i in 0..ring.len() {
            // A side that is known already belongs to two rings.
            if delaunay.constrain(first + i, first + (i + 1) % ring.len()) != Constrained::New {
                return Err(TriangulationError::Crossing {
                    x: ring[i].x,
                    y: ring[i].y,
                });
            }
        }
        first += ring.len();
    }
    Ok(inside(&delaunay, &Corners::new(polygon, &delaunay)))
}

/// The sides of triangles that no other triangle has, each with its triangle on the left, sorted.
pub fn open_sides(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let all = triangles
        .iter()
        .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let mut sides: Vec<[u32; 2]> = all.collect();
    sides.sort_unstable();
    let is_open = |[a, b]: &[u32; 2]| sides.binary_search(&[*b, *a]).is_err();
    sides.iter().copied().filter(is_open).collect()
}

/// From vertices of the triangulation to corners of the rings.
struct Corners {
    /// The only corner at a vertex, or the last of several.
    only: Vec<u32>,
    /// Where rings touch, corners by their vertex and the next one of their ring.
    shared: BTreeMap<(usize, usize), u32>,
}

impl Corners {
    fn new(polygon: &Polygon, delaunay: &Delaunay) -> Corners {
        let count = polygon.rings().map(Vec::len).sum();
        let mut uses = vec![0u32; count];
        (0..count).for_each(|corner| uses[delaunay.vertex(corner)] += 1);
        let mut corners = Corners {
            only: vec![0; count],
            shared: BTreeMap::new(),
        };
        let mut first = 0;
        for ring in polygon.rings() {
            for i in 0..ring.len() {
                let (here, next) = (
                    delaunay.vertex(first + i),
                    delaunay.vertex(first + (i + 1) % ring.len()),
                );
                corners.only[here] = (first + i) as u32;
                if uses[here] > 1 {
                    corners.shared.insert((here, next), (first + i) as u32);
                }
            }
            first += ring.len();
        }
        corners
    }
}

/// The triangles that an odd number of constraints parts from the outside.
fn inside(delaunay: &Delaunay, corners: &Corners) -> Vec<[u32; 3]> {
    let corner = |edge: Edge| {
        let vertex = edge.from().index();
        if corners.shared.is_empty() {
            return corners.only[vertex];
        }
        // Turned clockwise, the first constraint is the side that begins at the corner.
        let mut side = edge;
        while !side.is_constraint_edge() {
            side = side.cw();
        }
        corners
            .shared
            .get(&(vertex, side.to().index()))
            .copied()
            .unwrap_or(corners.only[vertex])
    };
    delaunay
        .inside(|_| true)
        .iter()
        .map(|face| face.adjacent_edges().map(corner))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Ring;

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    fn area(polygon: &Polygon, triangles: &[[u32; 3]]) -> f64 {
        let corners: Vec<Point> = polygon.rings().flatten().copied().collect();
        let twice = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| corners[i as usize]);
            let twice = (b - a).cross(c - a);
            assert!(twice > 0.0);
            twice
        };
        triangles.iter().map(twice).sum::<f64>() / 2.0
    }

    #[test]
    fn holes_and_collinear_sides_are_kept() {
        // Holes whose sides lie on one line, as those between the rungs of a ladder.
        let hole = |x: f64| ring(&[[x, 1.0], [x, 2.0], [x + 0.5, 2.0], [x + 0.5, 1.0]]);
        let outer = ring(&[[0., 0.], [4., 0.], [10., 0.], [10., 3.], [5., 3.], [0., 3.]]);
        let polygon = Polygon {
            outer,
            holes: (1..9).map(|x| hole(f64::from(x))).collect(),
        };
        let triangles = triangulate(&polygon).unwrap();
        assert!((area(&polygon, &triangles) - polygon.area()).abs() < 1e-12);
        // V - E + F = 1 - h for a polygon: F = V - 2 + 2·h.
        assert_eq!(
            triangles.len(),
            polygon.rings().map(Vec::len).sum::<usize>() - 2 + 2 * 8
        );
    }

    #[test]
    fn rings_may_touch_in_corners() {
        // Two holes that touch each other, and the outer ring that one of them touches.
        let outer = ring(&[[0., 0.], [4., 0.], [4., 2.], [4., 4.], [0., 4.]]);
        let holes = vec![
            ring(&[[1., 2.], [2., 3.], [3., 2.], [2., 1.]]),
            ring(&[[3., 2.], [3.5, 3.], [4., 2.], [3.5, 1.]]),
        ];
        let polygon = Polygon { outer, holes };
        let triangles = triangulate(&polygon).unwrap();
        assert!((area(&polygon, &triangles) - polygon.area()).abs() < 1e-12);
        // The inside is a ring that is cut open where the rings touch: one boundary of all sides, without a hole.
        let sides = open_sides(&triangles);
        assert_eq!(sides.len(), polygon.rings().map(Vec::len).sum::<usize>());
        let next = |corner: u32| {
            sides
                .iter()
                .find(|side| side[0] == corner)
                .map(|side| side[1])
        };
        let around =
            std::iter::successors(Some(0), |corner| next(*corner).filter(|next| *next != 0));
        assert_eq!(around.count(), sides.len());
    }

    #[test]
    fn crossing_and_touching_rings_are_refused() {
        let bow = Polygon {
            outer: ring(&[[0., 0.], [2., 2.], [2., 0.], [0., 2.]]),
            holes: vec![],
        };
        assert!(matches!(
            triangulate(&bow),
            Err(TriangulationError::Crossing { .. })
        ));
        let touching = Polygon {
            outer: ring(&[[0., 0.], [4., 0.], [4., 4.], [0., 4.]]),
            holes: vec![ring(&[[2., 0.], [1., 1.], [2., 2.]])],
        };
        assert!(triangulate(&touching).is_err());
        let along = Polygon {
            outer: ring(&[[0., 0.], [1., 0.], [2., 0.], [4., 4.], [0., 4.]]),
            holes: vec![ring(&[[1., 0.], [1., 1.], [2., 0.]])],
        };
        assert!(triangulate(&along).is_err());
        let nan = Polygon {
            outer: ring(&[[0., 0.], [f64::NAN, 0.], [1., 1.]]),
            holes: vec![],
        };
        assert!(matches!(
            triangulate(&nan),
            Err(TriangulationError::OutOfRange { .. })
        ));
        assert_eq!(triangulate(&Polygon::default()), Ok(vec![]));
    }
}
