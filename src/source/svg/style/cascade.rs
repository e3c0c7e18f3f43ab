//! What is said of an element, weakest first, and what it sets.

use std::borrow::Cow;

use roxmltree::Node;

use super::paint::paint;
use super::{Own, Paint, ReferenceBox, Style, opacity, reference};
use crate::svg::length::{Axis, Basis, FONT_SIZE, Length};
use crate::svg::sheet::{self, Declaration, Sheet};
use fretwork_geometry::FillRule;
use fretwork_geometry::drawing::Cap;

/// The properties that are attributes too, in order.
const ATTRIBUTES: [&str; 25] = [
    "clip-path",
    "color",
    "display",
    "fill",
    "fill-opacity",
    "fill-rule",
    "filter",
    "font-size",
    "marker-end",
    "marker-mid",
    "marker-start",
    "mask",
    "opacity",
    "overflow",
    "stroke",
    "stroke-dasharray",
    "stroke-linecap",
    "stroke-linejoin",
    "stroke-miterlimit",
    "stroke-opacity",
    "stroke-width",
    "transform-box",
    "transform-origin",
    "vector-effect",
    "visibility",
];

/// The places and sizes that are properties.
const GEOMETRY: [&str; 10] = [
    "cx", "cy", "d", "height", "r", "rx", "ry", "width", "x", "y",
];

/// Properties that move or change what is seen, and are not read.
const UNREAD: [&str; 4] = ["offset-path", "rotate", "scale", "translate"];

/// The style of the element `node`, given its parent's and what lengths are taken of there. `bad` is
/// told of values that are not understood, which are then as if not said.
pub fn cascade<'a>(
    parent: &Style<'a>,
    node: Node<'a, '_>,
    sheet: &'a Sheet,
    basis: &Basis,
    bad: &mut dyn FnMut(&str, &str),
) -> (Style<'a>, Own<'a>) {
    let said = said(node, sheet);
    let (mut style, mut own) = (*parent, Own::default());
    // Other lengths may be so many times the height of the letters.
    for (name, value, _) in said.iter().filter(|(name, ..)| is_of_letters(name)) {
        match font_size(name, value, basis) {
            Some(size) => style.font_size = size,
            None => bad(name, value),
        }
    }
    let basis = Basis {
        font_size: style.font_size,
        ..*basis
    };
    for (name, value, is_css) in &said {
        let mut cascade = Cascade {
            style: &mut style,
            own: &mut own,
            basis: &basis,
            is_css: *is_css,
        };
        if cascade.apply(name, value).is_none() {
            bad(name, value);
        }
    }
    (style, own)
}

/// Names, values, and whether they are CSS.
type Said<'a> = Vec<(Cow<'a, str>, &'a str, bool)>;

/// All that is said of an element, weakest first.
fn said<'a>(node: Node<'a, '_>, sheet: &'a Sheet) -> Said<'a> {
    let attributes = node
        .attributes()
        .filter(|a| a.namespace().is_none() && ATTRIBUTES.binary_search(&a.name()).is_ok());
    let mut said: Said = attributes
        .map(|a| (Cow::Borrowed(a.name()), a.value().trim(), false))
        .collect();
    let mut css: Vec<Declaration> = sheet.declarations(node).collect();
    css.extend(sheet::declarations(node.attribute("style").unwrap_or("")));
    let (strong, weak): (Vec<_>, Vec<_>) = css.into_iter().partition(|d| d.important);
    let all = weak.into_iter().chain(strong);
    said.extend(all.map(|d| (d.name, d.value, true)));
    said.retain(|(_, value, _)| !value.eq_ignore_ascii_case("inherit"));
    said
}

fn is_of_letters(name: &str) -> bool {
    matches!(name, "font" | "font-size")
}

/// The height of letters that `font-size` or `font` says.
fn font_size(name: &str, value: &str, basis: &Basis) -> Option<f64> {
    let whole = basis.font_size;
    let size = |text: &str| match &*text.to_ascii_lowercase() {
        "xx-small" => Some(9.0),
        "x-small" => Some(10.0),
        "small" => Some(13.0),
        "medium" => Some(FONT_SIZE),
        "large" => Some(18.0),
        "x-large" => Some(24.0),
        "xx-large" => Some(32.0),
        "xxx-large" => Some(48.0),
        "larger" => Some(1.2 * whole),
        "smaller" => Some(whole / 1.2),
        text => text.parse::<Length>().ok().map(|l| l.font_size(basis)),
    };
    if name == "font-size" {
        return size(value).filter(|size| *size >= 0.0);
    }
    // In `italic 700 10px/1.2 Arial` the first length with a unit is the size.
    let words = value.split_whitespace().map(|word| {
        let end = word.find('/').unwrap_or(word.len());
        &word[..end]
    });
    let has_unit = |word: &&str| !word.ends_with(|c: char| c.is_ascii_digit());
    Some(words.filter(has_unit).find_map(size).unwrap_or(whole))
}

