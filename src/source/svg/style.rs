//! What an element's attributes, rules and `style` make of it: whether it is seen, how it is
//! filled and stroked. Colours matter only as far as they are there or not.

use roxmltree::Node;
use svgtypes::Paint as Css;

use super::length::{Axis, Length};
use super::sheet::{self, Declaration, Sheet};
use fretwork_geometry::drawing::{Cap, Join, Stroke};
use fretwork_geometry::{FillRule, Point};

/// The inherited properties.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    fill: Paint,
    stroke: Paint,
    /// Whether `currentColor` is not transparent.
    color: bool,
    fill_opaque: bool,
    stroke_opaque: bool,
    /// What is inside a shape.
    pub rule: FillRule,
    width: f64,
    cap: Cap,
    miter: bool,
    miter_limit: f64,
    round_join: bool,
    visible: bool,
    /// Whether strokes are dashed.
    pub dashed: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Paint {
    None,
    Some,
    CurrentColor,
}

impl Default for Style {
    fn default() -> Style {
        Style {
            fill: Paint::Some,
            stroke: Paint::None,
            color: true,
            fill_opaque: true,
            stroke_opaque: true,
            rule: FillRule::NonZero,
            width: 1.0,
            cap: Cap::Butt,
            miter: true,
            miter_limit: 4.0,
            round_join: false,
            visible: true,
            dashed: false,
        }
    }
}

/// What concerns the element alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct Own<'a> {
    /// `display: none`.
    undisplayed: bool,
    /// An opacity of zero.
    transparent: bool,
    /// `clip-path`, when it has one.
    clip: bool,
    /// `mask`, when it has one.
    mask: bool,
    /// `vector-effect: non-scaling-stroke`.
    pub fixed_stroke: bool,
    /// The `transform` of its style, which wins over the attribute.
    pub transform: Option<&'a str>,
    /// `transform-origin`.
    pub origin: Option<&'a str>,
}

impl Own<'_> {
    /// Whether nothing in the element is seen.
    pub fn is_hidden(&self) -> bool {
        self.undisplayed || self.transparent
    }

    /// Whether parts of the element may be cut away.
    pub fn is_clipped(&self) -> bool {
        self.clip || self.mask
    }
}

/// The properties that are attributes too, in order.
const ATTRIBUTES: [&str; 18] = [
    "clip-path",
    "color",
    "display",
    "fill",
    "fill-opacity",
    "fill-rule",
    "mask",
    "opacity",
    "stroke",
    "stroke-dasharray",
    "stroke-linecap",
    "stroke-linejoin",
    "stroke-miterlimit",
    "stroke-opacity",
    "stroke-width",
    "transform-origin",
    "vector-effect",
    "visibility",
];

/// The style of the element `tag`, given its parent's, for a viewport of this size. `bad` is told
/// of values that are not understood, which are then as if not said.
pub fn cascade<'a>(
    parent: &Style,
    node: Node<'a, '_>,
    tag: &str,
    sheet: &'a Sheet,
    viewport: Point,
    bad: &mut dyn FnMut(&str, &str),
) -> (Style, Own<'a>) {
    let (mut style, mut own) = (*parent, Own::default());
    let mut apply = |name: &str, value: &'a str| {
        if value != "inherit" && apply(&mut style, &mut own, name, value, viewport).is_none() {
            bad(name, value);
        }
    };
    for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
        if ATTRIBUTES.binary_search(&attribute.name()).is_ok() {
            apply(attribute.name(), attribute.value().trim());
        }
    }
    let inline = || sheet::declarations(node.attribute("style").unwrap_or(""));
    let mut said = |all: &mut dyn Iterator<Item = Declaration<'a>>| {
        all.for_each(|d| apply(d.name, d.value));
    };
    let rules: Vec<Declaration> = sheet.declarations(node, tag).collect();
    said(&mut rules.iter().copied().filter(|d| !d.important));
    said(&mut inline().filter(|d| !d.important));
    said(&mut rules.iter().copied().filter(|d| d.important));
    said(&mut inline().filter(|d| d.important));
    (style, own)
}

