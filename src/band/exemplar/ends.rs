//! The end pieces of an open band (rule B10): the pieces of its exemplar with those that close its
//! two ends, and which may follow which. The solver begins with the first piece and ends with the
//! last one, as always.

use super::bar::Bar;
use super::cap::{cap, height, portals};
use super::mirror::mirrored;
use super::normalize::Exemplar;
use super::piece::Piece;
use super::seam::{Seam, Seams};
use super::slicing::MOST_PIECES;

/// What closes the ends of an open band.
#[derive(Clone, Debug, PartialEq)]
pub enum Ends {
    /// The first and the last piece of the exemplar.
    Free,
    /// A bar over the height of the band, this thick.
    Bar(f64),
    /// A drawing at the exemplar's scale, and its mirror image.
    Cap(Exemplar),
}

impl Ends {
    /// The same for an exemplar that is larger by a factor. A bar stays as it is.
    pub fn scaled(&self, factor: f64) -> Ends {
        match self {
            Ends::Cap(cap) => Ends::Cap(cap.scaled(factor)),
            other => other.clone(),
        }
    }
}

/// Why an exemplar cannot be closed by end pieces.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EndsError {
    /// No cut passes the exemplar, so that there is nothing for a bar to close.
    #[error("no cut passes the exemplar: there is no place where a bar could close it")]
    Uncut,
    /// The cap has no portal.
    #[error("the cap ends nowhere straight at its right side, where the pattern is to go on")]
    NoPortal,
    /// The cap is higher than the band.
    #[error("the cap is {cap:.3} high, higher than the band, {room:.3}")]
    TooHigh {
        /// The height that the cap needs.
        cap: f64,
        /// The height of the band.
        room: f64,
    },
    /// The cap's portals meet those of no cut.
    #[error(
        "the cap goes on in {} {}, which meet no cut of the exemplar",
        cap.len(),
        if cap.len() == 1 { "portal" } else { "portals" }
    )]
    Unmet {
        /// The widths of the cap's portals, from below upward.
        cap: Vec<f64>,
        /// Those of the cut that is the most like it; empty where no cut has that many.
        nearest: Vec<f64>,
        /// The numbers of portals that cuts of the exemplar have, ascending.
        numbers: Vec<usize>,
    },
    /// The curve is shorter than both end pieces.
    #[error("the curve, {length:.3} long, is too short for its end pieces, {ends:.3} together")]
    TooShort {
        /// The length of the curve.
        length: f64,
        /// The lengths of both end pieces.
        ends: f64,
    },
}

/// What stands at the ends of a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndPieces {
    /// The exemplar's own pieces.
    Own,
    /// Halves of bars, which stay straight.
    Bars,
    /// Caps, which keep their shape but for what meets the pattern.
    Caps,
}

/// The pieces of a band with end pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// The pieces, the end pieces first and last.
    pub pieces: Vec<Piece>,
    /// How any two of them join.
    pub seams: Seams,
    /// The number of each among the exemplar's pieces; none for an end piece.
    pub origin: Vec<Option<usize>>,
}

/// The place that a piece may take in a pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Role {
    /// The outer half of the first bar.
    Begin,
    /// The inner half of the first bar with the piece of this number.
    Open(usize),
    /// The piece of this number.
    Inner(usize),
    /// The piece of this number with the inner half of the last bar.
    Close(usize),
    /// The outer half of the last bar.
    End,
}

/// The seam between the halves of a bar.
const WHOLE: Seam = Seam {
    cost: 0.0,
    rise: 0.0,
    gap: 0.0,
};

