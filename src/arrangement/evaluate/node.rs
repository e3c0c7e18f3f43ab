//! What partitions, mapping and merging operators construct: functions from regions to curves.

use std::fmt;

use starlark::codemap::FileSpan;
use starlark::eval::Evaluator;
use starlark::values::Value;

use super::evaluation;
use super::place::Place;
use crate::{Border, IrregularProperties, StripesProperties};
use fretwork_geometry::Seed;
use fretwork_script::session::CurvesValue;
use fretwork_script::values::{Callable, CellKind, Operation};

/// An arrangement. Its operands, if it has any, are beside it in the [`Callable`].
#[derive(Debug)]
pub(crate) struct Node {
    pub what: What,
    /// Of the construction.
    pub seed: Seed,
    /// Where it was constructed.
    pub site: Option<FileSpan>,
}

/// Which arrangement. Operands of a map are the mapper and what it maps; those of a merge what is merged.
pub(crate) enum What {
    Stripes(StripesProperties),
    Grid(StripesProperties, StripesProperties, Border),
    Uniform(IrregularProperties, Border),
    Random(IrregularProperties, Border),
    Map(CellKind),
    Union,
    Inside(Border),
    Outside(Border),
}

impl fmt::Debug for What {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl What {
    /// The operator that makes it.
    pub fn name(&self) -> &'static str {
        match self {
            What::Stripes(_) => "stripes_partition",
            What::Grid(..) => "grid_partition",
            What::Uniform(..) => "uniform_partition",
            What::Random(..) => "random_partition",
            What::Map(CellKind::Vertex) => "map_to_vertices",
            What::Map(CellKind::Edge) => "map_to_edges",
            What::Map(CellKind::Face) => "map_to_faces",
            What::Union => "union",
            What::Inside(_) => "inside",
            What::Outside(_) => "outside",
        }
    }

    /// Which of `operands` are arrangements.
    pub fn inputs<'a, 'v>(&self, operands: &'a [Value<'v>]) -> &'a [Value<'v>] {
        let first = usize::from(matches!(self, What::Map(_)));
        operands.get(first..).unwrap_or_default()
    }
}

impl Node {
    /// The node that `value` is, with its operands.
    pub fn of<'v>(value: Value<'v>) -> Option<(&'v Node, &'v [Value<'v>])> {
        let callable = Callable::from_value(value)?;
        Some((callable.operation().downcast_ref()?, callable.operands()))
    }
}

impl Operation for Node {
    fn name(&self) -> &'static str {
        self.what.name()
    }

    fn call<'v>(
        &self,
        me: Value<'v>,
        argument: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Value<'v>> {
        let place = Place::of(argument, eval)?;
        let curves = evaluation::evaluate(me, &place, eval)?;
        Ok(eval.heap().alloc(CurvesValue(curves)))
    }
}
