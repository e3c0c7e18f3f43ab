//! The dynamic program (Zhou 2014, section 3.6.2), run from the end backward: the least cost to go
//! from every state, for every remaining length and every remaining count. What is asked for, and
//! which of the ways is taken, is decided in `search`.

use std::ops::Range;

use super::cell_layout::CellLayout;
use super::packed_cost::{Choice, PackedCost};
use super::quantized::{Keep, Quantized, Remaining};
use super::states::States;

/// The least costs to the end.
///
/// Invariant: the cell of (state, remaining length, counts, level) holds the least sum of step
/// costs over all ways from the state to an end that use up exactly that length and those counts,
/// if the last piece of every state on the way stands at a level where it may.
pub struct CostToGo {
    layout: CellLayout,
    /// The cost from the first state, per remaining length, with the counts and level asked for.
    pub start: Vec<Option<u64>>,
    /// How the way goes on from every cell of every state; kept for walks along one way.
    choices: Vec<Vec<u8>>,
    /// The cost of every cell of every state without padding; kept for searches forward.
    costs: Vec<Vec<f32>>,
}

impl CostToGo {
    /// Fills the table. `start` is what remains after the first piece, but for the length.
    ///
    /// Rows are filled by ascending remaining length, in blocks as long as the shortest step: the
    /// rows of a block depend only on earlier blocks, so that a whole block of a state is one
    /// straight loop. Only the rows that the longest step reaches back to are kept with full
    /// precision. Takes one addition and one comparison for each cell and step.
    pub fn fill(states: &States, quantized: &Quantized, start: Remaining, keep: Keep) -> CostToGo {
        let rows = quantized.longest as usize + 1;
        let mut filler = Filler::new(states, quantized, rows);
        let layout = filler.layout;
        let (choices, costs) = match keep {
            Keep::Choices => (rows * layout.cells, 0),
            Keep::Costs => (0, rows * layout.full()),
        };
        let none = PackedCost::IMPOSSIBLE.unpack().1;
        let mut table = CostToGo {
            layout,
            start: Vec::with_capacity(rows),
            choices: vec![vec![none; choices]; states.len()],
            costs: (0..states.len())
                .map(|_| Vec::with_capacity(costs))
                .collect(),
        };
        let asked = layout.cell(start.components, start.holes, start.level);
        let mut row = 0;
        while row < rows {
            let count = filler.block.min(rows - row);
            filler.make_room(row, row + count);
            for state in 0..states.len() {
                filler.relax(state, row, count, &mut table.choices[state]);
            }
            let cost = |row: usize| filler.windows[0][filler.index(row) + asked].cost();
            table.start.extend((row..row + count).map(cost));
            if keep == Keep::Costs {
                table.keep_costs(&filler, row..row + count);
            }
            row += count;
        }
        table
    }

    /// Takes over the costs of filled rows.
    fn keep_costs(&mut self, filler: &Filler<'_>, rows: Range<usize>) {
        for (list, window) in self.costs.iter_mut().zip(&filler.windows) {
            let block = &window[filler.index(rows.start)..filler.index(rows.end)];
            for line in self.layout.full_lines(block) {
                list.extend(line.iter().map(|c| c.rounded_cost()));
            }
        }
    }

    /// The least cost from `state` to the end, rounded; infinite where there is no way, or where
    /// costs were not kept.
    pub fn cost(&self, state: u32, rest: Remaining) -> f64 {
        self.costs[state as usize]
            .get(self.layout.full_cell(rest))
            .map_or(f64::INFINITY, |&cost| cost.into())
    }

    /// How many cells there are in all states, without padding.
    pub fn size(&self) -> usize {
        self.start.len() * self.layout.full() * self.costs.len()
    }

    /// The number of a cell among all of them, below [`CostToGo::size`].
    pub fn index(&self, state: u32, rest: Remaining) -> usize {
        state as usize * self.start.len() * self.layout.full() + self.layout.full_cell(rest)
    }

    /// How the cheapest way from `state` goes on; none where choices were not kept.
    pub fn choice(&self, state: u32, rest: Remaining) -> Choice {
        let byte = self.choices[state as usize].get(self.layout.cell_of_all(rest));
        byte.map_or(Choice::None, |&byte| Choice::of(byte))
    }
}

/// The part of a table that is being filled.
struct Filler<'a> {
    states: &'a States,
    quantized: &'a Quantized,
    layout: CellLayout,
    /// How many rows depend on no other row of the same block.
    block: usize,
    /// How many rows a step can reach back.
    history: usize,
    /// How many rows a window holds.
    capacity: usize,
    /// The row at index `history` of the windows.
    base: usize,
    /// The costs of recent rows, for each state.
    windows: Vec<Vec<PackedCost>>,
    /// The block that is being filled.
    scratch: Vec<PackedCost>,
}

