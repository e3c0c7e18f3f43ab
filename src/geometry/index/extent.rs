//! Boxes in any number of dimensions.

use crate::{Bounds, Bounds3};

/// An axis-parallel box in N dimensions, as the trees hold it. Empty where `min` exceeds `max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent<const N: usize> {
    /// The least coordinates.
    pub min: [f64; N],
    /// The greatest coordinates.
    pub max: [f64; N],
}

impl<const N: usize> Extent<N> {
    /// The box of nothing.
    pub const EMPTY: Extent<N> = Extent {
        min: [f64::INFINITY; N],
        max: [f64::NEG_INFINITY; N],
    };

    /// The box around both.
    #[inline]
    pub fn union(&self, other: &Extent<N>) -> Extent<N> {
        Extent {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    /// Whether the two have a point in common; borders count.
    #[inline]
    pub fn meets(&self, other: &Extent<N>) -> bool {
        (0..N).all(|k| self.min[k] <= other.max[k] && other.min[k] <= self.max[k])
    }

    /// The square of the distance to another box; 0 where they meet.
    #[inline]
    pub fn squared_distance(&self, other: &Extent<N>) -> f64 {
        let apart = |k: usize| {
            (self.min[k] - other.max[k])
                .max(other.min[k] - self.max[k])
                .max(0.0)
        };
        (0..N).map(|k| apart(k) * apart(k)).sum()
    }

    /// The distance to another box; 0 where they meet.
    #[inline]
    pub fn distance(&self, other: &Extent<N>) -> f64 {
        self.squared_distance(other).sqrt()
    }

    /// The middle along an axis, twice.
    #[inline]
    pub(super) fn doubled_middle(&self, axis: usize) -> f64 {
        self.min[axis] + self.max[axis]
    }
}

impl<const N: usize> From<[f64; N]> for Extent<N> {
    /// The box of one point.
    #[inline]
    fn from(point: [f64; N]) -> Extent<N> {
        Extent {
            min: point,
            max: point,
        }
    }
}

impl From<Bounds> for Extent<2> {
    #[inline]
    fn from(b: Bounds) -> Extent<2> {
        Extent {
            min: [b.min.x, b.min.y],
            max: [b.max.x, b.max.y],
        }
    }
}

impl From<Bounds3> for Extent<3> {
    #[inline]
    fn from(b: Bounds3) -> Extent<3> {
        Extent {
            min: [b.min.x, b.min.y, b.min.z],
            max: [b.max.x, b.max.y, b.max.z],
        }
    }
}
