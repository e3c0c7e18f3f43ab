//! `wrap`, a kind of arrangement: drawings laid on surfaces.

use super::side::Side;
use crate::macros::record;
use crate::placement::PlaneScale;
use crate::scalar::{Angle, Fraction, PositiveLength};
use crate::types::wants;
use crate::value::SpacePoint;
use crate::{Decode, Decoder, Ref, Tree};

record! {
    /// A drawing laid on a surface. Lengths are kept on cylinders, cones and extruded walls, and along the profile on other
    /// turned surfaces; on a mesh the part around the place is flattened with as little stretch as possible. Seen from outside,
    /// right in the drawing is to the right, and up in it is up along the profile, on a mesh as near to z as the surface allows.
    pub struct Wrap {
        /// What is laid on it: a region, a cutout, an exemplar, or the lines of an arrangement.
        from: Ref<wants::Drawing>,
        /// The surface.
        onto: Ref<wants::Surface>,
        /// The region that an arrangement is drawn on. The middle of its box is the drawing's, and where it is periodic the
        /// drawing closes around the surface.
        region: Option<Ref<wants::Region>>,
        /// The width of the lines of an arrangement; what has an area already has none.
        width: Option<PositiveLength>,
        /// The place for the drawing's middle: the place of the surface nearest to it. Without it half up a turned surface, over
        /// +x, and half up and along a wall; needed on a mesh.
        at: Option<SpacePoint>,
        /// How far the drawing is turned about its middle, from +x toward +y.
        rotate: Angle = 0,
        /// A factor, or one for each axis, about its middle.
        scale: PlaneScale = 1,
        /// `around` puts copies side by side all the way around, joined to one another; a number puts so many evenly spaced.
        /// Without it there is one, unless the region is periodic.
        repeat: Option<AroundForm>,
        /// How far a period may be from one that closes, as a part of it; it is then stretched to close exactly.
        length_tolerance: Fraction = "5%",
        /// On which side of the surface the thickness goes when the cutout becomes a solid.
        side: Side = "center",
    }
}

/// How many copies go around.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum AroundForm {
    /// As many as there is room for, joined.
    Joined,
    /// So many, evenly spaced.
    Spaced(u32),
}

/// More copies than this are refused.
const MOST: i64 = 10_000;

impl Decode for AroundForm {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<AroundForm> {
        match tree.plain() {
            Tree::Text(word) if &**word == "around" => Some(AroundForm::Joined),
            Tree::Int(n) if (1..=MOST).contains(n) => {
                u32::try_from(*n).ok().map(AroundForm::Spaced)
            }
            Tree::Int(n) => cx.error(format!("{n} copies are not from 1 to {MOST}")),
            _ => cx.mismatch("`around` or a number of copies", tree),
        }
    }
}

impl schemars::JsonSchema for AroundForm {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Around".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "`around`, or how many copies go around.",
            "type": ["integer", "string"], "minimum": 1, "maximum": MOST, "pattern": r"^around$|\$\{",
        })
    }
}
