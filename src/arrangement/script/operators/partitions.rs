//! Partition operators (table 3.2).

use std::sync::Arc;

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::Value;

use crate::script::construction::{Construction, Operator};
use crate::script::operators::arguments::border;
use crate::script::operators::properties::{irregular_of, stripes_of};
use crate::script::seeds::settled;
use fretwork_geometry::Seed;
use fretwork_script::scope::Scope;
use fretwork_script::session::session;
use fretwork_script::values::Callable;

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
}

/// The arrangement that `what` makes of `operands`, with the next seed.
pub(crate) fn construct<'v>(
    what: Operator,
    operands: Vec<Value<'v>>,
    eval: &Evaluator<'v, '_, '_>,
) -> starlark::Result<Value<'v>> {
    let seed = settled(session(eval), Scope::construct)?;
    Ok(unseeded(what, operands, seed, eval))
}

/// The arrangement that `what` makes of `operands`.
pub(crate) fn unseeded<'v>(
    what: Operator,
    operands: Vec<Value<'v>>,
    seed: Seed,
    eval: &Evaluator<'v, '_, '_>,
) -> Value<'v> {
    let site = eval.call_stack_top_location();
    eval.heap().alloc(Callable::new(
        Arc::new(Construction { what, seed, site }),
        operands,
    ))
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    fn stripes_partition<'v>(
        properties: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let what = Operator::Stripes(stripes_of(properties, "stripes_partition")?);
        construct(what, Vec::new(), eval)
    }

    fn grid_partition<'v>(
        across: Value<'v>,
        along: Value<'v>,
        border: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let operator = "grid_partition";
        let what = Operator::Grid(
            stripes_of(across, operator)?,
            stripes_of(along, operator)?,
            self::border(border)?,
        );
        construct(what, Vec::new(), eval)
    }

    fn uniform_partition<'v>(
        properties: Value<'v>,
        border: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let what = Operator::Uniform(
            irregular_of(properties, "uniform_partition")?,
            self::border(border)?,
        );
        construct(what, Vec::new(), eval)
    }

    fn random_partition<'v>(
        properties: Value<'v>,
        border: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let what = Operator::Random(
            irregular_of(properties, "random_partition")?,
            self::border(border)?,
        );
        construct(what, Vec::new(), eval)
    }
}
