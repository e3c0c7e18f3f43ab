//! The table of the dynamic program (Zhou 2014, section 3.6.2): for every state, every remaining
//! length and every remaining count, the cheapest way to the end. What is asked for, and which
//! of the ways is taken, is decided in `solver`.

use crate::solve::states::States;

/// Steps, ends and limits in whole numbers.
#[derive(Clone, Debug)]
pub struct Scaled {
    /// The length of each step of [`States::all_steps`], above zero.
    pub lengths: Vec<u32>,
    /// The cost of each step.
    pub costs: Vec<u64>,
    /// The rise of each step.
    pub rises: Vec<i32>,
    /// Length and cost of each state's end.
    pub ends: Vec<(u32, u64)>,
    /// The longest remaining length.
    pub longest: u32,
    /// The largest counts of components and holes that remain; 0 where they are not tracked.
    pub components: u32,
    /// See `components`.
    pub holes: u32,
    /// Whether components and holes are tracked.
    pub tracked: [bool; 2],
    /// The lowest and highest offset at which the last piece of each state may stand, from the lowest
    /// of all; one level, and rises of 0, where drift is not tracked.
    pub levels: Vec<(u32, u32)>,
    /// How many levels there are.
    pub level_count: u32,
    /// The lowest and highest level at which a pattern may end.
    pub end_levels: (u32, u32),
}

/// What remains to be done, in the units of [`Scaled`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rest {
    /// Length after the state's last piece.
    pub length: u32,
    /// Components still to be closed.
    pub components: u32,
    /// Holes still to be closed.
    pub holes: u32,
    /// The offset of the state's last piece.
    pub level: u32,
}

/// How the cheapest way goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// There is no way.
    None,
    /// The pattern ends.
    End,
    /// With this step of the state.
    Step(usize),
}

const NONE: u8 = 255;
const END: u8 = 254;
/// A cell holds 256 · cost + choice in an f64, exactly: the smaller of two is the cheaper, and of equals the
/// earlier choice. What is not below this has no way to the end.
const NEVER: f64 = (1u64 << 50) as f64;
/// No sum of costs may reach this; a step that costs as much is never taken.
pub const COST_LIMIT: u64 = 1 << 42;

/// The cheapest ways to the end.
pub struct Table {
    shape: Shape,
    /// The cost from the first state, per remaining length, with the counts and level that were asked.
    pub start: Vec<Option<u64>>,
    /// How the way goes on from every cell of every state; kept for searches backward.
    choices: Vec<Vec<u8>>,
    /// The cost of every cell of every state, the empty ones left out; kept for searches forward.
    costs: Vec<Vec<f32>>,
}

/// What is kept of the cells of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// How the cheapest way goes on.
    Choices,
    /// Its cost.
    Costs,
}

/// How the cells of one remaining length are laid out: components, then holes, then levels, each after
/// empty cells that catch steps below zero.
#[derive(Clone, Copy, Debug)]
struct Shape {
    pads: [usize; 3],
    sizes: [usize; 3],
    cells: usize,
}

impl Shape {
    fn new(states: &States, scaled: &Scaled) -> Shape {
        let most = |tracked: bool, count: &dyn Fn(&crate::solve::states::Step) -> u32| {
            if tracked {
                states.all_steps().iter().map(count).max().unwrap_or(0) as usize
            } else {
                0
            }
        };
        let components = most(scaled.tracked[0], &|s| s.components);
        let holes = most(scaled.tracked[1], &|s| s.holes);
        let rise = scaled
            .rises
            .iter()
            .map(|r| r.unsigned_abs())
            .max()
            .unwrap_or(0)
            .min(scaled.level_count) as usize;
        let pads = [components, holes, rise];
        let sizes = [
            scaled.components as usize + 1 + components,
            scaled.holes as usize + 1 + holes,
            scaled.level_count as usize + rise,
        ];
        Shape {
            pads,
            sizes,
            cells: sizes.iter().product(),
        }
    }

    fn cell(&self, components: u32, holes: u32, level: u32) -> usize {
        let [c, h, l] = [
            components as usize + self.pads[0],
            holes as usize + self.pads[1],
            level as usize + self.pads[2],
        ];
        (c * self.sizes[1] + h) * self.sizes[2] + l
    }

    /// How many cells of one remaining length are not empty.
    fn full(&self) -> usize {
        (0..3).map(|i| self.sizes[i] - self.pads[i]).product()
    }

    /// The number of a cell among those that are not empty.
    fn full_cell(&self, rest: Rest) -> usize {
        let [_, holes, levels] = [0, 1, 2].map(|i| self.sizes[i] - self.pads[i]);
        let place =
            (rest.components as usize * holes + rest.holes as usize) * levels + rest.level as usize;
        rest.length as usize * self.full() + place
    }

    /// The cells of remaining lengths that are not empty, those of all levels together.
    fn full_lines<'a>(&self, rows: &'a [f64]) -> impl Iterator<Item = &'a [f64]> {
        let Shape { pads, sizes, cells } = *self;
        let planes = rows
            .chunks(cells)
            .flat_map(move |row| row.chunks(sizes[1] * sizes[2]).skip(pads[0]));
        planes
            .flat_map(move |plane| plane.chunks(sizes[2]).skip(pads[1]))
            .map(move |line| &line[pads[2]..])
    }

    fn is_plain(&self) -> bool {
        self.cells == 1
    }
}

