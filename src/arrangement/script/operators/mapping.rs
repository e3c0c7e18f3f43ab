//! Mapping operators (table 3.3).

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::Value;

use crate::script::construction::Operator;
use crate::script::operators::arguments::function;
use crate::script::operators::partitions::construct;
use fretwork_script::values::CellKind;

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
}

fn map<'v>(
    kind: CellKind,
    mapper: Value<'v>,
    arrangement: Value<'v>,
    eval: &Evaluator<'v, '_, '_>,
) -> starlark::Result<Value<'v>> {
    let what = Operator::Map(kind);
    let mapper = function(mapper, what.name(), "a mapper and an arrangement")?;
    let arrangement = function(arrangement, what.name(), "a mapper and an arrangement")?;
    construct(what, vec![mapper, arrangement], eval)
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    /// The arrangement of what `mapper`, a function of one vertex that gives curves, makes of every vertex of `arrangement`.
    ///
    /// Fails where the mapper does.
    ///
    /// Example: `dots = map_to_vertices(lambda v: match_point(dot, bbox_center(dot), location(v)), cells)`
    fn map_to_vertices<'v>(
        mapper: Value<'v>,
        arrangement: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        map(CellKind::Vertex, mapper, arrangement, eval)
    }

    /// The arrangement of what `mapper`, a function of one edge that gives curves, makes of every edge of `arrangement`.
    ///
    /// Fails where the mapper does.
    ///
    /// Example: `inner = map_to_edges(lambda e: nothing() if is_boundary(e) else to_curve(e), cells)`
    fn map_to_edges<'v>(
        mapper: Value<'v>,
        arrangement: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        map(CellKind::Edge, mapper, arrangement, eval)
    }

    /// The arrangement of what `mapper` makes of every bounded face of `arrangement`: a function of one face that gives curves, or an arrangement that is drawn in it.
    ///
    /// Fails where the mapper does.
    ///
    /// Example: `filled = map_to_faces(rows, cells)`
    fn map_to_faces<'v>(
        mapper: Value<'v>,
        arrangement: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        map(CellKind::Face, mapper, arrangement, eval)
    }
}
