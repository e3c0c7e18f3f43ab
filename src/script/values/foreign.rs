//! Values whose content another room defines: properties, and functions made of other values.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use allocative::Allocative;
use starlark::any::ProvidesStaticType;
use starlark::coerce::Coerce;
use starlark::eval::{Arguments, Evaluator};
use starlark::values::{
    Freeze, FreezeResult, Freezer, NoSerialize, StarlarkPagablePanic, StarlarkValue, Trace, Value,
    ValueLike,
};
use starlark::{starlark_complex_value, starlark_simple_value};
use starlark_derive::starlark_value;

/// The content of a [`Properties`] value. It may be changed from within until the value is frozen.
pub trait Content: Any + fmt::Debug + Send + Sync {
    /// What it is, in a word or two.
    fn kind(&self) -> &'static str;
}

/// A record that scripts hand from function to function.
#[derive(Clone, Debug, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative)]
pub struct Properties(#[allocative(skip)] pub Arc<dyn Content>);

starlark_simple_value!(Properties);

impl fmt::Display for Properties {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<{}>", self.0.kind())
    }
}

#[starlark_value(type = "properties")]
impl<'v> StarlarkValue<'v> for Properties {}

/// What a [`Callable`] does; the values it was made of are handed to it.
pub trait Operation: Any + fmt::Debug + Send + Sync {
    /// What it is called in messages.
    fn name(&self) -> &'static str;

    /// The value at `argument`; `me` is the callable itself.
    fn call<'v>(
        &self,
        me: Value<'v>,
        argument: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>>;
}

type Shared = Arc<dyn Operation>;

/// A function of one argument, made by Rust of other values: an arrangement, a field.
#[derive(
    Debug, Trace, Coerce, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative,
)]
#[repr(C)]
pub struct CallableGen<V> {
    #[allocative(skip)]
    #[trace(unsafe_ignore)]
    operation: Shared,
    operands: Vec<V>,
}

starlark_complex_value!(pub Callable);

impl<'v> Callable<'v> {
    /// `operation` on `operands`.
    pub fn new(operation: Arc<dyn Operation>, operands: Vec<Value<'v>>) -> Callable<'v> {
        CallableGen {
            operation,
            operands,
        }
    }

    /// What it does.
    pub fn operation(&self) -> &dyn Any {
        &*self.operation
    }

    /// What it was made of.
    pub fn operands(&self) -> &[Value<'v>] {
        &self.operands
    }
}

impl<'v> Freeze for Callable<'v> {
    type Frozen = FrozenCallable;
    fn freeze(self, freezer: &Freezer) -> FreezeResult<Self::Frozen> {
        let operands = self
            .operands
            .into_iter()
            .map(|v| v.freeze(freezer))
            .collect::<Result<_, _>>()?;
        Ok(CallableGen {
            operation: self.operation,
            operands,
        })
    }
}

impl<V> fmt::Display for CallableGen<V> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<{}>", self.operation.name())
    }
}

#[starlark_value(type = "function")]
impl<'v, V: ValueLike<'v>> StarlarkValue<'v> for CallableGen<V>
where
    Self: ProvidesStaticType<'v>,
{
    fn name_for_call_stack(&self, _me: Value<'v>) -> String {
        self.operation.name().to_owned()
    }

    fn invoke(
        &self,
        me: Value<'v>,
        args: &Arguments<'v, '_>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        args.no_named_args()?;
        let argument = args.positional1(eval.heap())?;
        self.operation.call(me, argument, eval)
    }
}