impl<'a> Filler<'a> {
    fn new(states: &'a States, quantized: &'a Quantized, rows: usize) -> Filler<'a> {
        let layout = CellLayout::new(states, quantized);
        let lengths = || quantized.lengths.iter().copied();
        let shortest = lengths().min().unwrap_or(1).max(1) as usize;
        let longest = lengths().max().unwrap_or(1).max(1) as usize;
        let block = shortest.min(rows);
        // A window moves on when it is full. It is long enough for that to be rare.
        let capacity = longest + 1 + (2 * longest).max(shortest).max(64) + shortest;
        let window = || vec![PackedCost::NEVER; (capacity + 1) * layout.cells];
        Filler {
            states,
            quantized,
            layout,
            block,
            history: longest + 1,
            capacity,
            base: 0,
            windows: (0..states.len()).map(|_| window()).collect(),
            scratch: vec![PackedCost::NEVER; block * layout.cells],
        }
    }

    /// Where a row begins in a window.
    fn index(&self, row: usize) -> usize {
        (row + self.history - self.base) * self.layout.cells
    }

    /// Moves the windows on until they hold the rows from `row` to below `end` and those that these
    /// depend on.
    fn make_room(&mut self, row: usize, end: usize) {
        if end + self.history - self.base <= self.capacity {
            return;
        }
        let from = row - self.base;
        let cells = self.layout.cells;
        for window in &mut self.windows {
            window.copy_within(from * cells..(from + self.history) * cells, 0);
            window[self.history * cells..].fill(PackedCost::NEVER);
        }
        self.base = row;
    }

    /// Fills the rows `row..row + count` of one state; `choices` is empty where they are not kept.
    fn relax(&mut self, state: usize, row: usize, count: usize, choices: &mut [u8]) {
        let cells = self.layout.cells;
        let begin = self.index(row);
        let scratch = &mut self.scratch[..count * cells];
        scratch.fill(PackedCost::IMPOSSIBLE);
        let base = self.states.step_base(state as u32);
        for (k, step) in self.states.steps(state as u32).iter().enumerate() {
            let shift = self.layout.shift(self.quantized, base + k, step);
            let source = (begin as isize - shift) as usize;
            let from = &self.windows[step.to as usize][source..source + count * cells];
            let way = PackedCost::step(self.quantized.costs[base + k], k);
            for (best, &c) in scratch.iter_mut().zip(from) {
                *best = best.or(c.after(way));
            }
        }
        self.enter_end(state, row, count);
        if !self.layout.is_plain() {
            self.empty_forbidden(state, count);
        }
        let window = &mut self.windows[state][begin..begin + count * cells];
        if choices.is_empty() {
            self.scratch
                .iter()
                .zip(window)
                .for_each(|(best, cost)| *cost = best.unpack().0);
            return;
        }
        let choices = &mut choices[row * cells..(row + count) * cells];
        for ((best, cost), choice) in self.scratch.iter().zip(window).zip(choices) {
            (*cost, *choice) = best.unpack();
        }
    }

    /// Enters the state's end where it lies in the block.
    fn enter_end(&mut self, state: usize, row: usize, count: usize) {
        let Some(end) = &self.states.ends[state] else {
            return;
        };
        let (length, cost) = self.quantized.ends[state];
        let [components, holes] = self.quantized.counted(end.components, end.holes);
        let length = length as usize;
        let possible = components <= self.quantized.components && holes <= self.quantized.holes;
        if possible && (row..row + count).contains(&length) {
            for level in self.quantized.end_levels.0..=self.quantized.end_levels.1 {
                let cell =
                    (length - row) * self.layout.cells + self.layout.cell(components, holes, level);
                self.scratch[cell] = self.scratch[cell].or(PackedCost::end(cost));
            }
        }
    }

    /// Empties the padding, and the cells of levels at which the state's piece may not stand.
    fn empty_forbidden(&mut self, state: usize, count: usize) {
        let CellLayout { pads, sizes, cells } = self.layout;
        let (low, high) = self.quantized.levels[state];
        for row in self.scratch[..count * cells].chunks_mut(cells) {
            for (c, plane) in row.chunks_mut(sizes[1] * sizes[2]).enumerate() {
                for (h, line) in plane.chunks_mut(sizes[2]).enumerate() {
                    if c < pads[0] || h < pads[1] || low > high {
                        line.fill(PackedCost::IMPOSSIBLE);
                    } else {
                        line[..pads[2] + low as usize].fill(PackedCost::IMPOSSIBLE);
                        line[pads[2] + high as usize + 1..].fill(PackedCost::IMPOSSIBLE);
                    }
                }
            }
        }
    }
}
