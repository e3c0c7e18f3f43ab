//! Where a region is certainly inside, certainly outside, or near its border: a coarse raster that
//! spares most cells and edges of a partition the exact cutting.

use fretwork_geometry::{Bounds, Curves, Point, Region};

/// What a tile of the raster holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Only the inside.
    Inside,
    /// Only the outside.
    Outside,
    /// Some of the border.
    Border,
}

/// The raster. What is beyond it is outside.
pub(crate) struct RegionRaster {
    origin: Point,
    tile: Point,
    columns: usize,
    sides: Vec<Side>,
}

impl RegionRaster {
    /// The raster of `region`, of about `tiles` tiles; `tolerance` is how far things may be moved
    /// before they are compared with it.
    pub fn new(region: &Region, tiles: usize, tolerance: f64) -> RegionRaster {
        let bounds = region
            .bounds()
            .union(region.contour.bounds())
            .grown(4.0 * tolerance);
        let side = (bounds.width() * bounds.height() / tiles.max(1) as f64).sqrt();
        let count = |length: f64| ((length / side).ceil().max(1.0) as usize).min(tiles.max(1));
        let (columns, rows) = (count(bounds.width()), count(bounds.height()));
        let tile = Point::new(
            bounds.width() / columns as f64,
            bounds.height() / rows as f64,
        );
        let mut raster = RegionRaster {
            origin: bounds.min,
            tile,
            columns,
            sides: vec![Side::Outside; columns * rows],
        };
        raster.fill(region, rows);
        let rings = region.area.iter().flat_map(|p| p.rings());
        for ring in rings {
            for i in 0..ring.len() {
                raster.mark(ring[i], ring[(i + 1) % ring.len()], 2.0 * tolerance);
            }
        }
        raster.mark_curves(&region.contour, 2.0 * tolerance);
        raster
    }

    /// What the tiles hold that meet `bounds`: one side when all agree, else the border.
    pub fn side(&self, bounds: &Bounds) -> Side {
        let rows = self.sides.len() / self.columns;
        let (left, right) = index_range(
            bounds.min.x - self.origin.x,
            bounds.max.x - self.origin.x,
            self.tile.x,
        );
        let (low, high) = index_range(
            bounds.min.y - self.origin.y,
            bounds.max.y - self.origin.y,
            self.tile.y,
        );
        let (n, m) = (self.columns as i64, rows as i64);
        let mut side = (left < 0 || low < 0 || right >= n || high >= m).then_some(Side::Outside);
        for row in low.max(0)..=high.min(m - 1) {
            for column in left.max(0)..=right.min(n - 1) {
                let here = self.sides[(row * n + column) as usize];
                if here == Side::Border || side.is_some_and(|s| s != here) {
                    return Side::Border;
                }
                side = Some(here);
            }
        }
        side.unwrap_or(Side::Outside)
    }

    /// Marks the tiles whose middles are inside, row by row, by the even-odd rule.
    fn fill(&mut self, region: &Region, rows: usize) {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); rows];
        for ring in region.area.iter().flat_map(|p| p.rings()) {
            for i in 0..ring.len() {
                let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
                let row = |p: Point| {
                    ((p.y - self.origin.y) / self.tile.y - 0.5)
                        .ceil()
                        .clamp(0.0, rows as f64) as usize
                };
                let from = row(a).min(row(b));
                for (r, of_row) in crossings[from..row(a).max(row(b))].iter_mut().enumerate() {
                    let y = self.origin.y + ((from + r) as f64 + 0.5) * self.tile.y;
                    of_row.push(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0));
                }
            }
        }
        for (row, of_row) in crossings.iter_mut().enumerate() {
            of_row.sort_by(f64::total_cmp);
            for pair in of_row.chunks_exact(2) {
                let column = |x: f64| {
                    ((x - self.origin.x) / self.tile.x - 0.5)
                        .ceil()
                        .clamp(0.0, self.columns as f64) as usize
                };
                for c in column(pair[0])..column(pair[1]) {
                    self.sides[row * self.columns + c] = Side::Inside;
                }
            }
        }
    }

    fn mark_curves(&mut self, curves: &Curves, margin: f64) {
        for curve in curves.iter() {
            curve
                .points
                .windows(2)
                .for_each(|w| self.mark(w[0], w[1], margin));
        }
    }

    /// Marks the tiles within `margin` of the segment, and perhaps some more.
    fn mark(&mut self, a: Point, b: Point, margin: f64) {
        let (a, b) = if a.y <= b.y {
            (a - self.origin, b - self.origin)
        } else {
            (b - self.origin, a - self.origin)
        };
        let rows = (self.sides.len() / self.columns) as i64;
        let (low, high) = index_range(a.y - margin, b.y + margin, self.tile.y);
        for row in low.max(0)..=high.min(rows - 1) {
            let part = |y: f64| {
                if b.y > a.y {
                    ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0)
                } else {
                    0.5
                }
            };
            let (bottom, top) = (
                row as f64 * self.tile.y - margin,
                (row + 1) as f64 * self.tile.y + margin,
            );
            let (from, to) = if b.y > a.y {
                (a.lerp(b, part(bottom)), a.lerp(b, part(top)))
            } else {
                (a, b)
            };
            let (left, right) = index_range(
                from.x.min(to.x) - margin,
                from.x.max(to.x) + margin,
                self.tile.x,
            );
            for column in left.max(0)..=right.min(self.columns as i64 - 1) {
                self.sides[row as usize * self.columns + column as usize] = Side::Border;
            }
        }
    }
}

/// The first and last tile that meet an interval, with one more where it ends on a tile's side.
fn index_range(low: f64, high: f64, tile: f64) -> (i64, i64) {
    ((low / tile).floor() as i64, (high / tile).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Polygon;

    #[test]
    fn tiles_away_from_the_border_are_on_one_side() {
        let ring = |lo: f64, hi: f64| {
            [[lo, lo], [hi, lo], [hi, hi], [lo, hi]]
                .map(Point::from)
                .to_vec()
        };
        let mut hole = ring(4.0, 6.0);
        hole.reverse();
        let region = Region::of_area(vec![Polygon {
            outer: ring(0.0, 10.0),
            holes: vec![hole],
        }]);
        for tiles in [1, 100, 1009, 10_000] {
            let raster = RegionRaster::new(&region, tiles, 1e-9);
            for (i, j) in (-5..115).flat_map(|i| (-5..115).map(move |j| (i, j))) {
                let p = Point::new(f64::from(i), f64::from(j)) * 0.1;
                let inside = region.area[0].contains(p);
                let bounds = Bounds::of([p]).grown(0.01);
                match raster.side(&bounds) {
                    Side::Inside => assert!(inside, "{tiles} {p:?}"),
                    Side::Outside => assert!(!inside, "{tiles} {p:?}"),
                    Side::Border => assert!(
                        tiles < 10_000
                            || [0.0, 4.0, 6.0, 10.0]
                                .iter()
                                .any(|v| (p.x - v).abs().min((p.y - v).abs()) < 0.21)
                    ),
                }
            }
        }
        assert_eq!(
            RegionRaster::new(&region, 10_000, 1e-9)
                .side(&Bounds::of([Point::new(2.0, 2.0)]).grown(0.5)),
            Side::Inside
        );
        assert_eq!(
            RegionRaster::new(&region, 100, 1e-9).side(&Bounds::of([Point::new(12.0, 2.0)])),
            Side::Outside
        );
    }
}
