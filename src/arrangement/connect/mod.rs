//! Lines made into one sheet: `sheet` widens them and cuts them to a region, `bridges` finds the
//! shortest ways between the pieces.

pub(crate) mod bridges;
pub(crate) mod sheet;
