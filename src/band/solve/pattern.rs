//! A sequence of pieces that meets what was asked: the exemplar is cut, and the solver is run.

use super::alignment::Alignment;
use super::solver::solve;
use super::task::{Demand, Drift, Failure, Problem, Sequence, Task};
use super::unsolvable::{Unsolvable, explain};
use crate::exemplar::bar::Bar;
use crate::exemplar::ends::{EndPieces, Ended, Ends, EndsError, with_bars, with_caps};
use crate::exemplar::error::{ExemplarWarning, SlicingError};
use crate::exemplar::normalize::Exemplar;
use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;
use crate::exemplar::slicing::slice;
use crate::parameters::{Parameters, Room};

/// The slack of a room that is higher than its exemplar: offsets may leave the room by this part of
/// its height. With 0 a pattern that fills its band to a hair would be refused; a twentieth shows.
pub const SLACK: f64 = 0.025;
/// The slack of a room that is exactly as high as its exemplar, which could not drift at all
/// otherwise. How high its pattern becomes says how much smaller the exemplar must be; with less
/// slack tilted exemplars have no pattern to tell it, with more the pattern says too much.
const FITTED_SLACK: f64 = 0.15;
/// How many sizes of a fitted exemplar are tried.
const SIZES: usize = 4;
/// Each of them is this part of the one before it: the last is a seventh below the first.
const SMALLER: f64 = 0.95;

/// Why there is no pattern.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PatternError {
    /// The exemplar is higher than the room.
    #[error("the exemplar is {exemplar:.3} high, higher than the band, {room:.3}")]
    TooHigh {
        /// The height of the exemplar.
        exemplar: f64,
        /// The height of the room.
        room: f64,
    },
    /// The exemplar cannot be cut.
    #[error(transparent)]
    Slicing(#[from] SlicingError),
    /// Its ends cannot be closed as asked.
    #[error(transparent)]
    Ends(#[from] EndsError),
    /// No sequence of its pieces will do.
    #[error(transparent)]
    Unsolvable(#[from] Unsolvable),
}

impl PatternError {
    /// Whether only a higher band would do.
    pub fn is_drift(&self) -> bool {
        matches!(self, PatternError::Unsolvable(Unsolvable::Drift { .. }))
    }
}

/// A sequence of pieces that meets the parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// The pieces of the exemplar and their seams.
    pub parts: Parts,
    /// The sequence.
    pub sequence: Sequence,
}

/// The pieces of an exemplar with the end pieces of the band, and how any two of them join.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// The pieces.
    pub(crate) pieces: Vec<Piece>,
    /// Their seams.
    pub(crate) seams: Seams,
    /// The number of each among the exemplar's pieces; none for an end piece.
    pub(crate) origin: Vec<Option<usize>>,
    /// What the first and the last piece are.
    pub(crate) end_pieces: EndPieces,
}

impl Parts {
    /// Cuts the exemplar.
    ///
    /// # Errors
    /// As for `slice`.
    pub fn new(
        exemplar: &Exemplar,
        parameters: &Parameters,
    ) -> Result<(Parts, Vec<ExemplarWarning>), SlicingError> {
        let (pieces, warnings) = slice(exemplar, &parameters.cutting)?;
        let seams = Seams::new(&pieces, parameters.tangent_weight);
        let mut parts = Parts {
            origin: (0..pieces.len()).map(Some).collect(),
            pieces,
            seams,
            end_pieces: EndPieces::Own,
        };
        parts.forbid_repeats(parameters.least_repeat * exemplar.width);
        Ok((parts, warnings))
    }

    /// Forbids that a run of neighbouring pieces narrower than `least` comes twice in succession.
    fn forbid_repeats(&mut self, least: f64) {
        for last in 0..self.pieces.len() {
            let mut width = 0.0;
            for first in (0..=last).rev() {
                width += self.pieces[first].width;
                if width < least {
                    self.seams.forbid(last, first);
                }
            }
        }
    }

    /// The same with end pieces for a band of this room.
    ///
    /// # Errors
    /// End pieces that cannot be joined to these, and a room that is too short for them.
    fn ended(self, ends: &Ends, parameters: &Parameters, room: Room) -> Result<Parts, EndsError> {
        let Ended {
            pieces,
            seams,
            origin,
        } = match ends {
            Ends::Free => return Ok(self),
            &Ends::Bar(thickness) => {
                let height = room.height;
                with_bars(&self.pieces, &self.seams, Bar { thickness, height })?
            }
            Ends::Cap(cap) => {
                let most = room.height * (1.0 + 2.0 * room.slack);
                with_caps(&self.pieces, cap, parameters.tangent_weight, most)?
            }
        };
        let one = match ends {
            &Ends::Bar(thickness) => thickness,
            _ => pieces.first().map_or(0.0, |p| p.width),
        };
        if room.length * (1.0 + parameters.length_tolerance) <= 2.0 * one {
            return Err(EndsError::TooShort {
                length: room.length,
                ends: 2.0 * one,
            });
        }
        Ok(Parts {
            pieces,
            seams,
            origin,
            end_pieces: match ends {
                Ends::Bar(_) => EndPieces::Bars,
                _ => EndPieces::Caps,
            },
        })
    }

