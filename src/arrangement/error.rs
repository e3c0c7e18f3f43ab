//! Why a partition, a placement or a mask has no value. No places in files: callers add them.

use fretwork_geometry::Point;
use fretwork_geometry::TopologyError;
use fretwork_geometry::planar_map::PlanarMapError;
use fretwork_geometry::polygon::AreaError;

use crate::limit::LIMIT;

/// An operator's refusal, with the values it refuses.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ArrangementError {
    /// A distance between lines that is not a length above the resolution.
    #[error("lines must be at least {least:e} apart, not {spacing}")]
    Spacing {
        /// The distance asked for.
        spacing: f64,
        /// The resolution of the planar map.
        least: f64,
    },
    /// Stripes without a distance between their lines.
    #[error("stripes need at least one spacing")]
    NoSpacing,
    /// An angle that is no number.
    #[error("an angle must be finite, not {0}")]
    Angle(f64),
    /// The two families of a grid run the same way; their angles in radians.
    #[error("the lines of a grid must cross: angles {}° and {}° are parallel", degrees(.0), degrees(.1))]
    Parallel(f64, f64),
    /// More output than is allowed for.
    #[error(
        "there would be about {count:.3e} {what}, more than {LIMIT}; is every length in the right unit?"
    )]
    TooMany {
        /// What there would be too many of.
        what: &'static str,
        /// How many, roughly.
        count: f64,
    },
    /// A density that is not a positive number.
    #[error("{}", density_fault(*.density, .at))]
    Density {
        /// The density.
        density: f64,
        /// Where, when it comes from a field.
        at: Option<Point>,
    },
    /// A weight of a label that is negative or not a number, or weights whose sum is 0.
    #[error("weights must be finite, not negative, and not all 0; got {0}")]
    Weight(f64),
    /// A region with a coordinate that is not finite, or too large for its partition.
    #[error("the region's coordinates are not finite or too large for the partition")]
    Region,
    /// An element lacks a point that it is to be put in place by.
    #[error("the element has no point `{name}`; it has {}", if .known.is_empty() { "none".to_owned() } else { .known.join(", ") })]
    NoPoint {
        /// The name of the point.
        name: String,
        /// The names of its points.
        known: Vec<String>,
    },
    /// Elements cannot be packed.
    #[error("nothing can be packed: {0}")]
    Packing(&'static str),
    /// The pieces of a sheet are not as many as asked for.
    #[error("{wanted} pieces are asked for, and there are {found}: {}", if .found < .wanted { "lines are never cut apart" } else { "no straight bridge inside the region joins the rest" })]
    Components {
        /// How many there are.
        found: usize,
        /// How many there are to be.
        wanted: usize,
    },
    /// A frame that fills its whole region.
    #[error("a frame of {0} leaves nothing of the region open")]
    Frame(f64),
    /// A region that is to be registered is not of slices.
    #[error(
        "the region has no slices: only those that `slices` gave can be registered, as they are"
    )]
    NoSlices,
    /// The outline of a sheet touches itself.
    #[error("the outline is not simple: {0}")]
    Outline(#[from] TopologyError),
    /// An area could not be computed.
    #[error(transparent)]
    Area(#[from] AreaError),
    /// A planar map could not be built.
    #[error(transparent)]
    Map(#[from] PlanarMapError),
    /// Lines that do not continue across the sides of a periodic tile.
    #[error(
        "the lines do not meet across the sides of the tile; the nearest that do have an angle of {} degrees and spacings {scale} times as large",
        degrees(angle)
    )]
    Period {
        /// The nearest angle that fits, radians.
        angle: f64,
        /// What to multiply all spacings by.
        scale: f64,
    },
    /// A field that does not continue across the sides of a periodic tile.
    #[error(
        "the field is not the same on opposite sides of the tile: {here} at ({}, {}), and {there} one period further",
        at.x,
        at.y
    )]
    FieldPeriod {
        /// A place on a side.
        at: Point,
        /// The value there.
        here: f64,
        /// The value on the other side.
        there: f64,
    },
    /// A tile that is too small for a point set of its density.
    #[error("the tile is too small: its sides must be at least {least}, not {side}")]
    Tile {
        /// The shorter side.
        side: f64,
        /// The least that works.
        least: f64,
    },
}

/// Radians in degrees, to a digit less than they have, so that whole ones look whole.
fn degrees(radians: &f64) -> f64 {
    let digits = 1e12;
    libm::round(radians.to_degrees() * digits) / digits
}

fn density_fault(density: f64, at: &Option<Point>) -> String {
    let place = place(at);
    if density.is_nan() {
        format!(
            "the density has no value{place}; `otherwise:` gives a field a value where it has none"
        )
    } else {
        format!("a density must be positive and finite, not {density}{place}")
    }
}

fn place(at: &Option<Point>) -> String {
    at.map_or(String::new(), |p| format!(" at ({}, {})", p.x, p.y))
}
