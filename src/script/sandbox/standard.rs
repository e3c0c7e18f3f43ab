//! Bounded forms of the standard functions that would walk or build something large in one step.

use std::sync::LazyLock;

use starlark::environment::{Globals, GlobalsBuilder};
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::tuple::UnpackTuple;
use starlark::values::{Value, none::NoneType};

use crate::sandbox::measure::{charge, measure, size};
use crate::sandbox::{natives, range};
use crate::values::bounded::BoundedStandard;

/// Puts the bounded forms among the globals, in place of standard functions of the same name.
pub(crate) fn register(builder: &mut GlobalsBuilder) {
    natives::register(builder);
    functions(builder);
    range::register(builder);
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
