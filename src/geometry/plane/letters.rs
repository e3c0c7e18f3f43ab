//! Letters of single lines, drawn for this project: what is engraved or plotted in one stroke, without a font file. Letters
//! of areas come from fonts and are not known here.

use crate::{CurveLabels, Curves, Point};

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

/// Characters with their widths in columns, and their strokes: points of a column and a row, apart by blanks, strokes by commas.
const GLYPHS: &[(char, u8, &str)] = &[
    (' ', 2, ""),
    ('!', 0, "08 04,02 03"),
    ('"', 1, "07 08,17 18"),
    ('#', 4, "12 18,32 38,04 44,06 46"),
    ('$', 4, "47 38 18 07 06 15 35 44 43 32 12 03,29 21"),
    ('%', 4, "02 48,08 18 17 07 08,33 43 42 32 33"),
    ('&', 4, "42 06 07 18 27 26 04 03 12 22 44"),
    ('\'', 0, "07 08"),
    ('(', 1, "18 06 04 12"),
    (')', 1, "08 16 14 02"),
    ('*', 4, "23 27,04 46,06 44"),
    ('+', 4, "05 45,27 23"),
    (',', 1, "13 01"),
    ('-', 2, "05 25"),
    ('.', 0, "02 03"),
    ('/', 3, "02 38"),
    ('0', 4, "12 32 43 47 38 18 07 03 12"),
    ('1', 3, "07 18 12,02 22"),
    ('2', 4, "07 18 38 47 46 02 42"),
    ('3', 4, "07 18 38 47 46 35 15,35 44 43 32 12 03"),
    ('4', 4, "32 38 04 44"),
    ('5', 4, "48 08 05 35 44 43 32 12 03"),
    ('6', 4, "47 38 18 07 03 12 32 43 44 35 15 04"),
    ('7', 4, "08 48 12"),
    ('8', 4, "15 06 07 18 38 47 46 35 15 04 03 12 32 43 44 35"),
    ('9', 4, "03 12 32 43 47 38 18 07 06 15 35 46"),
    (':', 0, "02 03,05 06"),
    (';', 1, "13 01,15 16"),
    ('<', 3, "37 05 33"),
    ('=', 4, "06 46,04 44"),
    ('>', 3, "07 35 03"),
    ('?', 3, "07 18 28 37 36 24,22 23"),
    ('@', 4, "34 25 14 23 34 45 47 38 18 07 03 12 42"),
    ('A', 4, "02 06 28 46 42,04 44"),
    ('B', 4, "02 08 38 47 46 35 05,35 44 43 32 02"),
    ('C', 4, "47 38 18 07 03 12 32 43"),
    ('D', 4, "02 08 28 46 44 22 02"),
    ('E', 4, "48 08 02 42,05 35"),
    ('F', 4, "48 08 02,05 35"),
    ('G', 4, "47 38 18 07 03 12 32 43 45 25"),
    ('H', 4, "02 08,42 48,05 45"),
    ('I', 2, "12 18,02 22,08 28"),
    ('J', 4, "48 43 32 12 03"),
    ('K', 4, "02 08,48 05 42"),
    ('L', 4, "08 02 42"),
    ('M', 4, "02 08 25 48 42"),
    ('N', 4, "02 08 42 48"),
    ('O', 4, "12 32 43 47 38 18 07 03 12"),
    ('P', 4, "02 08 38 47 46 35 05"),
    ('Q', 4, "12 32 43 47 38 18 07 03 12,24 42"),
    ('R', 4, "02 08 38 47 46 35 05,25 42"),
    ('S', 4, "47 38 18 07 06 15 35 44 43 32 12 03"),
    ('T', 4, "08 48,28 22"),
    ('U', 4, "08 03 12 32 43 48"),
    ('V', 4, "08 22 48"),
    ('W', 4, "08 12 26 32 48"),
    ('X', 4, "02 48,08 42"),
    ('Y', 4, "08 25 48,25 22"),
    ('Z', 4, "08 48 02 42"),
    ('[', 1, "18 08 02 12"),
    ('\\', 3, "08 32"),
    (']', 1, "08 18 12 02"),
    ('^', 4, "06 28 46"),
    ('_', 4, "01 41"),
    ('`', 1, "08 17"),
    ('a', 3, "36 32,35 26 16 05 03 12 22 33"),
    ('b', 3, "08 02,05 16 26 35 33 22 12 03"),
    ('c', 3, "35 26 16 05 03 12 22 33"),
    ('d', 3, "38 32,35 26 16 05 03 12 22 33"),
    ('e', 3, "04 34 35 26 16 05 03 12 32"),
    ('f', 3, "38 28 17 12,06 26"),
    ('g', 3, "36 31 20 10 01,35 26 16 05 03 12 22 33"),
    ('h', 3, "08 02,05 16 26 35 32"),
    ('i', 0, "02 06,07 08"),
    ('j', 1, "16 11 00,17 18"),
    ('k', 3, "08 02,36 04 32"),
    ('l', 1, "08 03 12"),
    ('m', 4, "02 06,05 16 25 22,25 36 45 42"),
    ('n', 3, "02 06,05 16 26 35 32"),
    ('o', 3, "12 22 33 35 26 16 05 03 12"),
    ('p', 3, "06 00,05 16 26 35 33 22 12 03"),
    ('q', 3, "36 30,35 26 16 05 03 12 22 33"),
    ('r', 2, "02 06,05 16 26"),
    ('s', 3, "35 26 16 05 14 24 33 22 12 03"),
    ('t', 2, "18 13 22,06 26"),
    ('u', 3, "06 03 12 22 33,36 32"),
    ('v', 4, "06 22 46"),
    ('w', 4, "06 12 25 32 46"),
    ('x', 3, "02 36,06 32"),
    ('y', 4, "06 22,46 10"),
    ('z', 3, "06 36 02 32"),
    ('{', 2, "28 17 16 05 14 13 22"),
    ('|', 0, "00 08"),
    ('}', 2, "08 17 16 25 14 13 02"),
    ('~', 4, "04 15 34 45"),
    ('×', 3, "03 36,06 33"),
    ('ß', 3, "02 07 18 28 37 36 25 34 33 22 12"),
    ('–', 4, "05 45"),
    ('—', 8, "05 85"),
    ('−', 4, "05 45"),
    ('±', 4, "06 46,28 24,03 43"),
    ('÷', 4, "05 45,26 27,23 24"),
    ('°', 2, "06 17 28 06"),
    ('¹', 1, "07 18 15"),
    ('²', 2, "07 18 27 26 05 25"),
    ('³', 2, "08 28 17 26 15 05"),
    ('µ', 3, "06 01,03 12 22 33,36 32"),
    ('·', 0, "04 05"),
    ('•', 1, "04 05 15 14 04"),
    ('…', 6, "02 03,32 33,62 63"),
    ('‘', 1, "08 17"),
    ('’', 1, "18 07"),
    ('‚', 1, "13 01"),
    ('“', 3, "08 17,28 37"),
    ('”', 3, "18 07,38 27"),
    ('„', 3, "13 01,33 21"),
    ('‹', 2, "26 04 22"),
    ('›', 2, "06 24 02"),
    ('«', 4, "26 04 22,46 24 42"),
    ('»', 4, "06 24 02,26 44 22"),
    ('¡', 0, "00 04,05 06"),
    ('¿', 3, "31 20 10 01 02 14,16 15"),
    ('€', 4, "47 38 28 17 13 22 32 43,06 26,04 24"),
    ('£', 4, "47 38 28 17 13 02 42,05 25"),
    ('¥', 4, "08 25 48,25 22,15 35,13 33"),
    ('¢', 3, "35 26 16 05 03 12 22 33,11 27"),
    ('©', 6, "12 52 63 67 58 18 07 03 12,46 37 27 16 14 23 33 44"),
    ('№', 7, "02 08 42 48,57 68 77 66 57,55 75"),
    ('Æ', 6, "02 06 28 68,38 32 62,35 55,04 34"),
    ('æ', 6, "35 26 16 05 03 12 22 33,34 64 65 56 46 35 33 42 62"),
    ('Œ', 6, "38 18 07 03 12 32,68 38 32 62,35 55"),
    (
        'œ',
        6,
        "33 35 26 16 05 03 12 22 33,34 64 65 56 46 35 33 42 62",
    ),
    ('Ø', 4, "12 32 43 47 38 18 07 03 12,02 48"),
    ('ø', 3, "12 22 33 35 26 16 05 03 12,02 36"),
    ('Ł', 4, "08 02 42,04 26"),
    ('ł', 2, "18 13 22,04 26"),
    ('Đ', 5, "12 18 38 56 54 32 12,05 35"),
    ('đ', 4, "38 32,35 26 16 05 03 12 22 33,27 47"),
    ('Ð', 5, "12 18 38 56 54 32 12,05 35"),
    ('ð', 3, "12 22 33 35 26 16 05 03 12,35 28,17 37"),
    ('Þ', 4, "02 08,07 37 46 45 34 04"),
    ('þ', 3, "08 00,05 16 26 35 33 22 12 03"),
    ('ı', 0, "02 06"),
    ('ď', 5, "38 32,35 26 16 05 03 12 22 33,58 47"),
    ('ľ', 2, "08 03 12,28 17"),
    ('Ľ', 4, "08 02 42,38 27"),
    ('ť', 4, "18 13 22,06 26,48 37"),
    ('\u{a0}', 2, ""),
    ('\u{202f}', 1, ""),
];

