//! Where regular partitions begin.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::value::PlanePoint;
use super::{Decode, Decoder, Tree};

/// The point of the plane from which a partition is laid out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Anchor {
    /// The lower left corner of the box of the region that is divided.
    Region,
    /// A point of the plane, the same for every region.
    Point(PlanePoint),
}

impl Anchor {
    /// The point, where it does not depend on the region.
    pub fn point(self) -> Option<[f64; 2]> {
        match self {
            Anchor::Region => None,
            Anchor::Point(point) => Some(point.0),
        }
    }
}

impl Decode for Anchor {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Anchor> {
        match tree {
            Tree::Text(word) if &**word == "region" => Some(Anchor::Region),
            Tree::Text(word) if &**word == "origin" => Some(Anchor::Point(PlanePoint([0.0; 2]))),
            Tree::List(_) => PlanePoint::decode(tree, cx).map(Anchor::Point),
            _ => cx.mismatch("`region`, `origin` or a point `[x, y]`", tree),
        }
    }
}

impl JsonSchema for Anchor {
    fn schema_name() -> Cow<'static, str> {
        "Anchor".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let doc = "Where a partition begins: `region`, the lower left corner of the region's box; `origin` or a point `[x, y]` of the plane.";
        let words = json_schema!({ "enum": ["region", "origin"] });
        json_schema!({ "description": doc, "anyOf": [words, g.subschema_for::<PlanePoint>()] })
    }
}
