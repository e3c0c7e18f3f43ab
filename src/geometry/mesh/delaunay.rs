//! The constrained Delaunay triangulation of some corners, by the `spade` crate.
//!
//! Three steps lead from a polygon to its triangles:
//!
//! 1. [`Delaunay::new`] inserts the corners. Every triangle then has no corner inside its circumcircle.
//! 2. [`Delaunay::constrain`] makes each side of the polygon an edge. Other edges give way to it, and the rest stays as close
//!    to Delaunay's condition as the sides allow (Chew 1989). A side that crosses another side or runs through a
//!    corner cannot become an edge; the caller is told so.
//! 3. [`Delaunay::inside`] floods the triangles from the convex hull inward and changes sides at each constraint, by the
//!    even-odd rule.
//!
//! Spade's predicates are exact (Shewchuk 1997), so that these steps cannot disagree with one another. No corner is ever
//! added. The polygon's own reading, and what walls are put on its sides, is not decided here but in `triangulate` and
//! where bodies are made.

use spade::handles::{DirectedEdgeHandle, FaceHandle, FixedVertexHandle, InnerTag};
use spade::{
    CdtEdge, ConstrainedDelaunayTriangulation, LastUsedVertexHintGenerator, Point2, Triangulation,
};

use super::TriangulationError;
use crate::{Bounds, Point};

type Triangles =
    ConstrainedDelaunayTriangulation<Point2<f64>, (), (), (), LastUsedVertexHintGenerator>;
/// An edge, seen from one of its ends.
pub type Edge<'a> = DirectedEdgeHandle<'a, Point2<f64>, (), CdtEdge<()>, ()>;
/// A triangle.
pub type Face<'a> = FaceHandle<'a, InnerTag, Point2<f64>, (), CdtEdge<()>, ()>;

/// A triangulation whose vertices stand for numbered corners.
pub struct Delaunay {
    triangles: Triangles,
    /// The vertex of each corner.
    vertices: Vec<FixedVertexHandle>,
}

/// What became of a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constrained {
    /// The corners are the ends of an edge that stays.
    New,
    /// They were so before.
    Known,
    /// Something is in the way: another constraint, or a corner.
    Blocked,
}

/// Bits of a place along either axis, for the order in which corners are inserted. 16 tell 65,536 squares apart along each axis. With
/// fewer, many corners of a large polygon share a square and each search for a corner's triangle takes longer; more
/// bits change nothing as long as there are fewer corners than squares.
const BITS: u32 = 16;

impl Delaunay {
    /// The triangulation of `corners`. Corners in one place share a vertex.
    ///
    /// To insert a corner, one walks from the corner before it to the triangle that it lies in. Corners are therefore inserted
    /// along a Hilbert curve, on which neighbours are near in the plane (Amenta, Choi and Rote 2003 on orders of
    /// insertion). After the sort this takes O(n) unless the corners were placed to defeat it.
    ///
    /// # Errors
    /// Coordinates that are not numbers, or out of range.
    pub fn new(corners: &[Point]) -> Result<Delaunay, TriangulationError> {
        if let Some(p) = corners.iter().find(|p| !(in_range(p.x) && in_range(p.y))) {
            return Err(TriangulationError::OutOfRange { x: p.x, y: p.y });
        }
        let bounds = Bounds::of(corners.iter().copied());
        let cell = bounds.longer_side().max(f64::MIN_POSITIVE) / f64::from((1u32 << BITS) - 1);
        let place = |x: f64, least: f64| ((x - least) / cell) as u32;
        let key =
            |p: Point| along_hilbert_curve(place(p.x, bounds.min.x), place(p.y, bounds.min.y));
        let mut order: Vec<(u64, usize)> = corners
            .iter()
            .enumerate()
            .map(|(i, &p)| (key(p), i))
            .collect();
        order.sort_unstable();
        let mut triangles = Triangles::default();
        let mut vertices = vec![FixedVertexHandle::from_index(0); corners.len()];
        for (_, i) in order {
            let p = corners[i];
            let out_of_range = |_| TriangulationError::OutOfRange { x: p.x, y: p.y };
            vertices[i] = triangles
                .insert(Point2::new(p.x, p.y))
                .map_err(out_of_range)?;
        }
        Ok(Delaunay {
            triangles,
            vertices,
        })
    }

    /// Whether every corner has a place of its own.
    pub fn is_distinct(&self) -> bool {
        self.triangles.num_vertices() == self.vertices.len()
    }

