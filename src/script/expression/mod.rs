//! `${…}`: expressions of Starlark. `evaluate` gives their values, `names` says what they read,
//! `error` what is wrong with one.

pub(crate) mod error;
pub(crate) mod evaluate;
pub(crate) mod names;

pub use error::ExpressionError;
pub use evaluate::{evaluate, evaluate_with, free_names};
