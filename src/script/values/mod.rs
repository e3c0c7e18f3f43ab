//! Values that scripts handle and Rust defines. The traits of the interpreter are `unsafe` to
//! implement and derived by its macros, which is why all of them are here and `unsafe` code is
//! allowed here alone; none is written by hand. What operators do with the values is elsewhere.
#![allow(unsafe_code)]

mod bounded;
mod cell;
mod curves;
mod foreign;
mod function;
mod point;
mod session;

pub(super) use bounded::{BoundedMethod, BoundedStandard};
pub use cell::CellKind;
pub use cell::{Cell, RegionValue};
pub use curves::CurvesValue;
pub use foreign::{Callable, Content, Operation, Properties};
pub(super) use function::{MathFunction, number};
pub use point::PointValue;
pub use session::Session;
