//! `symbols`: the letters of facade patterns.

use crate::macros::record;
use crate::scalar::{PositiveLength, PositiveNumber};

record! {
    /// A letter of facade patterns; its name is one letter.
    pub struct Symbol {
        /// Its preferred size along the axis. Without it the size is free.
        size: Option<PositiveLength>,
        /// It hides what is below it.
        opaque: bool = false,
        /// It keeps its neighbours: no space opens beside it.
        attached: bool = false,
        /// It may not be cut by what is above it; only be covered whole.
        unoccludable: bool = false,
        /// It is never resized.
        fixed: bool = false,
        /// How unwilling it is to be resized; below 1 more willing than others.
        weight: PositiveNumber = 1,
    }
}
