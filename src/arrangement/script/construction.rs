//! What partitions, mapping and merging operators construct: functions from regions to curves.

use std::fmt;

use starlark::codemap::FileSpan;
use starlark::values::Value;

use crate::border::Border;
use crate::partition::properties::StripesProperties;
use crate::random::properties::IrregularProperties;
use fretwork_geometry::Seed;
use fretwork_script::values::{Callable, CellKind};

/// An arrangement. Its operands, if it has any, are beside it in the [`Callable`].
#[derive(Debug)]
pub(crate) struct Construction {
    pub what: Operator,
    /// Of the construction.
    pub seed: Seed,
    /// Where it was constructed.
    pub site: Option<FileSpan>,
}

/// Which arrangement. Operands of a map are the mapper and what it maps; those of a merge what is merged.
pub(crate) enum Operator {
    Stripes(StripesProperties),
    Grid(StripesProperties, StripesProperties, Border),
    Uniform(IrregularProperties, Border),
    Random(IrregularProperties, Border),
    Map(CellKind),
    Union,
    Inside(Border),
    Outside(Border),
}

impl fmt::Debug for Operator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Operator {
    /// The operator that makes it.
    pub fn name(&self) -> &'static str {
        match self {
            Operator::Stripes(_) => "stripes_partition",
            Operator::Grid(..) => "grid_partition",
            Operator::Uniform(..) => "uniform_partition",
            Operator::Random(..) => "random_partition",
            Operator::Map(CellKind::Vertex) => "map_to_vertices",
            Operator::Map(CellKind::Edge) => "map_to_edges",
            Operator::Map(CellKind::Face) => "map_to_faces",
            Operator::Union => "union",
            Operator::Inside(_) => "inside",
            Operator::Outside(_) => "outside",
        }
    }

    /// Which of `operands` are arrangements.
    pub fn inputs<'a, 'v>(&self, operands: &'a [Value<'v>]) -> &'a [Value<'v>] {
        let first = usize::from(matches!(self, Operator::Map(_)));
        operands.get(first..).unwrap_or_default()
    }
}

impl Construction {
    /// The node that `value` is, with its operands.
    pub fn of<'v>(value: Value<'v>) -> Option<(&'v Construction, &'v [Value<'v>])> {
        let callable = Callable::from_value(value)?;
        Some((callable.operation().downcast_ref()?, callable.operands()))
    }
}
