//! Lines made into one sheet: `sheet` widens them and cuts them to a region, `bridges` finds the
//! shortest ways between the pieces, and `segment_tree` finds what is nearest.

pub(crate) mod bridges;
pub(crate) mod segment_tree;
pub(crate) mod sheet;
