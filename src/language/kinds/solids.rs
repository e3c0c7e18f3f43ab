//! `solids`: closed meshes, ready to fabricate.

use super::look::Look;
use super::side::Side;
use crate::macros::{kinds, record};
use crate::placement::SpacePlacement;
use crate::scalar::{Count, NonNegativeLength, PositiveLength};
use crate::types::wants;
use crate::value::{NonEmpty, OneOrMany};
use crate::{Decode, Decoder, Ref, Tree};

kinds! {
    /// Closed triangle meshes in space, z up, ready to fabricate.
    pub enum Solid {
        /// Parts put together.
        assemble: Assemble(Assemble),
        /// A surface made thick, with a cutout cut through it.
        carve: Carve(Carve),
        /// A surface with a cutout standing out of it.
        emboss: Emboss(Emboss),
        /// A box with sides along the axes; `at` is its corner of least coordinates.
        r#box: Box(Cuboid),
        /// A ball; `at` is its centre.
        sphere: Sphere(Sphere),
        /// A cylinder along z; `at` is the centre of its base.
        cylinder: Cylinder(Cylinder),
        /// A region made thick, mirrored into world space: it looks the same seen from above.
        extrude: Extrude(Extrude),
        /// What is in any of the solids.
        union: Union(NonEmpty<Ref<wants::Solid>>),
        /// What is in all of the solids.
        intersection: Intersection(NonEmpty<Ref<wants::Solid>>),
        /// What is in the first solid and in none of the others.
        difference: Difference(NonEmpty<Ref<wants::Solid>>),
    }
}

record! {
    /// Parts put together.
    pub struct Assemble {
        /// The parts.
        parts: NonEmpty<Part>,
        /// The parts become one body; otherwise they stay objects of their own.
        union: bool = false,
    }
}

record! {
    /// A part of a whole.
    pub struct Part {
        /// What it is.
        from: Ref<wants::Part>,
        /// How thick a cutout or a region becomes, which need one, or a surface: without one it is the body that it encloses.
        thickness: Option<PositiveLength>,
        /// On which side of what the cutout lies on, or of the surface, the thickness goes. Without it, the cutout's own `side`, and inside of a surface.
        side: Option<Side>,
    }
    /// How it looks; parts that become one body have no looks of their own.
    + look: Look
    /// Where it stands.
    + placement: SpacePlacement
}

record! {
    /// A surface made thick, with a cutout cut through it.
    pub struct Carve {
        /// The surface, open or closed.
        surface: Ref<wants::Surface>,
        /// The cutout, which lies on the surface, or several in a list; what they fill is taken away.
        cutout: OneOrMany<Ref<wants::Cutout>>,
        /// How thick the surface becomes.
        thickness: PositiveLength,
        /// How deep it is engraved: what is taken away goes so deep from the outer face of the body, and a floor stays below it. Without it,
        /// it goes through.
        depth: Option<PositiveLength>,
        /// On which side of the surface the thickness goes: with `inside` the surface is the outer face of the body, with `outside` the inner one.
        side: Side = "inside",
        /// The cutout is kept and the rest of the surface taken away.
        invert: bool = false,
        /// With `invert`: rims of the surface that are kept too, so wide, to hold the cutout together.
        frame: NonNegativeLength = 0,
    }
}

record! {
    /// A surface with a cutout standing out of it.
    pub struct Emboss {
        /// The surface; flat openings of it are closed.
        surface: Ref<wants::Surface>,
        /// The cutout, which lies on the surface, or several in a list.
        cutout: OneOrMany<Ref<wants::Cutout>>,
        /// How far they stand out.
        height: PositiveLength,
    }
}

record! {
    /// A box with sides along the axes; `at` is its corner of least coordinates.
    pub struct Cuboid {
        /// Its extents along x, y and z.
        size: Extents,
    }
    /// Where it stands.
    + placement: SpacePlacement
}

/// Extents along x, y and z, all above 0.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(transparent)]
pub struct Extents(pub [f64; 3]);

impl Decode for Extents {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Extents> {
        match tree.as_list() {
            Some(items) if items.len() == 3 => match *cx.items::<PositiveLength>(items)? {
                [x, y, z] => Some(Extents([x.0, y.0, z.0])),
                _ => None,
            },
            _ => cx.mismatch("extents `[x, y, z]`", tree),
        }
    }
}

impl schemars::JsonSchema for Extents {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Extents".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let length = g.subschema_for::<PositiveLength>();
        let doc = "Extents `[x, y, z]`, lengths above 0.";
        schemars::json_schema!({ "description": doc, "type": "array", "items": length, "minItems": 3, "maxItems": 3 })
    }
}

record! {
    /// A ball; `at` is its centre.
    pub struct Sphere {
        /// Its radius.
        radius: PositiveLength,
        /// How many pieces a full turn has, at least 3.
        segments: Count = 96,
    }
    /// Where it stands.
    + placement: SpacePlacement
}

record! {
    /// A cylinder along z; `at` is the centre of its base.
    pub struct Cylinder {
        /// Its radius.
        radius: PositiveLength,
        /// Its height.
        height: PositiveLength,
        /// How many pieces a full turn has, at least 3.
        segments: Count = 96,
    }
    /// Where it stands.
    + placement: SpacePlacement
}

record! {
    /// A region made thick, standing on the xy plane.
    pub struct Extrude {
        /// The region.
        region: Ref<wants::Region>,
        /// Its height.
        height: PositiveLength,
    }
    /// Where it stands.
    + placement: SpacePlacement
}
