//! The tiles that lie deep in a region, row by row.

use crate::tiled::lattice::{Lattice, TileNumber};
use fretwork_geometry::{Point, Region};

/// Tiles, by the second number and then by ranges of the first.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rows {
    /// The second number of the first row.
    first: i64,
    /// Of each row the first and the last of each range, ascending.
    runs: Vec<Vec<[i64; 2]>>,
}

/// What the border of a region is to one row.
#[derive(Clone, Default)]
struct Row {
    /// The first and the last tile near a piece of the border.
    near: Vec<[i64; 2]>,
    /// Where the border crosses the middle of the row.
    crossings: Vec<f64>,
}

/// Where tiles lie.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiling {
    pub lattice: Lattice,
    pub origin: Point,
}

impl Tiling {
    /// The tiles in `region` that are `depth` away from its border, or more; of all rows, or of those from one to another.
    /// Nearly: tiles in corners may be taken for nearer than they are. Whether a tile is among them does not depend on the
    /// rows that are asked for.
    ///
    /// Time grows with the rows that the pieces of the border reach.
    pub fn deep(&self, region: &Region, depth: f64, within: Option<[i64; 2]>) -> Rows {
        let spread = self.lattice.spread(depth);
        let rings = || region.area.iter().flat_map(|polygon| polygon.rings());
        let number = |p: &Point| self.lattice.coordinates(*p - self.origin);
        let rows = rings().flatten().map(|p| libm::floor(number(p)[1]) as i64);
        let (low, high) = rows.fold((i64::MAX, i64::MIN), |(low, high), row| {
            (low.min(row), high.max(row))
        });
        let [low, high] = within.map_or([low, high], |[from, to]| [low.max(from), high.min(to)]);
        if low > high {
            return Rows {
                first: 0,
                runs: Vec::new(),
            };
        }
        let mut border = vec![Row::default(); (high - low + 1) as usize];
        for ring in rings() {
            let mut before = ring.last().map(number).unwrap_or_default();
            for p in ring {
                let here = number(p);
                add_piece(before, here, spread, low, &mut border);
                before = here;
            }
        }
        Rows {
            first: low,
            runs: border.into_iter().map(Row::runs).collect(),
        }
    }
}

/// Notes what a piece of the border from `a` to `b` is to the rows from `low` on.
fn add_piece(a: [f64; 2], b: [f64; 2], spread: [f64; 2], low: i64, border: &mut [Row]) {
    let (from, to) = if a[1] <= b[1] { (a, b) } else { (b, a) };
    let at = |v: f64| {
        if to[1] > from[1] {
            let part = ((v - from[1]) / (to[1] - from[1])).clamp(0.0, 1.0);
            from[0] + (to[0] - from[0]) * part
        } else {
            from[0]
        }
    };
    let row = |v: f64| libm::floor(v) as i64 - low;
    let (first, last) = (row(from[1] - spread[1]), row(to[1] + spread[1]));
    for n in first.max(0)..=last.min(border.len() as i64 - 1) {
        let row = &mut border[n as usize];
        let v = (low + n) as f64;
        let ends = if to[1] > from[1] {
            [at(v - spread[1]), at(v + 1.0 + spread[1])]
        } else {
            [from[0], to[0]]
        };
        let (least, greatest) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        row.near.push([
            libm::floor(least - spread[0]) as i64,
            libm::floor(greatest + spread[0]) as i64,
        ]);
        let middle = v + 0.5;
        if (from[1] <= middle) != (to[1] <= middle) {
            row.crossings.push(at(middle));
        }
    }
}

impl Row {
    /// The ranges between what is near the border that lie inside of it.
    fn runs(mut self) -> Vec<[i64; 2]> {
        self.near.sort_unstable();
        self.crossings.sort_by(f64::total_cmp);
        let mut runs = Vec::new();
        let mut reached = None;
        for [from, to] in self.near {
            if let Some(last) = reached
                && last + 1 < from
            {
                let middle = last as f64 + 1.5;
                let before = self.crossings.partition_point(|u| *u < middle);
                if before % 2 == 1 {
                    runs.push([last + 1, from - 1]);
                }
            }
            reached = Some(reached.map_or(to, |last: i64| last.max(to)));
        }
        runs
    }
}

