//! The natives behind `rewrite`, and bounded forms of the standard functions that
//! would walk or build something large in one step.

use starlark::environment::{Globals, GlobalsBuilder};
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::dict::DictRef;
use starlark::values::list::ListRef;
use starlark::values::tuple::{TupleRef, UnpackTuple};
use starlark::values::{Value, none::NoneType};
use std::sync::LazyLock;

use super::Exhausted;
use crate::session::session;
use crate::values::{BoundedMethod, BoundedStandard};

type Outcome<'v> = starlark::Result<Value<'v>>;

/// Values smaller than this are not counted: between two looks of the interpreter at its heap they
/// cannot add up to much.
const SMALL: usize = 256;
/// What may be measured, rendered or compared at once.
pub(super) const LARGE: usize = 1 << 20;
/// How deeply lists may be nested in one another where they are rendered or compared: the interpreter
/// recurses there.
const DEPTH: usize = 500;

/// Puts the bounded forms among the globals, in place of standard functions of the same name.
pub(crate) fn register(builder: &mut GlobalsBuilder) {
    guards(builder);
    comparisons(builder);
    augmented(builder);
    functions(builder);
    super::range::register(builder);
    for (name, function) in STANDARD.iter() {
        if let Some(name) = BOUNDED.iter().find(|bounded| **bounded == name) {
            builder.set(name, BoundedStandard { name, function });
        }
    }
    for name in ABSENT {
        builder.set(name, NoneType);
    }
}

static STANDARD: LazyLock<Globals> = LazyLock::new(Globals::standard);

/// Standard functions that are charged for the sizes of their arguments.
const BOUNDED: [&str; 20] = [
    "abs",
    "all",
    "any",
    "bytes",
    "chr",
    "dict",
    "enumerate",
    "fail",
    "float",
    "hash",
    "int",
    "list",
    "max",
    "min",
    "ord",
    "reversed",
    "set",
    "sorted",
    "tuple",
    "zip",
];

/// Standard functions with which a method could be reached unbounded.
const ABSENT: [&str; 2] = ["getattr", "dir"];

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
fn measure(value: Value<'_>) -> Result<usize, Exhausted> {
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
fn charge(eval: &Evaluator<'_, '_, '_>, elements: usize) -> Result<(), Exhausted> {
    if elements <= SMALL {
        Ok(())
    } else {
        session(eval)
            .budget()
            .grow(elements, eval.heap().allocated_bytes())
    }
}

/// Whether both are plain numbers, which is by far the most common case.
fn numbers(a: Value<'_>, b: Value<'_>) -> bool {
    let number = |v: Value<'_>| v.unpack_i32().is_some() || v.get_type() == "float";
    number(a) && number(b)
}

/// Refuses products of whole numbers that are large already.
fn check_product(a: Value<'_>, b: Value<'_>) -> starlark::Result<()> {
    let is_big =
        |v: Value<'_>| v.get_type() == "int" && v.unpack_i32().is_none() && i64_of(v).is_none();
    if is_big(a) || is_big(b) {
        return Err(starlark::Error::new_other(TooBig));
    }
    Ok(())
}

#[derive(Debug, thiserror::Error)]
#[error("a whole number beyond 64 bits cannot be multiplied or shifted")]
struct TooBig;

/// The whole number, where 64 bits hold it.
pub(crate) fn i64_of(value: Value<'_>) -> Option<i64> {
    use starlark::values::UnpackValue;
    i64::unpack_value(value).ok().flatten()
}

fn check_repetition(
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

fn check_percent(
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
fn check_comparison(
    a: Value<'_>,
    b: Value<'_>,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Result<()> {
    if size(a) > 0 && size(b) > 0 {
        charge(eval, measure(a)?.min(measure(b)?))?;
    }
    Ok(())
}

fn check_membership(
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

#[starlark_module]
fn guards(builder: &mut GlobalsBuilder) {
    fn _bounded<'v>(
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        charge(eval, size(value))?;
        Ok(value)
    }

    fn _bounded_tuple<'v>(
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        // A tuple of tuples is hashed as often as it is reached: towers of shared ones must stay small.
        let nested = TupleRef::from_value(value)
            .is_some_and(|t| t.iter().any(|v| TupleRef::from_value(v).is_some()));
        if nested {
            charge(eval, measure(value)?)?;
        }
        Ok(value)
    }

    fn _bounded_method<'v>(
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let kind = value.get_type();
        if !matches!(kind, "string" | "list" | "dict" | "set") {
            return Ok(value);
        }
        charge(eval, size(value))?;
        Ok(eval.heap().alloc(BoundedMethod::new(value)))
    }

    fn _bounded_add<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        if !numbers(a, b) {
            charge(eval, size(a).saturating_add(size(b)))?;
        }
        a.add(b, eval.heap())
    }

    fn _bounded_multiply<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        if !numbers(a, b) {
            check_repetition(a, b, eval)?;
        }
        a.mul(b, eval.heap())
    }

    fn _bounded_percent<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_percent(a, b, eval)?;
        a.percent(b, eval.heap())
    }

    fn _bounded_shift<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_product(a, b)?;
        a.left_shift(b, eval.heap())
    }

    fn _bounded_or<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        charge(eval, size(a).saturating_add(size(b)))?;
        a.bit_or(b, eval.heap())
    }
}

