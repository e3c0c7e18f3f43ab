//! Cells of planar maps, and regions that are no single face.

use std::fmt;
use std::sync::Arc;

use allocative::Allocative;
use starlark::any::ProvidesStaticType;
use starlark::collections::StarlarkHasher;
use starlark::starlark_simple_value;
use starlark::values::{NoSerialize, StarlarkPagablePanic, StarlarkValue, Value, ValueLike};
use starlark_derive::starlark_value;

use crate::watch::note_text;
use fretwork_geometry::Region;

/// Which cells a mapper is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellKind {
    /// Points.
    Vertex,
    /// Pieces of curves between vertices.
    Edge,
    /// Areas between edges.
    Face,
}

impl CellKind {
    /// `vertex`, `edge` or `face`.
    pub fn name(self) -> &'static str {
        match self {
            CellKind::Vertex => "vertex",
            CellKind::Edge => "edge",
            CellKind::Face => "face",
        }
    }
}

/// A cell of one of the session's planar maps. Two are equal when they are the same cell; a cell
/// does not outlive the evaluation.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    ProvidesStaticType,
    NoSerialize,
    StarlarkPagablePanic,
    Allocative,
)]
pub struct Cell {
    /// A vertex, an edge or a face.
    #[allocative(skip)]
    pub kind: CellKind,
    /// The number of the map in the session.
    pub map: u32,
    /// The number of the cell in the map.
    pub id: u32,
}

starlark_simple_value!(Cell);

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        note_text();
        write!(f, "<{} {}>", self.kind.name(), self.id)
    }
}

#[starlark_value(type = "cell")]
impl<'v> StarlarkValue<'v> for Cell {
    fn equals(&self, other: Value<'v>) -> starlark::Result<bool> {
        Ok(other.downcast_ref::<Self>() == Some(self))
    }

    fn write_hash(&self, hasher: &mut StarlarkHasher) -> starlark::Result<()> {
        std::hash::Hash::hash(self, hasher);
        Ok(())
    }
}

/// A region of several pieces, which is no face of a planar map.
#[derive(Clone, Debug, ProvidesStaticType, NoSerialize, StarlarkPagablePanic, Allocative)]
pub struct RegionValue(#[allocative(skip)] pub Arc<Region>);

starlark_simple_value!(RegionValue);

impl fmt::Display for RegionValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "<region of {} pieces>", self.0.area.len())
    }
}

#[starlark_value(type = "region")]
impl<'v> StarlarkValue<'v> for RegionValue {}
