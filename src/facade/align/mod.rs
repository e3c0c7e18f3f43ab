//! The alignment of one group's words along one axis (section 5.2 of the paper): columns of entries
//! that differ in length as little as possible. Sizes are found afterwards, in `size`.
//!
//! `build_network` turns words into the rows of a network. Its nodes say how far each row is read,
//! and its arcs are columns. `successors` lists the columns that may follow a node, `lower_bound`
//! bounds what is still to pay after it, `dominance` drops the ways that another one makes useless,
//! and `search` finds the shortest path.

pub mod build_network;
pub mod dominance;
pub mod lower_bound;
pub mod network;
pub mod place;
pub mod row;
pub mod search;
pub mod successors;
