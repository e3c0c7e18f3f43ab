//! Where a thickness goes: a choice that several kinds share.

use crate::macros::choice;

choice! {
    /// On which side of what it grows from a thickness lies.
    pub enum Side {
        /// Half of it on each side.
        center: Center,
        /// On the inner side: inside of a surface, toward the middle of a curve, below a plane.
        inside: Inside,
        /// On the outer side: out of a surface, away from the middle of a curve, above a plane.
        outside: Outside,
    }
}
