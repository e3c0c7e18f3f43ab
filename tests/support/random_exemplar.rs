//! Random exemplars for tests and benchmarks: cells of a grid, with their corners moved. The file
//! is taken in by path, because it is no part of the library.

use fretwork_geometry::polygon::signed_area;
use fretwork_geometry::{Point, Ring, Seed};

/// How a random exemplar looks.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Cells along u.
    pub columns: usize,
    /// Cells along v; every second row is a rail or a gap.
    pub rows: usize,
    /// The share of cells between rails that are filled.
    pub filled: f64,
    /// How far corners move along v and along u, in cells.
    pub jitter: [f64; 2],
}

/// The contours of a seed's exemplar, the interior on their left, v up.
pub fn contours(sample: Sample, seed: u64) -> Vec<Ring> {
    let Sample {
        columns,
        rows,
        filled,
        jitter,
    } = sample;
    let seed = Seed::root(seed);
    let mut cells = vec![vec![false; rows + 2]; columns + 2];
    for (x, column) in cells.iter_mut().enumerate().take(columns + 1).skip(1) {
        for (y, cell) in column.iter_mut().enumerate().take(rows + 1).skip(1) {
            // Rails are mostly there, what joins them is rarer.
            let share = if y % 2 == 1 { 0.75 } else { filled };
            *cell = seed.number(x as i64).number(y as i64).unit(0) < share;
        }
    }
    if cells.iter().flatten().all(|c| !c) {
        cells[1][1] = true;
    }
    part_corners(&mut cells);
    trace(&cells, |x, y| {
        let s = seed.name("corner").number(x as i64).number(y as i64);
        Point::new(
            x as f64 + jitter[1] * s.range(0, -1.0, 1.0),
            y as f64 + jitter[0] * s.range(1, -1.0, 1.0),
        )
    })
}

/// Fills cells until no two touch at a corner only.
fn part_corners(cells: &mut [Vec<bool>]) {
    let mut fixed = false;
    while !fixed {
        fixed = true;
        for x in 0..cells.len() - 1 {
            for y in 0..cells[0].len() - 1 {
                let corners = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
                let four = corners.map(|(x, y)| cells[x][y]);
                let other = match four {
                    [true, false, false, true] => corners[1],
                    [false, true, true, false] => corners[0],
                    _ => continue,
                };
                cells[other.0][other.1] = true;
                fixed = false;
            }
        }
    }
}

/// The outlines of the filled cells, which lie on their left.
fn trace(cells: &[Vec<bool>], corner: impl Fn(usize, usize) -> Point) -> Vec<Ring> {
    let mut next = std::collections::BTreeMap::new();
    for x in 1..cells.len() - 1 {
        for y in 1..cells[0].len() - 1 {
            if !cells[x][y] {
                continue;
            }
            let mut side = |empty: bool, from: (usize, usize), to: (usize, usize)| {
                if empty {
                    next.insert(from, to);
                }
            };
            side(!cells[x][y - 1], (x, y), (x + 1, y));
            side(!cells[x + 1][y], (x + 1, y), (x + 1, y + 1));
            side(!cells[x][y + 1], (x + 1, y + 1), (x, y + 1));
            side(!cells[x - 1][y], (x, y + 1), (x, y));
        }
    }
    let mut rings = Vec::new();
    while let Some((&start, _)) = next.iter().next() {
        let mut ring = Vec::new();
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            ring.push(corner(at.0, at.1));
            at = to;
        }
        rings.push(ring);
    }
    rings.sort_by(|a: &Ring, b| signed_area(b).total_cmp(&signed_area(a)));
    rings
}
