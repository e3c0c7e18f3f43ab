//! Points, steps and directions.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};

use super::super::record::prose;
use super::super::scalar::{Length, Number};
use super::super::{Decode, Decoder, Tree};
use super::list::list_schema;

/// Defines a list of a fixed number of numbers.
macro_rules! tuple {
    ($(#[doc = $doc:literal])* $name:ident($n:literal), $item:ty, $least:literal, $what:literal) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub [f64; $n]);

        impl Decode for $name {
            fn decode(tree: &Tree, cx: &mut Decoder) -> Option<$name> {
                let numbers = numbers::<$item, $n>(tree, $least, $what, cx)?;
                Some($name(numbers.map(|number| number.map_or(0.0, |item| item.0))))
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(g: &mut SchemaGenerator) -> Schema {
                let mut schema = list_schema::<$item>(g, $least, Some($n));
                schema.insert("description".into(), prose(concat!($($doc, "\n"),*)).into());
                schema
            }
        }
    };
}

tuple!(
    /// A point or a step in the plane: `[x, y]`, lengths.
    PlanePoint(2), Length, 2, "a point `[x, y]`"
);
tuple!(
    /// A point or a step in space: `[x, y, z]`, lengths; without `z` it is 0.
    SpacePoint(3), Length, 2, "a point `[x, y, z]`"
);
tuple!(
    /// A vector of plain numbers, `[x, y, z]`.
    Vector(3), Number, 3, "a vector `[x, y, z]`"
);

/// A direction: a vector `[x, y, z]` that is not zero; its length does not matter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Direction(pub [f64; 3]);

impl Decode for Direction {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Direction> {
        let Vector(vector) = Vector::decode(tree, cx)?;
        if vector == [0.0; 3] {
            cx.error("a direction must not be zero")
        } else {
            Some(Direction(vector))
        }
    }
}

impl JsonSchema for Direction {
    fn schema_name() -> Cow<'static, str> {
        "Direction".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let doc = "A direction: a vector `[x, y, z]` of plain numbers that is not zero; its length does not matter.";
        let mut schema = Vector::json_schema(g);
        schema.insert("description".into(), doc.into());
        schema
    }
}

/// Reads a list of `least` to `N` numbers; those that are missing at its end are none.
fn numbers<T: Decode + Copy, const N: usize>(
    tree: &Tree,
    least: usize,
    what: &str,
    cx: &mut Decoder,
) -> Option<[Option<T>; N]> {
    match tree.as_list() {
        Some(items) if (least..=N).contains(&items.len()) => {
            let mut out = [None; N];
            let decoded: Vec<T> = cx.items(items)?;
            out.iter_mut()
                .zip(decoded)
                .for_each(|(slot, item)| *slot = Some(item));
            Some(out)
        }
        Some(items) => cx.error(format!("expected {what}, found a list of {}", items.len())),
        None => cx.mismatch(what, tree),
    }
}
