//! Letters as areas and as lines: set in lines, aligned, fitted, led along a curve, held together as stencils. What letters
//! look like is known to fonts and to the engraving letters.

use std::sync::Arc;

use super::exemplar::magnification;
use super::placement::maps;
use super::stencil::stencilled;
use super::tolerance::{default_tolerance, fine_in_plane};
use fretwork_action::{Action, Data, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::polygon::{AreaError, fill};
use fretwork_geometry::{
    Affine, Bounds, CurveLabels, Curves, FillRule, Point, Polygon, Ring, letters,
};
use fretwork_language::kinds::texts::{Align, Anchor, LetterSide, Letters, Setting};
use fretwork_language::scalar::Extent;
use fretwork_source::font::{self, FontError, Glyph, Line, Typeset};

use super::baseline::Baseline;
use super::lettering::{Placed, letter_at, overlapping};

type Failed = Vec<Diagnostic>;

/// The area of letters before it is put in its place, and warnings about it.
///
/// # Errors
/// When the font lacks a letter, the text is longer than its curve, or a stencil does not hold.
pub fn area(action: &Action, kind: &Letters) -> Result<(Vec<Polygon>, Failed), Failed> {
    let setting = &kind.setting;
    let magnified = magnification(setting.placement.scale.0);
    let fine = fine_in_plane(&action.definition, action.definition.units);
    let tolerance = default_tolerance(setting.size.0, 1e-3, fine / magnified);
    let set = match &kind.font {
        Some(file) => {
            let (_, font) = action.file(&file.0)?;
            font::set(&font, &setting.content.0, setting.size.0, tolerance)
                .map_err(|e| unset(action, &e))?
        }
        None => engraving(action, setting)?.widened(letters::WEIGHT * setting.size.0, tolerance),
    };
    let letters = laid(action, setting, &set)?;
    let rings: Vec<Ring> = letters.iter().flat_map(|l| l.rings.clone()).collect();
    let told = |e: AreaError| failed(action, &e.to_string());
    let area = fill(&rings, FillRule::NonZero).map_err(told)?;
    let warning = match &setting.on {
        Some(on) => overlapping(action, &on.name, &letters, setting.size.0).map_err(told)?,
        None => None,
    };
    let warnings = Vec::from_iter(warning);
    let Some(stencil) = &kind.stencil else {
        return Ok((area, warnings));
    };
    let at = || action.definition.field(&["text", "stencil"]);
    let made = stencilled(&area, stencil.width.0).map_err(|e| {
        let letter = e.at().and_then(|at| letter_at(&letters, at));
        let letter = letter.map_or(String::new(), |letter| format!("`{letter}`: "));
        let error = Diagnostic::error(format!("{letter}{e}")).at(at(), "does not hold");
        vec![e.help().into_iter().fold(error, Diagnostic::help)]
    })?;
    Ok((made, warnings))
}

/// What a font cannot do, at the text where a letter is the reason, else at the font.
fn unset(action: &Action, error: &FontError) -> Failed {
    let (field, here) = match error {
        FontError::NoLetter(_) | FontError::TooLong(_) => ("content", "in this text"),
        FontError::NotAFont | FontError::Woff(_) | FontError::Damaged(_) => ("font", "this font"),
    };
    let at = action.definition.field(&["text", field]);
    vec![Diagnostic::error(error.to_string()).at(at, here)]
}

/// Letters of single lines.
///
/// # Errors
/// A letter that there is not, a text longer than its curve.
pub fn lines(action: &Action, kind: &Setting) -> StageResult {
    let set = engraving(action, kind)?;
    let mut once = Curves::new();
    let letters = laid(action, kind, &set)?.into_iter();
    for stroke in letters.flat_map(|letter| letter.rings) {
        once.push(stroke, CurveLabels::default());
    }
    let mut curves = Curves::new();
    for map in maps(&kind.placement) {
        curves.append(&once.transformed(&map));
    }
    Ok((Data::Curves(Arc::new(curves)), Vec::new()))
}

/// The text in engraving letters, their strokes as lines.
fn engraving(action: &Action, setting: &Setting) -> Result<Typeset, Failed> {
    let size = setting.size.0;
    let line = |text: &str| -> Result<Line, letters::NoLetter> {
        let letters = letters::line(text, size)?;
        let glyph = |letter: &letters::Letter| Glyph {
            at: Point::new(letter.at, 0.0),
            advance: letter.width,
            rings: letter.strokes.clone(),
        };
        Ok(Line {
            width: letters.last().map_or(0.0, |last| last.at + last.width),
            glyphs: letters.iter().map(glyph).collect(),
        })
    };
    let lines: Result<Vec<Line>, _> = setting.content.0.lines().map(line).collect();
    let lines = lines.map_err(|e| {
        let help = "name a font that has it with `font`";
        let at = action.definition.field(&["text", "content"]);
        vec![
            Diagnostic::error(e.to_string())
                .at(at, "in this text")
                .help(help),
        ]
    })?;
    Ok(Typeset {
        lines,
        leading: letters::LEADING * size,
    })
}

/// The letters where they stand, before the placement of the whole.
fn laid(action: &Action, setting: &Setting, set: &Typeset) -> Result<Vec<Placed>, Failed> {
    let set = spaced(set, setting);
    let leading = set.leading * setting.leading.0;
    let down = raised(setting, &set, leading);
    let baseline = baseline(action, setting, &set)?;
    // Letters stay upright where y goes north.
    let up = match action.definition.map {
        Some(_) => Affine::scale(1.0, -1.0),
        None => Affine::IDENTITY,
    };
    let mut letters = Vec::new();
    let texts = setting.content.0.lines();
    for ((line, text), number) in set.lines.iter().zip(texts).zip(0..) {
        let down = down + leading * f64::from(number);
        // Where a shape stands for several letters none of them is named.
        let is_each = text.chars().count() == line.glyphs.len();
        let mut chars = text.chars().filter(|_| is_each);
        for glyph in &line.glyphs {
            let middle = glyph.at.x + 0.5 * glyph.advance;
            // About the middle of its foot, which comes to its place on the baseline.
            let own = Affine::translation(Point::new(-0.5 * glyph.advance, glyph.at.y + down));
            let place = match &baseline {
                None => Affine::translation(Point::new(middle + aligned(setting, line), 0.0)),
                Some(curve) => curve.place(middle + aligned(setting, line), glyph.advance),
            };
            let map = own.then(place).then(up);
            let moved = |ring: &Ring| ring.iter().map(|p| map.apply(*p)).collect();
            letters.push(Placed {
                letter: chars.next(),
                rings: glyph.rings.iter().map(moved).collect(),
            });
        }
    }
    Ok(letters)
}

/// The lines with blanks between letters, as wide as they are to be.
fn spaced(set: &Typeset, setting: &Setting) -> Typeset {
    let mut set = set.clone();
    for line in &mut set.lines {
        for (glyph, number) in line.glyphs.iter_mut().zip(0..) {
            glyph.at.x += setting.letter_spacing.0 * f64::from(number);
        }
        let gaps = line.glyphs.len().saturating_sub(1) as f64;
        line.width += setting.letter_spacing.0 * gaps;
    }
    let width = |line: &Line| {
        let [from, to] = inked(line);
        to - from
    };
    let widest = set.lines.iter().map(width).fold(0.0, f64::max);
    match setting.fit {
        Some(fit) if widest > 0.0 => set.scaled(fit.0 / widest),
        _ => set,
    }
}

/// How far all lines are moved down so that the anchor comes to the baseline of the first.
fn raised(setting: &Setting, set: &Typeset, leading: f64) -> f64 {
    let mut bounds = Bounds::EMPTY;
    for (line, number) in set.lines.iter().zip(0..) {
        let down = leading * f64::from(number);
        let points = line.glyphs.iter().flat_map(|glyph| {
            let own = glyph.rings.iter().flatten();
            own.map(move |p| Point::new(p.x, p.y + glyph.at.y + down))
        });
        bounds = bounds.union(Bounds::of(points));
    }
    if bounds.is_empty() {
        return 0.0;
    }
    match setting.anchor {
        Anchor::Baseline => 0.0,
        Anchor::Top => -bounds.min.y,
        Anchor::Middle => -bounds.center().y,
        Anchor::Bottom => -bounds.max.y,
    }
}

/// The curve that the text runs along, if it does.
fn baseline(action: &Action, setting: &Setting, set: &Typeset) -> Result<Option<Baseline>, Failed> {
    let Some(on) = &setting.on else {
        return Ok(None);
    };
    let curve = action.input(on);
    let is_against = setting.side == LetterSide::Right;
    let at = match setting.start {
        Some(Extent::Fraction(part)) => part * curve.length(),
        Some(Extent::Length(length)) => length,
        None => {
            let part = match setting.align {
                Align::Start => 0.0,
                Align::Middle => 0.5,
                Align::End => 1.0,
            };
            curve.length() * if is_against { 1.0 - part } else { part }
        }
    };
    if at > curve.length() * (1.0 + 1e-9) {
        let message = format!(
            "the text starts at {}, and its curve `{}` is {} long",
            rounded(at),
            on.name,
            rounded(curve.length())
        );
        let place = action.definition.field(&["text", "start"]);
        return Err(vec![Diagnostic::error(message).at(place, "beyond its end")]);
    }
    let Some(baseline) = Baseline::new(&curve, at, is_against) else {
        return Err(failed(
            action,
            &format!("`{}` does not lie in a level plane", on.name),
        ));
    };
    let told = set.lines.iter().find_map(|line| {
        let ends = inked(line).map(|end| end + aligned(setting, line));
        let over = baseline.over(ends)?;
        Some(too_long(&on.name, curve.length(), ends[1] - ends[0], over))
    });
    match told {
        None => Ok(Some(baseline)),
        Some(message) => Err(vec![Diagnostic::error(message)
            .at(action.span(), "in this text")
            .help("`size`, `fit` and `letter_spacing` decide how long it is, `start` where it stands")]),
    }
}

/// What is wrong with a line of text that is `wide` on a curve of a length, and ends `over` beyond it.
fn too_long(curve: &str, length: f64, wide: f64, over: f64) -> String {
    if wide > length {
        let (length, width) = (rounded(length), rounded(wide));
        format!("the text is {width} long, and its curve `{curve}` {length}")
    } else {
        let over = rounded(over);
        format!("the text goes beyond its curve `{curve}` by {over}")
    }
}

/// How far a line is moved to the right: what is drawn of it ends or has its middle at the anchor. It begins there with its
/// first letter's own blank, unless it is to be so wide exactly. On a curve nothing of a letter stands before the anchor,
/// which may be where the curve begins.
fn aligned(setting: &Setting, line: &Line) -> f64 {
    let [from, to] = inked(line);
    match setting.align {
        Align::Start if setting.fit.is_some() => -from,
        Align::Start if setting.on.is_some() => (-from).max(0.0),
        Align::Start => 0.0,
        Align::Middle => -0.5 * (from + to),
        Align::End => -to,
    }
}

/// From where to where a line is drawn; what it advances by where nothing is drawn.
fn inked(line: &Line) -> [f64; 2] {
    let points = line.glyphs.iter().flat_map(|glyph| {
        let own = glyph.rings.iter().flatten();
        own.map(move |p| glyph.at.x + p.x)
    });
    let (from, to) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
        (l.min(x), h.max(x))
    });
    if from <= to {
        [from, to]
    } else {
        [0.0, line.width]
    }
}

fn failed(action: &Action, message: &str) -> Failed {
    vec![Diagnostic::error(message.to_owned()).at(action.span(), "in this text")]
}

/// A length for people, to three digits after the point.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}
