//! Polygons with holes to triangles, over exactly the corners that they have.

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::super::{Point, Polygon};

/// Why a polygon cannot be divided into triangles.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TriangulationError {
    /// A coordinate is NaN, infinite, or too large or too small to be computed with.
    #[error("({x}, {y}) is out of the range that can be computed with")]
    OutOfRange {
        /// The coordinate along x.
        x: f64,
        /// The coordinate along y.
        y: f64,
    },
    /// Sides of the polygon cross, or a corner stands in two places of the rings.
    #[error("the sides of a polygon cross or touch near ({x}, {y})")]
    Crossing {
        /// The coordinate along x.
        x: f64,
        /// The coordinate along y.
        y: f64,
    },
}

/// The triangles of `polygon`, counter-clockwise (+x toward +y), over the corners of its rings, which are numbered
/// through: the outer ring's first. Every side of a ring is a side of exactly one triangle, so walls can be put on
/// it, and no corner is added. A constrained Delaunay triangulation; O(n log n). Rings must be simple and may not
/// touch; which of them are holes follows from the even-odd rule.
///
/// # Errors
/// Coordinates out of range; rings that cross or touch.
pub fn triangulate(polygon: &Polygon) -> Result<Vec<[u32; 3]>, TriangulationError> {
    let corners: Vec<Point> = polygon.rings().flatten().copied().collect();
    if let Some(p) = corners.iter().find(|p| !(in_range(p.x) && in_range(p.y))) {
        return Err(TriangulationError::OutOfRange { x: p.x, y: p.y });
    }
    let mut triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut vertices = Vec::with_capacity(corners.len());
    let mut numbers = vec![u32::MAX; corners.len()];
    for (number, p) in corners.iter().enumerate() {
        let crossing = TriangulationError::Crossing { x: p.x, y: p.y };
        let vertex = triangulation.insert(Point2::new(p.x, p.y)).map_err(|_| crossing.clone())?;
        if std::mem::replace(&mut numbers[vertex.index()], number as u32) != u32::MAX {
            return Err(crossing);
        }
        vertices.push(vertex);
    }
    let mut first = 0;
    for ring in polygon.rings() {
        for i in 0..ring.len() {
            let (a, b) = (vertices[first + i], vertices[first + (i + 1) % ring.len()]);
            let crossing = TriangulationError::Crossing { x: ring[i].x, y: ring[i].y };
            if a == b || !triangulation.can_add_constraint(a, b) {
                return Err(crossing);
            }
            triangulation.add_constraint(a, b);
            // A corner on the side would have split it.
            if !triangulation.get_edge_from_neighbors(a, b).is_some_and(|edge| edge.is_constraint_edge()) {
                return Err(crossing);
            }
        }
        first += ring.len();
    }
    Ok(inside(&triangulation, &numbers))
}

/// Coordinates that the predicates of the triangulation are exact for.
fn in_range(v: f64) -> bool {
    v == 0.0 || (1e-40..=1e40).contains(&v.abs())
}

/// The triangles that an odd number of constraints parts from the outside.
fn inside(triangulation: &ConstrainedDelaunayTriangulation<Point2<f64>>, numbers: &[u32]) -> Vec<[u32; 3]> {
    let mut is_inside: Vec<Option<bool>> = vec![None; triangulation.num_all_faces()];
    let outer = triangulation.outer_face();
    is_inside[outer.index()] = Some(false);
    let mut waiting: Vec<_> = triangulation.convex_hull().map(|edge| edge.fix()).collect();
    while let Some(edge) = waiting.pop() {
        let edge = triangulation.directed_edge(edge);
        let Some(here) = is_inside[edge.face().index()] else { continue };
        let beyond = edge.rev().face();
        if is_inside[beyond.index()].is_some() {
            continue;
        }
        is_inside[beyond.index()] = Some(here ^ edge.is_constraint_edge());
        if let Some(face) = beyond.as_inner() {
            waiting.extend(face.adjacent_edges().map(|side| side.fix()));
        }
    }
    let faces = triangulation.inner_faces().filter(|face| is_inside[face.index()] == Some(true));
    faces.map(|face| face.vertices().map(|vertex| numbers[vertex.index()])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ring;

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
        let polygon = Polygon { outer, holes: (1..9).map(|x| hole(f64::from(x))).collect() };
        let triangles = triangulate(&polygon).unwrap();
        assert!((area(&polygon, &triangles) - polygon.area()).abs() < 1e-12);
        // V - E + F = 1 - h for a polygon: F = V - 2 + 2·h.
        assert_eq!(triangles.len(), polygon.rings().map(Vec::len).sum::<usize>() - 2 + 2 * 8);
    }

    #[test]
    fn crossing_and_touching_rings_are_refused() {
        let bow = Polygon { outer: ring(&[[0., 0.], [2., 2.], [2., 0.], [0., 2.]]), holes: vec![] };
        assert!(matches!(triangulate(&bow), Err(TriangulationError::Crossing { .. })));
        let touching = Polygon {
            outer: ring(&[[0., 0.], [4., 0.], [4., 4.], [0., 4.]]),
            holes: vec![ring(&[[2., 0.], [1., 1.], [2., 2.]])],
        };
        assert!(triangulate(&touching).is_err());
        let nan = Polygon { outer: ring(&[[0., 0.], [f64::NAN, 0.], [1., 1.]]), holes: vec![] };
        assert!(matches!(triangulate(&nan), Err(TriangulationError::OutOfRange { .. })));
        assert_eq!(triangulate(&Polygon::default()), Ok(vec![]));
    }
}
