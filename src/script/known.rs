//! Planar maps of which only a part is known: what a mapper asks of a cell beyond that part is refused, and it is noted that
//! this happened, so that the caller can try again with a larger part.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::session::{Session, refuse};
use crate::values::cell::{Cell, CellKind};

/// Which cells of a planar map are as they are in the whole of which the map is a part.
#[derive(Debug, Default)]
pub struct KnownCells {
    /// By the number of the vertex.
    pub vertices: Vec<bool>,
    /// By the number of the edge.
    pub edges: Vec<bool>,
    /// By the number of the face. The unbounded face is known as a neighbour; what lies around it is not.
    pub faces: Vec<bool>,
    missed: AtomicBool,
}

impl KnownCells {
    /// No cell is asked for yet.
    pub fn new(vertices: Vec<bool>, edges: Vec<bool>, faces: Vec<bool>) -> KnownCells {
        KnownCells {
            vertices,
            edges,
            faces,
            missed: AtomicBool::new(false),
        }
    }

    /// Whether a cell is known.
    pub fn holds(&self, kind: CellKind, id: u32) -> bool {
        let known = match kind {
            CellKind::Vertex => &self.vertices,
            CellKind::Edge => &self.edges,
            CellKind::Face => &self.faces,
        };
        known.get(id as usize) == Some(&true)
    }

    /// Whether a cell was asked for that is not known.
    pub fn was_missed(&self) -> bool {
        self.missed.load(Ordering::Relaxed)
    }

    fn refuse(&self) -> starlark::Error {
        self.missed.store(true, Ordering::Relaxed);
        refuse("it asks for a cell of which only a part is known here")
    }
}

impl Session {
    /// The same, where the map that is mapped, the first one, is known in part.
    pub fn knowing(mut self, known: Option<Arc<KnownCells>>) -> Session {
        self.known = known;
        self
    }

    /// Refuses a cell that is not known.
    ///
    /// # Errors
    /// When only a part of the map is known, and the cell does not lie in it.
    pub fn know(&self, cell: Cell) -> starlark::Result<()> {
        match &self.known {
            Some(known) if cell.map == 0 && !known.holds(cell.kind, cell.id) => Err(known.refuse()),
            _ => Ok(()),
        }
    }

    /// Refuses to hand out cells of the map that `of` is in where one of them is not known.
    ///
    /// # Errors
    /// When that is so.
    pub fn know_all(
        &self,
        of: Cell,
        kind: CellKind,
        mut ids: impl Iterator<Item = u32>,
    ) -> starlark::Result<()> {
        match &self.known {
            Some(known) if of.map == 0 && !ids.all(|id| known.holds(kind, id)) => {
                Err(known.refuse())
            }
            _ => Ok(()),
        }
    }

    /// Refuses to tell what lies around the unbounded face where only a part of the map is known.
    ///
    /// # Errors
    /// When that is so.
    pub fn know_around(&self, cell: Cell) -> starlark::Result<()> {
        match &self.known {
            Some(known) if cell.map == 0 && cell.kind == CellKind::Face && cell.id == 0 => {
                Err(known.refuse())
            }
            _ => Ok(()),
        }
    }
}
