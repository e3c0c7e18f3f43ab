//! The words that say where a thing stands: `at`, `rotate`, `scale`, `mirror`, `repeat`.
//!
//! They are done in this order: scale, mirror, rotate, move; then the copies of `repeat`.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::macros::{choice, record};
use super::scalar::{Angle, Count, Length, Scale};
use super::value::{OneOrMany, PlanePoint, SpacePoint};
use super::{Decode, Decoder, Tree};

record! {
    /// A place in the plane.
    pub struct PlanePlacement {
        /// Where its origin goes.
        at: PlanePoint = [0, 0],
        /// How far it is turned about its origin, from +x toward +y.
        rotate: Angle = 0,
        /// A factor, or one for each axis, about its origin.
        scale: PlaneScale = 1,
        /// The axis whose coordinate changes its sign.
        mirror: Option<PlaneAxis>,
        /// Copies, all of them placed by the other words first.
        repeat: Option<PlaneRepeat>,
    }
}

record! {
    /// A place in space for one thing.
    pub struct SpacePlace {
        /// Where its origin goes.
        at: SpacePoint = [0, 0, 0],
        /// How far it is turned about its origin: an angle about z, or angles about x, then y, then z.
        rotate: Rotation = 0,
        /// A factor, or one for each axis, about its origin.
        scale: SpaceScale = 1,
        /// The axis whose coordinate changes its sign.
        mirror: Option<SpaceAxis>,
    }
}

record! {
    /// A place in space.
    pub struct SpacePlacement {
        /// Copies, all of them placed by the other words first.
        repeat: Option<Repeat>,
    }
    /// Where the first copy stands.
    + place: SpacePlace
}

record! {
    /// How a drawing is turned before it is used.
    pub struct Turn {
        /// How far it is turned about the centre of its bounding box, from +x toward +y.
        rotate: Angle = 0,
        /// A factor, or one for each axis.
        scale: PlaneScale = 1,
        /// The axis whose coordinate changes its sign.
        mirror: Option<PlaneAxis>,
    }
}

choice! {
    /// An axis of the plane.
    pub enum PlaneAxis {
        /// Left and right change places.
        x: X,
        /// Top and bottom change places.
        y: Y,
    }
}

choice! {
    /// An axis of space.
    pub enum SpaceAxis {
        /// Left and right change places.
        x: X,
        /// Front and back change places.
        y: Y,
        /// Top and bottom change places.
        z: Z,
    }
}

/// Angles about x, y and z, in this order, in radians.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Rotation(pub [f64; 3]);

impl Decode for Rotation {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Rotation> {
        match tree.as_list() {
            None => Angle::decode(tree, cx).map(|angle| Rotation([0.0, 0.0, angle.0])),
            Some(items) if items.len() == 3 => match *cx.items::<Angle>(items)? {
                [x, y, z] => Some(Rotation([x.0, y.0, z.0])),
                _ => None,
            },
            Some(_) => cx.mismatch("an angle or three angles `[rx, ry, rz]`", tree),
        }
    }
}

impl JsonSchema for Rotation {
    fn schema_name() -> Cow<'static, str> {
        "Rotation".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        let angle = g.subschema_for::<Angle>();
        let three = json_schema!({ "type": "array", "items": angle, "minItems": 3, "maxItems": 3 });
        json_schema!({ "description": "An angle about z, or angles `[rx, ry, rz]` about x, then y, then z.", "anyOf": [angle, three] })
    }
}

