//! Scripts that make element textures, and how what they make is evaluated on a region. `node` is
//! what an operator constructs, `place` what it is applied to, `evaluation` the walk over the nodes
//! with `memo` of what is used twice, `mapping` the calls of mappers, `parallel` the same on all
//! cores, `seeds` where randomness
//! comes from, `script` and `argument` what callers see. The operators themselves are in
//! [`operators`](super::operators).

mod argument;
mod evaluation;
mod mapping;
mod memo;
mod node;
mod parallel;
mod place;
mod script;
mod seeds;

pub use argument::Argument;
pub(super) use argument::Scalar;
pub use script::{Mapper, Script, ScriptArrangement};

pub(super) use node::{Node, What};
pub(super) use seeds::{cell_seed, plain, settled};

#[cfg(test)]
mod tests;
