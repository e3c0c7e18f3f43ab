//! Repeats of a tile by the names that textile and wallpaper printers have for them: where copies of one drawing go
//! (rule R24). What is drawn in the tile is made elsewhere, and so is what cuts the copies to a region.

use fretwork_geometry::{Affine, Bounds, Curves, Point, budget};
use fretwork_language::kinds::arrangements::RepeatLayout;

/// Bytes for a point of a copy.
const POINT: usize = 32;

/// A tile and how its copies follow one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Repeat {
    /// The box of the tile.
    pub tile: Bounds,
    /// How columns and rows are moved or mirrored.
    pub layout: RepeatLayout,
}

impl Repeat {
    /// After how much along x and along y all is the same again.
    pub fn period(&self) -> Point {
        let (width, height) = (self.tile.width(), self.tile.height());
        match self.layout {
            RepeatLayout::Straight => Point::new(width, height),
            RepeatLayout::HalfDrop => Point::new(2.0 * width, height),
            RepeatLayout::Brick => Point::new(width, 2.0 * height),
            RepeatLayout::Mirrored => Point::new(2.0 * width, 2.0 * height),
        }
    }

    /// The period of a tile nearest to `period` that this repeat closes in; none where it does already.
    pub fn nearest_period(&self, period: Point) -> Option<Point> {
        let own = self.period();
        let whole = |given: f64, own: f64| libm::round(given / own).max(1.0) * own;
        let fits = Point::new(whole(period.x, own.x), whole(period.y, own.y));
        // A millionth of a tile at the far side is not seen.
        let off = |a: f64, b: f64, own: f64| (a - b).abs() > 1e-6 * own;
        (off(fits.x, period.x, own.x) || off(fits.y, period.y, own.y)).then_some(fits)
    }

    /// The copies of `drawing` that meet `window`, row by row from its least corner.
    pub fn over(&self, window: Bounds, drawing: &Curves) -> Curves {
        let drawn = drawing.bounds();
        let mut all = Curves::new();
        if drawn.is_empty() || window.is_empty() {
            return all;
        }
        let (width, height) = (self.tile.width(), self.tile.height());
        // Copies lie off their place by less than a tile, and drawings reach out of theirs.
        let reach = |low: f64, high: f64, of: f64| {
            let out = (low.abs().max(high.abs()) / of).ceil() as i64;
            1 + out.clamp(0, 1 << 20)
        };
        let (left, right) = (drawn.min.x - self.tile.min.x, drawn.max.x - self.tile.max.x);
        let (below, above) = (drawn.min.y - self.tile.min.y, drawn.max.y - self.tile.max.y);
        let place = |at: f64, corner: f64, of: f64| ((at - corner) / of).floor() as i64;
        let columns = reach(left.min(0.0), right.max(0.0), width);
        let rows = reach(below.min(0.0), above.max(0.0), height);
        let first = place(window.min.x, self.tile.min.x, width) - columns;
        let last = place(window.max.x, self.tile.min.x, width) + columns;
        let lowest = place(window.min.y, self.tile.min.y, height) - rows;
        let highest = place(window.max.y, self.tile.min.y, height) + rows;
        for row in lowest..=highest {
            for column in first..=last {
                let map = self.map(column, row);
                let corners = [drawn.min, drawn.max].map(|corner| map.apply(corner));
                if Bounds::of(corners).intersects(&window) {
                    budget::make("points of repeats", drawing.points().len(), POINT);
                    all.append(&drawing.transformed(&map));
                }
            }
        }
        all
    }

