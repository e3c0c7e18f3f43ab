//! A sequence of pieces and its geometry together: where badly matched pieces leave the pattern thin, or make it
//! impossible to draw, the solver is asked for another sequence that does not join them.

use super::recipe::{Pattern, Recipe, Room};
use super::shape::{Attempt, Bed, ShapeError, Shaped, shape};

/// Sequences that are tried.
const ATTEMPTS: usize = 8;

/// The polygons of `pattern`, or of the first other sequence that meets the recipe and has no thin places but those of
/// the exemplar; where there is none among those tried, of the one with the fewest. The counts are those of the pattern.
///
/// # Errors
/// What makes the polygons of `pattern` impossible, when those of the others are as well.
pub fn draw(mut pattern: Pattern, recipe: &Recipe, room: Room, bed: &Bed) -> Result<(Pattern, Shaped), ShapeError> {
    let mut parts = pattern.parts.clone();
    let mut best: Option<(usize, Pattern, Shaped)> = None;
    let mut failure = None;
    for _ in 0..ATTEMPTS {
        let Attempt { shaped, weak } = shape(&pattern, bed);
        weak.iter().for_each(|&(piece, next)| parts.seams.forbid(piece, next));
        match shaped {
            Ok(shaped) if best.as_ref().is_none_or(|b| weak.len() < b.0) => best = Some((weak.len(), pattern, shaped)),
            Ok(_) => {}
            Err(error) => failure = failure.or(Some(error)),
        }
        if weak.is_empty() {
            break;
        }
        let Ok(sequence) = parts.solve(recipe, room) else { break };
        pattern = Pattern { parts: parts.clone(), sequence };
    }
    best.map(|(_, pattern, shaped)| (pattern, shaped)).ok_or(failure.unwrap_or(ShapeError::Broken))
}
