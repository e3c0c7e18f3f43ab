//! A grid of squares, with the segments that touch each of them.

use super::{Bounds, Point};

/// Segments by the squares that they touch.
pub struct Buckets {
    origin: Point,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Where the segments of each square begin.
    starts: Vec<u32>,
    segments: Vec<u32>,
}

/// Squares a segment.
const SQUARES: f64 = 4.0;

impl Buckets {
    /// The grid of `segments`, whose ends lie in `bounds`.
    pub fn new(
        bounds: Bounds,
        segments: impl ExactSizeIterator<Item = [Point; 2]> + Clone,
    ) -> Buckets {
        let (w, h) = (bounds.width(), bounds.height());
        let most = SQUARES * segments.len() as f64;
        // What is flat has squares along one axis only.
        let cell = (w * h / most).sqrt().max((w + h) / most);
        let count = |extent: f64| (extent / cell) as usize + 1;
        let (columns, rows) = (count(w), count(h));
        let starts = vec![0; columns * rows + 1];
        let mut grid = Buckets {
            origin: bounds.min,
            cell,
            columns,
            rows,
            starts,
            segments: Vec::new(),
        };
        let mut starts = std::mem::take(&mut grid.starts);
        for segment in segments.clone() {
            grid.touched(segment, |square| starts[square + 1] += 1);
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut list = vec![0; starts[columns * rows] as usize];
        for (segment, k) in segments.zip(0..) {
            grid.touched(segment, |square| {
                list[next[square] as usize] = k;
                next[square] += 1;
            });
        }
        Buckets {
            starts,
            segments: list,
            ..grid
        }
    }

    /// Calls `visit` with all squares that a segment touches, and with others: long ones go piece by piece, not by their box.
    fn touched(&self, [from, to]: [Point; 2], mut visit: impl FnMut(usize)) {
        let steps = (from.distance(to) / self.cell).ceil().max(1.0) as usize;
        let mut begin = self.square(from);
        for i in 1..=steps {
            let end = self.square(from.lerp(to, i as f64 / steps as f64));
            let ((c0, r0), (c1, r1)) = (begin, end);
            for r in r0.min(r1)..=r0.max(r1) {
                (c0.min(c1)..=c0.max(c1)).for_each(|c| visit(r * self.columns + c));
            }
            begin = end;
        }
    }

    fn square(&self, p: Point) -> (usize, usize) {
        let index = |x: f64, most: usize| ((x / self.cell).max(0.0) as usize).min(most - 1);
        (
            index(p.x - self.origin.x, self.columns),
            index(p.y - self.origin.y, self.rows),
        )
    }

    /// Calls `visit` with all segments in a rectangle, and with others; with some of them more than once.
    pub fn within(&self, view: Bounds, mut visit: impl FnMut(u32)) {
        let ((c0, r0), (c1, r1)) = (self.square(view.min), self.square(view.max));
        for r in r0..=r1 {
            let row = r * self.columns;
            let range = self.starts[row + c0] as usize..self.starts[row + c1 + 1] as usize;
            self.segments[range].iter().for_each(|&k| visit(k));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    #[test]
    fn what_crosses_a_rectangle_is_among_what_is_visited() {
        let seed = Seed::root(5);
        let point = |k: u64| {
            Point::new(
                seed.range(2 * k, 0.0, 20.0),
                seed.range(2 * k + 1, 0.0, 3.0),
            )
        };
        let segments: Vec<[Point; 2]> = (0..60).map(|k| [point(2 * k), point(2 * k + 1)]).collect();
        let bounds = Bounds::of(segments.iter().flatten().copied());
        let grid = Buckets::new(bounds, segments.iter().copied());
        for k in 0..300 {
            let view = Bounds::of([point(1000 + 2 * k), point(1001 + 2 * k)]);
            let mut seen = vec![false; segments.len()];
            grid.within(view, |k| seen[k as usize] = true);
            for (s, seen) in segments.iter().zip(seen) {
                let holds = |t: f64| view.contains(s[0].lerp(s[1], t));
                assert!(
                    seen || !(0..=100).any(|i| holds(f64::from(i) / 100.0)),
                    "{k}"
                );
            }
        }
    }
}
