//! Errors and warnings of the room, in words for the user: the message is that of the error, and
//! the advice is added here. Nothing else in the room makes diagnostics, and nothing reads them.

use std::collections::BTreeSet;

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Fold, Point3};

use crate::exemplar::ends::EndsError;
use crate::exemplar::error::{ExemplarError, ExemplarWarning, SlicingError, near};
use crate::solve::pattern::PatternError;
use crate::solve::unsolvable::{Unsolvable, number};

impl From<ExemplarError> for Diagnostic {
    fn from(error: ExemplarError) -> Diagnostic {
        let diagnostic = Diagnostic::error(error.to_string());
        match error {
            ExemplarError::Empty => {
                diagnostic.help("bands are made of filled shapes or of strokes with a width")
            }
            ExemplarError::Area(_) | ExemplarError::Touching(_) | ExemplarError::NotSimple(_) => {
                diagnostic
            }
        }
    }
}

impl From<ExemplarWarning> for Diagnostic {
    fn from(warning: ExemplarWarning) -> Diagnostic {
        match warning {
            ExemplarWarning::Crossing(place) => Diagnostic::warning(format!(
                "the exemplar's outline crosses or touches itself{}",
                near(&place)
            ))
            .help("what lies inside by the fill rule is used"),
            ExemplarWarning::Joined(place) => Diagnostic::warning(format!(
                "parts of the exemplar touch{}, or nearly so",
                near(&place)
            ))
            .help("they are joined; let them overlap, or part them"),
            ExemplarWarning::Unchanging(cuts) => Diagnostic::warning(
                "the exemplar's topology does not change between its ends: it is cut uniformly",
            )
            .help(format!("`slicing: {{ uniform: {cuts} }}` says so")),
            ExemplarWarning::NoWideCut(min_portal) => Diagnostic::warning(format!(
                "every cut of the exemplar passes a neck thinner than `min_portal` {min_portal}"
            ))
            .help("the exemplar stays in one piece; lower `min_portal`"),
        }
    }
}

impl From<PatternError> for Diagnostic {
    fn from(error: PatternError) -> Diagnostic {
        let diagnostic = Diagnostic::error(error.to_string());
        let help = match error {
            PatternError::TooHigh { exemplar, .. } => Some(format!(
                "a height of {exemplar:.3} would do; or `fit: true` scales the exemplar"
            )),
            PatternError::Slicing(SlicingError::TooManyPieces { .. }) => {
                Some("raise `event_tolerance`, or use a simpler exemplar".into())
            }
            PatternError::Slicing(SlicingError::TooManyLines { .. }) => None,
            PatternError::Ends(ends) => Some(ends_advice(&ends)),
            PatternError::Unsolvable(unsolvable) => advice(&unsolvable),
        };
        match help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        }
    }
}

/// What end pieces would do instead.
fn ends_advice(error: &EndsError) -> String {
    let widths = |portals: &[f64]| {
        let widths: Vec<String> = portals.iter().map(|&w| number(w)).collect();
        widths.join(", ")
    };
    match error {
        EndsError::Uncut => {
            "`slicing: { uniform: 12 }` cuts it; or `ends: free` leaves it as it is".into()
        }
        EndsError::NoPortal => {
            "draw a cap for the beginning of the band, with a straight upright edge at its right \
             where each strand of the pattern goes on; its mirror image is put at the end"
                .into()
        }
        EndsError::TooHigh { cap, .. } => {
            format!(
                "a height of {} would do; or draw the cap lower",
                number(*cap)
            )
        }
        EndsError::Unmet {
            cap,
            nearest,
            numbers,
        } if nearest.is_empty() => {
            let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
            format!(
                "its right side has {}, and cuts of the exemplar have {}",
                cap.len(),
                if numbers.is_empty() {
                    "none".into()
                } else {
                    numbers.join(" or ")
                }
            )
        }
        EndsError::Unmet { cap, nearest, .. } => format!(
            "from below upward its portals are {} wide, those of the most similar cut {}; they must \
             overlap when the cap is moved up or down",
            widths(cap),
            widths(nearest)
        ),
        EndsError::TooShort { .. } => {
            "use a longer curve, a thinner `bar`, or a narrower cap".into()
        }
    }
}

/// What would do instead.
fn advice(unsolvable: &Unsolvable) -> Option<String> {
    let help = match unsolvable {
        Unsolvable::TooShort { .. } => return None,
        Unsolvable::Length { nearest, .. } if nearest.is_empty() => {
            "no piece can follow another so that the pattern goes on; \
             `slicing: { uniform: 12 }` cuts other pieces"
                .into()
        }
        Unsolvable::Length { nearest, .. } => {
            let nearest: Vec<String> = nearest.iter().map(|&l| number(l)).collect();
            let nearest = nearest.join(" and ");
            format!("the nearest lengths are {nearest}; or raise `length_tolerance`")
        }
        Unsolvable::Components { possible, .. } => {
            format!("numbers of components that can be had: {}", list(possible))
        }
        Unsolvable::Holes { possible, .. } => {
            format!("numbers of holes that can be had: {}", list(possible))
        }
        Unsolvable::AtOnce { .. } => "each can be had alone; ask for `any` of one of them".into(),
        Unsolvable::Drift { height } => {
            // A little more, so that rounding does not take the height back.
            format!("a height of {} would do", number(height * (1.0 + 1e-6)))
        }
        Unsolvable::TooManyStates(_) => "use a simpler exemplar, or fewer cuts".into(),
        Unsolvable::TooLong { .. } => "use a larger exemplar, or a shorter curve".into(),
    };
    Some(help)
}

/// The members of a set; of large sets how many there are between which ends.
fn list(set: &BTreeSet<u32>) -> String {
    let names: Vec<String> = set.iter().map(u32::to_string).collect();
    match (names.len(), set.first(), set.last()) {
        (0, _, _) => "none".into(),
        (13.., Some(a), Some(b)) => format!("{} of those from {a} to {b}", names.len()),
        _ => names.join(", "),
    }
}

/// The error about a pattern that holds nothing together, or keeps nothing apart, at its thinnest
/// place.
pub fn fragile(width: f64, place: &str) -> Diagnostic {
    Diagnostic::error(format!(
        "the pattern would be only {width:.6} thin, {place}: its pieces fit too badly"
    ))
    .help(
        "ask for other counts, `slicing: { uniform: 12 }`, a `min_portal`, \
         or a larger `length_tolerance`",
    )
}

/// The warning about a band that folds over itself where its curve is bent sharply.
pub fn folded(fold: Fold) -> Diagnostic {
    let Point3 { x, y, z } = fold.at;
    Diagnostic::warning(format!(
        "the band is higher than the curve's radius of curvature allows \
         near ({x:.3}, {y:.3}, {z:.3})"
    ))
    .help(format!(
        "up to a height of {:.3} it does not fold there",
        fold.height
    ))
}