    /// How many pieces the exemplar has.
    pub fn count(&self) -> usize {
        let cut = self.origin.iter().flatten();
        cut.max().map_or(0, |&last| last + 1)
    }

    /// The numbers, among the exemplar's pieces, of those of `sequence`; end pieces have none.
    pub fn numbers(&self, sequence: &[usize]) -> Vec<usize> {
        sequence.iter().filter_map(|&k| self.origin[k]).collect()
    }

    /// The sequence of pieces that meets the parameters and fits in the room.
    ///
    /// # Errors
    /// Counts or lengths that cannot be had, with those that can.
    pub fn arrange(&self, parameters: &Parameters, room: Room) -> Result<Sequence, Unsolvable> {
        let task = self.task(parameters, room);
        let problem = self.problem(&task);
        solve(&problem).map_err(|failure| explain(failure, &problem))
    }

    /// The sequence in which none of the `weak` pairs stands any more. Where there is none, one
    /// without the first of them. The pairs that the answer avoids stay forbidden from then on.
    /// None where there is no such sequence either, or no weak pair.
    pub fn solve_without(
        &mut self,
        weak: &[(usize, usize)],
        parameters: &Parameters,
        room: Room,
    ) -> Option<Sequence> {
        for some in [weak, weak.get(..1)?] {
            let before = self.seams.clone();
            for &(piece, next) in some {
                self.seams.forbid(piece, next);
            }
            let solved: Result<Sequence, Failure> = {
                let task = self.task(parameters, room);
                solve(&self.problem(&task))
            };
            match solved {
                Ok(sequence) => return Some(sequence),
                Err(_) => self.seams = before,
            }
        }
        None
    }

    fn problem<'a>(&'a self, task: &'a Task) -> Problem<'a> {
        Problem {
            pieces: &self.pieces,
            seams: &self.seams,
            task,
        }
    }

    fn task(&self, parameters: &Parameters, room: Room) -> Task {
        let half = room.height * (0.5 + room.slack);
        let range = |p: &Piece| (-half - p.bounds.min.y, half - p.bounds.max.y);
        Task {
            length: room.length,
            tolerance: parameters.length_tolerance * room.length,
            closed: room.closed,
            demand: Demand {
                components: parameters.components,
                holes: parameters.holes,
                around: room.closed && room.around,
            },
            drift: Drift {
                ranges: self.pieces.iter().map(range).collect(),
            },
            variety: parameters.variety,
        }
    }
}

impl Pattern {
    /// The seams and the final offsets of its pieces; none where two of them cannot be neighbours.
    pub fn alignment(&self, closed: bool) -> Option<Alignment> {
        let Parts { pieces, seams, .. } = &self.parts;
        Alignment::new(pieces, seams, &self.sequence.pieces, closed)
    }

    /// The height of a band that the pattern does not leave.
    fn extent(&self, closed: bool) -> f64 {
        let alignment = self.alignment(closed);
        alignment.map_or(0.0, |a| a.height(&self.parts.pieces, &self.sequence.pieces))
    }
}

/// A pattern with what is to be told about its exemplar.
type Composed = (Pattern, Vec<ExemplarWarning>);

/// The exemplar as high as the room with its pattern. Where pieces must stand above and below one
/// another, the exemplar is smaller, so that the pattern is as high as the room but for its slack.
/// Where nothing smaller will do, the exemplar is as high as the room and its pattern is higher.
///
/// # Errors
/// As for [`compose`].
pub fn fit(
    exemplar: &Exemplar,
    ends: &Ends,
    parameters: &Parameters,
    room: Room,
) -> Result<(Exemplar, Composed), PatternError> {
    let factor = room.height / exemplar.height;
    let (exemplar, ends) = (exemplar.scaled(factor), ends.scaled(factor));
    let loose = Room {
        slack: FITTED_SLACK,
        ..room
    };
    let whole = compose(&exemplar, &ends, parameters, loose)?;
    let extent = whole.0.extent(room.closed);
    if extent <= room.height * (1.0 + 2.0 * room.slack) {
        return Ok((exemplar, whole));
    }
    let smaller = |factor| {
        let exemplar = exemplar.scaled(factor);
        let made = compose(&exemplar, &ends.scaled(factor), parameters, room).ok()?;
        Some((exemplar, made))
    };
    let first = room.height / extent;
    let factors = std::iter::successors(Some(first), |factor| Some(SMALLER * factor));
    let found = factors.take(SIZES).find_map(smaller);
    Ok(found.unwrap_or((exemplar, whole)))
}

/// Cuts the exemplar, adds the end pieces, and solves for the sequence.
///
/// # Errors
/// An exemplar higher than the band, end pieces that cannot be used, and as for [`Parts::new`] and
/// [`Parts::arrange`].
pub fn compose(
    exemplar: &Exemplar,
    ends: &Ends,
    parameters: &Parameters,
    room: Room,
) -> Result<Composed, PatternError> {
    if exemplar.height > room.height * (1.0 + 2.0 * room.slack) {
        return Err(PatternError::TooHigh {
            exemplar: exemplar.height,
            room: room.height,
        });
    }
    let (parts, warnings) = Parts::new(exemplar, parameters)?;
    let parts = parts.ended(ends, parameters, room)?;
    let sequence = parts.arrange(parameters, room)?;
    Ok((Pattern { parts, sequence }, warnings))
}