/// How many cells a table of these would have.
pub fn size(states: &States, scaled: &Scaled) -> usize {
    Shape::new(states, scaled)
        .cells
        .saturating_mul(scaled.longest as usize + 1)
        .saturating_mul(states.len())
}

/// One state's costs of recent lengths.
struct Window {
    cells: Vec<f64>,
}

impl Table {
    /// Fills the table from the end backward. `start` is what remains after the first piece, but for the length.
    /// Takes time proportional to cells times steps per state, and a byte a cell for choices or four for costs; one step is
    /// one addition and one comparison.
    pub fn fill(states: &States, scaled: &Scaled, start: Rest, keep: Keep) -> Table {
        let rows = scaled.longest as usize + 1;
        let mut filler = Filler::new(states, scaled, rows);
        let shape = filler.shape;
        let cells = rows * shape.cells;
        let (choices, costs) = if keep == Keep::Choices {
            (cells, 0)
        } else {
            (0, rows * shape.full())
        };
        let mut table = Table {
            shape,
            start: Vec::with_capacity(rows),
            choices: vec![vec![NONE; choices]; states.len()],
            costs: (0..states.len())
                .map(|_| Vec::with_capacity(costs))
                .collect(),
        };
        let asked = shape.cell(start.components, start.holes, start.level);
        let mut row = 0;
        while row < rows {
            let count = filler.block.min(rows - row);
            filler.make_room(row, row + count);
            for state in 0..states.len() {
                filler.relax(state, row, count, &mut table.choices[state]);
            }
            let cost = |row: usize| filler.windows[0].cells[filler.index(row) + asked];
            table.start.extend(
                (row..row + count)
                    .map(cost)
                    .map(|c| (c < NEVER).then_some(c as u64 / 256)),
            );
            if keep == Keep::Costs {
                table.keep_costs(&filler, row..row + count);
            }
            row += count;
        }
        table
    }

    /// Takes over the costs of filled rows.
    fn keep_costs(&mut self, filler: &Filler<'_>, rows: std::ops::Range<usize>) {
        for (list, window) in self.costs.iter_mut().zip(&filler.windows) {
            let block = &window.cells[filler.index(rows.start)..filler.index(rows.end)];
            for line in self.shape.full_lines(block) {
                list.extend(line.iter().map(|&c| {
                    if c < NEVER {
                        (c / 256.0) as f32
                    } else {
                        f32::INFINITY
                    }
                }));
            }
        }
    }

    /// The least cost from `state` to the end, rounded; infinite where there is no way, or where costs were not kept.
    pub fn cost(&self, state: u32, rest: Rest) -> f64 {
        self.costs[state as usize]
            .get(self.shape.full_cell(rest))
            .map_or(f64::INFINITY, |&cost| cost.into())
    }

    /// How many cells there are, of all states.
    pub fn size(&self) -> usize {
        self.start.len() * self.shape.full() * self.costs.len()
    }

    /// The number of a cell among all, below [`Table::size`].
    pub fn index(&self, state: u32, rest: Rest) -> usize {
        state as usize * self.start.len() * self.shape.full() + self.shape.full_cell(rest)
    }

    /// How the cheapest way from `state` goes on; none where choices were not kept.
    pub fn choice(&self, state: u32, rest: Rest) -> Choice {
        match self.choices[state as usize].get(self.cell(rest)) {
            None | Some(&NONE) => Choice::None,
            Some(&END) => Choice::End,
            Some(&step) => Choice::Step(step as usize),
        }
    }

    fn cell(&self, rest: Rest) -> usize {
        rest.length as usize * self.shape.cells
            + self.shape.cell(rest.components, rest.holes, rest.level)
    }
}

struct Filler<'a> {
    states: &'a States,
    scaled: &'a Scaled,
    shape: Shape,
    /// Rows that depend on no other row of the same block.
    block: usize,
    history: usize,
    capacity: usize,
    /// The row at index `history` of the windows.
    base: usize,
    windows: Vec<Window>,
    scratch: Vec<f64>,
}

