//! Embedded Starlark: expressions of specs, and the values, budgets and diagnostics of scripts.
//! Operators of arrangements are not here; they live with what they operate on and are put among
//! the globals by their room.

mod convert;
pub mod expression;
pub mod fault;
mod formula;
mod guard;
mod label_cache;
mod language;
mod library;
pub mod loaded;
mod mathematics;
mod names;
pub mod scope;
pub mod session;
mod value;
pub mod values;

pub use expression::{ExpressionError, evaluate, free_names};
pub use formula::ScalarExpression;
pub use guard::Limits;
pub use language::register;
pub use library::Host;
pub use value::Value;
pub use values::CellKind;
