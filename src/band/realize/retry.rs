//! A sequence of pieces and its geometry together. Where badly matched pieces leave the pattern
//! thin, or make it impossible to draw, the solver is asked for another sequence that does not join
//! them.

use fretwork_geometry::neck::Neck;

use super::bed::Bed;
use super::shape::{Attempt, Shape, ShapeError, shape};
use crate::parameters::{Parameters, Room};
use crate::solve::pattern::Pattern;

/// How many sequences are tried. Each costs one more search and one more drawing; with fewer, small
/// exemplars are given up that have a good sequence.
const ATTEMPTS: usize = 8;
/// What is thinner than this part of the finest detail holds nothing together, or keeps nothing
/// apart. With a greater part patterns are refused that can be made with care; with a smaller one
/// the part breaks when it is taken out of the sheet.
const FRAGILE: f64 = 0.5;

/// A pattern with its geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The pattern.
    pub pattern: Pattern,
    /// Its polygons.
    pub shape: Shape,
    /// Its narrowest place, if that is finer than was wanted.
    pub thinnest: Option<Neck>,
    /// Whether it is so thin that it holds nothing together, or keeps nothing apart.
    pub is_fragile: bool,
}

/// The polygons of `pattern`, or of the first other sequence that meets the parameters and has no
/// thin places but those of the exemplar. Where none of those tried is like that, the answer is the
/// least fragile one, and of these the one with the fewest such places. The counts are those of the
/// pattern.
///
/// # Errors
/// What makes the polygons of `pattern` impossible, when those of the others are impossible as
/// well.
pub fn draw(
    mut pattern: Pattern,
    parameters: &Parameters,
    room: Room,
    bed: &Bed,
) -> Result<Drawn, ShapeError> {
    let mut parts = pattern.parts.clone();
    let mut best: Option<((bool, usize), Drawn)> = None;
    let mut failure = None;
    for _ in 0..ATTEMPTS {
        let Attempt {
            shape,
            thinnest,
            weak,
        } = shape(&pattern, bed);
        let is_fragile = thinnest.is_some_and(|neck| neck.width < FRAGILE * bed.detail.finest);
        let rank = (is_fragile, weak.len());
        match shape {
            Ok(shape) if best.as_ref().is_none_or(|b| rank < b.0) => {
                let drawn = Drawn {
                    pattern,
                    shape,
                    thinnest,
                    is_fragile,
                };
                best = Some((rank, drawn));
            }
            Ok(_) => {}
            Err(error) => failure = failure.or(Some(error)),
        }
        let Some(sequence) = parts.solve_without(&weak, parameters, room) else {
            break;
        };
        pattern = Pattern {
            parts: parts.clone(),
            sequence,
        };
    }
    best.map(|(_, drawn)| drawn)
        .ok_or(failure.unwrap_or(ShapeError::Broken))
}
