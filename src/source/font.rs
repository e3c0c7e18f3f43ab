//! Letters of fonts: text shaped with a TrueType or OpenType font, its outlines flattened, letter by letter. Which
//! lines a text is broken into is for whoever writes it, and so is where letters stand; hinting and colour are left out.

use harfrust::font::glyph::outline::{DrawMemory, DrawOptions, PathSink};
use harfrust::{Buffer, Font, GlyphId, ShapeOptions, ShaperFont};

use super::woff::{WoffError, is_woff, unpacked};
use fretwork_geometry::drawing::Stroke;
use fretwork_geometry::polygon::stroke_outlines;
use fretwork_geometry::{Point, Ring, flatten};

/// The longest text, in characters.
const LONGEST: usize = 10_000;

/// Why a text has no outlines.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FontError {
    /// The bytes are no font with outlines.
    #[error("this is no TrueType, OpenType or WOFF font with outlines")]
    NotAFont,
    /// The font lacks a letter of the text.
    #[error("the font has no letter `{0}` (U+{code:04X})", code = u32::from(*.0))]
    NoLetter(char),
    /// A packed font that cannot be unpacked.
    #[error(transparent)]
    Woff(#[from] WoffError),
    /// The text is longer than anybody writes.
    #[error("the text has {0} characters, more than {LONGEST}")]
    TooLong(usize),
    /// The outline of a letter is damaged.
    #[error("the outline of a letter is damaged: {0}")]
    Damaged(String),
}

/// Text set in lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Typeset {
    /// The lines.
    pub lines: Vec<Line>,
    /// From one baseline to the next.
    pub leading: f64,
}

/// A line of letters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// The letters, from left to right.
    pub glyphs: Vec<Glyph>,
    /// How far they advance together.
    pub width: f64,
}

/// A letter, or several that are drawn as one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Glyph {
    /// Where its foot begins on the line.
    pub at: Point,
    /// How far the next one is.
    pub advance: f64,
    /// Its outlines about the beginning of its foot, upward toward −y as in a drawing; or its strokes.
    pub rings: Vec<Ring>,
}

impl Typeset {
    /// All of it so many times as large.
    pub fn scaled(mut self, factor: f64) -> Typeset {
        self.leading *= factor;
        for line in &mut self.lines {
            line.width *= factor;
            for glyph in &mut line.glyphs {
                glyph.at = glyph.at * factor;
                glyph.advance *= factor;
                let points = glyph.rings.iter_mut().flatten();
                points.for_each(|p| *p = *p * factor);
            }
        }
        self
    }

    /// Its strokes as outlines of this width, with round ends. Lines begin and end with half a stroke.
    pub fn widened(mut self, width: f64, tolerance: f64) -> Typeset {
        for line in &mut self.lines {
            line.width += width;
        }
        for glyph in self.lines.iter_mut().flat_map(|line| &mut line.glyphs) {
            glyph.at.x += 0.5 * width;
            let strokes = std::mem::take(&mut glyph.rings);
            for stroke in strokes {
                stroke_outlines(&stroke, &Stroke::round(width), tolerance, &mut glyph.rings);
            }
        }
        self
    }
}

/// `text` in `font` (TrueType, OpenType, or one of these packed as WOFF), with its ligatures and kerning, lines by the font's own distance. `size` is the height of the em square;
/// curves are flattened to `tolerance`, both in the units of the result. Right-to-left text begins at its left
/// end too.
///
/// # Errors
/// [`FontError`]; white space alone has no outlines, which is no error here.
pub fn set(font: &[u8], text: &str, size: f64, tolerance: f64) -> Result<Typeset, FontError> {
    let count = text.chars().count();
    if count > LONGEST {
        return Err(FontError::TooLong(count));
    }
    let bytes = if is_woff(font) {
        unpacked(font)?
    } else {
        font.to_vec()
    };
    let font = Font::new(bytes, 0).ok_or(FontError::NotAFont)?;
    let line = font.metrics().h_line().ok_or(FontError::NotAFont)?;
    let scale = size / f64::from(font.units_per_em());
    let lines = text
        .lines()
        .map(|line| set_line(&font, line, scale, tolerance));
    Ok(Typeset {
        lines: lines.collect::<Result<_, _>>()?,
        leading: (line.ascender - line.descender + line.line_gap).to_f64() * scale,
    })
}

fn set_line(font: &Font, text: &str, scale: f64, tolerance: f64) -> Result<Line, FontError> {
    let mut buffer = Buffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    harfrust::shape(&ShaperFont::new(font), &mut buffer, ShapeOptions::default())
        .map_err(|error| FontError::Damaged(error.to_string()))?;
    let outlines = font.outline_glyphs();
    let (mut x, mut y) = (0.0, 0.0);
    let mut glyphs = Vec::new();
    for (info, position) in buffer.glyph_infos().iter().zip(buffer.glyph_positions()) {
        if info.glyph_id == 0 {
            let letter = text
                .get(info.cluster as usize..)
                .and_then(|rest| rest.chars().next());
            return Err(FontError::NoLetter(
                letter.unwrap_or(char::REPLACEMENT_CHARACTER),
            ));
        }
        let offset = Point::new(
            x + f64::from(position.x_offset),
            y + f64::from(position.y_offset),
        );
        let mut pen = Pen {
            scale,
            tolerance,
            at: Point::ORIGIN,
            open: Vec::new(),
            rings: Vec::new(),
        };
        if let Some(glyph) = outlines.get(GlyphId::new(info.glyph_id)) {
            glyph
                .draw(&DrawOptions::new(), DrawMemory::Scratch, &mut pen)
                .map_err(|error| FontError::Damaged(error.to_string()))?;
            pen.finish();
        }
        glyphs.push(Glyph {
            at: Point::new(offset.x * scale, -offset.y * scale),
            advance: f64::from(position.x_advance) * scale,
            rings: pen.rings,
        });
        (x, y) = (
            x + f64::from(position.x_advance),
            y + f64::from(position.y_advance),
        );
    }
    Ok(Line {
        glyphs,
        width: x * scale,
    })
}