impl<'a> Filler<'a> {
    fn new(states: &'a States, scaled: &'a Scaled, rows: usize) -> Filler<'a> {
        let shape = Shape::new(states, scaled);
        let shortest = scaled.lengths.iter().copied().min().unwrap_or(1).max(1) as usize;
        let longest = scaled.lengths.iter().copied().max().unwrap_or(1).max(1) as usize;
        let block = shortest.min(rows);
        // The window moves on when it is full; it is long enough for that to be rare.
        let capacity = longest + 1 + (2 * longest).max(shortest).max(64) + shortest;
        let window = || Window {
            cells: vec![NEVER; (capacity + 1) * shape.cells],
        };
        Filler {
            states,
            scaled,
            shape,
            block,
            history: longest + 1,
            capacity,
            base: 0,
            windows: (0..states.len()).map(|_| window()).collect(),
            scratch: vec![0.0; block * shape.cells],
        }
    }

    fn index(&self, row: usize) -> usize {
        (row + self.history - self.base) * self.shape.cells
    }

    /// Moves the windows on until they hold the rows from `row` to below `end` and what those depend on.
    fn make_room(&mut self, row: usize, end: usize) {
        if end + self.history - self.base <= self.capacity {
            return;
        }
        let from = row - self.base;
        let cells = self.shape.cells;
        for window in &mut self.windows {
            window
                .cells
                .copy_within(from * cells..(from + self.history) * cells, 0);
            window.cells[self.history * cells..].fill(NEVER);
        }
        self.base = row;
    }

    /// The rows `row..row + count` of one state; `choices` are empty where they are not kept.
    fn relax(&mut self, state: usize, row: usize, count: usize, choices: &mut [u8]) {
        let cells = self.shape.cells;
        let begin = self.index(row);
        let scratch = &mut self.scratch[..count * cells];
        scratch.fill(NEVER + f64::from(NONE));
        let first = self.states.steps(state as u32);
        let base = self.states.step_base(state as u32);
        for (k, step) in first.iter().enumerate() {
            let shift = shift(&self.shape, self.scaled, base + k, step);
            let source = (begin as isize - shift) as usize;
            let from = &self.windows[step.to as usize].cells[source..source + count * cells];
            let cost = (self.scaled.costs[base + k] * 256 + k as u64) as f64;
            for (best, &c) in scratch.iter_mut().zip(from) {
                let way = c + cost;
                *best = if way < *best { way } else { *best };
            }
        }
        self.end(state, row, count);
        if !self.shape.is_plain() {
            self.forbid(state, count);
        }
        let window = &mut self.windows[state].cells[begin..begin + count * cells];
        if choices.is_empty() {
            self.scratch
                .iter()
                .zip(window)
                .for_each(|(&best, cost)| *cost = way(best).0);
            return;
        }
        let choices = &mut choices[row * cells..(row + count) * cells];
        for ((&best, cost), choice) in self.scratch.iter().zip(window).zip(choices) {
            (*cost, *choice) = way(best);
        }
    }

    /// Enters the state's end where it lies in the block.
    fn end(&mut self, state: usize, row: usize, count: usize) {
        let Some(end) = &self.states.ends[state] else {
            return;
        };
        let (length, cost) = self.scaled.ends[state];
        let [components, holes] = [end.components, end.holes];
        let needed = [
            if self.scaled.tracked[0] {
                components
            } else {
                0
            },
            if self.scaled.tracked[1] { holes } else { 0 },
        ];
        let length = length as usize;
        let possible = needed[0] <= self.scaled.components && needed[1] <= self.scaled.holes;
        if possible && (row..row + count).contains(&length) {
            for level in self.scaled.end_levels.0..=self.scaled.end_levels.1 {
                let cell = (length - row) * self.shape.cells
                    + self.shape.cell(needed[0], needed[1], level);
                let way = (cost * 256) as f64 + f64::from(END);
                self.scratch[cell] = self.scratch[cell].min(way);
            }
        }
    }

    /// Empties the cells that stand for nothing, and those of levels where the piece may not be.
    fn forbid(&mut self, state: usize, count: usize) {
        const IMPOSSIBLE: f64 = NEVER + NONE as f64;
        let Shape { pads, sizes, cells } = self.shape;
        let (low, high) = self.scaled.levels[state];
        for row in self.scratch[..count * cells].chunks_mut(cells) {
            for (c, plane) in row.chunks_mut(sizes[1] * sizes[2]).enumerate() {
                for (h, line) in plane.chunks_mut(sizes[2]).enumerate() {
                    if c < pads[0] || h < pads[1] || low > high {
                        line.fill(IMPOSSIBLE);
                    } else {
                        line[..pads[2] + low as usize].fill(IMPOSSIBLE);
                        line[pads[2] + high as usize + 1..].fill(IMPOSSIBLE);
                    }
                }
            }
        }
    }
}

/// What a cell holds, taken apart: 256 · cost, and the choice.
fn way(cell: f64) -> (f64, u8) {
    // Rounds down to a multiple of 256: the sum has no room for smaller digits.
    const ROUND: f64 = 1.5 * (1u64 << 60) as f64;
    let floor = (cell - 127.5 + ROUND) - ROUND;
    if floor >= NEVER {
        (NEVER, NONE)
    } else {
        (floor, (cell - floor) as u8)
    }
}

/// How many cells lie between a cell and the one that `step` leads to.
fn shift(
    shape: &Shape,
    scaled: &Scaled,
    number: usize,
    step: &crate::solve::states::Step,
) -> isize {
    let components = if scaled.tracked[0] {
        step.components as usize
    } else {
        0
    };
    let holes = if scaled.tracked[1] {
        step.holes as usize
    } else {
        0
    };
    let planes = (components * shape.sizes[1] + holes) * shape.sizes[2];
    (scaled.lengths[number] as usize * shape.cells + planes) as isize
        - scaled.rises[number] as isize
}
