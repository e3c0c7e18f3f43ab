//! A sequence of pieces and its geometry together: where badly matched pieces leave the pattern thin, or make it
//! impossible to draw, the solver is asked for another sequence that does not join them.

use crate::realize::shape::{Attempt, Bed, ShapeError, Shaped, shape};
use crate::solve::pattern::{Pattern, Recipe, Room};
use fretwork_geometry::neck::Neck;

/// Sequences that are tried.
const ATTEMPTS: usize = 8;
/// What is thinner than this part of the finest detail that is wanted holds nothing together.
const FRAGILE: f64 = 0.5;

/// A pattern with its geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The pattern.
    pub pattern: Pattern,
    /// Its polygons.
    pub shaped: Shaped,
    /// Its narrowest place, if that is finer than was wanted.
    pub thinnest: Option<Neck>,
    /// Whether it is so thin that it holds nothing together, or keeps nothing apart.
    pub is_fragile: bool,
}

/// The polygons of `pattern`, or of the first other sequence that meets the recipe and has no thin places but those of
/// the exemplar; where there is none among those tried, of the one that is least fragile and has the fewest such places. The counts
/// are those of the pattern.
///
/// # Errors
/// What makes the polygons of `pattern` impossible, when those of the others are as well.
pub fn draw(
    mut pattern: Pattern,
    recipe: &Recipe,
    room: Room,
    bed: &Bed,
) -> Result<Drawn, ShapeError> {
    let mut parts = pattern.parts.clone();
    let mut best: Option<((bool, usize), Drawn)> = None;
    let mut failure = None;
    for _ in 0..ATTEMPTS {
        let Attempt {
            shaped,
            thinnest,
            weak,
        } = shape(&pattern, bed);
        let is_fragile = thinnest.is_some_and(|neck| neck.width < FRAGILE * bed.detail.finest);
        let rank = (is_fragile, weak.len());
        match shaped {
            Ok(shaped) if best.as_ref().is_none_or(|b| rank < b.0) => {
                best = Some((
                    rank,
                    Drawn {
                        pattern,
                        shaped,
                        thinnest,
                        is_fragile,
                    },
                ));
            }
            Ok(_) => {}
            Err(error) => failure = failure.or(Some(error)),
        }
        let Some(sequence) = parts.solve_without(&weak, recipe, room) else {
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
