//! Plain values to the interpreter's and back.

use starlark::values::dict::{AllocDict, DictRef};
use starlark::values::list::{AllocList, ListRef};
use starlark::values::tuple::TupleRef;
use starlark::values::{Heap, Value as Script};

use crate::mathematics::Number;
use crate::value::Value;
use crate::values::function::number;

/// How many elements a value that leaves a script may have, in all its lists together.
const ELEMENTS: usize = 1 << 20;

/// `value` on `heap`.
pub(crate) fn to_script<'v>(value: &Value, heap: Heap<'v>) -> Script<'v> {
    match value {
        Value::None => Script::new_none(),
        Value::Bool(b) => Script::new_bool(*b),
        Value::Int(i) => heap.alloc(*i),
        Value::Float(f) => heap.alloc(*f),
        Value::Text(text) => heap.alloc_str(text).to_value(),
        Value::List(items) => heap.alloc(AllocList(items.iter().map(|item| to_script(item, heap)))),
        Value::Dict(items) => heap.alloc(AllocDict(
            items
                .iter()
                .map(|(k, v)| (to_script(k, heap), to_script(v, heap))),
        )),
    }
}

/// Why a value cannot leave a script.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum ConvertError {
    #[error("the value is {0}, which is not a usable number")]
    NotFinite(f64),
    #[error("the value is a whole number beyond 64 bits")]
    TooBig,
    #[error("the value has more than {ELEMENTS} elements")]
    TooLarge,
    #[error("the value is a {0}, not a number, text, truth value, list or dictionary")]
    Kind(String),
}

/// The plain value of `value`.
pub(crate) fn from_script(value: Script<'_>) -> Result<Value, ConvertError> {
    plain(value, &mut { ELEMENTS }, 100)
}

fn plain(value: Script<'_>, left: &mut usize, depth: usize) -> Result<Value, ConvertError> {
    *left = left.checked_sub(1).ok_or(ConvertError::TooLarge)?;
    let depth = depth.checked_sub(1).ok_or(ConvertError::TooLarge)?;
    if value.is_none() {
        return Ok(Value::None);
    }
    if let Some(b) = value.unpack_bool() {
        return Ok(Value::Bool(b));
    }
    if let Some(text) = value.unpack_str() {
        return Ok(Value::Text(text.into()));
    }
    if let Some(number) = number(value) {
        return match number {
            Number::Int(i) => Ok(Value::Int(i)),
            Number::Float(_) if value.get_type() == "int" => Err(ConvertError::TooBig),
            Number::Float(f) if f.is_finite() => Ok(Value::Float(f)),
            Number::Float(f) => Err(ConvertError::NotFinite(f)),
        };
    }
    let items = ListRef::from_value(value).map(|list| list.content());
    if let Some(items) = items.or_else(|| TupleRef::from_value(value).map(|tuple| tuple.content()))
    {
        return items
            .iter()
            .map(|item| plain(*item, left, depth))
            .collect::<Result<_, _>>()
            .map(Value::List);
    }
    if let Some(dict) = DictRef::from_value(value) {
        let items = dict
            .iter()
            .map(|(k, v)| Ok((plain(k, left, depth)?, plain(v, left, depth)?)));
        return items.collect::<Result<_, _>>().map(Value::Dict);
    }
    Err(ConvertError::Kind(value.get_type().to_owned()))
}
