//! `surfaces`: triangle meshes.

use crate::macros::{kinds, record};
use crate::placement::{Rotation, SpaceAxis, SpaceScale};
use crate::scalar::{Count, FilePath, PositiveLength};
use crate::types::wants;
use crate::value::{NonEmpty, PlanePoint, SpacePoint};
use crate::{Decode, Decoder, Ref, Tree};

kinds! {
    /// Triangle meshes in space, z up.
    pub enum Surface {
        /// A mesh from a file: STL, glTF or GLB, OBJ, PLY.
        mesh: Mesh(Mesh),
        /// A profile turned about the z axis.
        revolve: Revolve(Revolve),
        /// A level curve moved upward: a wall, open at the top and the bottom.
        extrude: Extrude(Extrude),
    }
}

record! {
    /// A mesh: STL, glTF or GLB (as it stands at rest, with its skins, morph weights and instances), OBJ, PLY. Faces of many corners may be concave.
    pub struct Mesh {
        /// The file.
        file: FilePath,
        /// The longest side of its bounding box after scaling, uniformly, from where it stands. Without it, the file's units are the spec's
        /// (glTF's are metres). What is up in glTF, its y, becomes z.
        longest_side: Option<PositiveLength>,
        /// How far it is turned about the origin, before all else.
        rotate: Rotation = 0,
        /// A factor, or one for each axis.
        scale: SpaceScale = 1,
        /// The axis whose coordinate changes its sign.
        mirror: Option<SpaceAxis>,
        /// Where its origin goes, after all else.
        at: SpacePoint = [0, 0, 0],
    }
}

record! {
    /// A profile turned about the z axis.
    pub struct Revolve {
        /// Points `[r, z]` from bottom to top, or a planar curve whose x is the radius and whose y is the height.
        profile: Profile,
        /// How many pieces a full turn has, at least 3.
        segments: Count = 96,
    }
}

record! {
    /// A level curve moved upward, facing outward on a closed curve and to the right of an open one.
    pub struct Extrude {
        /// The curve, which lies level.
        profile: Ref<wants::Curve>,
        /// How high the wall is.
        height: PositiveLength,
    }
}

/// What is turned about the axis.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Profile {
    /// Radius and height of its points.
    Points(NonEmpty<PlanePoint>),
    /// A planar curve.
    Curve(Ref<wants::Curve>),
}

impl Decode for Profile {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Profile> {
        match tree {
            Tree::Text(_) => Ref::decode(tree, cx).map(Profile::Curve),
            _ => NonEmpty::decode(tree, cx).map(Profile::Points),
        }
    }
}

impl schemars::JsonSchema for Profile {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Profile".into()
    }

    fn json_schema(g: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let points = g.subschema_for::<NonEmpty<PlanePoint>>();
        let curve = g.subschema_for::<Ref<wants::Curve>>();
        schemars::json_schema!({ "description": "Points `[r, z]`, or the name of a planar curve.", "anyOf": [points, curve] })
    }
}