/// What properties set.
struct Cascade<'s, 'a> {
    style: &'s mut Style<'a>,
    own: &'s mut Own<'a>,
    basis: &'s Basis,
    is_css: bool,
}

impl<'a> Cascade<'_, 'a> {
    /// Sets the property; none when the value is not understood.
    fn apply(&mut self, name: &str, value: &'a str) -> Option<()> {
        let is = |word: &str| value.eq_ignore_ascii_case(word);
        let (style, own) = (&mut *self.style, &mut *self.own);
        match name {
            "fill" => style.fill = paint(value)?,
            "stroke" => style.stroke = paint(value)?,
            "color" => match paint(value)? {
                Paint::Current => {}
                color => style.color = color,
            },
            "fill-opacity" => style.fill_opacity = opacity(value)?,
            "stroke-opacity" => style.stroke_opacity = opacity(value)?,
            "fill-rule" if is("evenodd") => style.rule = FillRule::EvenOdd,
            "fill-rule" if is("nonzero") => style.rule = FillRule::NonZero,
            "fill-rule" => return None,
            "visibility" => style.visible = !(is("hidden") || is("collapse")),
            "marker" => style.markers = [reference(value); 3],
            "marker-start" => style.markers[0] = reference(value),
            "marker-mid" => style.markers[1] = reference(value),
            "marker-end" => style.markers[2] = reference(value),
            "display" => own.undisplayed = is("none"),
            "opacity" => own.transparency = 1.0 - opacity(value)?,
            "overflow" => own.overflows = Some(is("visible") || is("auto")),
            "vector-effect" => own.fixed_stroke = value.contains("non-scaling-stroke"),
            "clip-path" => own.clip = Some(value).filter(|_| !is("none")),
            "mask" | "mask-image" => own.mask = Some(value).filter(|_| !is("none")),
            "filter" if !is("none") => own.unread.push("a filter"),
            "transform" if self.is_css && !is("none") => own.transform = Some(value),
            "transform-origin" => own.origin = Some(value),
            "transform-box" => {
                own.reference = match &*value.to_ascii_lowercase() {
                    "view-box" => ReferenceBox::View,
                    "fill-box" | "content-box" => ReferenceBox::Fill,
                    "stroke-box" | "border-box" => ReferenceBox::Stroke,
                    _ => return None,
                }
            }
            _ if name.starts_with("stroke-") => return self.line(name, value),
            _ if self.is_css => return self.place(name, value),
            _ => {}
        }
        Some(())
    }

    /// Sets a property of strokes.
    fn line(&mut self, name: &str, value: &str) -> Option<()> {
        let style = &mut *self.style;
        match name {
            "stroke-width" => {
                let width = value
                    .parse::<Length>()
                    .ok()?
                    .user(Axis::Diagonal, self.basis);
                style.width = Some(width).filter(|w| *w >= 0.0)?;
            }
            "stroke-linecap" => {
                style.cap = match &*value.to_ascii_lowercase() {
                    "butt" => Cap::Butt,
                    "round" => Cap::Round,
                    "square" => Cap::Square,
                    _ => return None,
                }
            }
            "stroke-linejoin" => {
                style.round_join = value.eq_ignore_ascii_case("round");
                style.miter = matches!(value, "miter" | "miter-clip" | "arcs");
            }
            "stroke-miterlimit" => {
                let limit = value.parse::<svgtypes::Number>().ok().map(|n| n.0);
                style.miter_limit = limit.filter(|n| *n >= 1.0)?;
            }
            "stroke-dasharray" => {
                style.dashed = value != "none" && value.contains(|c: char| matches!(c, '1'..='9'))
            }
            _ => {}
        }
        Some(())
    }

    /// Notes a place or size that the style says. In CSS lengths other than zero need a unit.
    fn place(&mut self, name: &str, value: &'a str) -> Option<()> {
        if let Some(known) = UNREAD.iter().find(|known| **known == name) {
            if !value.eq_ignore_ascii_case("none") {
                self.own.unread.push(known);
            }
        } else if let Ok(i) = GEOMETRY.binary_search(&name) {
            let number = value.parse::<svgtypes::Number>();
            if name != "d" && number.is_ok_and(|n| n.0 != 0.0) {
                return None;
            }
            self.own.geometry.push((GEOMETRY[i], value));
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::{ATTRIBUTES, GEOMETRY};

    #[test]
    fn the_names_can_be_searched() {
        assert!(ATTRIBUTES.is_sorted() && GEOMETRY.is_sorted());
    }
}
