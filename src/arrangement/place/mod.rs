//! Elements at the cells of a planar map (`elements`), cells that are moved themselves
//! (`transform`), and the similarities that both use (`similarity`).

pub(crate) mod elements;
pub mod similarity;
pub(crate) mod transform;
