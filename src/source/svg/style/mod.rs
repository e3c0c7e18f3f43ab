//! What an element's attributes, rules and `style` make of it: whether it is seen, how it is
//! filled and stroked. Colours matter only as far as they are there or not. What is said of an element is put
//! together in `cascade`, values of paint are read in `paint`.

mod cascade;
mod paint;
#[cfg(test)]
mod tests;

pub use cascade::cascade;
pub use paint::{Paint, opacity, reference};

use super::length::FONT_SIZE;
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
