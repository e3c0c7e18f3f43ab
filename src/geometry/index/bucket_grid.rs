//! A uniform grid of buckets in the plane.

use super::Rows;
use crate::{Bounds, Point};

/// Squares for each segment. With more, the grid takes more memory than the segments; with fewer, long lists are read
/// for each question. Between 2 and 8 the time hardly changes.
const SQUARES_PER_SEGMENT: f64 = 4.0;

/// A grid never has more squares than about this, along one axis or in all: beyond, clearing it costs more than it spares.
const MOST_SQUARES: f64 = 2e6;

/// The squares of a uniform grid over a rectangle. Points outside belong to the outermost squares.
#[derive(Clone, Copy, Debug)]
pub struct Squares {
    origin: Point,
    side: f64,
    columns: usize,
    rows: usize,
}

impl Squares {
    /// Squares about `side` wide over `bounds`; wider ones where there would be more than two million.
    pub fn over(bounds: &Bounds, side: f64) -> Squares {
        let area = bounds.width() * bounds.height();
        let least = (area / MOST_SQUARES).sqrt();
        let least = least.max(bounds.longer_side() / MOST_SQUARES);
        let side = side.max(least);
        Squares::new(bounds, if side > 0.0 { side } else { 1.0 })
    }

    /// Squares that suit `count` segments which are spread evenly over `bounds`.
    pub fn suited(bounds: &Bounds, count: usize) -> Squares {
        let (w, h) = (bounds.width(), bounds.height());
        let most = SQUARES_PER_SEGMENT * count as f64;
        // What is flat has squares along one axis only.
        Squares::new(bounds, (w * h / most).sqrt().max((w + h) / most))
    }

    fn new(bounds: &Bounds, side: f64) -> Squares {
        let count = |extent: f64| (extent / side) as usize + 1;
        Squares {
            origin: bounds.min,
            side,
            columns: count(bounds.width()),
            rows: count(bounds.height()),
        }
    }

    /// How many squares there are.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Whether there are none; there is always one.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Column and row of the square that a point belongs to.
    #[inline]
    fn place(&self, p: Point) -> (usize, usize) {
        let index = |x: f64, most: usize| ((x / self.side).max(0.0) as usize).min(most - 1);
        let p = p - self.origin;
        (index(p.x, self.columns), index(p.y, self.rows))
    }

    /// The squares that a rectangle touches, as one range for each row.
    #[inline]
    fn within(&self, view: &Bounds) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let ((left, low), (right, high)) = (self.place(view.min), self.place(view.max));
        let columns = self.columns;
        (low..=high).map(move |row| row * columns + left..row * columns + right + 1)
    }

    /// Calls `visit` with all squares that a segment touches, and with others; with some of them twice. A long segment
    /// goes piece by piece, not by its box.
    fn along(&self, [from, to]: [Point; 2], mut visit: impl FnMut(usize)) {
        let steps = (from.distance(to) / self.side).ceil().max(1.0) as usize;
        let mut begin = self.place(from);
        for i in 1..=steps {
            let end = self.place(from.lerp(to, i as f64 / steps as f64));
            let ((c0, r0), (c1, r1)) = (begin, end);
            for row in r0.min(r1)..=r0.max(r1) {
                (c0.min(c1)..=c0.max(c1)).for_each(|column| visit(row * self.columns + column));
            }
            begin = end;
        }
    }
}

/// Numbered things of the plane by the squares of a uniform grid that they touch.
///
/// It suits things of about one size: a question reads all lists of the squares that its rectangle touches. Answers hold
/// everything that meets the rectangle, and more. Where sizes differ much take a [`super::BoxTree`].
///
/// ```
/// use fretwork_geometry::index::{BucketGrid, Squares};
/// use fretwork_geometry::{Bounds, Point};
/// let bounds = Bounds::of([Point::new(0.0, 0.0), Point::new(10.0, 10.0)]);
/// let mut grid = BucketGrid::empty(Squares::over(&bounds, 1.0));
/// let dot = |x: f64| Bounds::of([Point::new(x, x)]);
/// (0..10).for_each(|i| grid.insert(i, &dot(f64::from(i))));
/// assert_eq!(grid.near(&Bounds::of([Point::new(2.5, 2.5), Point::new(4.5, 3.0)])), [2, 3]);
/// ```
#[derive(Clone, Debug)]
pub struct BucketGrid {
    squares: Squares,
    /// What the grid was made of; empty when it was made empty.
    first: Rows,
    /// What was inserted, by square; empty until something is.
    inserted: Vec<Vec<u32>>,
}

