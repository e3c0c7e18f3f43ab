//! What bands and panels are asked for, in plain values.

use fretwork_language::kinds::bands as kinds;
use fretwork_language::value::Target;

use crate::exemplar::slicing::Cutting;

/// How pieces are cut and put together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// How many components; none where any number will do.
    pub components: Option<u32>,
    /// How many holes; none where any number will do.
    pub holes: Option<u32>,
    /// Where the exemplar is cut.
    pub cutting: Cutting,
    /// The weight of the autocorrelation.
    pub variety: f64,
    /// The weight of directions in the cost of a seam: 1 - α of section 3.6.1.
    pub tangent_weight: f64,
    /// How far the pieces' total may be from the length, as a part of it.
    pub length_tolerance: f64,
    /// What is repeated at once is at least this part of the exemplar's width. With 0 every piece
    /// may follow itself.
    pub least_repeat: f64,
}

impl From<&kinds::Synthesis> for Parameters {
    fn from(spec: &kinds::Synthesis) -> Parameters {
        let target = |t: Target| match t {
            Target::Any => None,
            Target::Exactly(n) => Some(n),
        };
        Parameters {
            components: target(spec.components),
            holes: target(spec.holes),
            cutting: Cutting {
                slicing: spec.slicing,
                event_tolerance: spec.event_tolerance.0,
                min_portal: spec.min_portal.0,
            },
            variety: spec.variety.0,
            tangent_weight: spec.tangent_weight.0,
            length_tolerance: spec.length_tolerance.0,
            least_repeat: 0.0,
        }
    }
}

/// The room for a pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Along the band.
    pub length: f64,
    /// Across it.
    pub height: f64,
    /// The end is the beginning.
    pub closed: bool,
    /// A component must run round.
    pub around: bool,
    /// Offsets may leave the room by this part of its height.
    pub slack: f64,
}
