//! Lengths, costs and offsets in the whole numbers of the table: how fine its steps are, and what
//! rounding may lose.

use crate::solve::cost_to_go::{COST_LIMIT, Keep, Scaled, size};
use crate::solve::states::States;

/// The limits of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The longest length after the first piece.
    pub longest: f64,
    /// Components and holes that remain after the first piece, where they are asked for.
    pub components: Option<u32>,
    /// See `components`.
    pub holes: Option<u32>,
    /// What is kept of the cells: with costs rows are coarser.
    pub keep: Keep,
}

/// The offsets at which the pieces stay in the band.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// The lowest and the highest offset of each piece.
    pub ranges: Vec<(f64, f64)>,
}

impl Drift {
    /// How far pieces at these offsets leave the band, below and above: 0 or less where they do not.
    pub fn beyond(&self, pieces: &[usize], offsets: &[f64]) -> [f64; 2] {
        let (mut below, mut above) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for (&offset, &piece) in offsets.iter().zip(pieces) {
            let (low, high) = self.ranges[piece];
            below = below.max(low - offset);
            above = above.max(offset - high);
        }
        [below, above]
    }
}

/// Which offsets a table tracks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tracked<'a> {
    /// None: pieces may stand anywhere.
    Nothing,
    /// The accumulated ones stay in the band.
    Within(&'a Drift),
    /// And the last of them is near 0. What a pattern ends with is taken back along it: final offsets then stay in the band too,
    /// or nearly.
    Settled(&'a Drift),
}

/// The units of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Length of one row.
    pub length: f64,
    /// Cost of one count.
    pub cost: f64,
    /// Offset of one level.
    pub level: f64,
    /// The offset of level 0.
    pub lowest: f64,
    /// The most by which a step's length differs from its rows.
    pub rounding: f64,
}

impl Units {
    /// The level of an offset.
    pub fn level_of(&self, offset: f64) -> i64 {
        libm::round((offset - self.lowest) / self.level) as i64
    }
}

/// The finest row is this part of the narrowest piece.
const FINEST: usize = 16;
/// Additions that a table may take (about half a nanosecond each), for rows finer than half the narrowest piece.
const CHEAP_WORK: usize = 6_000_000;
/// Additions that a table may take at all before rows are made coarser.
const MOST_WORK: usize = 600_000_000;
/// Cells, of a byte each, that a table may have before rows are made coarser.
const MOST_CELLS: usize = 64_000_000;
/// The same where the cost of every cell is kept.
const MOST_CELLS_WITH_COSTS: usize = 12_000_000;
/// Rows in the narrowest piece when more than costs is weighed: every row keeps sequences of its own.
const FINEST_WITH_COSTS: usize = 4;
/// Levels of the band.
const LEVELS: u32 = 24;
/// A pattern settles that ends within this part of all levels from 0.
const SETTLED: f64 = 0.15;

/// The whole numbers for `states` within `limits`. Rows are as fine as is cheap: the divisor of the narrowest step at
/// which all steps are nearest to whole numbers of rows.
pub fn scale(states: &States, limits: &Limits, tracked: Tracked) -> (Scaled, Units) {
    let narrowest = states
        .all_steps()
        .iter()
        .map(|s| s.length)
        .fold(f64::INFINITY, f64::min);
    let narrowest = if narrowest.is_finite() && narrowest > 0.0 {
        narrowest
    } else {
        limits.longest.max(1e-300)
    };
    let mut units = Units {
        length: narrowest,
        cost: cost_unit(states, limits, narrowest),
        level: 1.0,
        lowest: 0.0,
        rounding: 0.0,
    };
    let mut scaled = counts(states, limits, &units);
    if let Tracked::Within(drift) | Tracked::Settled(drift) = tracked {
        add_levels(states, drift, &mut scaled, &mut units);
    }
    if let Tracked::Settled(_) = tracked {
        let most = SETTLED * f64::from(LEVELS) * units.level;
        let level = |offset: f64| units.level_of(offset).clamp(0, i64::from(LEVELS) - 1) as u32;
        scaled.end_levels = (level(-most), level(most));
    }
    scaled.longest = rows(limits.longest, narrowest);
    let cells = size(states, &scaled).max(1);
    let width = cells / (scaled.longest as usize + 1) / states.len().max(1);
    let work = width
        .saturating_mul(states.all_steps().len() + 2 * states.len())
        .saturating_mul(scaled.longest as usize + 1);
    let (finest_row, most_cells) = match limits.keep {
        Keep::Choices => (FINEST, MOST_CELLS),
        Keep::Costs => (FINEST_WITH_COSTS, MOST_CELLS_WITH_COSTS),
    };
    let cheap = (CHEAP_WORK / work.max(1)).max(2);
    let finest = cheap
        .min(MOST_WORK / work.max(1))
        .min(most_cells / cells)
        .clamp(1, finest_row);
    units.length = quantum(states, narrowest, finest);
    let row = |length: f64| (libm::round(length / units.length) as u32).max(1);
    scaled.lengths = states.all_steps().iter().map(|s| row(s.length)).collect();
    scaled
        .ends
        .iter_mut()
        .zip(&states.ends)
        .for_each(|(scaled, end)| {
            scaled.0 = end.map_or(0, |e| libm::round(e.seam.gap / units.length) as u32);
        });
    let errors = states
        .all_steps()
        .iter()
        .zip(&scaled.lengths)
        .map(|(s, &n)| (s.length - f64::from(n) * units.length).abs());
    units.rounding = errors.fold(0.0, f64::max);
    scaled.longest = rows(limits.longest, units.length);
    (scaled, units)
}

