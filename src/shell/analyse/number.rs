//! What a component of a vector is: a number of single or double precision, or four of them side by side, one for
//! each of four load cases. What is written for one load case then works for four, and each value that a
//! product needs beside the vectors is read once for all of them.

use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// A number, or several that are computed with alike.
pub(super) trait Real:
    Copy
    + Send
    + Sync
    + Default
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + AddAssign
    + SubAssign
    + 'static
{
    /// A plain number of this precision.
    type Plain: Real;

    /// The nearest to `x`, as each of them.
    fn of(x: f64) -> Self;

    /// Each of them times `factor`.
    fn scaled(self, factor: Self::Plain) -> Self;
}

/// Numbers of double precision, one for each load case.
pub(super) trait Columns: Real<Plain = f64> {
    /// How many there are.
    const COUNT: usize;

    /// The same in single precision.
    type Single: Real<Plain = f32>;

    /// The number of each column.
    fn of_columns(number: impl FnMut(usize) -> f64) -> Self;

    /// The number of one column.
    fn column(self, column: usize) -> f64;

    /// The nearest of single precision.
    fn single(self) -> Self::Single;

    /// Exactly the same numbers.
    fn double(single: Self::Single) -> Self;
}

/// Four numbers side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Four<T>(pub(super) [T; 4]);

impl Real for f32 {
    type Plain = f32;

    #[inline(always)]
    fn of(x: f64) -> f32 {
        x as f32
    }

    #[inline(always)]
    fn scaled(self, factor: f32) -> f32 {
        self * factor
    }
}

impl Real for f64 {
    type Plain = f64;

    #[inline(always)]
    fn of(x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> f64 {
        self * factor
    }
}

impl<T: Real> Real for Four<T> {
    type Plain = T;

    #[inline(always)]
    fn of(x: f64) -> Four<T> {
        Four([T::of(x); 4])
    }

    #[inline(always)]
    fn scaled(self, factor: T) -> Four<T> {
        let [a, b, c, d] = self.0;
        Four([a * factor, b * factor, c * factor, d * factor])
    }
}

impl Columns for f64 {
    const COUNT: usize = 1;
    type Single = f32;

    fn of_columns(mut number: impl FnMut(usize) -> f64) -> f64 {
        number(0)
    }

    fn column(self, _column: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn single(self) -> f32 {
        self as f32
    }

    #[inline(always)]
    fn double(single: f32) -> f64 {
        f64::from(single)
    }
}

impl Columns for Four<f64> {
    const COUNT: usize = 4;
    type Single = Four<f32>;

    fn of_columns(number: impl FnMut(usize) -> f64) -> Four<f64> {
        Four(std::array::from_fn(number))
    }

    fn column(self, column: usize) -> f64 {
        self.0[column]
    }

    #[inline(always)]
    fn single(self) -> Four<f32> {
        let [a, b, c, d] = self.0;
        Four([a as f32, b as f32, c as f32, d as f32])
    }

    #[inline(always)]
    fn double(single: Four<f32>) -> Four<f64> {
        let [a, b, c, d] = single.0;
        Four([a.into(), b.into(), c.into(), d.into()])
    }
}

impl<T: Real> Add for Four<T> {
    type Output = Four<T>;

    #[inline(always)]
    fn add(self, other: Four<T>) -> Four<T> {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Four([a + e, b + f, c + g, d + h])
    }
}

impl<T: Real> Sub for Four<T> {
    type Output = Four<T>;

    #[inline(always)]
    fn sub(self, other: Four<T>) -> Four<T> {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Four([a - e, b - f, c - g, d - h])
    }
}

impl<T: Real> Mul for Four<T> {
    type Output = Four<T>;

    #[inline(always)]
    fn mul(self, other: Four<T>) -> Four<T> {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Four([a * e, b * f, c * g, d * h])
    }
}

impl<T: Real> AddAssign for Four<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Four<T>) {
        *self = *self + other;
    }
}

impl<T: Real> SubAssign for Four<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Four<T>) {
        *self = *self - other;
    }
}
