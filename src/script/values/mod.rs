//! Values that scripts handle and Rust defines. The traits of the interpreter are `unsafe` to
//! implement and derived by its macros, which is why all of them are here and `unsafe` code is
//! allowed here alone; none is written by hand. What operators do with the values is elsewhere.
#![allow(unsafe_code)]

mod bounded;
mod function;
mod session;

pub(super) use bounded::{BoundedMethod, BoundedStandard};
pub(super) use function::{MathFunction, number};
pub(super) use session::Session;
