//! Embedded Starlark: expressions of specs, and the values, budgets and diagnostics of scripts.
//! Operators of arrangements are not here; they live with what they operate on and are put among
//! the globals by their room.

mod convert;
pub mod expression;
mod fault;
mod formula;
mod guard;
mod language;
mod mathematics;
mod names;
mod session;
mod value;
mod values;

pub use expression::{ExpressionError, evaluate, free_names};
pub use formula::ScalarExpression;
pub use guard::Limits;
pub use value::Value;
