//! What the name of a node stands for.

use std::sync::Arc;

use crate::function::Arrangement;
use fretwork_geometry::{Curves, Field};

/// What the name of a node stands for among a script's arguments.
pub enum Named {
    /// An element.
    Element(Arc<Curves>),
    /// A function of the plane.
    Field(Field),
    /// A function of regions.
    Arrangement(Arrangement),
}
