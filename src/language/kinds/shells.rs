//! `shells`: pixel patterns on surfaces, that hold together and bear loads.

use super::force_profiles::Zone;
use super::side::Side;
use crate::macros::{kinds, record};
use crate::scalar::{Count, Fraction, NonNegativeLength, PositiveLength, PositiveNumber};
use crate::types::wants;
use crate::value::{Direction, List};
use crate::{Decode, Decoder, Ref, Tree};

record! {
    /// A surface made of voxels that a picture's texture makes solid or empty, in one piece, and strong enough.
    pub struct Shell {
        /// The surface.
        surface: Ref<wants::Surface>,
        /// The texture.
        exemplar: Ref<wants::RasterExemplar>,
        /// The thickness of the shell.
        thickness: PositiveLength,
        /// Where the shell lies.
        side: Side = "center",
        /// Parts that stay solid: rims and feet.
        keep_solid: List<Zone> = Tree::list([]),
        /// Where the texture's up points on the surface. Without it, as `{ up: [0, 0, 1] }`.
        orientation: Option<Orientation>,
        /// The part of a pixel by which the start is disturbed at random.
        jitter: Fraction = 0.1,
        /// What it must bear. Without it, it must only hold together.
        force_profile: Option<Ref<wants::ForceProfile>>,
        /// How long a way between two points of the shell may be, as a multiple of the object's extent; larger, fewer bridges.
        geodesic_limit: Option<PositiveNumber>,
        /// The least width of what is solid.
        min_feature: NonNegativeLength = 0,
        /// How many rounds of analysis and repair there may be.
        max_iterations: Count = 30,
    }
    /// How fine it is.
    + voxels: VoxelSize
}

kinds! {
    /// How fine the voxels are.
    pub enum VoxelSize {
        /// How many voxels there are along the longest side of the surface's bounding box.
        resolution: Resolution(Count),
        /// The side of a voxel.
        voxel: Voxel(PositiveLength),
    }
}

/// Where a texture's up points on a surface.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Orientation {
    /// As near to this direction as the surface allows.
    Up(Direction),
    /// Along the principal stress under this profile.
    Stress(Ref<wants::ForceProfile>),
    /// Along a vector field.
    Field(Ref<wants::Field>),
}

kinds! {
    /// Where a texture's up points.
    pub enum OrientationForm {
        /// As near to this direction as the surface allows.
        up: Up(Direction),
        /// Along the principal stress under this force profile.
        stress: Stress(Ref<wants::ForceProfile>),
    }
}

impl Decode for Orientation {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Orientation> {
        if let Tree::Text(_) = tree {
            return Ref::decode(tree, cx).map(Orientation::Field);
        }
        match OrientationForm::decode(tree, cx)? {
            OrientationForm::Up(direction) => Some(Orientation::Up(direction)),
            OrientationForm::Stress(profile) => Some(Orientation::Stress(profile)),
        }
    }
}

impl schemars::JsonSchema for Orientation {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Orientation".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let doc = "Where a texture's up points on a surface: `{ up: [0, 0, 1] }`, `{ stress: PROFILE }`, or a vector field.";
        let forms = [
            g.subschema_for::<OrientationForm>(),
            g.subschema_for::<Ref<wants::Field>>(),
        ];
        schemars::json_schema!({ "description": doc, "anyOf": forms })
    }
}
