//! Values that say what an area is painted with.

use svgtypes::PaintFallback;

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

pub(super) fn paint(value: &str) -> Option<Paint<'_>> {
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
