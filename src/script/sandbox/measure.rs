//! How large values are, and what that costs.

use starlark::eval::Evaluator;
use starlark::values::dict::DictRef;
use starlark::values::list::ListRef;
use starlark::values::tuple::TupleRef;
use starlark::values::{UnpackValue, Value};

use crate::sandbox::budget::Exhausted;
use crate::session::session;

/// Values smaller than this are not counted: between two looks of the interpreter at its heap they
/// cannot add up to much.
pub(crate) const SMALL: usize = 256;
/// What may be measured, rendered or compared at once.
pub(crate) const LARGE: usize = 1 << 20;
/// How deeply lists may be nested in one another where they are rendered or compared: the interpreter
/// recurses there.
pub(crate) const DEPTH: usize = 500;

impl From<Exhausted> for starlark::Error {
    fn from(e: Exhausted) -> starlark::Error {
        starlark::Error::new_other(e)
    }
}

/// How many elements or bytes `value` has itself.
pub(crate) fn size(value: Value<'_>) -> usize {
    if let Some(text) = value.unpack_str() {
        return text.len();
    }
    if let Some(list) = ListRef::from_value(value) {
        return list.len();
    }
    if let Some(tuple) = TupleRef::from_value(value) {
        return tuple.len();
    }
    if let Some(dict) = DictRef::from_value(value) {
        return dict.iter().len();
    }
    match value.get_type() {
        "range" | "set" | "bytes" => value.length().map_or(0, |n| n.max(0) as usize),
        _ => 0,
    }
}

/// How many elements and bytes `value` has with all that is in it, shared parts counted as often as
/// they occur; at most about [`LARGE`], beyond which it is an error, as is what is nested beyond [`DEPTH`].
pub(crate) fn measure(value: Value<'_>) -> Result<usize, Exhausted> {
    let mut open = vec![(value, 0)];
    let mut total = 0;
    while let Some((value, depth)) = open.pop() {
        if depth > DEPTH {
            return Err(Exhausted::Depth(DEPTH));
        }
        let within = |v| (v, depth + 1);
        total += size(value).max(1);
        if total > LARGE || open.len() > LARGE {
            return Err(Exhausted::Steps(LARGE as u64));
        }
        if let Some(list) = ListRef::from_value(value) {
            open.extend(list.iter().map(within));
        } else if let Some(tuple) = TupleRef::from_value(value) {
            open.extend(tuple.iter().map(within));
        } else if let Some(dict) = DictRef::from_value(value) {
            open.extend(dict.iter().flat_map(|(k, v)| [within(k), within(v)]));
        }
    }
    Ok(total)
}

/// Charges for one walk over `elements`.
pub(crate) fn charge(eval: &Evaluator<'_, '_, '_>, elements: usize) -> Result<(), Exhausted> {
    if elements <= SMALL {
        Ok(())
    } else {
        session(eval)
            .budget()
            .grow(elements, eval.heap().allocated_bytes())
    }
}

/// The whole number, where 64 bits hold it.
pub(crate) fn i64_of(value: Value<'_>) -> Option<i64> {
    i64::unpack_value(value).ok().flatten()
}
