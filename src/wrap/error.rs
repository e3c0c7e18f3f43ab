//! Why a drawing cannot be laid on a surface.

use fretwork_geometry::{PlanarMapError, Point3, Polygon, polygon, topology};

/// Why there is no cutout on the surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WrapError {
    /// The drawing has no area.
    #[error("there is nothing to lay on the surface")]
    Empty,
    /// The surface is broken.
    #[error("the surface has no triangles, or broken ones")]
    Broken,
    /// No place is given on a surface that has no middle of its own.
    #[error("it is not said where on the surface")]
    NoPlace,
    /// Copies go around where nothing goes around.
    #[error(
        "nothing goes around this surface: only turned ones and closed walls have a way around"
    )]
    NoWayAround,
    /// Copies go around where the surface has no part that is not at its tip.
    #[error("the surface is all tip: every piece of its profile ends on the axis")]
    OnAxis,
    /// The drawing is wider than the way around.
    #[error("the drawing is {wide:.3} wide and the way around the surface {around:.3}: {:.3} too much", .wide - .around)]
    TooWide {
        /// How wide all copies are.
        wide: f64,
        /// The way around.
        around: f64,
        /// How many copies there are.
        copies: usize,
    },
    /// The drawing reaches over a rim.
    #[error(
        "the drawing reaches {by:.3} over the {rim} rim of the surface, which is {room:.3} wide there"
    )]
    OverRim {
        /// Which one.
        rim: &'static str,
        /// By how much.
        by: f64,
        /// The length of the surface across.
        room: f64,
    },
    /// The drawing lies over the tip of a cone.
    #[error("the drawing reaches over the tip of the cone")]
    OverTip,
    /// The drawing is larger than the patch that can be flattened.
    #[error("the drawing is larger than the surface around the place: it reaches {by:.3} too far")]
    TooLarge {
        /// By how much.
        by: f64,
        /// The part of its size that would fit, if that is known.
        fits: Option<f64>,
    },
    /// The surface cannot be flattened there.
    #[error("within the drawing's reach the surface turns back on itself near ({:.3}, {:.3}, {:.3})", .at.x, .at.y, .at.z)]
    TurnsBack {
        /// Where.
        at: Point3,
        /// The part of its size that would fit, if that is known.
        fits: Option<f64>,
    },
    /// Copies of the drawing do not meet themselves.
    #[error(
        "the seam does not close: {copies} times {period:.4} is not the {around:.4} around the surface"
    )]
    Seam {
        /// The period.
        period: f64,
        /// How often it fits best.
        copies: usize,
        /// The way around.
        around: f64,
    },
    /// More copies than are made.
    #[error("{0} copies would go around, which are too many")]
    TooMany(f64),
    /// Areas cannot be united.
    #[error(transparent)]
    Area(#[from] polygon::AreaError),
    /// Outlines cross or touch.
    #[error(transparent)]
    Topology(#[from] topology::TopologyError),
    /// The outline cannot be pressed into the surface.
    #[error(transparent)]
    Map(#[from] PlanarMapError),
    /// Parts meet in a point on the surface.
    #[error("parts of the drawing meet in a point near ({:.3}, {:.3}, {:.3})", .at.x, .at.y, .at.z)]
    Pinched {
        /// Where.
        at: Point3,
    },
}

impl WrapError {
    /// The error about a drawing of this area, where how far it reaches was not known exactly.
    pub(crate) fn of(self, area: &[Polygon]) -> WrapError {
        let corners = area.iter().flat_map(|polygon| &polygon.outer);
        let reach = corners.map(|p| p.length()).fold(0.0, f64::max);
        match self {
            WrapError::TooLarge {
                fits: Some(part), ..
            } => WrapError::TooLarge {
                by: reach * (1.0 - part),
                fits: Some(part),
            },
            other => other,
        }
    }

    /// What would help, if something is known, for a drawing that is laid with these factors.
    pub fn help(&self, scale: [f64; 2]) -> Option<String> {
        let scaled = |part: f64| match scale {
            [x, y] if x == y => format!("{:.4}", x * part),
            [x, y] => format!("[{:.4}, {:.4}]", x * part, y * part),
        };
        match self {
            WrapError::NoPlace => {
                Some("add `at: [x, y, z]`; the nearest place of the surface is taken".into())
            }
            WrapError::NoWayAround => Some(
                "a `revolve` goes around, and an `extrude` of a closed curve; elsewhere lay it once, without `repeat`"
                    .into(),
            ),
            WrapError::OnAxis => {
                Some("give the profile one point more, where the pattern is to end".into())
            }
            WrapError::Seam { period, around, .. } => {
                let least = libm::floor(around / period).max(1.0);
                let with = |count: f64| format!("{:.4} ({count} around)", around / count);
                let periods = format!("{} or {}", with(least), with(least + 1.0));
                Some(format!(
                    "periods that close are {periods}; a larger `length_tolerance` stretches it"
                ))
            }
            WrapError::TooWide {
                wide,
                around,
                copies,
            } => {
                let scaled = scaled(around / wide);
                let fewer = libm::floor(around / (wide / *copies as f64));
                Some(if *copies > 1 && fewer >= 1.0 {
                    format!("`repeat: {fewer}` would fit, or a `scale` of {scaled}")
                } else {
                    format!("a `scale` of {scaled} would fit")
                })
            }
            WrapError::OverRim { .. } => {
                Some("scale it down, or move it by `at`, which its middle comes to".into())
            }
            WrapError::TooLarge {
                fits: Some(part), ..
            }
            | WrapError::TurnsBack {
                fits: Some(part), ..
            } => Some(format!(
                "there is room for it with a `scale` of {}, or at a flatter place",
                scaled(*part)
            )),
            WrapError::TooLarge { .. } | WrapError::TurnsBack { .. } => {
                Some("scale it down, or choose a flatter place".into())
            }
            WrapError::Pinched { .. } => Some(
                "move them apart, or let them overlap: `inset` with a `by` a little below 0".into(),
            ),
            _ => None,
        }
    }
}