/// `pieces` with bars: a bar may stand at any cut between them.
///
/// # Errors
/// An exemplar without a cut through it.
pub fn with_bars(pieces: &[Piece], seams: &Seams, bar: Bar) -> Result<Ended, EndsError> {
    let n = pieces.len();
    // A table of the solver holds so many pieces. Beyond that, bars may stand at the first cuts only.
    let room = (MOST_PIECES.saturating_sub(n + 2)) / 2;
    let numbers = || 0..n;
    let opening = numbers().filter(|&k| !pieces[k].left.is_empty()).take(room);
    let closing = numbers()
        .filter(|&k| !pieces[k].right.is_empty())
        .take(room);
    let mut roles = vec![Role::Begin];
    roles.extend(numbers().map(Role::Inner));
    roles.extend(opening.map(Role::Open));
    roles.extend(closing.map(Role::Close));
    roles.push(Role::End);
    if roles.len() == n + 2 {
        return Err(EndsError::Uncut);
    }
    let shape = |role: &Role| match *role {
        Role::Begin => bar.outer(),
        Role::Inner(k) => pieces[k].clone(),
        Role::Open(k) => bar.joined(&pieces[k]),
        Role::Close(k) => mirrored(&bar.joined(&mirrored(&pieces[k]))),
        Role::End => mirrored(&bar.outer()),
    };
    let between = |a: usize, b: usize| match (roles[a], roles[b]) {
        (Role::Begin, Role::Open(_)) | (Role::Close(_), Role::End) => Some(WHOLE),
        (Role::Inner(i) | Role::Open(i), Role::Inner(j) | Role::Close(j)) => seams.get(i, j),
        _ => None,
    };
    let origin = |role: &Role| match *role {
        Role::Inner(k) | Role::Open(k) | Role::Close(k) => Some(k),
        Role::Begin | Role::End => None,
    };
    Ok(Ended {
        pieces: roles.iter().map(shape).collect(),
        seams: Seams::by(roles.len(), between),
        origin: roles.iter().map(origin).collect(),
    })
}

/// `pieces` between a cap and its mirror image in a band of height `room`.
///
/// # Errors
/// A cap without portals, one that is higher than the band, and one that meets no cut.
pub fn with_caps(
    pieces: &[Piece],
    drawing: &Exemplar,
    tangent_weight: f64,
    room: f64,
) -> Result<Ended, EndsError> {
    let first = cap(drawing).ok_or(EndsError::NoPortal)?;
    let needed = height(first.bounds);
    if needed > room {
        return Err(EndsError::TooHigh { cap: needed, room });
    }
    let mut all = vec![first.clone()];
    all.extend_from_slice(pieces);
    all.push(mirrored(&first));
    let last = all.len() - 1;
    let compared = Seams::new(&all, tangent_weight);
    let meets = |a: usize, b: usize| compared.get(a, b).filter(|s| overlap(&all[a], &all[b], s));
    let between = |a: usize, b: usize| match (a, b) {
        (_, 0) => None,
        (a, _) if a == last => None,
        (0, b) if b == last => None,
        (0, b) => meets(0, b),
        (a, b) if b == last => meets(a, b),
        (a, b) => compared.get(a, b),
    };
    let seams = Seams::by(all.len(), between);
    let met = |pair: (usize, usize)| seams.get(pair.0, pair.1).is_some();
    if !(1..last).any(|k| met((0, k))) || !(1..last).any(|k| met((k, last))) {
        return Err(unmet(&first, pieces));
    }
    let origin = |k: usize| (0 < k && k < last).then(|| k - 1);
    Ok(Ended {
        origin: (0..=last).map(origin).collect(),
        pieces: all,
        seams,
    })
}

/// Whether the portals of two pieces overlap, each by half of the narrower one or more, where the
/// second piece stands as `seam` says.
fn overlap(a: &Piece, b: &Piece, seam: &Seam) -> bool {
    let mut pairs = a.right.chunks(2).zip(b.left.chunks(2));
    pairs.all(|(p, q)| {
        let shared = (p[1].v.min(q[1].v + seam.rise)) - (p[0].v.max(q[0].v + seam.rise));
        shared >= 0.5 * (p[1].v - p[0].v).min(q[1].v - q[0].v)
    })
}

/// What is to be told about a cap that meets no cut.
fn unmet(cap: &Piece, pieces: &[Piece]) -> EndsError {
    let wanted = portals(&cap.right);
    let cuts = pieces.iter().map(|p| portals(&p.left));
    let cuts: Vec<Vec<f64>> = cuts.filter(|c| !c.is_empty()).collect();
    let mut numbers: Vec<usize> = cuts.iter().map(Vec::len).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let off = |cut: &Vec<f64>| -> f64 {
        let pairs = cut.iter().zip(&wanted);
        pairs.map(|(a, b)| (a - b).abs()).sum()
    };
    let alike = cuts.iter().filter(|c| c.len() == wanted.len());
    let nearest = alike.min_by(|a, b| off(a).total_cmp(&off(b)));
    EndsError::Unmet {
        nearest: nearest.cloned().unwrap_or_default(),
        cap: wanted,
        numbers,
    }
}