impl Style {
    /// Whether a shape of this style is filled.
    pub fn filled(&self) -> bool {
        self.visible && self.fill_opaque && self.painted(self.fill)
    }

    /// How a shape of this style is stroked, if it is, where user units are `scale` spec units.
    pub fn stroked(&self, scale: f64) -> Option<Stroke> {
        let width = self.width * scale;
        let painted =
            self.visible && self.stroke_opaque && self.painted(self.stroke) && width > 0.0;
        let join = match (self.round_join, self.miter) {
            (true, _) => Join::Round,
            (false, true) => Join::Miter(self.miter_limit),
            (false, false) => Join::Bevel,
        };
        painted.then_some(Stroke {
            width,
            cap: self.cap,
            join,
        })
    }

    /// Whether `visibility` shows it.
    pub fn visible(&self) -> bool {
        self.visible
    }

    fn painted(&self, paint: Paint) -> bool {
        paint == Paint::Some || paint == Paint::CurrentColor && self.color
    }
}

/// Sets the property; none when the value is not understood.
fn apply<'a>(
    style: &mut Style,
    own: &mut Own<'a>,
    name: &str,
    value: &'a str,
    viewport: Point,
) -> Option<()> {
    match name {
        "display" => own.undisplayed = value == "none",
        "opacity" => own.transparent = opacity(value)? <= 0.0,
        "visibility" => style.visible = !matches!(value, "hidden" | "collapse"),
        "fill" => style.fill = paint(value)?,
        "stroke" => style.stroke = paint(value)?,
        "color" => style.color = paint(value)? != Paint::None,
        "fill-opacity" => style.fill_opaque = opacity(value)? > 0.0,
        "stroke-opacity" => style.stroke_opaque = opacity(value)? > 0.0,
        "fill-rule" if value == "evenodd" => style.rule = FillRule::EvenOdd,
        "fill-rule" if value == "nonzero" => style.rule = FillRule::NonZero,
        "fill-rule" => return None,
        "stroke-width" => {
            let width = value.parse::<Length>().ok()?.user(Axis::Diagonal, viewport);
            style.width = Some(width).filter(|w| *w >= 0.0)?;
        }
        "stroke-linecap" => {
            style.cap = match value {
                "butt" => Cap::Butt,
                "round" => Cap::Round,
                "square" => Cap::Square,
                _ => return None,
            }
        }
        "stroke-linejoin" => {
            style.round_join = value == "round";
            style.miter = matches!(value, "miter" | "miter-clip" | "arcs");
        }
        "stroke-miterlimit" => {
            style.miter_limit = value
                .parse::<svgtypes::Number>()
                .ok()
                .map(|n| n.0)
                .filter(|n| *n >= 1.0)?;
        }
        "stroke-dasharray" => {
            style.dashed = value != "none" && value.contains(|c: char| matches!(c, '1'..='9'))
        }
        "vector-effect" => own.fixed_stroke = value.contains("non-scaling-stroke"),
        "clip-path" => own.clip = value != "none",
        "mask" => own.mask = value != "none",
        "transform" if value != "none" => own.transform = Some(value),
        "transform-origin" => own.origin = Some(value),
        _ => {}
    }
    Some(())
}

fn paint(value: &str) -> Option<Paint> {
    let seen = |c: svgtypes::Color| {
        if c.alpha > 0 {
            Paint::Some
        } else {
            Paint::None
        }
    };
    if value.eq_ignore_ascii_case("transparent") {
        return Some(Paint::None);
    }
    Some(match Css::from_str(value) {
        Ok(Css::None) => Paint::None,
        Ok(Css::CurrentColor) => Paint::CurrentColor,
        Ok(Css::Color(color)) => seen(color),
        Ok(Css::FuncIRI(..) | Css::ContextFill | Css::ContextStroke | Css::Inherit) => Paint::Some,
        Err(_) if value.eq_ignore_ascii_case("currentcolor") => Paint::CurrentColor,
        Err(_) => return None,
    })
}