/// Letters that are others with a mark above or below.
const MARKED: &[(&str, &str, char)] = &[
    ("ÄËÏÖÜŸäëïöüÿ", "AEIOUYaeiouy", '¨'),
    ("ÁÉÍÓÚÝĆĹŃŔŚŹáéíóúýćńŕśź", "AEIOUYCLNRSZaeiouycnrsz", '´'),
    ("ŐŰőű", "OUou", '˝'),
    ("ÀÈÌÒÙàèìòù", "AEIOUaeiou", '`'),
    ("ÂÊÎÔÛâêîôû", "AEIOUaeiou", '^'),
    ("ÃÑÕãñõ", "ANOano", '~'),
    ("ÅŮåů", "AUau", '°'),
    ("ĀĒĪŌŪāēīōū", "AEIOUaeiou", '¯'),
    ("ĂĞŬăğŭ", "AGUagu", '˘'),
    ("ĊĖĠİŻċėġż", "CEGIZcegz", '˙'),
    ("ČĎĚŇŘŠŤŽčěňřšž", "CDENRSTZcenrsz", 'ˇ'),
    ("ÇĶĻŅŞŢȘȚçķļņşţșț", "CKLNSTSTcklnstst", '¸'),
    ("ĄĘĮŲąęįų", "AEIUaeiu", '˛'),
];

