//! The two directions of a canvas.

use std::ops::{Index, IndexMut};

/// A direction of the canvas. Whatever a facade has once for each direction stands in an array of
/// two, which an axis indexes: `canvas[Axis::Y]` is the height.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Axis {
    /// From the left to the right.
    X,
    /// From the ground up.
    Y,
}

impl Axis {
    /// Both axes, x first.
    pub const BOTH: [Axis; 2] = [Axis::X, Axis::Y];

    /// The name of the axis, as specs and messages write it.
    pub fn name(self) -> &'static str {
        match self {
            Axis::X => "x",
            Axis::Y => "y",
        }
    }

    /// The name of the canvas's side along the axis.
    pub fn side(self) -> &'static str {
        match self {
            Axis::X => "width",
            Axis::Y => "height",
        }
    }

    /// The field of a layer that masks symbols along the axis.
    pub fn mask(self) -> &'static str {
        match self {
            Axis::X => "visible.x",
            Axis::Y => "visible.y",
        }
    }
}

impl<T> Index<Axis> for [T; 2] {
    type Output = T;

    fn index(&self, axis: Axis) -> &T {
        &self[axis as usize]
    }
}

impl<T> IndexMut<Axis> for [T; 2] {
    fn index_mut(&mut self, axis: Axis) -> &mut T {
        &mut self[axis as usize]
    }
}
