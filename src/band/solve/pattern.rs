//! What bands and panels are asked for, in plain values, and the sequence of pieces that meets it.

use fretwork_diagnostic::Diagnostic;
use fretwork_language::kinds::bands as kinds;
use fretwork_language::value::Target;

use crate::exemplar::normalize::Exemplar;
use crate::exemplar::piece::Piece;
use crate::exemplar::seam::Seams;
use crate::exemplar::slicing::{Slicing, slice};
use crate::solve::least_squares_offsets::settled;
use crate::solve::quantize::Drift;
use crate::solve::search::{Failure, Sequence, Task, height, joints, solve};
use crate::solve::states::Demand;
use crate::solve::unsolvable::{DRIFT, explain};

/// How pieces are cut and put together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recipe {
    /// How many components; none for any.
    pub components: Option<u32>,
    /// How many holes; none for any.
    pub holes: Option<u32>,
    /// Where the exemplar is cut.
    pub slicing: Slicing,
    /// Narrower necks are not cut.
    pub min_portal: f64,
    /// The weight of the autocorrelation.
    pub variety: f64,
    /// 1 - α of the cost of a seam.
    pub tangent_weight: f64,
    /// How far the pieces' total may be from the length, as a part of it.
    pub length_tolerance: f64,
    /// What comes again is at least this part of the exemplar's width: 0 lets every piece follow itself.
    pub least_repeat: f64,
}

impl From<&kinds::Synthesis> for Recipe {
    fn from(spec: &kinds::Synthesis) -> Recipe {
        let target = |t: Target| match t {
            Target::Any => None,
            Target::Exactly(n) => Some(n),
        };
        Recipe {
            components: target(spec.components),
            holes: target(spec.holes),
            slicing: match spec.slicing {
                kinds::Slicing::Topology => Slicing::Topology {
                    event_tolerance: spec.event_tolerance.0,
                },
                kinds::Slicing::Uniform(lines) => Slicing::Uniform(lines.0 as usize),
            },
            min_portal: spec.min_portal.0,
            variety: spec.variety.0,
            tangent_weight: spec.tangent_weight.0,
            length_tolerance: spec.length_tolerance.0,
            least_repeat: 0.0,
        }
    }
}

/// The room for a pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Along the band.
    pub length: f64,
    /// Across it.
    pub height: f64,
    /// The end is the beginning.
    pub closed: bool,
    /// A component must run round.
    pub around: bool,
    /// Offsets may leave the room by this part of its height.
    pub slack: f64,
}

/// The slack of a room that is higher than its exemplar.
pub const SLACK: f64 = 0.025;
/// The slack of a room that is exactly as high as its exemplar, which could not drift at all otherwise: how high its pattern
/// becomes says how much smaller the exemplar must be.
const FITTED_SLACK: f64 = 0.15;
/// So many sizes of the exemplar are tried, each this part of the one before it.
const SIZES: usize = 4;
const SMALLER: f64 = 0.95;

/// A sequence of pieces that meets a recipe.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// The pieces of the exemplar and their seams.
    pub parts: Parts,
    /// The sequence.
    pub sequence: Sequence,
}

/// The pieces of an exemplar, and how any two of them join.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// The pieces.
    pub(crate) pieces: Vec<Piece>,
    /// Their seams.
    pub(crate) seams: Seams,
}

impl Parts {
    /// Cuts the exemplar.
    ///
    /// # Errors
    /// What `slice` refuses.
    pub fn new(
        exemplar: &Exemplar,
        recipe: &Recipe,
    ) -> Result<(Parts, Vec<Diagnostic>), Diagnostic> {
        let (pieces, warnings) = slice(exemplar, recipe.slicing, recipe.min_portal)?;
        let seams = Seams::new(&pieces, recipe.tangent_weight);
        let mut parts = Parts { pieces, seams };
        parts.forbid_repeats(recipe.least_repeat * exemplar.width);
        Ok((parts, warnings))
    }

    /// No run of neighbouring pieces that is narrower than `least` comes twice in succession.
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

    /// How many pieces there are.
    pub fn count(&self) -> usize {
        self.pieces.len()
    }

    /// The sequence of pieces that meets the recipe and fits in the room.
    ///
    /// # Errors
    /// Counts or lengths that cannot be had; each error says what would do.
    pub fn arrange(&self, recipe: &Recipe, room: Room) -> Result<Sequence, Diagnostic> {
        let explained =
            |failure| explain(failure, &self.pieces, &self.seams, &self.task(recipe, room));
        self.solve(recipe, room).map_err(explained)
    }

