//! Stand-ins that charge the budget before they pass a call on.

use std::fmt;

use allocative::Allocative;
use starlark::any::ProvidesStaticType;
use starlark::coerce::Coerce;
use starlark::eval::{Arguments, Evaluator};
use starlark::values::{
    Freeze, FreezeResult, Freezer, FrozenValue, Heap, NoSerialize, StarlarkPagable,
    StarlarkPagablePanic, StarlarkValue, Trace, Value, ValueLike,
};
use starlark::{starlark_complex_value, starlark_simple_value};
use starlark_derive::starlark_value;

use crate::sandbox::calls::{call_method, call_standard};

/// A text, list or dictionary whose next attribute is a method to be called within the budget.
#[derive(Debug, Trace, Coerce, ProvidesStaticType, NoSerialize, StarlarkPagable, Allocative)]
#[repr(C)]
pub(crate) struct BoundedMethodGen<V> {
    receiver: V,
    /// The name of the method, once it is known; before, None.
    name: V,
}

starlark_complex_value!(pub(in crate) BoundedMethod);

impl<'v> BoundedMethod<'v> {
    /// The methods of `receiver`.
    pub(crate) fn new(receiver: Value<'v>) -> BoundedMethod<'v> {
        BoundedMethodGen {
            receiver,
            name: Value::new_none(),
        }
    }
}

impl<'v> Freeze for BoundedMethod<'v> {
    type Frozen = FrozenBoundedMethod;
    fn freeze(self, freezer: &Freezer) -> FreezeResult<Self::Frozen> {
        Ok(BoundedMethodGen {
            receiver: self.receiver.freeze(freezer)?,
            name: self.name.freeze(freezer)?,
        })
    }
}

impl<V: fmt::Display> fmt::Display for BoundedMethodGen<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<method {}>", self.name)
    }
}

#[starlark_value(type = "method")]
impl<'v, V: ValueLike<'v>> StarlarkValue<'v> for BoundedMethodGen<V>
where
    Self: ProvidesStaticType<'v>,
{
    fn get_attr(&self, attribute: &str, heap: Heap<'v>) -> Option<Value<'v>> {
        let receiver = self.receiver.to_value();
        let name = heap.alloc_str(attribute).to_value();
        receiver
            .has_attr(attribute, heap)
            .then(|| heap.alloc(BoundedMethodGen { receiver, name }))
    }

    fn dir_attr(&self) -> Vec<String> {
        self.receiver.to_value().dir_attr()
    }

    fn invoke(
        &self,
        _me: Value<'v>,
        args: &Arguments<'v, '_>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let name = self.name.to_value().unpack_str().unwrap_or_default();
        with_arguments(args, eval, |positional, named, eval| {
            call_method(self.receiver.to_value(), name, positional, named, eval)
        })
    }
}

/// A standard function that is charged for the sizes of its arguments.
#[derive(Debug, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative)]
pub(crate) struct BoundedStandard {
    pub(crate) name: &'static str,
    /// Owned by the standard globals, which are never dropped.
    #[allocative(skip)]
    pub(crate) function: FrozenValue,
}

starlark_simple_value!(BoundedStandard);

impl fmt::Display for BoundedStandard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<function {}>", self.name)
    }
}

#[starlark_value(type = "function")]
impl<'v> StarlarkValue<'v> for BoundedStandard {
    fn name_for_call_stack(&self, _me: Value<'v>) -> String {
        self.name.to_owned()
    }

    fn invoke(
        &self,
        _me: Value<'v>,
        args: &Arguments<'v, '_>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        with_arguments(args, eval, |positional, named, eval| {
            call_standard(self.name, self.function.to_value(), positional, named, eval)
        })
    }
}

/// Hands on the arguments as slices.
fn with_arguments<'v>(
    args: &Arguments<'v, '_>,
    eval: &mut Evaluator<'v, '_, '_>,
    call: impl FnOnce(
        &[Value<'v>],
        &[(&str, Value<'v>)],
        &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>>,
) -> starlark::Result<Value<'v>> {
    let positional: Vec<Value<'v>> = args.positions(eval.heap())?.collect();
    let names = args.names_map()?;
    let named: Vec<(&str, Value<'v>)> = names
        .iter()
        .map(|(name, value)| (name.as_str(), *value))
        .collect();
    call(&positional, &named, eval)
}
