//! A rectangle of samples of a scalar, and the values between them.

use serde::{Deserialize, Serialize};

use crate::{Bounds, Point};

/// Samples on a lattice: the one in column i and row j stands for the middle of its pixel,
/// `origin + ((i + 1/2)·step.x, (j + 1/2)·step.y)`. Beyond the lattice the outermost samples go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Raster {
    /// The corner of the first pixel.
    pub origin: Point,
    /// The size of a pixel; a component is negative where columns or rows run backwards.
    pub step: Point,
    /// Columns, at least 1.
    pub width: usize,
    /// The samples row by row; NaN where there is none. Their number is a multiple of `width`.
    pub values: Vec<f64>,
}

impl Raster {
    /// How many rows there are.
    #[inline]
    pub fn height(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    /// The sample of the pixel that holds `p`.
    #[inline]
    pub fn nearest(&self, p: Point) -> f64 {
        let (u, v) = self.place(p);
        self.sample(libm::round(u), libm::round(v))
    }

    /// The values of the four samples around `p`, weighted by nearness in x and y.
    pub fn bilinear(&self, p: Point) -> f64 {
        let (u, v) = self.place(p);
        let (i, j) = (u.floor(), v.floor());
        if self.values.is_empty() || i.is_nan() || j.is_nan() {
            return f64::NAN;
        }
        let (s, t) = (u - i, v - j);
        let inside = |k: f64, n: usize| k.clamp(0.0, (n - 1) as f64) as usize;
        let (left, right) = (inside(i, self.width), inside(i + 1.0, self.width));
        let height = self.height();
        let row = |j: f64| {
            let first = inside(j, height) * self.width;
            // A sample of no weight is not asked for, so that NaN does not spread to its neighbours.
            if s == 0.0 {
                self.values[first + left]
            } else {
                self.values[first + left] * (1.0 - s) + self.values[first + right] * s
            }
        };
        if t == 0.0 {
            row(j)
        } else {
            row(j) * (1.0 - t) + row(j + 1.0) * t
        }
    }

    /// The first and last column and the first and last row of the samples that the values in a box depend on.
    pub(super) fn samples_of(&self, within: &Bounds) -> [[usize; 2]; 2] {
        let ((u0, v0), (u1, v1)) = (self.place(within.min), self.place(within.max));
        let range = |a: f64, b: f64, n: usize| {
            let inside = |k: f64| k.clamp(0.0, n.saturating_sub(1) as f64) as usize;
            [inside(a.min(b).floor()), inside(a.max(b).floor() + 1.0)]
        };
        [range(u0, u1, self.width), range(v0, v1, self.height())]
    }

    /// What stands for the raster where values are compared.
    pub fn digest(&self) -> [u8; 32] {
        let mut hasher = blake3::Hasher::new();
        let head = [
            self.origin.x,
            self.origin.y,
            self.step.x,
            self.step.y,
            self.width as f64,
        ];
        for value in head.iter().chain(&self.values) {
            hasher.update(&value.to_le_bytes());
        }
        *hasher.finalize().as_bytes()
    }

    /// `p` in columns and rows, counted from the middle of the first pixel.
    #[inline]
    fn place(&self, p: Point) -> (f64, f64) {
        (
            (p.x - self.origin.x) / self.step.x - 0.5,
            (p.y - self.origin.y) / self.step.y - 0.5,
        )
    }

    #[inline]
    fn sample(&self, i: f64, j: f64) -> f64 {
        if self.values.is_empty() || i.is_nan() || j.is_nan() {
            return f64::NAN;
        }
        let inside = |k: f64, n: usize| k.clamp(0.0, (n - 1) as f64) as usize;
        self.values[inside(j, self.height()) * self.width + inside(i, self.width)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_met_in_the_middle_of_their_pixels() {
        let raster = Raster {
            origin: Point::new(10.0, 20.0),
            step: Point::new(2.0, -2.0),
            width: 2,
            values: vec![1.0, 3.0, 5.0, f64::NAN],
        };
        assert_eq!(raster.bilinear(Point::new(11.0, 19.0)), 1.0);
        assert_eq!(raster.bilinear(Point::new(12.0, 19.0)), 2.0);
        assert_eq!(raster.bilinear(Point::new(11.0, 18.0)), 3.0);
        assert_eq!(raster.bilinear(Point::new(-90.0, 99.0)), 1.0);
        assert!(raster.bilinear(Point::new(12.0, 18.0)).is_nan());
        assert_eq!(raster.nearest(Point::new(12.5, 19.9)), 3.0);
        assert!(raster.nearest(Point::new(f64::NAN, 0.0)).is_nan());
        assert!(
            Raster {
                width: 0,
                values: vec![],
                ..raster
            }
            .nearest(Point::ORIGIN)
            .is_nan()
        );
    }
}
