//! A straight bar across a band (rule B10), in two halves. The outer half is a piece of its own: the
//! one that every pattern with bars begins with. The inner half is a part of the piece behind it,
//! so that the face of the bar, where outlines turn along the cut, lies within a piece.

use std::collections::BTreeMap;

use fretwork_geometry::{Point, Ring};

use super::piece::{Chain, Endpoint, Piece, Port, Side};

/// A bar across a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Along the band.
    pub thickness: f64,
    /// Across it, from -height / 2 to height / 2.
    pub height: f64,
}

impl Bar {
    /// The ends of the portal between the two halves.
    fn ends(self) -> Vec<Endpoint> {
        let end = |v| Endpoint {
            v,
            tangent: Point::new(1.0, 0.0),
        };
        vec![end(-0.5 * self.height), end(0.5 * self.height)]
    }

    /// The outer half at the beginning of a band.
    pub fn outer(self) -> Piece {
        let (width, top) = (0.5 * self.thickness, 0.5 * self.height);
        let corners = [[width, top], [0.0, top], [0.0, -top], [width, -top]];
        let outline = Chain {
            points: corners.map(Point::from).to_vec(),
            from: (Side::Right, 1),
            to: (Side::Right, 0),
        };
        Piece::of_outlines(width, vec![outline], Vec::new(), [Vec::new(), self.ends()])
    }

    /// `piece` with the inner half on its left, joined to all portals there. Between two of them
    /// the outline runs along the face of the bar; what it then encloses is a hole.
    pub fn joined(self, piece: &Piece) -> Piece {
        let mut joining = Joining::new(piece, 0.5 * self.thickness);
        let top = 0.5 * self.height;
        let face = joining.shift.x;
        let mut chains = vec![joining.outline(
            vec![Point::new(0.0, -top), Point::new(face, -top)],
            (Side::Left, 0),
            (Side::Left, 0),
        )];
        let starts: Vec<Port> = piece.chains.iter().map(|c| c.from).collect();
        for &port in starts.iter().filter(|port| port.0 == Side::Right) {
            chains.push(joining.outline(Vec::new(), port, port));
        }
        for chain in &mut chains {
            if chain.to.0 == Side::Left {
                chain
                    .points
                    .extend([Point::new(face, top), Point::new(0.0, top)]);
            }
            chain.points.dedup();
        }
        let shifted = |ring: &Ring| ring.iter().map(|&p| p + joining.shift).collect();
        let mut rings: Vec<Ring> = piece.rings.iter().map(shifted).collect();
        while let Some((&port, _)) = joining.left.first_key_value() {
            let mut ring = joining.outline(Vec::new(), port, port).points;
            ring.dedup();
            rings.push(ring);
        }
        let ends = [self.ends(), piece.right.clone()];
        Piece::of_outlines(face + piece.width, chains, rings, ends)
    }
}

/// The outlines of a piece while a bar is joined to them.
struct Joining<'a> {
    /// The outlines that are left, by the ports where they begin.
    left: BTreeMap<Port, &'a Chain>,
    /// The number of the last port on the left.
    last: u16,
    shift: Point,
}

impl<'a> Joining<'a> {
    fn new(piece: &'a Piece, by: f64) -> Joining<'a> {
        Joining {
            left: piece.chains.iter().map(|c| (c.from, c)).collect(),
            last: (piece.left.len() as u16).saturating_sub(1),
            shift: Point::new(by, 0.0),
        }
    }

    /// The outline that goes on at `port`, after `points`: along the outlines of the piece and the
    /// face of the bar, to the right side or to the last port on the left, or until it closes.
    fn outline(&mut self, mut points: Vec<Point>, mut port: Port, from: Port) -> Chain {
        let mut to = port;
        while let Some(chain) = self.left.remove(&port) {
            points.extend(chain.points.iter().map(|&p| p + self.shift));
            to = chain.to;
            if to.0 == Side::Right || to.1 == self.last {
                break;
            }
            port = (Side::Left, to.1 + 1);
        }
        if to.0 == Side::Left {
            to = (Side::Left, 1);
        }
        Chain { points, from, to }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exemplar::descriptor::Descriptor;
    use crate::exemplar::mirror::mirrored;
    use crate::exemplar::piece::cut;
    use fretwork_geometry::polygon::signed_area;

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    const BAR: Bar = Bar {
        thickness: 2.0,
        height: 6.0,
    };

    /// A frame 10 by 4 with a hole from 2 to 8 and an island in it.
    fn frame() -> Vec<Ring> {
        vec![
            ring(&[[0., -2.], [10., -2.], [10., 2.], [0., 2.]]),
            ring(&[[2., -1.], [2., 1.], [8., 1.], [8., -1.]]),
            ring(&[[4., -0.5], [6., -0.5], [6., 0.5], [4., 0.5]]),
        ]
    }

    #[test]
    fn a_bar_joins_all_portals() {
        let pieces = cut(&frame(), 10.0, &[5.0]).unwrap();
        let joined = BAR.joined(&pieces[1]);
        // The room round the end of the island is one hole between the bar and the frame.
        assert_eq!(joined.descriptor, Descriptor::new(&[0], &[], 0, 1));
        assert_eq!((joined.width, joined.left.len()), (6.0, 2));
        let area: f64 = joined.rings.iter().map(|r| signed_area(r)).sum();
        assert_eq!(area, -(3.0 * 2.0 - 1.0));
    }

    #[test]
    fn bars_at_both_ends_close_a_pattern() {
        let pieces = cut(&frame(), 10.0, &[3.0, 5.0, 7.0]).unwrap();
        let begun = BAR.outer().descriptor;
        let open = BAR.joined(&pieces[1]).descriptor;
        let close = mirrored(&BAR.joined(&mirrored(&pieces[2]))).descriptor;
        assert_eq!(close, Descriptor::new(&[0, 1, 0], &[0], 0, 0));
        let whole = begun.merge(&open).and_then(|d| d.merge(&close)).unwrap();
        let end = mirrored(&BAR.outer()).descriptor;
        assert_eq!(whole.merge(&end), Some(Descriptor::new(&[], &[], 2, 1)));
    }
}
