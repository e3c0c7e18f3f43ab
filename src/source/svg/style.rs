//! What an element's attributes, rules and `style` make of it: whether it is seen, how it is
//! filled and stroked. Colours matter only as far as they are there or not.

use std::borrow::Cow;

use roxmltree::Node;
use svgtypes::PaintFallback;

use super::length::{Axis, Basis, FONT_SIZE, Length};
use super::sheet::{self, Declaration, Sheet};
use fretwork_geometry::FillRule;
use fretwork_geometry::drawing::{Cap, Join, Stroke};

/// The inherited properties.
#[derive(Clone, Copy, Debug)]
pub struct Style<'a> {
    fill: Paint<'a>,
    stroke: Paint<'a>,
    /// What `currentColor` is.
    color: Paint<'a>,
    /// What `context-fill` and `context-stroke` are.
    context: [Paint<'a>; 2],
    fill_opacity: f64,
    stroke_opacity: f64,
    /// What is inside a shape.
    pub rule: FillRule,
    /// The width of strokes in user units.
    pub width: f64,
    cap: Cap,
    miter: bool,
    miter_limit: f64,
    round_join: bool,
    visible: bool,
    /// Whether strokes are dashed.
    pub dashed: bool,
    /// The height of letters in user units.
    pub font_size: f64,
    /// What stands at the start, the middle and the end of lines.
    pub markers: [Option<&'a str>; 3],
}

/// What an area is painted with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint<'a> {
    /// Nothing, or what is transparent.
    None,
    /// A colour.
    Color {
        /// Whether it is white and opaque.
        is_white: bool,
    },
    /// The gradient or pattern with this id, or else the colour that stands behind it.
    Server {
        /// The id.
        id: &'a str,
        /// Whether there is a colour behind it, and whether that is seen.
        fallback: Option<bool>,
    },
    /// The value of `color`.
    Current,
    /// The fill or the stroke (1) of what shows a marker.
    Context(usize),
}

const BLACK: Paint = Paint::Color { is_white: false };

impl Default for Style<'_> {
    fn default() -> Self {
        Style {
            fill: BLACK,
            stroke: Paint::None,
            color: BLACK,
            context: [Paint::None; 2],
            fill_opacity: 1.0,
            stroke_opacity: 1.0,
            rule: FillRule::NonZero,
            width: 1.0,
            cap: Cap::Butt,
            miter: true,
            miter_limit: 4.0,
            round_join: false,
            visible: true,
            dashed: false,
            font_size: FONT_SIZE,
            markers: [None; 3],
        }
    }
}

/// What the percentages of a transform's origin are taken of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ReferenceBox {
    /// The viewport.
    #[default]
    View,
    /// The box of the element's outline.
    Fill,
    /// The box of its stroke.
    Stroke,
}

/// What concerns the element alone.
#[derive(Clone, Debug, Default)]
pub struct Own<'a> {
    /// `display: none`.
    undisplayed: bool,
    /// 1 less its opacity.
    transparency: f64,
    /// `clip-path`, when it has one.
    pub clip: Option<&'a str>,
    /// `mask`, when it has one.
    pub mask: Option<&'a str>,
    /// `vector-effect: non-scaling-stroke`.
    pub fixed_stroke: bool,
    /// Whether what leaves its viewport is seen, where it says so.
    overflows: Option<bool>,
    /// The `transform` of its style, which wins over the attribute.
    pub transform: Option<&'a str>,
    /// `transform-origin`.
    pub origin: Option<&'a str>,
    /// `transform-box`.
    pub reference: ReferenceBox,
    /// Properties that change what is seen and are not read.
    pub unread: Vec<&'static str>,
    /// Places and sizes that its style says, which win over attributes.
    geometry: Vec<(&'static str, &'a str)>,
}

impl<'a> Own<'a> {
    /// Whether nothing in the element is seen.
    pub fn is_hidden(&self) -> bool {
        self.undisplayed || self.transparency >= 1.0
    }

    /// Whether it is seen through.
    pub fn is_translucent(&self) -> bool {
        self.transparency > 0.0
    }

    /// Whether what leaves the viewport of the element is seen all the same.
    pub fn overflows(&self) -> bool {
        self.overflows.unwrap_or(false)
    }