fn opacity(value: &str) -> Option<f64> {
    let (number, unit) = value.strip_suffix('%').map_or((value, 1.0), |n| (n, 0.01));
    number
        .trim()
        .parse::<svgtypes::Number>()
        .ok()
        .map(|n| n.0 * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cascaded(attributes: &str, css: &str) -> (Style, bool, Vec<String>) {
        let text = format!("<svg><path class='a' {attributes}/></svg>");
        let document = roxmltree::Document::parse(&text).unwrap();
        let sheet = Sheet::parse(css);
        let node = document.root_element().first_element_child().unwrap();
        let mut bad = Vec::new();
        let mut note = |name: &str, value: &str| bad.push(format!("{name}: {value}"));
        let (style, own) = cascade(
            &Style::default(),
            node,
            "path",
            &sheet,
            Point::new(100.0, 100.0),
            &mut note,
        );
        (style, own.is_hidden(), bad)
    }

    fn painted(attributes: &str, css: &str) -> (bool, bool) {
        let (style, ..) = cascaded(attributes, css);
        (style.filled(), style.stroked(1.0).is_some())
    }

    #[test]
    fn the_attributes_can_be_searched() {
        assert!(ATTRIBUTES.is_sorted());
    }

    #[test]
    fn styles_win_over_rules_and_rules_over_attributes() {
        assert_eq!(painted("", ""), (true, false));
        assert_eq!(painted("fill='none'", ".a{fill:red}"), (true, false));
        assert_eq!(
            painted("fill='red' style='fill:none'", ".a{fill:red}"),
            (false, false)
        );
        assert_eq!(
            painted("style='fill:red'", ".a{fill:none!important}"),
            (false, false)
        );
        assert_eq!(painted("style='fill:none;stroke:#000'", ""), (false, true));
    }

    #[test]
    fn paint_is_there_or_not() {
        for none in ["none", "transparent", "rgba(1,2,3,0)", "#12345600"] {
            assert_eq!(
                painted(&format!("fill='{none}'"), ""),
                (false, false),
                "{none}"
            );
        }
        for some in [
            "red",
            "#abc",
            "url(#g)",
            "url(#g) none",
            "rgb(1,2,3)",
            "currentColor",
            "hsl(120, 50%, 50%)",
        ] {
            assert_eq!(
                painted(&format!("fill='{some}'"), ""),
                (true, false),
                "{some}"
            );
        }
        assert_eq!(
            painted("fill='currentColor' color='transparent'", ""),
            (false, false)
        );
        assert_eq!(painted("stroke='red' stroke-width='0'", ""), (true, false));
        assert_eq!(
            painted("stroke='red' stroke-opacity='0' fill-opacity='0%'", ""),
            (false, false)
        );
        assert_eq!(
            painted("stroke='red' visibility='collapse'", ""),
            (false, false)
        );
        assert_eq!(
            cascaded("stroke='red' stroke-width='2%' stroke-linecap='round'", "")
                .0
                .stroked(3.0),
            Some(Stroke {
                width: 6.0,
                cap: Cap::Round,
                join: Join::Miter(4.0)
            })
        );
    }

    #[test]
    fn hiding_is_by_display_or_opacity() {
        assert!(cascaded("display='none'", "").1);
        assert!(cascaded("style='opacity: 0.0'", "").1);
        assert!(cascaded("", ".a{display:none}").1);
        assert!(!cascaded("style='display:inline;opacity:.5'", "").1);
        // What is stronger shows again what is hidden by what is weaker.
        assert!(!cascaded("", ".a{display:none} .a{display:inline}").1);
        assert!(!cascaded("style='display:inline'", ".a{display:none}").1);
        assert!(!cascaded("display='none'", ".a{display:inline}").1);
        assert!(!cascaded("style='opacity:1'", "path{opacity:0}").1);
        assert!(cascaded("style='opacity:1'", "path{display:none}").1);
        assert_eq!(
            cascaded("fill='oops' stroke-width='-1' fill-rule='x'", "").2,
            ["fill: oops", "stroke-width: -1", "fill-rule: x"]
        );
    }
}
