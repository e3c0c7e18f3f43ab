//! Forces and accelerations in space.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::super::{Decode, Decoder, Tree};
use super::quantity::{Written, pattern, quantity};
use super::unit::ACCELERATIONS;
use super::{Force, number_schema};

/// A force in space, in newtons.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ForceVector(pub [f64; 3]);

impl Decode for ForceVector {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<ForceVector> {
        match tree.as_list() {
            Some(items) if items.len() == 3 => match *cx.items::<Force>(items)? {
                [x, y, z] => Some(ForceVector([x.0, y.0, z.0])),
                _ => None,
            },
            _ => cx.mismatch("a force `[x, y, z]`", tree),
        }
    }
}

impl JsonSchema for ForceVector {
    fn schema_name() -> Cow<'static, str> {
        "ForceVector".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let force = g.subschema_for::<Force>();
        json_schema!({ "description": "A force `[x, y, z]`.", "type": "array", "items": force, "minItems": 3, "maxItems": 3 })
    }
}

/// The acceleration by gravity, in m/s².
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Gravity(pub [f64; 3]);

/// What gravity is on earth, in m/s².
const STANDARD_GRAVITY: f64 = 9.81;

impl Decode for Gravity {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Gravity> {
        const GRAVITY: &str = "a direction `[x, y, z]`, or a vector with the unit m/s2";
        let Some(items) = tree.as_list().filter(|items| items.len() == 3) else {
            return cx.mismatch(GRAVITY, tree);
        };
        let read = |cx: &mut Decoder, n: usize| {
            cx.at(&n.to_string(), |cx| {
                quantity(&items[n], "an acceleration", ACCELERATIONS, cx)
            })
        };
        let (x, y, z) = (read(cx, 0), read(cx, 1), read(cx, 2));
        match (x?, y?, z?) {
            (Written::InUnit(x), Written::InUnit(y), Written::InUnit(z)) => {
                Some(Gravity([x, y, z]))
            }
            (Written::Plain(x), Written::Plain(y), Written::Plain(z)) => {
                let largest = x.abs().max(y.abs()).max(z.abs());
                if largest == 0.0 {
                    return cx.error_with(
                        "a direction must not be zero",
                        "write [\"0m/s2\", \"0m/s2\", \"0m/s2\"] for no gravity",
                    );
                }
                let [x, y, z] = [x, y, z].map(|part| part / largest);
                let factor = STANDARD_GRAVITY / (x * x + y * y + z * z).sqrt();
                Some(Gravity([x, y, z].map(|part| part * factor + 0.0)))
            }
            _ => cx.error("either all parts of the vector have the unit m/s2, or none has"),
        }
    }
}

impl JsonSchema for Gravity {
    fn schema_name() -> Cow<'static, str> {
        "Gravity".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let part = number_schema("number", "", Some(&pattern("m/s2")), &[]);
        let doc = "The acceleration by gravity: a direction `[x, y, z]` (of 9.81 m/s²), or a vector in text with units (`[\"0m/s2\", \"0m/s2\", \"-1.62m/s2\"]`).";
        json_schema!({ "description": doc, "type": "array", "items": part, "minItems": 3, "maxItems": 3 })
    }
}