impl Rows {
    /// Whether a tile is among them.
    pub fn contains(&self, [i, j]: TileNumber) -> bool {
        let row = j
            .checked_sub(self.first)
            .and_then(|n| usize::try_from(n).ok());
        let Some(runs) = row.and_then(|n| self.runs.get(n)) else {
            return false;
        };
        let after = runs.partition_point(|run| run[0] <= i);
        after > 0 && i <= runs[after - 1][1]
    }

    /// How many there are.
    pub fn count(&self) -> u64 {
        let runs = self.runs.iter().flatten();
        runs.map(|run| (run[1] - run[0] + 1).unsigned_abs()).sum()
    }

    /// The tiles, by rows.
    pub fn tiles(&self) -> impl Iterator<Item = TileNumber> + '_ {
        (self.first..).zip(&self.runs).flat_map(|(j, runs)| {
            let of_run = move |run: &[i64; 2]| (run[0]..=run[1]).map(move |i| [i, j]);
            runs.iter().flat_map(of_run)
        })
    }

    /// Their ranges, each as far up as the rows above have the same one: the first and the last tile of each block.
    pub fn blocks(&self) -> Vec<[TileNumber; 2]> {
        let mut open: Vec<[TileNumber; 2]> = Vec::new();
        let mut blocks = Vec::new();
        for (j, runs) in (self.first..).zip(&self.runs) {
            let (mut on, mut ended) = (Vec::new(), Vec::new());
            for block in open {
                let is_same = runs.iter().any(|run| *run == [block[0][0], block[1][0]]);
                if is_same { &mut on } else { &mut ended }.push(block);
            }
            blocks.extend(ended);
            for run in runs {
                match on.iter_mut().find(|block| block[0][0] == run[0]) {
                    Some(block) => block[1][1] = j,
                    None => on.push([[run[0], j], [run[1], j]]),
                }
            }
            open = on;
        }
        blocks.extend(open);
        blocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    fn tiling(periods: [[f64; 2]; 2]) -> Tiling {
        Tiling {
            lattice: Lattice::of(periods.map(Point::from)).expect("two periods"),
            origin: Point::new(0.3, -0.7),
        }
    }

    #[test]
    fn deep_tiles_are_inside_and_far_from_the_border_and_none_is_missing() {
        for (n, periods) in [[[2.0, 0.0], [0.0, 1.0]], [[1.0, 1.5], [-2.0, 0.5]]]
            .into_iter()
            .enumerate()
        {
            let seed = Seed::root(7 + n as u64);
            let ring = (0..40).map(|k| {
                let angle = k as f64 * std::f64::consts::TAU / 40.0;
                Point::unit(angle) * seed.range(k, 20.0, 60.0)
            });
            let region = Region::of_area(vec![fretwork_geometry::Polygon {
                outer: ring.collect(),
                holes: vec![],
            }]);
            let tiling = tiling(periods);
            let rows = tiling.deep(&region, 3.0, None);
            let distance = |p: Point| {
                let ring = &region.area[0].outer;
                let ends = ring.iter().zip(ring.iter().cycle().skip(1));
                ends.map(|(a, b)| {
                    let (d, q) = (*b - *a, p - *a);
                    p.distance(*a + d * (q.dot(d) / d.dot(d)).clamp(0.0, 1.0))
                })
                .fold(f64::INFINITY, f64::min)
            };
            assert!(rows.count() > 100);
            for i in -80..80 {
                for j in -80..80 {
                    let corner = tiling.origin + tiling.lattice.at([i, j]);
                    let center = corner + tiling.lattice.point([0.5, 0.5]);
                    let is_inside = region.area[0].contains(center);
                    if rows.contains([i, j]) {
                        assert!(is_inside && distance(center) >= 3.0, "{i} {j}");
                    } else {
                        // What is not found is not much deeper than asked for.
                        assert!(!is_inside || distance(center) < 3.0 + 9.0, "{i} {j}");
                    }
                }
            }
            let part = tiling.deep(&region, 3.0, Some([-3, 4]));
            let some = rows.tiles().filter(|k| (-3..=4).contains(&k[1]));
            assert!(part.tiles().eq(some));
            let in_blocks: u64 = rows
                .blocks()
                .iter()
                .map(|[a, b]| ((b[0] - a[0] + 1) * (b[1] - a[1] + 1)) as u64)
                .sum();
            assert_eq!(in_blocks, rows.count());
        }
    }
}
