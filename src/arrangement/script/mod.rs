//! Scripts that make element textures, and how what they make is evaluated on a region.
//!
//! The operators that a script calls (`operators`) only construct: a [`construction`] is a function
//! of regions with its operands beside it. `evaluation` applies one to a [`place`], from the root down
//! to the partitions; `memo` keeps what is used twice, `mapping` calls mappers, `parallel` does so on
//! all cores, and `seeds` says where randomness comes from. `apply` lets a script call a construction
//! itself. Callers see `program` and `argument`, and `reference` for people.

pub(crate) mod apply;
pub(crate) mod argument;
pub(crate) mod construction;
pub(crate) mod evaluation;
pub(crate) mod mapping;
pub(crate) mod memo;
pub(crate) mod operators;
pub(crate) mod parallel;
pub(crate) mod place;
pub(crate) mod program;
pub(crate) mod reference;
pub(crate) mod seeds;
pub(crate) mod structure;

#[cfg(test)]
pub(crate) mod tests;