    /// As [`Parts::arrange`], without the search for what could be had instead.
    pub(crate) fn solve(&self, recipe: &Recipe, room: Room) -> Result<Sequence, Failure> {
        solve(&self.pieces, &self.seams, &self.task(recipe, room))
    }

    /// The sequence in which none of the pairs `weak` stands any more, now or later; where there is none, one without the first of
    /// them. None where there is no such sequence either, or no weak pair.
    pub(crate) fn solve_without(
        &mut self,
        weak: &[(usize, usize)],
        recipe: &Recipe,
        room: Room,
    ) -> Option<Sequence> {
        for some in [weak, weak.get(..1)?] {
            let before = self.seams.clone();
            some.iter()
                .for_each(|&(piece, next)| self.seams.forbid(piece, next));
            match self.solve(recipe, room) {
                Ok(sequence) => return Some(sequence),
                Err(_) => self.seams = before,
            }
        }
        None
    }

    /// The height of a band that the final offsets of a sequence do not leave.
    fn extent(&self, sequence: &Sequence, closed: bool) -> f64 {
        let Parts { pieces, seams } = self;
        let seams = joints(seams, &sequence.pieces, closed).unwrap_or_default();
        height(
            pieces,
            &sequence.pieces,
            &settled(pieces, &sequence.pieces, &seams, closed),
            closed,
        )
    }

    fn task(&self, recipe: &Recipe, room: Room) -> Task {
        let half = room.height * (0.5 + room.slack);
        let ranges = self
            .pieces
            .iter()
            .map(|p| (-half - p.bounds.min.y, half - p.bounds.max.y))
            .collect();
        let around = room.closed && room.around;
        Task {
            length: room.length,
            tolerance: recipe.length_tolerance * room.length,
            closed: room.closed,
            demand: Demand {
                components: recipe.components,
                holes: recipe.holes,
                around,
            },
            drift: Drift { ranges },
            variety: recipe.variety,
        }
    }
}

/// The exemplar as high as the room with its pattern, or smaller where pieces must stand above and below one another: the
/// pattern is as high as the room then, but for its slack. Where nothing smaller will do, an exemplar as high as the room has a
/// pattern that is higher.
///
/// # Errors
/// As those of [`compose`].
pub fn fit(
    exemplar: &Exemplar,
    recipe: &Recipe,
    room: Room,
) -> Result<(Exemplar, (Pattern, Vec<Diagnostic>)), Diagnostic> {
    let exemplar = exemplar.scaled(room.height / exemplar.height);
    let scales = "`fit` scales the exemplar with the band: draw it level, so that both its ends are at the same height";
    let whole = compose(
        &exemplar,
        recipe,
        Room {
            slack: FITTED_SLACK,
            ..room
        },
    )
    .map_err(|e| {
        if e.message.contains(DRIFT) {
            e.help(scales)
        } else {
            e
        }
    })?;
    let extent = whole.0.parts.extent(&whole.0.sequence, room.closed);
    if extent <= room.height * (1.0 + 2.0 * room.slack) {
        return Ok((exemplar, whole));
    }
    let smaller = |factor| {
        let exemplar = exemplar.scaled(factor);
        let made = compose(&exemplar, recipe, room).ok()?;
        Some((exemplar, made))
    };
    let factors =
        std::iter::successors(Some(room.height / extent), |factor| Some(SMALLER * factor));
    Ok(factors
        .take(SIZES)
        .find_map(smaller)
        .unwrap_or((exemplar, whole)))
}

/// Cuts the exemplar and solves for the sequence.
///
/// # Errors
/// An exemplar higher than the band, and what [`Parts::new`] and [`Parts::arrange`] refuse; each says what would do.
pub fn compose(
    exemplar: &Exemplar,
    recipe: &Recipe,
    room: Room,
) -> Result<(Pattern, Vec<Diagnostic>), Diagnostic> {
    if exemplar.height > room.height * (1.0 + 2.0 * room.slack) {
        return Err(Diagnostic::error(format!(
            "the exemplar is {:.3} high, higher than the band, {:.3}",
            exemplar.height, room.height
        ))
        .help(format!(
            "a height of {:.3} would do; or `fit: true` scales the exemplar",
            exemplar.height
        )));
    }
    let (parts, warnings) = Parts::new(exemplar, recipe)?;
    let sequence = parts.arrange(recipe, room)?;
    Ok((Pattern { parts, sequence }, warnings))
}
