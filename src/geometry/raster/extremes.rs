//! The least and the greatest sample in any part of a raster, from a pyramid of blocks.

use crate::Bounds;
use crate::raster::grid::Raster;

/// The least and the greatest samples in blocks of 1, 2 × 2, 4 × 4 … samples. A sample that is missing counts as
/// -∞ for the least and not at all for the greatest. It has a third more entries than the raster has samples.
pub(super) struct Extremes {
    levels: Vec<Level>,
}

/// Blocks of one size.
struct Level {
    width: usize,
    /// Least and greatest, row by row.
    blocks: Vec<[f64; 2]>,
}

const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn widened(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

impl Extremes {
    /// The pyramid of `raster`. O(n).
    pub fn of(raster: &Raster) -> Extremes {
        let sample = |v: &f64| {
            if v.is_nan() {
                [f64::NEG_INFINITY; 2]
            } else {
                [*v, *v]
            }
        };
        let mut levels = vec![Level {
            width: raster.width.max(1),
            blocks: raster.values.iter().map(sample).collect(),
        }];
        while let Some(last) = levels.last()
            && last.blocks.len() > 1
        {
            let next = last.halved();
            levels.push(next);
        }
        Extremes { levels }
    }

    /// Bounds of the values that `raster`, whose pyramid this is, has in a box, interpolated or not. O(1).
    pub fn within(&self, raster: &Raster, within: &Bounds) -> [f64; 2] {
        let [[left, right], [low, high]] = raster.samples_of(within);
        // Blocks of a size of which at most three lie side by side.
        let longer = (right - left).max(high - low);
        let level = (usize::BITS - (longer / 2).leading_zeros()) as usize;
        let Some(blocks) = self.levels.get(level) else {
            return self.levels.last().map_or(NOTHING, Level::all);
        };
        let mut range = NOTHING;
        for row in low >> level..=high >> level {
            for column in left >> level..=right >> level {
                if let Some(block) = blocks.blocks.get(row * blocks.width + column) {
                    range = widened(range, *block);
                }
            }
        }
        range
    }
}

impl Level {
    /// The blocks of twice the size.
    fn halved(&self) -> Level {
        let height = self.blocks.len() / self.width;
        let width = self.width.div_ceil(2);
        let mut blocks = vec![NOTHING; width * height.div_ceil(2)];
        for (i, block) in self.blocks.iter().enumerate() {
            let (column, row) = (i % self.width, i / self.width);
            let above = &mut blocks[row / 2 * width + column / 2];
            *above = widened(*above, *block);
        }
        Level { width, blocks }
    }

    fn all(&self) -> [f64; 2] {
        self.blocks.iter().copied().fold(NOTHING, widened)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Point, Seed};

    #[test]
    fn no_value_in_a_box_exceeds_its_bounds_and_they_are_near() {
        let seed = Seed::root(3);
        for (width, height) in [(1, 1), (7, 5), (16, 16), (1, 9), (33, 2)] {
            let raster = Raster {
                origin: Point::new(-3.0, 2.0),
                step: Point::new(0.5, -0.25),
                width,
                values: (0..width * height).map(|i| seed.unit(i as u64)).collect(),
            };
            let extremes = Extremes::of(&raster);
            for case in 0..200 {
                let seed = seed.number(case);
                let corner = Point::new(seed.range(0, -6.0, 16.0), seed.range(1, -4.0, 4.0));
                let size = Point::new(seed.range(2, 0.0, 6.0), seed.range(3, 0.0, 2.0));
                let within = Bounds::of([corner, corner + size]);
                let [least, greatest] = extremes.within(&raster, &within);
                for k in 0..20 {
                    let part = Point::new(seed.unit(10 + k), seed.unit(40 + k));
                    let p = corner + Point::new(part.x * size.x, part.y * size.y);
                    for value in [raster.bilinear(p), raster.nearest(p)] {
                        assert!(value >= least - 1e-12 && value <= greatest + 1e-12);
                    }
                }
                assert!(raster.values.contains(&least) && raster.values.contains(&greatest));
            }
        }
    }

    #[test]
    fn a_missing_sample_has_no_least_value() {
        let raster = Raster {
            origin: Point::ORIGIN,
            step: Point::new(1.0, 1.0),
            width: 2,
            values: vec![1.0, f64::NAN, 3.0, 2.0],
        };
        let all = Bounds::of([Point::ORIGIN, Point::new(2.0, 2.0)]);
        let range = Extremes::of(&raster).within(&raster, &all);
        assert_eq!(range, [f64::NEG_INFINITY, 3.0]);
    }
}
