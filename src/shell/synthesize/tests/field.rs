//! Pictures of solid and empty pixels, and how far one is from another in the small.

use fretwork_geometry::Seed;

use super::*;

/// The pixels of a window as bits: up to 16 along a side.
type Bits = [u64; 4];

/// A picture of solid and empty pixels that goes on forever.
pub(super) struct Field {
    pub size: [usize; 2],
    pub solid: Vec<bool>,
}

impl Field {
    /// Whether a pixel is solid, beyond the borders that on the other side.
    pub fn at(&self, x: usize, y: usize) -> bool {
        self.solid[y % self.size[1] * self.size[0] + x % self.size[0]]
    }

    /// The pixels of the window of this width with its corner at a place.
    fn window(&self, width: usize, x: usize, y: usize) -> Bits {
        let mut bits = Bits::default();
        for n in (0..width * width).filter(|n| self.at(x + n % width, y + n / width)) {
            bits[n / 64] |= 1 << (n % 64);
        }
        bits
    }

    /// The mean part of the pixels in which windows of this width of this picture differ from those that match
    /// best in another.
    pub fn distance(&self, width: usize, other: &Field) -> f64 {
        let places = |field: &Field, step: usize, margin: usize| {
            let along = |axis: usize| (0..field.size[axis] - margin).step_by(step);
            let rows = along(1).flat_map(|y| along(0).map(move |x| (x, y)));
            rows.map(|(x, y)| field.window(width, x, y))
                .collect::<Vec<Bits>>()
        };
        let known = places(other, 1, 0);
        let tried = places(self, 5, width);
        let unlike = |a: &Bits, b: &Bits| (0..4).map(|k| (a[k] ^ b[k]).count_ones()).sum::<u32>();
        let best = |w: &Bits| known.iter().map(|k| unlike(k, w)).min().unwrap();
        let sum: u32 = tried.iter().map(best).sum();
        f64::from(sum) / (tried.len() * width * width) as f64
    }
}

/// An exemplar that tiles.
pub(super) fn of_exemplar(exemplar: &Pixels) -> Field {
    Field {
        size: [exemplar.width, exemplar.height()],
        solid: exemplar.solid.clone(),
    }
}

/// The texture of a level square, seen from above with y up.
pub(super) fn of_square(levels: &[Level], pattern: &Pattern) -> Field {
    let cells = &levels[0].surface.voxels.cells;
    let [first, last] = [cells[0], cells[cells.len() - 1]];
    let size = [0, 1].map(|axis| usize::from(last[axis] - first[axis]) + 1);
    let mut solid = vec![false; size[0] * size[1]];
    for (cell, is_solid) in cells.iter().zip(&pattern.solid) {
        let [x, y] = [0, 1].map(|axis| usize::from(cell[axis] - first[axis]));
        solid[(size[1] - 1 - y) * size[0] + x] = *is_solid;
    }
    Field { size, solid }
}

/// Square pieces of an exemplar from random places, side by side.
pub(super) fn pieces(exemplar: &Field, size: [usize; 2], side: usize) -> Field {
    let seed = Seed::root(7);
    let at = |x: usize, y: usize| {
        let piece = seed.number((x / side) as i64).number((y / side) as i64);
        let from = |n: u64, axis: usize| (piece.unit(n) * exemplar.size[axis] as f64) as usize;
        let x = (from(0, 0) + x % side) % exemplar.size[0];
        let y = (from(1, 1) + y % side) % exemplar.size[1];
        exemplar.solid[y * exemplar.size[0] + x]
    };
    let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    Field {
        size,
        solid: places.map(|(x, y)| at(x, y)).collect(),
    }
}