/// Takes outlines in font units and flattens them in the drawing plane.
struct Pen {
    scale: f64,
    tolerance: f64,
    at: Point,
    open: Vec<Point>,
    rings: Vec<Ring>,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> Point {
        Point::new(f64::from(x) * self.scale, -f64::from(y) * self.scale)
    }

    fn finish(&mut self) {
        let mut ring = std::mem::take(&mut self.open);
        if ring.first() == ring.last() {
            ring.pop();
        }
        if ring.len() > 2 {
            self.rings.push(ring);
        }
    }
}

impl PathSink for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.finish();
        self.at = self.place(x, y);
        self.open.push(self.at);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.at = self.place(x, y);
        self.open.push(self.at);
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        let (from, to) = (self.at, self.place(x, y));
        flatten::quadratic(
            [from, self.place(cx0, cy0), to],
            self.tolerance,
            &mut self.open,
        );
        self.at = to;
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let (from, to) = (self.at, self.place(x, y));
        let control = [from, self.place(cx0, cy0), self.place(cx1, cy1), to];
        flatten::cubic(control, self.tolerance, &mut self.open);
        self.at = to;
    }

    fn close(&mut self) {
        self.finish();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::polygon::fill;
    use fretwork_geometry::{Bounds, FillRule, Polygon};

    /// The area of text whose lines begin above one another.
    fn outline(
        font: &[u8],
        text: &str,
        size: f64,
        tolerance: f64,
    ) -> Result<Vec<Polygon>, FontError> {
        let set = set(font, text, size, tolerance)?;
        let mut rings: Vec<Ring> = Vec::new();
        for (line, number) in set.lines.iter().zip(0..) {
            let down = Point::new(0.0, set.leading * f64::from(number));
            for glyph in &line.glyphs {
                let moved = |ring: &Ring| ring.iter().map(|p| *p + glyph.at + down).collect();
                rings.extend(glyph.rings.iter().map(moved));
            }
        }
        Ok(fill(&rings, FillRule::NonZero).expect("coordinates are finite"))
    }

    const FONT: &[u8] = include_bytes!("../../tests/drawings/fret.ttf");

    fn areas(text: &str) -> Vec<Polygon> {
        outline(FONT, text, 10.0, 0.01).expect("the font has these letters")
    }

    fn bounds(polygons: &[Polygon]) -> Bounds {
        polygons
            .iter()
            .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
    }

    #[test]
    fn letters_are_pieces_with_holes() {
        assert_eq!(
            areas("IO")
                .iter()
                .map(|p| p.holes.len())
                .collect::<Vec<_>>(),
            [0, 1]
        );
        assert_eq!(areas(" "), []);
        // Capitals are 0.7 em high and stand on the baseline, upward in a drawing.
        let b = bounds(&areas("I"));
        assert!(
            (b.min.y + 7.0).abs() < 0.02 && b.max.y.abs() < 0.02,
            "{b:?}"
        );
    }

    #[test]
    fn lines_follow_one_another() {
        let two = areas("I\nI");
        assert_eq!(two.len(), 2);
        let distance = (two[0].bounds().min.y - two[1].bounds().min.y).abs();
        assert!((distance - 12.0).abs() < 1e-9, "{distance}");
    }

    #[test]
    fn letters_are_kerned() {
        let width = |text| bounds(&areas(text)).width();
        assert!(width("AV") < width("VV") - 0.5);
    }

    #[test]
    fn curves_are_within_the_tolerance() {
        let rough = outline(FONT, "O", 10.0, 0.5).unwrap();
        let fine = outline(FONT, "O", 10.0, 0.001).unwrap();
        assert!(rough[0].outer.len() < fine[0].outer.len());
        assert!((rough[0].area() - fine[0].area()).abs() < 0.5 * 30.0);
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert_eq!(
            outline(FONT, "é", 10.0, 0.01),
            Err(FontError::NoLetter('é'))
        );
        assert_eq!(
            outline(b"no font", "I", 10.0, 0.01),
            Err(FontError::NotAFont)
        );
        let woff = outline(b"wOF2...", "I", 10.0, 0.01);
        assert!(matches!(woff, Err(FontError::Woff(_))), "{woff:?}");
        assert_eq!(
            outline(FONT, &"I".repeat(20_000), 10.0, 0.01),
            Err(FontError::TooLong(20_000))
        );
        for end in (0..FONT.len()).step_by(97) {
            // A truncated font is an error or has letters missing; it never breaks anything.
            let _ = outline(&FONT[..end], "IO", 10.0, 0.01);
        }
    }
}
