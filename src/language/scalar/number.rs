//! Plain numbers and counts.

use serde_json::json;

use super::super::{Decode, Decoder, Tree};
use super::number_schema;

/// Defines a number without unit, within limits.
macro_rules! number {
    ($(#[doc = $doc:literal])* $name:ident, $what:literal, $test:expr, $limits:expr) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd, serde::Serialize, serde::Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub f64);

        impl Decode for $name {
            fn decode(tree: &Tree, cx: &mut Decoder) -> Option<$name> {
                let value = finite(tree, $what, cx)?;
                let fits: fn(f64) -> bool = $test;
                if fits(value) { Some($name(value)) } else { cx.error(format!("expected {}, found {value}", $what)) }
            }
        }

        impl schemars::JsonSchema for $name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                number_schema("number", concat!($($doc, "\n"),*), None, &$limits)
            }
        }
    };
}

number!(
    /// A number.
    Number, "a number", |_| true, []
);
number!(
    /// A number above 0.
    PositiveNumber, "a number above 0", |x| x > 0.0, [("exclusiveMinimum", json!(0))]
);
number!(
    /// A number, 0 or above.
    NonNegativeNumber, "a number that is not below 0", |x| x >= 0.0, [("minimum", json!(0))]
);

/// Defines a whole number within limits.
macro_rules! whole {
    ($(#[doc = $doc:literal])* $name:ident($ty:ty), $what:literal, $limits:expr) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub $ty);

        impl Decode for $name {
            fn decode(tree: &Tree, cx: &mut Decoder) -> Option<$name> {
                let (low, high): (i64, i64) = $limits;
                let value = integer(tree, $what, cx)?;
                if (low..=high).contains(&value) {
                    return <$ty>::try_from(value).ok().map($name);
                }
                cx.error(format!("expected {}, found {value}", $what))
            }
        }

        impl schemars::JsonSchema for $name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let (low, high): (i64, i64) = $limits;
                let low = if low == i64::MIN { None } else { Some(("minimum", json!(low))) };
                let high = if high == i64::MAX { None } else { Some(("maximum", json!(high))) };
                let limits: Vec<_> = low.into_iter().chain(high).collect();
                number_schema("integer", concat!($($doc, "\n"),*), None, &limits)
            }
        }
    };
}

whole!(
    /// A whole number.
    Integer(i64), "a whole number", (i64::MIN, i64::MAX)
);
whole!(
    /// A whole number, 1 or above.
    Count(u32), "a whole number of at least 1", (1, u32::MAX as i64)
);
whole!(
    /// A whole number, 0 or above.
    Natural(u32), "a whole number that is not below 0", (0, u32::MAX as i64)
);

/// The number that `tree` is, which must be finite.
pub(super) fn finite(tree: &Tree, what: &str, cx: &mut Decoder) -> Option<f64> {
    match tree.as_number() {
        Some(value) if value.is_finite() => Some(value + 0.0),
        Some(value) => cx.error(format!("expected a finite number, found {value}")),
        None => cx.mismatch(what, tree),
    }
}

/// The whole number that `tree` is; also one that division has made a float.
fn integer(tree: &Tree, what: &str, cx: &mut Decoder) -> Option<i64> {
    match tree.plain() {
        Tree::Int(n) => Some(*n),
        Tree::Float(_) => {
            let value = finite(tree, what, cx)?;
            // Below 2^53 every whole float is the integer that it looks like.
            let whole = value == value.trunc() && value.abs() < 9e15;
            if whole {
                Some(value as i64)
            } else {
                cx.error(format!("expected {what}, found {value}"))
            }
        }
        _ => cx.mismatch(what, tree),
    }
}

impl Decode for bool {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<bool> {
        match tree.plain() {
            Tree::Bool(value) => Some(*value),
            _ => cx.mismatch("`true` or `false`", tree),
        }
    }

    fn field_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        number_schema("boolean", "`true` or `false`.", None, &[])
    }
}
