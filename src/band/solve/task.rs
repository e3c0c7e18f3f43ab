//! What is asked of a sequence of pieces, what comes back, and why nothing may come back. All files
//! of the solver share these types.

use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;

/// What is asked of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// The length of the curve.
    pub length: f64,
    /// How far the pieces' total may be from it.
    pub tolerance: f64,
    /// Whether the pattern runs round a closed curve.
    pub closed: bool,
    /// Components and holes.
    pub demand: Demand,
    /// Where the pieces may stand.
    pub drift: Drift,
    /// The weight of the autocorrelation.
    pub variety: f64,
}

/// A task with the pieces that are to meet it.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The pieces of the exemplar.
    pub pieces: &'a [Piece],
    /// The seams between any two of them.
    pub seams: &'a Seams,
    /// What is asked.
    pub task: &'a Task,
}

/// What is asked of the topology.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Demand {
    /// How many components; none where any number will do.
    pub components: Option<u32>,
    /// How many holes; none where any number will do.
    pub holes: Option<u32>,
    /// A component must run round the loop.
    pub around: bool,
}

impl Demand {
    /// Whether descriptors matter at all.
    pub fn reads_topology(&self) -> bool {
        self.components.is_some() || self.holes.is_some() || self.around
    }
}

/// The offsets at which the pieces stay in the band.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// The lowest and the highest offset of each piece.
    pub ranges: Vec<(f64, f64)>,
}

impl Drift {
    /// How far `pieces` at these offsets leave the band below and above; 0 or less where they stay.
    pub fn beyond(&self, pieces: &[usize], offsets: &[f64]) -> [f64; 2] {
        let (mut below, mut above) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for (&offset, &piece) in offsets.iter().zip(pieces) {
            let (low, high) = self.ranges[piece];
            below = below.max(low - offset);
            above = above.max(offset - high);
        }
        [below, above]
    }
}

/// A sequence of pieces with what it adds up to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sequence {
    /// The numbers of the pieces.
    pub pieces: Vec<usize>,
    /// F: the sum of the costs of the seams.
    pub cost: f64,
    /// The pieces' total width with the gaps between them.
    pub length: f64,
    /// Components.
    pub components: u32,
    /// Holes.
    pub holes: u32,
    /// Components that run round a closed curve.
    pub around: u32,
}

/// How good a sequence is: less is better, and staying in the band comes first.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Rank {
    /// Whether its final offsets leave the band.
    pub leaves: bool,
    /// What is minimized among the others.
    pub value: f64,
}

/// A sequence and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// How good it is.
    pub rank: Rank,
    /// The sequence.
    pub sequence: Sequence,
}

impl Found {
    /// The better of two, and the first of equals.
    pub fn better(a: Option<Found>, b: Option<Found>) -> Option<Found> {
        match (&a, &b) {
            (Some(first), Some(second)) if second.rank < first.rank => b,
            (None, _) => b,
            _ => a,
        }
    }
}

/// Why there is no sequence.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// No sequence has the length and the counts.
    #[error("no sequence of pieces has the length and the counts")]
    Impossible,
    /// There is one, but only in a band of this height.
    #[error("the pieces drift: they need a height of {0}")]
    Drift(f64),
    /// The graph is too large.
    #[error(transparent)]
    States(#[from] TooManyStates),
    /// The table would be larger than memory.
    #[error("the pattern would consist of too many pieces")]
    TooLong,
}

/// The pieces give rise to more states than are kept in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the portals can be connected in more than {0} ways")]
pub struct TooManyStates(pub usize);
