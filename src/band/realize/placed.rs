//! A sequence with everything that its geometry needs, and its pieces once they are in place.

use fretwork_geometry::Ring;

use crate::exemplar::ends::EndPieces;
use crate::exemplar::piece::{Chain, Endpoint, Piece};
use crate::exemplar::seam::Seam;

/// The outlines of one piece in its place: x along the curve, y across it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placed {
    /// The open outlines.
    pub chains: Vec<Chain>,
    /// The closed outlines.
    pub rings: Vec<Ring>,
    /// Where the piece begins and ends.
    pub span: [f64; 2],
}

/// A sequence with everything that its geometry needs.
#[derive(Clone, Copy, Debug)]
pub struct Layout<'a> {
    /// The pieces of the exemplar.
    pub pieces: &'a [Piece],
    /// The numbers of those that follow one another.
    pub sequence: &'a [usize],
    /// The seam after each of them; a loop also has the one that closes it.
    pub seams: &'a [Seam],
    /// The offset of each of them.
    pub offsets: &'a [f64],
    /// The length of the curve, to which the pieces are stretched.
    pub length: f64,
    /// Whether the last is joined to the first.
    pub closed: bool,
    /// What the first and the last are. End pieces keep their shape across the band.
    pub end_pieces: EndPieces,
}

impl Layout<'_> {
    /// Where the endpoints at the seam after piece `k` meet: the means of both sides, or where an
    /// end piece has them.
    pub fn shared_endpoints(&self, k: usize) -> Vec<f64> {
        let next = (k + 1) % self.sequence.len();
        let (a, b) = (
            &self.pieces[self.sequence[k]],
            &self.pieces[self.sequence[next]],
        );
        let is_ended = self.end_pieces != EndPieces::Own;
        if is_ended && (k == 0 || k + 2 == self.sequence.len()) {
            let (ends, offset) = if k == 0 {
                (&a.right, self.offsets[k])
            } else {
                (&b.left, self.offsets[next])
            };
            return ends.iter().map(|end| end.v + offset).collect();
        }
        let mean = |(r, l): (&Endpoint, &Endpoint)| {
            0.5 * (r.v + self.offsets[k] + l.v + self.offsets[next])
        };
        a.right.iter().zip(&b.left).map(mean).collect()
    }
}
