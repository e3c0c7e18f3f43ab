//! Letters of single lines, drawn for this project: what is engraved or plotted in one stroke, or filled with strokes of one
//! width, without a font file. Letters of fonts are not known here.

mod table;

use crate::{CurveLabels, Curves, Point};
use table::{GLYPHS, MARKED, MARKS};

/// Letters are drawn on a grid: the baseline is row 2, small letters reach to row 6, capitals and figures to row 8.
const BASELINE: f64 = 2.0;
const CAPITAL: f64 = 6.0;
/// The height of capitals as a part of the size, as in most fonts.
const CAPITAL_PART: f64 = 0.7;
/// Columns between two letters.
const BETWEEN: f64 = 1.6;
/// From line to line, in sizes.
pub const LEADING: f64 = 1.3;
/// The width of the strokes of letters that are filled, in sizes.
pub const WEIGHT: f64 = 0.09;

/// A character that there is no letter for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the plain letters have no `{0}` (U+{code:04X})", code = u32::from(*.0))]
pub struct NoLetter(pub char);

/// A letter on its line.
#[derive(Clone, Debug, PartialEq)]
pub struct Letter {
    /// Where it begins.
    pub at: f64,
    /// How wide it is.
    pub width: f64,
    /// Its strokes about the beginning of its foot, upward toward −y.
    pub strokes: Vec<Vec<Point>>,
}

/// The letters of one line of this size, which is the height of a font's em square: capitals are 0.7 of it high.
///
/// # Errors
/// A character that there is no letter for.
pub fn line(text: &str, size: f64) -> Result<Vec<Letter>, NoLetter> {
    let unit = size * CAPITAL_PART / CAPITAL;
    let mut column = 0.0;
    let mut letters = Vec::new();
    for c in text.chars() {
        let (width, mut strokes) = glyph(c)?;
        for p in strokes.iter_mut().flatten() {
            *p = Point::new(p.x * unit, (BASELINE - p.y) * unit);
        }
        letters.push(Letter {
            at: column * unit,
            width: f64::from(width) * unit,
            strokes,
        });
        column += f64::from(width) + BETWEEN;
    }
    Ok(letters)
}

/// `text` in single lines: the first baseline begins at the origin, letters stand toward −y as in a drawing, and lines follow one
/// another by [`LEADING`] times the `size`.
///
/// # Errors
/// A character that there is no letter for. White space has no lines, which is no error.
///
/// ```
/// use fretwork_geometry::letters;
/// let letters = letters::write("Fret 7", 10.0).unwrap();
/// assert!((letters.bounds().height() - 7.0).abs() < 1e-12);
/// assert!(letters::write("Ж", 10.0).is_err());
/// ```
pub fn write(text: &str, size: f64) -> Result<Curves, NoLetter> {
    let mut curves = Curves::new();
    for (number, text) in text.lines().enumerate() {
        let down = LEADING * size * number as f64;
        for letter in line(text, size)? {
            let by = Point::new(letter.at, down);
            for stroke in letter.strokes {
                curves.push(stroke.into_iter().map(|p| p + by), CurveLabels::default());
            }
        }
    }
    Ok(curves)
}

/// The width of a letter and its strokes on the grid.
fn glyph(c: char) -> Result<(u8, Vec<Vec<Point>>), NoLetter> {
    if let Some((_, width, strokes)) = GLYPHS.iter().find(|glyph| glyph.0 == c) {
        return Ok((*width, of_text(strokes)));
    }
    for (marked, plain, mark) in MARKED {
        let Some(at) = marked.chars().position(|m| m == c) else {
            continue;
        };
        let base = plain.chars().nth(at).ok_or(NoLetter(c))?;
        let (width, mut strokes) = glyph(base)?;
        // The dot of an i makes room.
        if base == 'i' && *mark != '˛' {
            strokes.truncate(1);
        }
        let (_, drawn) = MARKS.iter().find(|m| m.0 == *mark).ok_or(NoLetter(c))?;
        let raised = if base.is_uppercase() && !matches!(*mark, '¸' | '˛' | ',') {
            2.0
        } else {
            0.0
        };
        let aside = Point::new(0.5 * f64::from(width) - 1.0, raised);
        let moved = |stroke: Vec<Point>| stroke.into_iter().map(|p| p + aside).collect();
        strokes.extend(of_text(drawn).into_iter().map(moved));
        return Ok((width, strokes));
    }
    Err(NoLetter(c))
}

/// The points of strokes as the table writes them.
fn of_text(strokes: &str) -> Vec<Vec<Point>> {
    let number = |c: u8| f64::from(c - b'0');
    let point = |pair: &str| match pair.as_bytes() {
        [x, y] => Some(Point::new(number(*x), number(*y))),
        _ => None,
    };
    let stroke = |stroke: &str| stroke.split(' ').filter_map(point).collect::<Vec<_>>();
    let strokes = strokes.split(',').map(stroke);
    strokes.filter(|stroke| stroke.len() > 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_letters_of_ascii_and_their_marks_are_drawn_within_their_widths() {
        let marked = MARKED.iter().flat_map(|(marked, plain, _)| {
            assert_eq!(marked.chars().count(), plain.chars().count());
            marked.chars()
        });
        let special = GLYPHS.iter().map(|glyph| glyph.0);
        for c in (' '..='~').chain(marked).chain(special) {
            let (width, strokes) = glyph(c).unwrap();
            assert_eq!(strokes.is_empty(), c.is_whitespace(), "{c}");
            for p in strokes.iter().flatten() {
                assert!((0.0..=10.0).contains(&p.y), "{c} {p:?}");
                // A mark may be wider than a narrow letter.
                let over = if c.is_ascii() { 0.0 } else { 1.0 };
                assert!(
                    (-over..=f64::from(width) + over).contains(&p.x),
                    "{c} {p:?}"
                );
            }
        }
    }

    #[test]
    fn no_two_letters_look_the_same_but_those_that_do_in_print() {
        let mut seen: Vec<(char, Vec<Vec<Point>>)> = Vec::new();
        let all = GLYPHS.iter().map(|glyph| glyph.0);
        let special = all.filter(|c| !c.is_ascii() && !c.is_whitespace());
        for c in ('!'..='~').chain(special) {
            let (_, strokes) = glyph(c).unwrap();
            let same = seen.iter().find(|(_, other)| *other == strokes);
            assert!(
                same.is_none() || "O‚".contains(c),
                "{c} looks like {same:?}"
            );
            seen.push((c, strokes));
        }
    }

    #[test]
    fn lines_are_as_wide_as_they_say() {
        let text = "Slice 12\n7 of 9";
        let drawn = write(text, 6.0).unwrap().bounds();
        let first = line("Slice 12", 6.0).unwrap();
        let width = first.last().map_or(0.0, |last| last.at + last.width);
        assert!((drawn.width() - width).abs() < 1e-9);
        assert!((drawn.max.y - 1.3 * 6.0).abs() < 1e-9);
        assert_eq!(write("a\u{416}", 1.0), Err(NoLetter('\u{416}')));
        assert!(line("", 3.0).unwrap().is_empty());
    }
}
