//! A mathematical function as a value of a script.

use std::fmt;

use allocative::Allocative;
use starlark::any::ProvidesStaticType;
use starlark::eval::{Arguments, Evaluator};
use starlark::starlark_simple_value;
use starlark::values::{
    NoSerialize, StarlarkPagablePanic, StarlarkValue, UnpackValue, Value, ValueError,
};
use starlark_derive::starlark_value;

use crate::mathematics::{Function, Number};
use crate::sandbox::measure::i64_of;

/// A function of numbers.
#[derive(Debug, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative)]
pub(crate) struct MathFunction {
    #[allocative(skip)]
    pub(crate) function: Function,
}

starlark_simple_value!(MathFunction);

impl fmt::Display for MathFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<function {}>", self.function.name())
    }
}

#[starlark_value(type = "function")]
impl<'v> StarlarkValue<'v> for MathFunction {
    fn name_for_call_stack(&self, _me: Value<'v>) -> String {
        self.function.name().to_owned()
    }

    fn invoke(
        &self,
        _me: Value<'v>,
        args: &Arguments<'v, '_>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        args.no_named_args()?;
        let mut numbers = [Number::Int(0); 32];
        let mut count = 0;
        for value in args.positions(eval.heap())? {
            let number = number(value).ok_or_else(|| {
                starlark::Error::from(ValueError::IncorrectParameterTypeNamed(
                    self.function.name().to_owned(),
                ))
            });
            *numbers
                .get_mut(count)
                .ok_or_else(|| starlark::Error::new_other(TooMany))? = number?;
            count += 1;
        }
        match self
            .function
            .call(&numbers[..count])
            .map_err(starlark::Error::new_other)?
        {
            Number::Int(i) => Ok(eval.heap().alloc(i)),
            Number::Float(f) => Ok(eval.heap().alloc(f)),
        }
    }
}

#[derive(Debug, thiserror::Error)]
#[error("more than 32 arguments; give a list")]
struct TooMany;

/// The number that `value` is.
pub(crate) fn number(value: Value<'_>) -> Option<Number> {
    if let Some(i) = value.unpack_i32() {
        return Some(Number::Int(i.into()));
    }
    let float = starlark::values::float::UnpackFloat::unpack_value(value)
        .ok()
        .flatten()?;
    Some(
        i64_of(value)
            .filter(|_| value.get_type() == "int")
            .map_or(Number::Float(float.0), Number::Int),
    )
}
