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
    /// The arrangement of stripes, cut by the region, with its contour.
    ///
    /// Fails where lines would be as near as the resolution of the planar map.
    ///
    /// Example: `rows = stripes_partition(stripes_properties(0, 10))`
    fn stripes_partition<'v>(
        properties: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let what = Operator::Stripes(stripes_of(properties, "stripes_partition")?);
        construct(what, Vec::new(), eval)
    }

    /// The arrangement of the cells between two families of stripes. `border` is one of CROP (what holds without it), CROP_ADD_BOUNDARY, KEEP_INSIDE, KEEP_OUTSIDE.
    ///
    /// Fails where the families are parallel.
    ///
    /// Example: `wall = grid_partition(stripes_properties(0, 10), stripes_properties(pi / 2, 20), KEEP_INSIDE)`
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

    /// The arrangement of the cells around random points that keep their distance (Poisson disks). `border` as for `grid_partition`.
    ///
    /// Fails on a tile that is too small for its points.
    ///
    /// Example: `cells = uniform_partition(irregular_properties(0.002))`
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

    /// The arrangement of the cells around independent random points (a Poisson process). `border` as for `grid_partition`.
    ///
    /// Fails on a tile that is too small for its points.
    ///
    /// Example: `shards = random_partition(irregular_properties(0.002), CROP)`
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
