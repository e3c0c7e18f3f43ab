//! The mirror image of a piece: what stands at one end of a band, drawn for the other.

use fretwork_geometry::{Point, Ring};

use super::piece::{Chain, Endpoint, Piece, Port, Side};

/// `piece` with left and right exchanged. Outlines run the other way, so that the interior stays on
/// their left.
pub fn mirrored(piece: &Piece) -> Piece {
    let across = |p: &Point| Point::new(piece.width - p.x, p.y);
    let reversed = |points: &[Point]| -> Vec<Point> { points.iter().rev().map(across).collect() };
    let chain = |chain: &Chain| Chain {
        points: reversed(&chain.points),
        from: other_side(chain.to),
        to: other_side(chain.from),
    };
    let end = |end: &Endpoint| Endpoint {
        v: end.v,
        tangent: Point::new(end.tangent.x, -end.tangent.y),
    };
    Piece::of_outlines(
        piece.width,
        piece.chains.iter().map(chain).collect(),
        piece
            .rings
            .iter()
            .map(|r| -> Ring { reversed(r) })
            .collect(),
        [&piece.right, &piece.left].map(|ends| ends.iter().map(end).collect()),
    )
}

/// The same port on the other side.
fn other_side((side, number): Port) -> Port {
    match side {
        Side::Left => (Side::Right, number),
        Side::Right => (Side::Left, number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exemplar::piece::cut;

    #[test]
    fn a_mirror_image_of_a_mirror_image_is_the_piece() {
        let contour: Ring = [[0., 0.], [9., 3.], [9., 5.], [4., 3.], [9., 8.], [0., 2.]]
            .map(Point::from)
            .to_vec();
        for piece in cut(&[contour], 9.0, &[2.0, 7.0]).unwrap() {
            let once = mirrored(&piece);
            assert_eq!(once.left.len(), piece.right.len());
            assert_eq!(once.descriptor.left.len(), piece.descriptor.right.len());
            let twice = mirrored(&once);
            assert_eq!(
                (&twice.descriptor, &twice.left),
                (&piece.descriptor, &piece.left)
            );
            for (a, b) in twice.chains.iter().zip(&piece.chains) {
                assert_eq!((a.from, a.to), (b.from, b.to));
                assert!(
                    a.points
                        .iter()
                        .zip(&b.points)
                        .all(|(p, q)| p.distance(*q) < 1e-12)
                );
            }
        }
    }
}