/// Defines a factor for each of `N` axes.
macro_rules! factors {
    ($(#[doc = $doc:literal])* $name:ident($n:literal), $what:literal) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub [f64; $n]);

        impl Decode for $name {
            fn decode(tree: &Tree, cx: &mut Decoder) -> Option<$name> {
                match tree.as_list() {
                    None => Scale::decode(tree, cx).map(|scale| $name([scale.0; $n])),
                    Some(items) if items.len() == $n => {
                        let factors: Vec<Scale> = cx.items(items)?;
                        let mut out = [1.0; $n];
                        out.iter_mut().zip(factors).for_each(|(slot, factor)| *slot = factor.0);
                        Some($name(out))
                    }
                    Some(_) => cx.mismatch($what, tree),
                }
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(g: &mut SchemaGenerator) -> Schema {
                let factor = g.subschema_for::<Scale>();
                let each = json_schema!({ "type": "array", "items": factor, "minItems": $n, "maxItems": $n });
                let doc = super::record::prose(concat!($($doc, "\n"),*));
                json_schema!({ "description": doc, "anyOf": [factor, each] })
            }
        }
    };
}

factors!(
    /// A factor above 0, or one for each axis of the plane.
    PlaneScale(2), "a factor or two factors `[x, y]`"
);
factors!(
    /// A factor above 0, or one for each axis of space.
    SpaceScale(3), "a factor or three factors `[x, y, z]`"
);

/// Copies of a thing, the first one in its own place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Repeat {
    /// Each copy is turned by `angle` (radians, about the origin; about the z axis in space) more
    /// than the one before.
    Turn {
        /// How many there are.
        count: u32,
        /// From one to the next.
        angle: f64,
    },
    /// Each copy is moved by `step` from the one before.
    Row {
        /// How many there are.
        count: u32,
        /// From one to the next.
        step: [f64; 3],
    },
    /// A grid along the axes.
    Grid {
        /// How many there are along each axis.
        count: [u32; 3],
        /// From one to the next along each axis.
        step: [f64; 3],
    },
}

impl Repeat {
    /// The turn (radians, about the origin; about the z axis in space) and the step from the first copy to each,
    /// itself included. Grids go along x first.
    pub fn copies(&self) -> Vec<(f64, [f64; 3])> {
        match *self {
            Repeat::Turn { count, angle } => (0..count)
                .map(|i| (angle * f64::from(i), [0.0; 3]))
                .collect(),
            Repeat::Row { count, step } => (0..count)
                .map(|i| (0.0, step.map(|s| s * f64::from(i))))
                .collect(),
            Repeat::Grid {
                count: [columns, rows, floors],
                step: [x, y, z],
            } => {
                let cells = (0..floors).flat_map(|k| {
                    (0..rows).flat_map(move |j| (0..columns).map(move |i| [i, j, k]))
                });
                cells
                    .map(|cell| cell.map(f64::from))
                    .map(|[i, j, k]| (0.0, [x * i, y * j, z * k]))
                    .collect()
            }
        }
    }

    /// How many copies there are.
    pub fn count(&self) -> usize {
        match *self {
            Repeat::Turn { count, .. } | Repeat::Row { count, .. } => count as usize,
            Repeat::Grid { count, .. } => count.iter().map(|n| *n as usize).product(),
        }
    }

    /// The same without what stands upright on the drawing plane.
    pub fn flat(self) -> Repeat {
        match self {
            Repeat::Grid {
                count: [columns, rows, _],
                step,
            } => Repeat::Grid {
                count: [columns, rows, 1],
                step,
            },
            other => other,
        }
    }
}

/// More copies than this are refused.
pub const MAX_COPIES: u64 = 100_000;

record! {
    /// Copies of a thing: `{ count: 4, turn: 90 }` around the origin, `{ count: 4, step: [50, 0] }` in a row,
    /// `{ count: [3, 2], step: [50, 40] }` in a grid.
    pub struct RepeatForm {
        /// How many there are; a list of two or three, one for each axis, makes a grid.
        count: OneOrMany<Count>,
        /// The angle from one copy to the next, about the origin (about the z axis in space).
        turn: Option<Angle>,
        /// The step from one copy to the next; in a grid, the distances along the axes.
        step: Option<OneOrMany<Length>>,
    }
}

impl Decode for Repeat {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Repeat> {
        const HELP: &str = "write { count: 4, turn: 90 }, { count: 4, step: [50, 0] } or { count: [3, 2], step: [50, 40] }";
        let form = RepeatForm::decode(tree, cx)?;
        let total: u64 = form
            .count
            .iter()
            .map(|count| u64::from(count.0))
            .fold(1, u64::saturating_mul);
        if total > MAX_COPIES {
            return cx.error(format!("{total} copies are more than {MAX_COPIES}"));
        }
        let step = form
            .step
            .as_ref()
            .map(|step| step.iter().map(|length| length.0).collect::<Vec<f64>>());
        match (&*form.count, form.turn, step.as_deref()) {
            ([count], Some(angle), None) => Some(Repeat::Turn {
                count: count.0,
                angle: angle.0,
            }),
            ([count], None, Some(step)) if step.len() <= 3 => Some(Repeat::Row {
                count: count.0,
                step: filled(step, 0.0),
            }),
            (counts, None, Some(step)) if counts.len() == step.len() && counts.len() <= 3 => {
                let counts: Vec<u32> = counts.iter().map(|count| count.0).collect();
                Some(Repeat::Grid {
                    count: filled(&counts, 1),
                    step: filled(step, 0.0),
                })
            }
            (_, Some(_), Some(_)) => cx.error_with("`turn` and `step` exclude each other", HELP),
            (_, None, None) => cx.error_with("copies need `turn` or `step`", HELP),
            _ => cx.error_with("`count` and `step` do not fit together", HELP),
        }
    }
}

/// Copies in the plane: neither `count` nor `step` has a third axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PlaneRepeat(pub Repeat);

impl Decode for PlaneRepeat {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<PlaneRepeat> {
        let axes = |key| {
            tree.get(key)
                .and_then(Tree::as_list)
                .map_or(0, |items| items.len())
        };
        for key in ["count", "step"] {
            if axes(key) > 2 {
                let message = format!(
                    "copies in the plane have two axes, and `{key}` is a list of {}",
                    axes(key)
                );
                return cx.at(key, |cx| cx.error(message));
            }
        }
        Repeat::decode(tree, cx).map(PlaneRepeat)
    }
}

impl JsonSchema for PlaneRepeat {
    fn schema_name() -> Cow<'static, str> {
        Repeat::schema_name()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        Repeat::json_schema(g)
    }
}

/// `values` and then `rest`.
fn filled<T: Copy>(values: &[T], rest: T) -> [T; 3] {
    std::array::from_fn(|n| values.get(n).copied().unwrap_or(rest))
}

impl JsonSchema for Repeat {
    fn schema_name() -> Cow<'static, str> {
        "Repeat".into()
    }

    fn json_schema(g: &mut SchemaGenerator) -> Schema {
        RepeatForm::json_schema(g)
    }
}