    /// The number of a corner's vertex.
    pub fn vertex(&self, corner: usize) -> usize {
        self.vertices[corner].index()
    }

    /// Makes corners `a` and `b` the ends of one edge that stays.
    pub fn constrain(&mut self, a: usize, b: usize) -> Constrained {
        let (a, b) = (self.vertices[a], self.vertices[b]);
        let is_edge = |triangles: &Triangles| {
            triangles
                .get_edge_from_neighbors(a, b)
                .is_some_and(|edge| edge.is_constraint_edge())
        };
        if is_edge(&self.triangles) {
            return Constrained::Known;
        }
        if a == b || !self.triangles.can_add_constraint(a, b) {
            return Constrained::Blocked;
        }
        self.triangles.add_constraint(a, b);
        // A corner on the way would have split it.
        if is_edge(&self.triangles) {
            Constrained::New
        } else {
            Constrained::Blocked
        }
    }

    /// The triangles inside by the even-odd rule: on the way from the outside to such a triangle one crosses an odd number of
    /// constraints for which `parts` is true. Constraints for which it is false do not count. O(n).
    pub fn inside(&self, parts: impl Fn(Edge) -> bool) -> Vec<Face<'_>> {
        let triangles = &self.triangles;
        let mut is_inside: Vec<Option<bool>> = vec![None; triangles.num_all_faces()];
        is_inside[triangles.outer_face().index()] = Some(false);
        let mut waiting: Vec<_> = triangles.convex_hull().map(|edge| edge.fix()).collect();
        while let Some(edge) = waiting.pop() {
            let edge = triangles.directed_edge(edge);
            let Some(here) = is_inside[edge.face().index()] else {
                continue;
            };
            let beyond = edge.rev().face();
            if is_inside[beyond.index()].is_some() {
                continue;
            }
            is_inside[beyond.index()] = Some(here ^ (edge.is_constraint_edge() && parts(edge)));
            if let Some(face) = beyond.as_inner() {
                waiting.extend(face.adjacent_edges().map(|side| side.fix()));
            }
        }
        triangles
            .inner_faces()
            .filter(|face| is_inside[face.index()] == Some(true))
            .collect()
    }
}

/// Coordinates that the predicates of the triangulation are exact for.
fn in_range(v: f64) -> bool {
    v == 0.0 || (1e-40..=1e40).contains(&v.abs())
}

/// How far along the Hilbert curve of this many bits a square of the grid lies.
fn along_hilbert_curve(mut x: u32, mut y: u32) -> u64 {
    let mut at = 0;
    for bit in (0..BITS).rev() {
        let (right, up) = (x >> bit & 1, y >> bit & 1);
        at = at << 2 | u64::from((3 * right) ^ up);
        let below = (1 << bit) - 1;
        (x, y) = (x & below, y & below);
        if up == 0 {
            if right == 1 {
                (x, y) = (below - x, below - y);
            }
            std::mem::swap(&mut x, &mut y);
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_from_square_to_square() {
        let side = 1u32 << 5;
        // The squares of the lower left corner are the first part of the curve.
        let mut squares: Vec<(u64, u32, u32)> = (0..side * side)
            .map(|i| (along_hilbert_curve(i % side, i / side), i % side, i / side))
            .collect();
        squares.sort_unstable();
        assert!(squares.iter().zip(0..).all(|(s, i)| s.0 == i));
        assert!(
            squares
                .windows(2)
                .all(|w| w[0].1.abs_diff(w[1].1) + w[0].2.abs_diff(w[1].2) == 1)
        );
    }

    #[test]
    fn constraints_are_known_again_and_block_others() {
        let square = [[0., 0.], [2., 0.], [2., 2.], [0., 2.], [1., 0.]].map(Point::from);
        let mut delaunay = Delaunay::new(&square).unwrap();
        assert!(delaunay.is_distinct());
        assert_eq!(delaunay.constrain(0, 2), Constrained::New);
        assert_eq!(delaunay.constrain(2, 0), Constrained::Known);
        assert_eq!(delaunay.constrain(1, 3), Constrained::Blocked);
        assert_eq!(delaunay.constrain(0, 1), Constrained::Blocked);
        assert_eq!(delaunay.constrain(3, 3), Constrained::Blocked);
        assert!(
            !Delaunay::new(&[square[0], square[0]])
                .unwrap()
                .is_distinct()
        );
    }
}
