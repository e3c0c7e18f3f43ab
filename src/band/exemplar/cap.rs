//! A drawn cap as a piece (rule B10): its right side, where it is cut straight, is where a pattern
//! goes on.

use fretwork_geometry::{Bounds, Point, Ring};

use super::normalize::Exemplar;
use super::piece::{Piece, cut};

/// Points within this part of a cap's width from its right end are on it. Drawing programs round
/// to about that.
const ON_END: f64 = 1e-4;
/// A cap is drawn out by twice this part of its width, so that outlines pass its last cut squarely.
const STUB: f64 = 1e-3;

/// The piece at the beginning of a band; none where nothing of the drawing ends straight at its
/// right side, or where what ends there cannot be told apart.
pub fn cap(exemplar: &Exemplar) -> Option<Piece> {
    let stub = STUB * exemplar.width;
    let drawn_out = |contour: &Ring| drawn_out(contour, exemplar.width, 2.0 * stub);
    let contours: Vec<Ring> = exemplar.contours.iter().map(drawn_out).collect();
    let end = exemplar.width + stub;
    let mut pieces = cut(&contours, end + stub, &[end]).ok()?;
    let piece = pieces.swap_remove(0);
    (!piece.right.is_empty()).then_some(piece)
}

/// The contour with every edge along u = `end` moved out by this much.
fn drawn_out(contour: &Ring, end: f64, by: f64) -> Ring {
    let n = contour.len();
    let is_on = |i: usize| contour[i % n].x >= end * (1.0 - ON_END);
    let mut ring = Ring::with_capacity(n + 4);
    for (i, &p) in contour.iter().enumerate() {
        // Edges along the end run upward, because the interior is on their left.
        let [comes, goes] = [is_on(i) && is_on(i + n - 1), is_on(i) && is_on(i + 1)];
        let out = Point::new(end + by, p.y);
        let at = Point::new(end, p.y);
        match (comes, goes) {
            (false, false) => ring.push(p),
            (false, true) => ring.extend([at, out]),
            (true, false) => ring.extend([out, at]),
            (true, true) => ring.push(out),
        }
    }
    ring
}

/// The widths of the portals of one side, from below upward.
pub fn portals(ends: &[super::piece::Endpoint]) -> Vec<f64> {
    ends.chunks(2).map(|p| p[1].v - p[0].v).collect()
}

/// The height of a band, centred on its curve, that a piece does not leave.
pub fn height(bounds: Bounds) -> f64 {
    2.0 * bounds.max.y.max(-bounds.min.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exemplar(contours: &[&[[f64; 2]]]) -> Exemplar {
        let ring = |c: &&[[f64; 2]]| c.iter().map(|&p| Point::from(p)).collect();
        Exemplar::from_contours(contours.iter().map(ring).collect())
    }

    #[test]
    fn what_ends_straight_on_the_right_is_a_portal() {
        // A fork: two prongs to the right, and a tip between them that ends in a point.
        let fork: &[[f64; 2]] = &[
            [0., 0.],
            [10., 0.],
            [10., 2.],
            [3., 2.],
            [10., 4.],
            [3., 6.],
            [10., 6.],
            [10., 8.],
            [0., 8.],
        ];
        let piece = cap(&exemplar(&[fork])).unwrap();
        let ends: Vec<f64> = piece.right.iter().map(|e| e.v).collect();
        assert_eq!(ends, [-4.0, -2.0, 2.0, 4.0]);
        assert!(piece.left.is_empty());
        assert_eq!(piece.descriptor.open_components(), 1);
        assert!(
            piece
                .right
                .iter()
                .all(|e| e.tangent == Point::new(1.0, 0.0))
        );
    }

    #[test]
    fn a_drawing_without_a_straight_right_side_is_no_cap() {
        assert_eq!(
            cap(&exemplar(&[&[[0., 0.], [5., -2.], [9., 0.], [5., 2.]]])),
            None
        );
    }
}
