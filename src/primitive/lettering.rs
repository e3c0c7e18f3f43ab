//! What is told of letters where they stand: which of them run into one another on a bend, and which one a place lies in. How
//! they come to stand there is known to `text`.

use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::polygon::{AreaError, fill, intersect};
use fretwork_geometry::{Bounds, FillRule, Point, Polygon, Ring};

/// Letters share more than this part of a square of their size where they run into one another. Written letters that are joined
/// share less.
const SHARED: f64 = 0.01;

/// A letter where it stands.
pub struct Placed {
    /// Which one it is, where each letter has a shape of its own.
    pub letter: Option<char>,
    /// Its outlines.
    pub rings: Vec<Ring>,
}

impl Placed {
    fn area(&self) -> Result<Vec<Polygon>, AreaError> {
        fill(&self.rings, FillRule::NonZero)
    }

    fn bounds(&self) -> Bounds {
        Bounds::of(self.rings.iter().flatten().copied())
    }
}

/// The letter in whose box a place lies.
pub fn letter_at(letters: &[Placed], at: Point) -> Option<char> {
    let found = letters.iter().find(|placed| placed.bounds().contains(at))?;
    found.letter
}

/// A warning where letters of this size, one after the other on the curve `on`, run into one another.
///
/// # Errors
/// When areas cannot be computed.
pub fn overlapping(
    action: &Action,
    on: &str,
    letters: &[Placed],
    size: f64,
) -> Result<Option<Diagnostic>, AreaError> {
    let drawn: Vec<&Placed> = letters.iter().filter(|l| !l.rings.is_empty()).collect();
    let mut found: Vec<&Placed> = Vec::new();
    for pair in drawn.windows(2) {
        if !pair[0].bounds().intersects(&pair[1].bounds()) {
            continue;
        }
        let shared = intersect(&pair[0].area()?, &pair[1].area()?)?;
        let shared: f64 = shared.iter().map(Polygon::area).sum();
        if shared > SHARED * size * size {
            found.push(pair[0]);
        }
    }
    let Some(first) = found.first() else {
        return Ok(None);
    };
    let at = first.bounds().center();
    let after = first
        .letter
        .map_or(String::new(), |letter| format!(" after `{letter}`"));
    let places = match found.len() {
        1 => String::new(),
        count => format!(" in {count} places, first"),
    };
    let message = format!(
        "letters run into one another where `{on}` bends{places}{after} near ({:.1}, {:.1})",
        at.x, at.y
    );
    let warning = Diagnostic::warning(message).at(action.span(), "in this text");
    Ok(Some(warning.help(
        "a `letter_spacing` parts them, so do smaller letters, or the other `side` of the curve",
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_that_of_the_letter_around_it() {
        let square = |x: f64, letter| Placed {
            letter: Some(letter),
            rings: vec![
                [[x, 0.0], [x + 2.0, 0.0], [x + 2.0, 2.0], [x, 2.0]]
                    .map(Point::from)
                    .to_vec(),
            ],
        };
        let letters = [square(0.0, 'A'), square(3.0, 'B')];
        assert_eq!(letter_at(&letters, Point::new(4.0, 1.0)), Some('B'));
        assert_eq!(letter_at(&letters, Point::new(2.5, 1.0)), None);
    }
}
