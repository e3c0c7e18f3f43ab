//! Embedded Starlark: expressions of specs, and the values, budgets and diagnostics of scripts.
//!
//! - [`evaluate()`] and [`free_names`] serve the `${…}` of a spec. Plain arithmetic takes a short cut through a small
//!   stack machine (`formula`), which [`ScalarExpression`] also runs for fields; all else, and every error
//!   message, is Starlark's.
//!   [`evaluate_with`] can measure text too, with a [`Ruler`].
//! - [`module`] reads a script with all that it loads and calls its functions.
//! - [`values`] are the values that Rust adds: points, cells, curves, properties, functions. [`session`] is what a
//!   running evaluation needs to know, and [`scope`] where its randomness comes from.
//! - `sandbox` keeps every evaluation within its [`Limits`].
//! - [`watch`] is how a mapper is observed whose results are to stand for those of other cells.
//! - [`fault`] turns an error of the interpreter into a diagnostic that points at what was written.
//!
//! Operators of arrangements are not here. Their room puts them among the globals, beside what [`register`]
//! puts there, and sees files only through a [`Host`].

mod convert;
pub mod expression;
pub mod fault;
mod formula;
pub mod known;
mod label_cache;
mod language;
mod library;
mod mathematics;
pub mod module;
pub mod numbers;
mod ruler;
mod sandbox;
mod scale;
pub mod scope;
pub mod session;
mod value;
pub mod values;
pub mod watch;

pub use expression::{ExpressionError, evaluate, evaluate_with, free_names};
pub use formula::scalar::ScalarExpression;
pub use language::register;
pub use library::Host;
pub use ruler::{Lettering, Ruler};
pub use sandbox::budget::Limits;
pub use value::Value;
pub use values::CellKind;
