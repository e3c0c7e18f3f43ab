//! The graph's numbers as the table of the dynamic program takes them: whole numbers of rows,
//! counts and levels. How they are chosen is decided in `quantize`.

/// Steps, ends and limits in whole numbers.
#[derive(Clone, Debug)]
pub struct Quantized {
    /// The length in rows of each step of `States::all_steps`, above zero.
    pub lengths: Vec<u32>,
    /// The cost of each step.
    pub costs: Vec<u64>,
    /// The rise in levels of each step; 0 where drift is not tracked.
    pub rises: Vec<i32>,
    /// Length and cost of each state's end.
    pub ends: Vec<(u32, u64)>,
    /// The longest remaining length.
    pub longest: u32,
    /// The largest count of components that remains; 0 where they are not tracked.
    pub components: u32,
    /// The largest count of holes that remains; 0 where they are not tracked.
    pub holes: u32,
    /// Whether components and holes are tracked.
    pub tracked: [bool; 2],
    /// The lowest and the highest level at which the last piece of each state may stand. There is
    /// one level, 0, where drift is not tracked.
    pub levels: Vec<(u32, u32)>,
    /// How many levels there are.
    pub level_count: u32,
    /// The lowest and the highest level at which a pattern may end.
    pub end_levels: (u32, u32),
}

impl Quantized {
    /// The counts of components and holes where they are tracked, and 0 where not.
    pub fn counted(&self, components: u32, holes: u32) -> [u32; 2] {
        let of = |tracked: bool, count: u32| if tracked { count } else { 0 };
        [of(self.tracked[0], components), of(self.tracked[1], holes)]
    }
}

/// What remains to be done after the last piece of a state, in the units of [`Quantized`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Remaining {
    /// Rows of length.
    pub length: u32,
    /// Components still to be closed.
    pub components: u32,
    /// Holes still to be closed.
    pub holes: u32,
    /// The level of the state's last piece.
    pub level: u32,
}

/// What is kept of the cells of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// How the cheapest way goes on, for a walk along it: a byte a cell.
    Choices,
    /// What the cheapest way costs, for a search that weighs more than costs: four bytes a cell.
    Costs,
}