/// Marks about the middle of a letter, above small letters.
const MARKS: &[(char, &str)] = &[
    ('¨', "07 08,27 28"),
    ('´', "17 28"),
    ('`', "08 17"),
    ('^', "07 18 27"),
    ('~', "07 18 27 38"),
    ('°', "07 18 27 16 07"),
    ('ˇ', "08 17 28"),
    ('˝', "07 18,27 38"),
    ('¯', "07 27"),
    ('˘', "08 07 27 28"),
    ('˙', "17 18"),
    ('¸', "12 11 00"),
    ('˛', "12 11 20"),
];

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
        let is_below = matches!(mark, '¸' | '˛');
        // The dot of an i makes room.
        if base == 'i' && !is_below {
            strokes.truncate(1);
        }
        let (_, drawn) = MARKS.iter().find(|m| m.0 == *mark).ok_or(NoLetter(c))?;
        let raised = if base.is_uppercase() && !is_below {
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
        let drawn = GLYPHS.iter().map(|glyph| glyph.0);
        for c in (' '..='~').chain(drawn).chain(marked) {
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
    fn no_two_letters_look_the_same_but_zero_and_o() {
        let mut seen: Vec<(char, Vec<Vec<Point>>)> = Vec::new();
        for c in '!'..='~' {
            let (_, strokes) = glyph(c).unwrap();
            let same = seen.iter().find(|(_, other)| *other == strokes);
            assert!(same.is_none() || c == 'O', "{c} looks like {same:?}");
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