impl BucketGrid {
    /// A grid that holds nothing yet.
    pub fn empty(squares: Squares) -> BucketGrid {
        BucketGrid {
            squares,
            first: Rows::default(),
            inserted: Vec::new(),
        }
    }

    /// The grid of `segments`, numbered in their order, whose ends lie in `bounds`. O(n) for segments of about one length.
    pub fn of_segments(
        bounds: Bounds,
        segments: impl ExactSizeIterator<Item = [Point; 2]> + Clone,
    ) -> BucketGrid {
        let squares = Squares::suited(&bounds, segments.len());
        let first = Rows::fill(squares.len(), |filler| {
            for (segment, number) in segments.clone().zip(0..) {
                squares.along(segment, |square| filler.put(square, number));
            }
        });
        BucketGrid {
            squares,
            first,
            inserted: Vec::new(),
        }
    }

    /// Adds a thing by its box.
    pub fn insert(&mut self, number: u32, bounds: &Bounds) {
        if self.inserted.is_empty() {
            self.inserted = vec![Vec::new(); self.squares.len()];
        }
        for square in self.squares.within(bounds).flatten() {
            self.inserted[square].push(number);
        }
    }

    /// Calls `visit` with the numbers of all that may meet `view`, with some of them more than once. The order depends
    /// on nothing but the grid.
    #[inline]
    pub fn within(&self, view: &Bounds, mut visit: impl FnMut(u32)) {
        for squares in self.squares.within(view) {
            if !self.first.is_empty() {
                let numbers = self.first.range(squares.clone());
                numbers.iter().for_each(|&number| visit(number));
            }
            if !self.inserted.is_empty() {
                let numbers = self.inserted[squares].iter().flatten();
                numbers.for_each(|&number| visit(number));
            }
        }
    }

    /// The numbers of all that may meet `view`, each once, ascending.
    pub fn near(&self, view: &Bounds) -> Vec<u32> {
        let mut numbers = Vec::new();
        self.within(view, |number| numbers.push(number));
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    fn segments(seed: Seed, count: u64) -> Vec<[Point; 2]> {
        let number = |k: u64, most: f64| seed.range(k, 0.0, most);
        let point = |k: u64| Point::new(number(2 * k, 20.0), number(2 * k + 1, 3.0));
        (0..count)
            .map(|k| [point(2 * k), point(2 * k + 1)])
            .collect()
    }

    /// Whether one of many points of a segment lies in a rectangle.
    fn crosses([a, b]: [Point; 2], view: &Bounds) -> bool {
        (0..=100).any(|i| view.contains(a.lerp(b, f64::from(i) / 100.0)))
    }

    #[test]
    fn what_crosses_a_rectangle_is_among_what_is_visited() {
        let segments = segments(Seed::root(5), 60);
        let bounds = Bounds::of(segments.iter().flatten().copied());
        let grid = BucketGrid::of_segments(bounds, segments.iter().copied());
        for corners in self::segments(Seed::root(6), 300) {
            let view = Bounds::of(corners);
            let near = grid.near(&view);
            for (number, segment) in (0..).zip(&segments) {
                let is_found = near.binary_search(&number).is_ok();
                assert!(is_found || !crosses(*segment, &view), "{number} {view:?}");
            }
        }
    }

    #[test]
    fn boxes_are_inserted_one_at_a_time() {
        let boxes: Vec<Bounds> = segments(Seed::root(7), 60)
            .into_iter()
            .map(Bounds::of)
            .collect();
        // Some of them lie outside of the grid.
        let bounds = Bounds::of([Point::new(2.0, 1.0), Point::new(15.0, 2.0)]);
        let mut grid = BucketGrid::empty(Squares::over(&bounds, 0.7));
        for (number, b) in (0..).zip(&boxes) {
            grid.insert(number, b);
            let meeting = (0..=number).filter(|&i| boxes[i as usize].intersects(b));
            let near = grid.near(b);
            assert!(meeting.into_iter().all(|i| near.contains(&i)));
            assert!(near.iter().all(|i| *i <= number));
        }
    }

    #[test]
    fn a_flat_or_empty_rectangle_has_squares() {
        let line = Bounds::of([Point::new(0.0, 1.0), Point::new(8.0, 1.0)]);
        assert_eq!(Squares::suited(&line, 4).len(), 17);
        assert_eq!(Squares::over(&Bounds::of([Point::ORIGIN]), 0.0).len(), 1);
    }
}
