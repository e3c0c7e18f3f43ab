//! Charges for operators before they run: each check looks at the sizes of the operands and refuses
//! what would grow or walk too much.

use starlark::eval::Evaluator;
use starlark::values::Value;
use starlark::values::dict::DictRef;

use crate::sandbox::measure::{charge, i64_of, measure, size};

/// Whether both are plain numbers, which is by far the most common case.
pub(crate) fn numbers(a: Value<'_>, b: Value<'_>) -> bool {
    let number = |v: Value<'_>| v.unpack_i32().is_some() || v.get_type() == "float";
    number(a) && number(b)
}

/// Refuses products of whole numbers that are large already.
pub(crate) fn check_product(a: Value<'_>, b: Value<'_>) -> starlark::Result<()> {
    let is_big =
        |v: Value<'_>| v.get_type() == "int" && v.unpack_i32().is_none() && i64_of(v).is_none();
    if is_big(a) || is_big(b) {
        return Err(starlark::Error::new_other(TooBig));
    }
    Ok(())
}

#[derive(Debug, thiserror::Error)]
#[error("a whole number beyond 64 bits cannot be multiplied or shifted")]
pub(crate) struct TooBig;

pub(crate) fn check_repetition(
    a: Value<'_>,
    b: Value<'_>,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<()> {
    let times = |v: Value<'_>| i64_of(v).map_or(1, |n| n.max(1) as usize);
    let (left, right) = (size(a), size(b));
    if left > 0 || right > 0 {
        charge(
            eval,
            left.saturating_mul(times(b))
                .max(right.saturating_mul(times(a))),
        )?;
        return Ok(());
    }
    check_product(a, b)
}

pub(crate) fn check_percent(
    format: Value<'_>,
    args: Value<'_>,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<()> {
    if let Some(text) = format.unpack_str() {
        let places = text.matches('%').count().max(1);
        charge(
            eval,
            text.len()
                .saturating_add(measure(args)?.saturating_mul(places)),
        )?;
    }
    Ok(())
}

/// Charges for comparing `a` with `b`.
pub(crate) fn check_comparison(
    a: Value<'_>,
    b: Value<'_>,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<()> {
    if size(a) > 0 && size(b) > 0 {
        charge(eval, measure(a)?.min(measure(b)?))?;
    }
    Ok(())
}

pub(crate) fn check_membership(
    item: Value<'_>,
    of: Value<'_>,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<()> {
    let walked = if DictRef::from_value(of).is_some() {
        1
    } else {
        size(of)
    };
    let each = if size(item) > 0 && item.unpack_str().is_none() {
        measure(item)?
    } else {
        1
    };
    Ok(charge(eval, walked.saturating_mul(each))?)
}
