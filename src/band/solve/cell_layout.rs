//! How the cells of a table lie in memory. A row is one remaining length; in it come components,
//! then holes, then levels. Each of the three begins with padding: cells that stay empty, so that a
//! step which closes more than remains, or rises out of the band, finds no way there and needs no
//! test in the inner loop.

use super::packed_cost::PackedCost;
use super::quantized::{Quantized, Remaining};
use super::states::{States, Step};

/// The layout of the cells of one remaining length.
#[derive(Clone, Copy, Debug)]
pub struct CellLayout {
    /// Padding before components, holes and levels.
    pub pads: [usize; 3],
    /// Components, holes and levels with their padding.
    pub sizes: [usize; 3],
    /// All cells of one remaining length.
    pub cells: usize,
}

impl CellLayout {
    /// The layout for these numbers; the padding is as wide as the largest step.
    pub fn new(states: &States, quantized: &Quantized) -> CellLayout {
        let mut most = [0; 2];
        for step in states.all_steps() {
            let counted = quantized.counted(step.components, step.holes);
            most = [0, 1].map(|i| counted[i].max(most[i]));
        }
        let rises = quantized.rises.iter().map(|r| r.unsigned_abs());
        let rise = rises.max().unwrap_or(0).min(quantized.level_count);
        let pads = [most[0] as usize, most[1] as usize, rise as usize];
        let sizes = [
            quantized.components as usize + 1 + pads[0],
            quantized.holes as usize + 1 + pads[1],
            quantized.level_count as usize + pads[2],
        ];
        CellLayout {
            pads,
            sizes,
            cells: sizes.iter().product(),
        }
    }

    /// The place of a cell in its row.
    pub fn cell(&self, components: u32, holes: u32, level: u32) -> usize {
        let [c, h, l] = [
            components as usize + self.pads[0],
            holes as usize + self.pads[1],
            level as usize + self.pads[2],
        ];
        (c * self.sizes[1] + h) * self.sizes[2] + l
    }

    /// The place of a cell among those of all rows.
    pub fn cell_of_all(&self, rest: Remaining) -> usize {
        rest.length as usize * self.cells + self.cell(rest.components, rest.holes, rest.level)
    }

    /// How many cells of one row are no padding.
    pub fn full(&self) -> usize {
        (0..3).map(|i| self.sizes[i] - self.pads[i]).product()
    }

    /// The place of a cell among those of all rows that are no padding.
    pub fn full_cell(&self, rest: Remaining) -> usize {
        let [_, holes, levels] = [0, 1, 2].map(|i| self.sizes[i] - self.pads[i]);
        let place =
            (rest.components as usize * holes + rest.holes as usize) * levels + rest.level as usize;
        rest.length as usize * self.full() + place
    }

    /// The cells of some rows that are no padding; all levels of one pair of counts come together.
    pub fn full_lines<'a>(
        &self,
        rows: &'a [PackedCost],
    ) -> impl Iterator<Item = &'a [PackedCost]> + use<'a> {
        let CellLayout { pads, sizes, cells } = *self;
        let planes = rows
            .chunks(cells)
            .flat_map(move |row| row.chunks(sizes[1] * sizes[2]).skip(pads[0]));
        planes
            .flat_map(move |plane| plane.chunks(sizes[2]).skip(pads[1]))
            .map(move |line| &line[pads[2]..])
    }

    /// Whether only lengths are tracked.
    pub fn is_plain(&self) -> bool {
        self.cells == 1
    }

    /// How many cells lie between a cell and the one that the step with this number leads to.
    pub fn shift(&self, quantized: &Quantized, number: usize, step: &Step) -> isize {
        let [components, holes] = quantized
            .counted(step.components, step.holes)
            .map(|n| n as usize);
        let planes = (components * self.sizes[1] + holes) * self.sizes[2];
        (quantized.lengths[number] as usize * self.cells + planes) as isize
            - quantized.rises[number] as isize
    }
}

/// How many cells a table of these numbers has.
pub fn size(states: &States, quantized: &Quantized) -> usize {
    CellLayout::new(states, quantized)
        .cells
        .saturating_mul(quantized.longest as usize + 1)
        .saturating_mul(states.len())
}