    /// What the style says of a place or size.
    pub fn geometry(&self, name: &str) -> Option<&'a str> {
        let mut said = self.geometry.iter().rev();
        said.find(|(known, _)| *known == name).map(|(_, v)| *v)
    }
}

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

impl<'a> Style<'a> {
    /// What a shape of this style is filled with.
    pub fn fill(&self) -> Paint<'a> {
        self.seen(self.fill, self.fill_opacity)
    }

    /// What its outline is painted with.
    pub fn stroke(&self) -> Paint<'a> {
        self.seen(self.stroke, self.stroke_opacity)
    }

    fn seen(&self, paint: Paint<'a>, opacity: f64) -> Paint<'a> {
        let mut paint = paint;
        if let Paint::Context(which) = paint {
            paint = self.context[which];
        }
        if paint == Paint::Current {
            paint = self.color;
        }
        match paint {
            _ if !self.visible || opacity <= 0.0 => Paint::None,
            Paint::Color { is_white } => Paint::Color {
                is_white: is_white && opacity >= 1.0,
            },
            other => other,
        }
    }

    /// The style with which a marker of a shape of this one begins, inheriting `above`.
    pub fn context_of(&self, above: Style<'a>) -> Style<'a> {
        Style {
            context: [self.fill(), self.stroke()],
            ..above
        }
    }

    /// How a stroke is drawn where user units are `scale` spec units; none when it has no width.
    pub fn pen(&self, scale: f64) -> Option<Stroke> {
        let width = self.width * scale;
        let join = match (self.round_join, self.miter) {
            (true, _) => Join::Round,
            (false, true) => Join::Miter(self.miter_limit),
            (false, false) => Join::Bevel,
        };
        (width > 0.0).then_some(Stroke {
            width,
            cap: self.cap,
            join,
        })
    }

    /// Whether `visibility` shows it.
    pub fn visible(&self) -> bool {
        self.visible
    }
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

/// The id in `url(#id)`; none where the value is another one.
pub fn reference(value: &str) -> Option<&str> {
    let rest = value.trim().strip_prefix("url(")?;
    let (inside, _) = rest.split_once(')')?;
    inside
        .trim()
        .trim_matches(['"', '\''])
        .trim()
        .strip_prefix('#')
}

fn paint(value: &str) -> Option<Paint<'_>> {
    use svgtypes::Paint as Css;
    let keyword = |word: &str| value.eq_ignore_ascii_case(word);
    if keyword("none") || keyword("transparent") {
        return Some(Paint::None);
    }
    if keyword("currentcolor") {
        return Some(Paint::Current);
    }
    Some(match Css::from_str(value).ok()? {
        Css::None => Paint::None,
        Css::CurrentColor => Paint::Current,
        Css::Color(color) if color.alpha == 0 => Paint::None,
        Css::Color(color) => Paint::Color {
            is_white: [color.red, color.green, color.blue, color.alpha] == [255; 4],
        },
        Css::FuncIRI(id, fallback) => Paint::Server {
            id,
            fallback: fallback.map(|fallback| match fallback {
                PaintFallback::None => false,
                PaintFallback::CurrentColor => true,
                PaintFallback::Color(color) => color.alpha > 0,
            }),
        },
        Css::ContextFill => Paint::Context(0),
        Css::ContextStroke => Paint::Context(1),
        Css::Inherit => return None,
    })
}

/// From 0 to 1, as far as the value goes.
pub fn opacity(value: &str) -> Option<f64> {
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
    use fretwork_geometry::Point;

    /// What `look` sees in the style of an element, and what was not understood.
    fn cascaded<T>(
        attributes: &str,
        css: &str,
        look: impl FnOnce(&Style, &Own) -> T,
    ) -> (T, Vec<String>) {
        let text = format!("<svg><path class='a' {attributes}/></svg>");
        let document = roxmltree::Document::parse(&text).unwrap();
        let sheet = Sheet::parse(css);
        let node = document.root_element().first_element_child().unwrap();
        let mut bad = Vec::new();
        let mut note = |name: &str, value: &str| bad.push(format!("{name}: {value}"));
        let basis = Basis::of(Point::new(100.0, 100.0));
        let (style, own) = cascade(&Style::default(), node, &sheet, &basis, &mut note);
        (look(&style, &own), bad)
    }

    fn painted(attributes: &str, css: &str) -> (bool, bool) {
        let seen = |style: &Style, _: &Own| {
            let stroke = style.pen(1.0).filter(|_| style.stroke() != Paint::None);
            (style.fill() != Paint::None, stroke.is_some())
        };
        cascaded(attributes, css, seen).0
    }

    fn hidden(attributes: &str, css: &str) -> bool {
        cascaded(attributes, css, |_, own| own.is_hidden()).0
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
            cascaded(
                "stroke='red' stroke-width='2%' stroke-linecap='round'",
                "",
                |style, _| { style.pen(3.0) }
            )
            .0,
            Some(Stroke {
                width: 6.0,
                cap: Cap::Round,
                join: Join::Miter(4.0)
            })
        );
    }

    #[test]
    fn hiding_is_by_display_or_opacity() {
        assert!(hidden("display='none'", ""));
        assert!(hidden("style='opacity: 0.0'", ""));
        assert!(hidden("", ".a{display:none}"));
        assert!(!hidden("style='display:inline;opacity:.5'", ""));
        // What is stronger shows again what is hidden by what is weaker.
        assert!(!hidden("", ".a{display:none} .a{display:inline}"));
        assert!(!hidden("style='display:inline'", ".a{display:none}"));
        assert!(!hidden("display='none'", ".a{display:inline}"));
        assert!(!hidden("style='opacity:1'", "path{opacity:0}"));
        assert!(hidden("style='opacity:1'", "path{display:none}"));
        assert_eq!(
            cascaded("fill='oops' stroke-width='-1' fill-rule='x'", "", |_, _| ()).1,
            ["fill: oops", "stroke-width: -1", "fill-rule: x"]
        );
    }

    #[test]
    fn names_and_keywords_may_be_written_in_capitals() {
        assert_eq!(painted("style='FILL:None;Stroke:RED'", ""), (false, true));
        assert!(hidden("", ".a{DISPLAY:NONE}"));
    }

    #[test]
    fn comments_stand_anywhere_in_a_style() {
        assert_eq!(
            painted("style='/*fill:red*/fill:/*a*/none/*b*/'", ""),
            (false, false)
        );
    }

    #[test]
    fn letters_give_lengths_their_size() {
        let width = |attributes: &str| {
            cascaded(attributes, "", |style, _| (style.font_size, style.width)).0
        };
        assert_eq!(width("stroke-width='2em' font-size='10'"), (10.0, 20.0));
        assert_eq!(
            width("style='stroke-width:1ex;font:bold 2em/1.5 Arial'"),
            (32.0, 16.0)
        );
        assert_eq!(width("font-size='150%' stroke-width='1rem'"), (24.0, 16.0));
        assert_eq!(width("font-size='large'").0, 18.0);
        assert_eq!(width("style='font:700 5px x'").0, 5.0);
    }

    #[test]
    fn servers_and_white_are_told_apart() {
        let fill = |value: &str| {
            let (paint, bad) = cascaded(&format!("fill='{value}'"), "", |style, _| {
                format!("{:?}", style.fill())
            });
            assert_eq!(bad, [""; 0]);
            paint
        };
        assert_eq!(
            fill("url(#p) none"),
            "Server { id: \"p\", fallback: Some(false) }"
        );
        assert_eq!(fill("url(#p)"), "Server { id: \"p\", fallback: None }");
        assert_eq!(fill("#fff"), "Color { is_white: true }");
        assert_eq!(fill("context-fill"), "None");
        assert_eq!(reference("url( \"#a\" ) x"), Some("a"));
        assert_eq!(reference("url(b.svg#a)"), None);
    }

    #[test]
    fn places_in_a_style_need_units() {
        let (said, bad) = cascaded("style='width:4px;x:0;r:5'", ".a{rx:1em}", |_, own| {
            ["width", "x", "r", "rx"].map(|name| own.geometry(name).unwrap_or("").to_string())
        });
        assert_eq!(said, ["4px", "0", "", "1em"]);
        assert_eq!(bad, ["r: 5"]);
        assert!(GEOMETRY.is_sorted());
    }
}