    /// Where the copy of a column and a row goes.
    fn map(&self, column: i64, row: i64) -> Affine {
        let (width, height) = (self.tile.width(), self.tile.height());
        let is_odd = |n: i64| n.rem_euclid(2) == 1;
        let at = Point::new(column as f64 * width, row as f64 * height);
        let moved = |by: Point| Affine::translation(at + by);
        match self.layout {
            RepeatLayout::HalfDrop if is_odd(column) => moved(Point::new(0.0, 0.5 * height)),
            RepeatLayout::Brick if is_odd(row) => moved(Point::new(0.5 * width, 0.0)),
            RepeatLayout::Mirrored => {
                let sign = |n: i64| if is_odd(n) { -1.0 } else { 1.0 };
                Affine::scale(sign(column), sign(row))
                    .about(self.tile.center())
                    .then(moved(Point::ORIGIN))
            }
            RepeatLayout::Straight | RepeatLayout::HalfDrop | RepeatLayout::Brick => {
                moved(Point::ORIGIN)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::CurveLabels;

    const LAYOUTS: [RepeatLayout; 4] = [
        RepeatLayout::Straight,
        RepeatLayout::HalfDrop,
        RepeatLayout::Brick,
        RepeatLayout::Mirrored,
    ];

    fn repeat(layout: RepeatLayout) -> Repeat {
        let tile = Bounds {
            min: Point::new(1.0, 2.0),
            max: Point::new(5.0, 5.0),
        };
        Repeat { tile, layout }
    }

    /// A flag that reaches out of the tile.
    fn flag() -> Curves {
        let mut curves = Curves::new();
        let points = [[1.5, 2.5], [1.5, 5.5], [6.25, 4.0]].map(Point::from);
        curves.push(points, CurveLabels::default());
        curves
    }

    /// Every copy within twelve tiles, sorted; what cannot be forgotten by a bound.
    fn all(repeat: &Repeat, window: Bounds) -> Vec<[i64; 6]> {
        let mut out = Vec::new();
        for row in -12..=12 {
            for column in -12..=12 {
                let copy = flag().transformed(&repeat.map(column, row));
                if copy.bounds().intersects(&window) {
                    out.extend(rounded(&copy));
                }
            }
        }
        out.sort_unstable();
        out
    }

    fn rounded(curves: &Curves) -> Vec<[i64; 6]> {
        let coordinates = |c: fretwork_geometry::Curve<'_>| {
            let of = |k: usize| (c.points[k].x * 1e3).round() as i64;
            let up = |k: usize| (c.points[k].y * 1e3).round() as i64;
            [of(0), up(0), of(1), up(1), of(2), up(2)]
        };
        curves.iter().map(coordinates).collect()
    }

    #[test]
    fn no_copy_is_forgotten_and_none_comes_twice() {
        let window = Bounds {
            min: Point::new(-9.0, -4.0),
            max: Point::new(13.5, 8.0),
        };
        for layout in LAYOUTS {
            let repeat = repeat(layout);
            let mut made = rounded(&repeat.over(window, &flag()));
            made.sort_unstable();
            assert_eq!(made, all(&repeat, window), "{layout:?}");
        }
    }

    #[test]
    fn all_is_the_same_one_period_further() {
        let window = Bounds {
            min: Point::new(0.0, 0.0),
            max: Point::new(16.0, 12.0),
        };
        for layout in LAYOUTS {
            let repeat = repeat(layout);
            for by in [
                Point::new(repeat.period().x, 0.0),
                Point::new(0.0, repeat.period().y),
            ] {
                let moved = Bounds {
                    min: window.min + by,
                    max: window.max + by,
                };
                let further = repeat.over(moved, &flag());
                let mut back = rounded(&further.transformed(&Affine::translation(by * -1.0)));
                back.sort_unstable();
                assert_eq!(back, all(&repeat, window), "{layout:?}");
            }
        }
    }

    #[test]
    fn periods_that_do_not_close_are_told_with_the_nearest() {
        let period = |x: f64, y: f64| Point::new(x, y);
        let drop = repeat(RepeatLayout::HalfDrop);
        assert_eq!(drop.nearest_period(period(16.0, 9.0)), None);
        assert_eq!(
            drop.nearest_period(period(12.0, 9.0)),
            Some(period(16.0, 9.0))
        );
        assert_eq!(
            drop.nearest_period(period(1.0, 4.0)),
            Some(period(8.0, 3.0))
        );
        let brick = repeat(RepeatLayout::Brick);
        assert_eq!(
            brick.nearest_period(period(4.0, 3.0)),
            Some(period(4.0, 6.0))
        );
    }
}