fn rows(length: f64, quantum: f64) -> u32 {
    (length / quantum).clamp(0.0, 1e8) as u32 + 2
}

/// The length of a row: `narrowest` / k for the k up to `finest` at which the steps' lengths are nearest to whole numbers.
fn quantum(states: &States, narrowest: f64, finest: usize) -> f64 {
    let mut lengths: Vec<f64> = states.all_steps().iter().map(|s| s.length).collect();
    lengths.sort_by(f64::total_cmp);
    lengths.dedup();
    let error = |q: f64| {
        let of = |l: f64| (l / q - libm::round(l / q)).abs() * q;
        lengths.iter().map(|&l| of(l)).sum::<f64>() / lengths.len() as f64
    };
    // Whole divisors first: of equally good ones the coarsest is taken.
    let mut best = (f64::INFINITY, narrowest);
    for eighths in (8..=8 * finest)
        .step_by(8)
        .chain((8..8 * finest).filter(|e| e % 8 != 0))
    {
        let q = narrowest * 8.0 / eighths as f64;
        let e = error(q);
        if e < 0.999 * best.0 - 1e-9 * narrowest {
            best = (e, q);
        }
    }
    best.1
}

/// The cost of one count: fine, but the sum over the longest pattern must stay below the limit.
fn cost_unit(states: &States, limits: &Limits, narrowest: f64) -> f64 {
    let ends = states.ends.iter().flatten().map(|e| e.seam.cost);
    let dearest = states
        .all_steps()
        .iter()
        .map(|s| s.seam.cost)
        .chain(ends)
        .fold(0.0, f64::max);
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

fn counts(states: &States, limits: &Limits, units: &Units) -> Scaled {
    let cost = |c: f64| libm::round(c / units.cost) as u64;
    Scaled {
        lengths: vec![1; states.all_steps().len()],
        costs: states
            .all_steps()
            .iter()
            .map(|s| cost(s.seam.cost))
            .collect(),
        rises: vec![0; states.all_steps().len()],
        ends: states
            .ends
            .iter()
            .map(|e| e.map_or((0, 0), |e| (0, cost(e.seam.cost))))
            .collect(),
        longest: 0,
        components: limits.components.unwrap_or(0),
        holes: limits.holes.unwrap_or(0),
        tracked: [limits.components.is_some(), limits.holes.is_some()],
        levels: vec![(0, 0); states.len()],
        level_count: 1,
        end_levels: (0, 0),
    }
}

fn add_levels(states: &States, drift: &Drift, scaled: &mut Scaled, units: &mut Units) {
    let lowest = drift
        .ranges
        .iter()
        .map(|r| r.0)
        .fold(f64::INFINITY, f64::min);
    let highest = drift
        .ranges
        .iter()
        .map(|r| r.1)
        .fold(f64::NEG_INFINITY, f64::max);
    units.lowest = lowest;
    units.level = ((highest - lowest) / f64::from(LEVELS - 1)).max(f64::MIN_POSITIVE);
    scaled.level_count = LEVELS;
    scaled.end_levels = (0, LEVELS - 1);
    for (level, &piece) in scaled.levels.iter_mut().zip(&states.pieces) {
        let (low, high) = drift.ranges[piece as usize];
        let (low, high) = (units.level_of(low), units.level_of(high));
        *level = if low <= high {
            (
                low.max(0) as u32,
                high.clamp(0, i64::from(LEVELS) - 1) as u32,
            )
        } else {
            (1, 0)
        };
    }
    for (k, step) in states.all_steps().iter().enumerate() {
        let rise = libm::round(step.seam.rise / units.level);
        if rise.abs() < f64::from(LEVELS) {
            scaled.rises[k] = rise as i32;
        } else {
            scaled.costs[k] = COST_LIMIT;
        }
    }
}
