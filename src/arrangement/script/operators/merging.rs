//! Merging operators (table 3.5). They are no constructions: nothing in them is random.

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::Value;
use starlark::values::tuple::UnpackTuple;

use crate::script::construction::Operator;
use crate::script::operators::arguments::{border, flat, function};
use crate::script::operators::partitions::unseeded;
use fretwork_geometry::Seed;
use fretwork_script::session::refuse;

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
}

fn merge<'v>(
    what: Operator,
    operands: Vec<Value<'v>>,
    eval: &Evaluator<'v, '_, '_>,
) -> starlark::Result<Value<'v>> {
    for operand in &operands {
        function(*operand, what.name(), "arrangements")?;
    }
    Ok(unseeded(what, operands, Seed::root(0), eval))
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    /// The arrangement of the curves of all of these, in order.
    ///
    /// Fails without an arrangement.
    ///
    /// Example: `both = union(rows, cells)`
    fn union<'v>(
        #[starlark(args)] arrangements: UnpackTuple<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let operands = flat(&arrangements.items);
        if operands.is_empty() {
            return Err(refuse("`union` takes arrangements, none given"));
        }
        merge(Operator::Union, operands, eval)
    }

    /// The arrangement of what of `input` lies inside of the faces of `mask`. `border` as for `grid_partition`, about those faces.
    ///
    /// Fails where one of the two does.
    ///
    /// Example: `inner = inside(rows, blobs, CROP_ADD_BOUNDARY)`
    fn inside<'v>(
        input: Value<'v>,
        mask: Value<'v>,
        border: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        merge(
            Operator::Inside(self::border(border)?),
            vec![input, mask],
            eval,
        )
    }

    /// The arrangement of what of `input` lies outside of the faces of `mask`. `border` as for `grid_partition`, about those faces.
    ///
    /// Fails where one of the two does.
    ///
    /// Example: `outer = outside(rows, blobs)`
    fn outside<'v>(
        input: Value<'v>,
        mask: Value<'v>,
        border: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        merge(
            Operator::Outside(self::border(border)?),
            vec![input, mask],
            eval,
        )
    }
}
