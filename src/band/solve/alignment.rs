//! Where the pieces of a sequence stand: the seams between them, the offsets that add up when each
//! piece is aligned to the one before it, and the final offsets that take this drift back.

use super::least_squares_offsets::least_squares_offsets;
use crate::exemplar::piece::Piece;
use crate::exemplar::seam::{Seam, Seams};

/// The seams of a sequence and the final offsets of its pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    /// The seam after each piece. A loop also has the one from the last piece to the first.
    pub joints: Vec<Seam>,
    /// The final offset of each piece (section 4.1).
    pub offsets: Vec<f64>,
    /// Whether the last piece is joined to the first.
    pub closed: bool,
}

impl Alignment {
    /// The alignment of `sequence`; none where two of its pieces cannot be neighbours.
    pub fn new(
        pieces: &[Piece],
        seams: &Seams,
        sequence: &[usize],
        closed: bool,
    ) -> Option<Alignment> {
        let joints = joints(seams, sequence, closed)?;
        let weighted: Vec<(Seam, usize)> = joints
            .iter()
            .zip(sequence)
            .map(|(&seam, &piece)| (seam, pieces[piece].right.len()))
            .collect();
        Some(Alignment {
            offsets: least_squares_offsets(&weighted, sequence.len(), closed),
            joints,
            closed,
        })
    }

    /// The height of a band that the pieces do not leave with their final offsets.
    pub fn height(&self, pieces: &[Piece], sequence: &[usize]) -> f64 {
        height(pieces, sequence, &self.offsets, self.closed)
    }
}

/// The seams of a sequence, with that from the last to the first piece when it is closed; none
/// where two pieces cannot be neighbours.
pub fn joints(seams: &Seams, sequence: &[usize], closed: bool) -> Option<Vec<Seam>> {
    let mut joints = sequence
        .windows(2)
        .map(|w| seams.get(w[0], w[1]))
        .collect::<Option<Vec<_>>>()?;
    if closed {
        joints.push(seams.get(*sequence.last()?, sequence[0])?);
    }
    Some(joints)
}

/// The offset of each piece when each is aligned to the one before it.
pub fn accumulated_offsets(seams: &Seams, sequence: &[usize]) -> Vec<f64> {
    let mut at = 0.0;
    let mut offsets = vec![at];
    for w in sequence.windows(2) {
        at += seams.get(w[0], w[1]).map_or(0.0, |s| s.rise);
        offsets.push(at);
    }
    offsets
}

/// The height of a band that the pieces of a sequence do not leave at these offsets. An open band
/// is centred on its curve; a loop may be moved as a whole.
pub fn height(pieces: &[Piece], sequence: &[usize], offsets: &[f64], closed: bool) -> f64 {
    let (mut lowest, mut highest) = (0.0f64, 0.0f64);
    for (offset, &piece) in offsets.iter().zip(sequence) {
        let bounds = pieces[piece].bounds;
        lowest = lowest.min(bounds.min.y + offset);
        highest = highest.max(bounds.max.y + offset);
    }
    if closed {
        highest - lowest
    } else {
        2.0 * highest.max(-lowest)
    }
}
