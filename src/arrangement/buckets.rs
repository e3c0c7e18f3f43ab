//! Boxes on a raster of buckets: which of many boxes are near to one.

use fretwork_geometry::{Bounds, Point};

/// Numbered boxes, found again by the buckets that they meet.
pub(crate) struct Buckets {
    origin: Point,
    side: f64,
    columns: usize,
    lists: Vec<Vec<u32>>,
}

impl Buckets {
    /// Buckets about `side` wide over `bounds`; what lies beyond is put into the outermost ones.
    pub fn over(bounds: &Bounds, side: f64) -> Buckets {
        const MOST: f64 = 2e6;
        let least = (bounds.width() * bounds.height() / MOST)
            .sqrt()
            .max(bounds.longer_side() / MOST);
        let side = if side.max(least) > 0.0 {
            side.max(least)
        } else {
            1.0
        };
        let count = |length: f64| (length / side) as usize + 1;
        let columns = count(bounds.width());
        Buckets {
            origin: bounds.min,
            side,
            columns,
            lists: vec![Vec::new(); columns * count(bounds.height())],
        }
    }

    /// Adds a box.
    pub fn insert(&mut self, number: u32, bounds: &Bounds) {
        for bucket in self.range(bounds) {
            self.lists[bucket].push(number);
        }
    }

    /// The numbers of the boxes that may meet `bounds`, each once, ascending.
    pub fn near(&self, bounds: &Bounds) -> Vec<u32> {
        let mut numbers: Vec<u32> = self
            .range(bounds)
            .flat_map(|bucket| &self.lists[bucket])
            .copied()
            .collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    fn range(&self, bounds: &Bounds) -> impl Iterator<Item = usize> + use<> {
        let columns = self.columns;
        let index = |v: f64, n: usize| ((v / self.side).max(0.0) as usize).min(n - 1);
        let place = |p: Point| {
            let p = p - self.origin;
            (index(p.x, columns), index(p.y, self.lists.len() / columns))
        };
        let ((left, low), (right, high)) = (place(bounds.min), place(bounds.max));
        (low..=high).flat_map(move |row| (left..=right).map(move |column| row * columns + column))
    }
}