#[starlark_module]
fn comparisons(builder: &mut GlobalsBuilder) {
    fn _bounded_equal<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        a.equals(b)
    }

    fn _bounded_unequal<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(!a.equals(b)?)
    }

    fn _bounded_less<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_lt())
    }

    fn _bounded_at_most<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_le())
    }

    fn _bounded_greater<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_gt())
    }

    fn _bounded_at_least<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_comparison(a, b, eval)?;
        Ok(a.compare(b)?.is_ge())
    }

    fn _bounded_in<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_membership(a, b, eval)?;
        b.is_in(a)
    }

    fn _bounded_not_in<'v>(
        a: Value<'v>,
        b: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<bool> {
        check_membership(a, b, eval)?;
        Ok(!b.is_in(a)?)
    }
}

/// The right sides of augmented assignments: checked against the old value, and handed back.
#[starlark_module]
fn augmented(builder: &mut GlobalsBuilder) {
    fn _bounded_adding<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        if !numbers(old, new) {
            charge(eval, size(old).saturating_add(size(new)))?;
        }
        Ok(new)
    }

    fn _bounded_multiplying<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_repetition(old, new, eval)?;
        Ok(new)
    }

    fn _bounded_filling<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        check_percent(old, new, eval)?;
        Ok(new)
    }

    fn _bounded_shifting<'v>(old: Value<'v>, new: Value<'v>) -> starlark::Result<Value<'v>> {
        check_product(old, new)?;
        Ok(new)
    }

    fn _bounded_joining<'v>(
        old: Value<'v>,
        new: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        charge(eval, size(old).saturating_add(size(new)))?;
        Ok(new)
    }
}

#[starlark_module]
fn functions(builder: &mut GlobalsBuilder) {
    fn str<'v>(
        #[starlark(require = pos)] value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<String> {
        charge(eval, measure(value)?)?;
        Ok(value.to_str())
    }

    fn repr<'v>(
        #[starlark(require = pos)] value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<String> {
        charge(eval, measure(value)?)?;
        Ok(value.to_repr())
    }

    fn len<'v>(
        #[starlark(require = pos)] value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<i32> {
        if value.unpack_str().is_some() {
            charge(eval, size(value))?;
        }
        value.length()
    }

    fn sum<'v>(
        #[starlark(require = pos)] values: Value<'v>,
        #[starlark(require = pos)] start: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let mut total = start.unwrap_or_else(|| eval.heap().alloc(0));
        for value in values.iterate(eval.heap())? {
            charge(eval, size(total).saturating_add(size(value)))?;
            total = total.add(value, eval.heap())?;
        }
        Ok(total)
    }

    fn print<'v>(#[starlark(args)] values: UnpackTuple<Value<'v>>) -> starlark::Result<NoneType> {
        // A script's only way out is its result.
        let _ = values;
        Ok(NoneType)
    }
}

/// Calls the method `name` of `receiver` once its result is known to be of bearable size.
pub(crate) fn call_method<'v>(
    receiver: Value<'v>,
    name: &str,
    positional: &[Value<'v>],
    named: &[(&str, Value<'v>)],
    eval: &mut Evaluator<'v, '_, '_>,
) -> Outcome<'v> {
    let own = size(receiver);
    let all = || positional.iter().copied().chain(named.iter().map(|n| n.1));
    let grown = match name {
        "join" => {
            let items = all().next().map_or(Ok(0), measure)?;
            let count = all().next().map_or(0, size);
            items.saturating_add(own.saturating_mul(count))
        }
        "replace" => {
            let old = positional.first().map_or(0, |v| size(*v)).max(1);
            let new = positional.get(1).map_or(0, |v| size(*v));
            own.saturating_add((own / old + 1).saturating_mul(new))
        }
        "format" => {
            let places = receiver
                .unpack_str()
                .map_or(0, |text| text.matches('{').count());
            let mut arguments = 0_usize;
            for value in all() {
                arguments = arguments.saturating_add(measure(value)?);
            }
            own.saturating_add(places.saturating_mul(arguments))
        }
        _ => {
            // What a method refuses is rendered in the message.
            let is_rendered = receiver.unpack_str().is_some() || matches!(name, "insert" | "pop");
            let of = |value| {
                if is_rendered {
                    measure(value)
                } else {
                    Ok(size(value))
                }
            };
            all().try_fold(own, |sum, value| {
                Ok::<_, Exhausted>(sum.saturating_add(of(value)?))
            })?
        }
    };
    charge(eval, grown)?;
    let method = receiver.get_attr_error(name, eval.heap())?;
    eval.eval_function(method, positional, named)
}

/// Calls a standard function once its arguments are charged for.
pub(crate) fn call_standard<'v>(
    name: &str,
    function: Value<'v>,
    positional: &[Value<'v>],
    named: &[(&str, Value<'v>)],
    eval: &mut Evaluator<'v, '_, '_>,
) -> Outcome<'v> {
    for value in positional {
        let nested = ListRef::from_value(*value).is_some() && size(*value) > 0;
        // Sorting compares each element with some others; and a number is read digit by digit.
        let walks = match name {
            "sorted" if nested => 16 * measure(*value)?,
            "int" | "float" => measure(*value)?.saturating_mul(size(*value)),
            // What is refused is rendered in the message.
            "abs" | "bytes" | "chr" | "fail" | "hash" | "ord" => measure(*value)?,
            _ => size(*value),
        };
        charge(eval, walks)?;
    }
    eval.eval_function(function, positional, named)
}
