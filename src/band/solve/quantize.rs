//! The units of a table: how fine its rows, costs and levels are, and what rounding may lose (rule
//! B4: the length is part of the state).

use super::cell_layout::size;
use super::packed_cost::COST_LIMIT;
use super::quantized::{Keep, Quantized};
use super::states::States;
use super::task::Drift;

/// The limits of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The longest length after the first piece.
    pub longest: f64,
    /// Components that remain after the first piece, where they are asked for.
    pub components: Option<u32>,
    /// Holes that remain after the first piece, where they are asked for.
    pub holes: Option<u32>,
    /// What is kept of the cells: costs take more memory, so that rows are coarser.
    pub keep: Keep,
}

/// Which offsets a table tracks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tracked<'a> {
    /// None: pieces may stand anywhere.
    Nothing,
    /// The accumulated offsets stay in the band.
    Within(&'a Drift),
    /// They stay in the band, and the last of them is near 0. What a pattern ends with is taken
    /// back along it, so that the final offsets stay in the band too, or nearly.
    Settled(&'a Drift),
}

/// The units of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// The length of one row.
    pub length: f64,
    /// The cost of one count.
    pub cost: f64,
    /// The offset between two levels.
    pub level: f64,
    /// The offset of level 0.
    pub lowest: f64,
    /// The most by which the length of a step differs from that of its rows.
    pub rounding: f64,
}

impl Units {
    /// The level of an offset.
    pub fn level_of(&self, offset: f64) -> i64 {
        libm::round((offset - self.lowest) / self.level) as i64
    }
}

/// The finest row is this part of the narrowest piece. Finer rows would cost time and lose nothing
/// less that shows: with 16, fifty pieces are off by at most 1.6 of the narrowest.
const FINEST: usize = 16;
/// The same where the cost of every cell is kept. A search forward keeps sequences of its own in
/// every row and adds up exact lengths, so that fine rows only make it slower.
const FINEST_WITH_COSTS: usize = 4;
/// Additions that a table may take, about half a nanosecond each, for rows finer than half the
/// narrowest piece: 3 ms. With more, short bands become slow for lengths that rarely matter; with
/// fewer, uneven pieces miss the length tolerance.
const CHEAP_WORK: usize = 6_000_000;
/// Additions that a table may take at all before its rows are made coarser: 0.3 s. Beyond that a
/// user waits; far below, two counters at once would leave only the coarsest rows.
const MOST_WORK: usize = 600_000_000;
/// Cells of a byte each that a table may have before its rows are made coarser: 64 MB.
const MOST_CELLS: usize = 64_000_000;
/// The same where the cost of every cell is kept in four bytes: 48 MB.
const MOST_CELLS_WITH_COSTS: usize = 12_000_000;
/// Levels of the band. Half as many round offsets by a fortieth of the band and lose sequences that
/// stay in it; twice as many double the table, and the searches along it use exact offsets anyway.
const LEVELS: u32 = 24;
/// A pattern settles if it ends within this part of all levels from 0. With a smaller part hardly a
/// sequence of tilted pieces settles; with a greater one the final offsets leave the band.
const SETTLED: f64 = 0.15;

/// The graph of `states` in whole numbers within `limits`, and their units. Rows are as fine as is
/// cheap, and divide the narrowest step so that all steps are nearest to whole numbers of rows.
pub fn quantize(states: &States, limits: &Limits, tracked: Tracked) -> (Quantized, Units) {
    let narrowest = narrowest_step(states).unwrap_or(limits.longest.max(1e-300));
    let mut units = Units {
        length: narrowest,
        cost: cost_unit(states, limits, narrowest),
        level: 1.0,
        lowest: 0.0,
        rounding: 0.0,
    };
    let mut quantized = counts(states, limits, &units);
    if let Tracked::Within(drift) | Tracked::Settled(drift) = tracked {
        add_levels(states, drift, &mut quantized, &mut units);
    }
    if let Tracked::Settled(_) = tracked {
        let most = SETTLED * f64::from(LEVELS) * units.level;
        let level = |offset: f64| units.level_of(offset).clamp(0, i64::from(LEVELS) - 1) as u32;
        quantized.end_levels = (level(-most), level(most));
    }
    quantized.longest = rows(limits.longest, narrowest);
    let finest = finest_row(states, &quantized, limits.keep);
    units.length = row_length(states, narrowest, finest);
    add_lengths(states, &mut quantized, &mut units);
    quantized.longest = rows(limits.longest, units.length);
    (quantized, units)
}

/// The length of the shortest step, where that is above zero.
fn narrowest_step(states: &States) -> Option<f64> {
    let lengths = states.all_steps().iter().map(|s| s.length);
    let narrowest = lengths.fold(f64::INFINITY, f64::min);
    (narrowest.is_finite() && narrowest > 0.0).then_some(narrowest)
}

/// How many rows a table needs for a length.
fn rows(length: f64, row: f64) -> u32 {
    (length / row).clamp(0.0, 1e8) as u32 + 2
}

/// Into how many rows the narrowest step may be divided, given a table with one row for it.
fn finest_row(states: &States, quantized: &Quantized, keep: Keep) -> usize {
    let rows = quantized.longest as usize + 1;
    let cells = size(states, quantized).max(1);
    let width = cells / rows / states.len().max(1);
    let work = width
        .saturating_mul(states.all_steps().len() + 2 * states.len())
        .saturating_mul(rows);
    let (finest, most_cells) = match keep {
        Keep::Choices => (FINEST, MOST_CELLS),
        Keep::Costs => (FINEST_WITH_COSTS, MOST_CELLS_WITH_COSTS),
    };
    let cheap = (CHEAP_WORK / work.max(1)).max(2);
    cheap
        .min(MOST_WORK / work.max(1))
        .min(most_cells / cells)
        .clamp(1, finest)
}

