//! Values that scripts handle and Rust defines. The traits of the interpreter are `unsafe` to
//! implement and derived by its macros, which is why all of them are here and `unsafe` code is
//! allowed here alone; none is written by hand. What operators do with the values is elsewhere.
#![allow(unsafe_code)]

pub(crate) mod bounded;
pub(crate) mod cell;
pub(crate) mod curves;
pub(crate) mod foreign;
pub(crate) mod function;
pub(crate) mod point;
pub(crate) mod session;

pub use cell::{Cell, CellKind, RegionValue};
pub use curves::CurvesValue;
pub use foreign::{Callable, Content, Operation, Properties};
pub use point::{PointValue, is_same_weight};
pub use session::Session;
