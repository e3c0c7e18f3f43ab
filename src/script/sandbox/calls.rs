//! Calls of methods and standard functions whose cost depends on their arguments.

use starlark::eval::Evaluator;
use starlark::values::Value;
use starlark::values::list::ListRef;

use crate::sandbox::budget::Exhausted;
use crate::sandbox::measure::{charge, measure, size};

type Outcome<'v> = starlark::Result<Value<'v>>;

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