/// The length of a row: `narrowest` / k for the k up to `finest` at which the steps' lengths are
/// nearest to whole numbers. k is a multiple of an eighth.
fn row_length(states: &States, narrowest: f64, finest: usize) -> f64 {
    let mut lengths: Vec<f64> = states.all_steps().iter().map(|s| s.length).collect();
    lengths.sort_by(f64::total_cmp);
    lengths.dedup();
    let error = |row: f64| {
        let of = |l: f64| (l / row - libm::round(l / row)).abs() * row;
        lengths.iter().map(|&l| of(l)).sum::<f64>() / lengths.len() as f64
    };
    let whole = (8..=8 * finest).step_by(8);
    let others = (8..8 * finest).filter(|e| e % 8 != 0);
    // Whole divisors come first, so that of equally good rows the coarsest is taken.
    let mut best = (f64::INFINITY, narrowest);
    for eighths in whole.chain(others) {
        let row = narrowest * 8.0 / eighths as f64;
        let e = error(row);
        if e < 0.999 * best.0 - 1e-9 * narrowest {
            best = (e, row);
        }
    }
    best.1
}

/// The cost of one count: fine, but the sum over the longest pattern must stay below the limit.
fn cost_unit(states: &States, limits: &Limits, narrowest: f64) -> f64 {
    let ends = states.ends.iter().flatten().map(|e| e.seam.cost);
    let steps = states.all_steps().iter().map(|s| s.seam.cost);
    let dearest = steps.chain(ends).fold(0.0, f64::max);
    let most = dearest * (limits.longest / narrowest + 2.0);
    let finest = 1.0 / (1u64 << 20) as f64;
    let least = most / (COST_LIMIT / 4) as f64;
    // A power of two, so that equal costs stay equal.
    let mut unit = finest;
    while unit < least && unit < 1e300 {
        unit *= 2.0;
    }
    unit
}

/// Costs and counts in whole numbers; lengths and levels are still missing.
fn counts(states: &States, limits: &Limits, units: &Units) -> Quantized {
    let steps = states.all_steps();
    let cost = |c: f64| libm::round(c / units.cost) as u64;
    let end_cost = |end: &super::states::End| (0, cost(end.seam.cost));
    let ends = states.ends.iter();
    Quantized {
        lengths: vec![1; steps.len()],
        costs: steps.iter().map(|s| cost(s.seam.cost)).collect(),
        rises: vec![0; steps.len()],
        ends: ends.map(|e| e.as_ref().map_or((0, 0), end_cost)).collect(),
        longest: 0,
        components: limits.components.unwrap_or(0),
        holes: limits.holes.unwrap_or(0),
        tracked: [limits.components.is_some(), limits.holes.is_some()],
        levels: vec![(0, 0); states.len()],
        level_count: 1,
        end_levels: (0, 0),
    }
}

/// Lengths of steps and ends in rows, and how much a step's rows may be off.
fn add_lengths(states: &States, quantized: &mut Quantized, units: &mut Units) {
    let steps = states.all_steps();
    let row = |length: f64| (libm::round(length / units.length) as u32).max(1);
    quantized.lengths = steps.iter().map(|s| row(s.length)).collect();
    for (quantized, end) in quantized.ends.iter_mut().zip(&states.ends) {
        quantized.0 = end.map_or(0, |e| libm::round(e.seam.gap / units.length) as u32);
    }
    let errors = steps
        .iter()
        .zip(&quantized.lengths)
        .map(|(s, &n)| (s.length - f64::from(n) * units.length).abs());
    units.rounding = errors.fold(0.0, f64::max);
}

/// Levels of the band, and how many of them each step rises.
fn add_levels(states: &States, drift: &Drift, quantized: &mut Quantized, units: &mut Units) {
    let lows = drift.ranges.iter().map(|r| r.0);
    let highs = drift.ranges.iter().map(|r| r.1);
    let lowest = lows.fold(f64::INFINITY, f64::min);
    let highest = highs.fold(f64::NEG_INFINITY, f64::max);
    units.lowest = lowest;
    units.level = ((highest - lowest) / f64::from(LEVELS - 1)).max(f64::MIN_POSITIVE);
    quantized.level_count = LEVELS;
    quantized.end_levels = (0, LEVELS - 1);
    for (level, &piece) in quantized.levels.iter_mut().zip(&states.pieces) {
        let (low, high) = drift.ranges[piece as usize];
        let (low, high) = (units.level_of(low), units.level_of(high));
        *level = if low <= high {
            let highest = i64::from(LEVELS) - 1;
            (low.max(0) as u32, high.clamp(0, highest) as u32)
        } else {
            // An empty range: the piece is higher than the band.
            (1, 0)
        };
    }
    for (k, step) in states.all_steps().iter().enumerate() {
        let rise = libm::round(step.seam.rise / units.level);
        if rise.abs() < f64::from(LEVELS) {
            quantized.rises[k] = rise as i32;
        } else {
            quantized.costs[k] = COST_LIMIT;
        }
    }
}
