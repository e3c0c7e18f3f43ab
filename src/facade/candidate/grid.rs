//! The integer grid of an axis (rule R5). Preferred sizes are whole numbers of steps, so that words and
//! alignments are compared exactly. Final sizes are real numbers and need not lie on it.

use fretwork_geometry::numeric::gcd;

/// The step that all sizes of an axis are multiples of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Its length, in the unit of the sizes.
    pub step: f64,
}

/// The finest step, as a fraction of the largest size. A coarser one would move borders by more than
/// the layout's own rounding; with a finer one, sums of steps could come near to 2^53 on large
/// canvases.
const FINEST: f64 = 1e-7;
/// The rounding error of a quotient, in steps. Sums of a thousand sizes stay well below it.
const SLACK: f64 = 1e-6;
/// The decimals that sizes are read with. Sizes with more are computed ones, such as thirds.
const DECIMALS: usize = 9;

impl Grid {
    /// The grid of `sizes`, all above zero: their greatest common divisor, found exactly for decimal
    /// fractions and closely for simple ratios. If they have none, the step is the finest one. `None`
    /// without sizes.
    pub fn of(sizes: &[f64]) -> Option<Grid> {
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        if largest <= 0.0 || !largest.is_finite() {
            return None;
        }
        let step = decimal(sizes)
            .or_else(|| ratio(sizes, largest))
            .filter(|step| *step >= largest * FINEST);
        Some(Grid {
            step: step.unwrap_or(largest * FINEST),
        })
    }

    /// The nearest whole number of steps, at least 1.
    pub fn steps(self, size: f64) -> i64 {
        // The cast saturates, but `of` makes no grid with so many steps.
        (libm::round(size / self.step) as i64).max(1)
    }

    /// The greatest number of steps that is not longer than `length`, but for rounding.
    pub fn floor(self, length: f64) -> i64 {
        libm::floor(length / self.step + SLACK) as i64
    }

    /// The least number of steps that is not shorter than `length`, but for rounding.
    pub fn ceil(self, length: f64) -> i64 {
        libm::ceil(length / self.step - SLACK) as i64
    }
}

/// The greatest common divisor of numbers with a few decimals.
fn decimal(sizes: &[f64]) -> Option<f64> {
    let mut scale = 1.0;
    for _ in 0..=DECIMALS {
        let scaled: Vec<f64> = sizes.iter().map(|s| s * scale).collect();
        let whole =
            |v: &f64| *v < 1e15 && (v - libm::round(*v)).abs() <= 1e-12 * v.max(1.0) && *v >= 0.5;
        if scaled.iter().all(whole) {
            let divisor = scaled.iter().map(|v| libm::round(*v) as u64).fold(0, gcd);
            return Some(divisor as f64 / scale);
        }
        scale *= 10.0;
    }
    None
}

/// The greatest common divisor of numbers in simple ratios, such as thirds, by Euclid's algorithm with
/// a tolerance.
fn ratio(sizes: &[f64], largest: f64) -> Option<f64> {
    let slack = largest * 1e-10;
    let mut divisor = 0.0;
    for &size in sizes {
        let (mut a, mut b) = (divisor, size);
        for _ in 0..64 {
            if b <= slack {
                break;
            }
            let rest = a - libm::floor(a / b + 1e-9) * b;
            (a, b) = (b, rest.max(0.0));
        }
        divisor = a;
    }
    let whole = |s: &f64| (s / divisor - libm::round(s / divisor)).abs() < 1e-6;
    (divisor >= largest * FINEST && sizes.iter().all(whole)).then_some(divisor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisors() {
        let step = |sizes: &[f64]| Grid::of(sizes).map(|g| g.step);
        assert_eq!(step(&[0.8, 1.2, 0.6]), Some(0.2));
        assert_eq!(step(&[3.0, 1.3]), Some(0.1));
        assert_eq!(step(&[815.0, 1190.0]), Some(5.0));
        assert_eq!(step(&[0.1 + 0.2, 0.6]), Some(0.3));
        assert_eq!(step(&[]), None);
        let third = step(&[1.0 / 3.0, 2.0 / 3.0, 1.0]).expect("a step");
        assert!((third - 1.0 / 3.0).abs() < 1e-9);
        let none = step(&[1.0, std::f64::consts::SQRT_2]).expect("a step");
        assert!((1.0e-7..1e-5).contains(&none), "{none}");
    }

    #[test]
    fn rounding_does_not_move_a_border() {
        let grid = Grid::of(&[0.1, 0.3]).expect("a step");
        assert_eq!(
            (grid.floor(0.1 * 3.0), grid.ceil(0.1 * 3.0), grid.steps(0.3)),
            (3, 3, 3)
        );
        assert_eq!((grid.floor(0.35), grid.ceil(0.35)), (3, 4));
    }
}
