//! One table of the dynamic program with its units, and how a sequence of pieces is read from it.
//! Which tables are filled, and what else is searched, is decided in `strategy`.

use fretwork_geometry::budget;

use super::alignment::{Alignment, joints};
use super::cell_layout::size;
use super::cost_to_go::CostToGo;
use super::packed_cost::Choice;
use super::quantize::{Limits, Tracked, Units, quantize};
use super::quantized::{Keep, Quantized, Remaining};
use super::states::{States, Step};
use super::task::{Failure, Problem, Rank, Sequence};
use crate::exemplar::descriptor::Loop;
use crate::exemplar::piece::Piece;

/// A search among the patterns that begin with one piece.
pub struct Search<'a> {
    /// The pieces and what is asked of them.
    pub problem: Problem<'a>,
    /// The states that begin with `first`.
    pub states: &'a States,
    /// The first piece.
    pub first: usize,
}

/// A filled table with its units.
pub struct CostTable {
    /// Steps and limits in whole numbers.
    pub quantized: Quantized,
    /// What these numbers count.
    pub units: Units,
    /// The least costs to the end.
    pub to_go: CostToGo,
    /// What remains after the first piece, but for the length.
    pub start: Remaining,
}

/// No table may have more cells: they take up to 800 MB. The coarsest rows are in use already when
/// this is reached, so that nothing is left but to say so.
const MOST_CELLS: usize = 200_000_000;
/// Rows beyond the tolerance at which sequences are still looked for. The rounding of a step hides
/// at most half a row; three rows let a handful of odd steps err the same way, and what is found
/// outside the tolerance is refused by its exact length.
const ROUNDED_ROWS: f64 = 3.0;

/// Charges for the cells of a table, and for an addition for each of their steps.
fn charge(states: &States, quantized: &Quantized, keep: Keep) {
    let cells = size(states, quantized);
    let bytes = match keep {
        Keep::Choices => size_of::<u8>(),
        Keep::Costs => size_of::<f32>() + size_of::<u8>(),
    };
    budget::make("cells of a pattern's table", cells, bytes);
    let branches = states.all_steps().len() / states.len().max(1);
    let steps = (cells as u64).saturating_mul(1 + branches as u64 / ADDITIONS);
    budget::spend("cells of a pattern's table", steps);
}

/// So many additions are a step.
const ADDITIONS: u64 = 20;

impl Search<'_> {
    /// Fills a table.
    ///
    /// # Errors
    /// `Impossible` where no pattern can end, and `TooLong` where the table would be too large.
    pub fn fill(&self, offsets: Tracked, keep: Keep) -> Result<CostTable, Failure> {
        if self.states.is_empty() {
            return Err(Failure::Impossible);
        }
        let limits = self.limits(keep).ok_or(Failure::Impossible)?;
        let (quantized, units) = quantize(self.states, &limits, offsets);
        if size(self.states, &quantized) > MOST_CELLS {
            return Err(Failure::TooLong);
        }
        charge(self.states, &quantized, keep);
        let start = Remaining {
            length: 0,
            components: quantized.components,
            holes: quantized.holes,
            level: level(&units, &quantized, 0.0),
        };
        let to_go = CostToGo::fill(self.states, &quantized, start, keep);
        Ok(CostTable {
            quantized,
            units,
            to_go,
            start,
        })
    }

    /// What remains after the first piece; none where that alone has more than is asked for.
    fn limits(&self, keep: Keep) -> Option<Limits> {
        let Problem { pieces, task, .. } = self.problem;
        let (components, holes) = self.states.start;
        let remaining = |asked: Option<u32>, have: u32| match asked {
            Some(n) => n.checked_sub(have).map(Some),
            None => Some(None),
        };
        // Where one component is asked for, the states already see to it that there is no other.
        let counted = task.demand.components.filter(|&n| n != 1);
        let longest = task.length + task.tolerance - pieces[self.first].width;
        Some(Limits {
            longest: longest.max(0.0),
            components: remaining(counted, components)?,
            holes: remaining(task.demand.holes, holes)?,
            keep,
        })
    }

    /// The cheapest sequence of a table whose length is within the tolerance. Of equally cheap ones
    /// it is the one whose length is nearest to the curve's.
    pub fn best(&self, table: &CostTable) -> Option<Sequence> {
        let cost = |row: u32| table.to_go.start[row as usize];
        let mut rows = self.starts(table, |row| cost(row).is_some());
        // The rows come by distance, and a stable sort keeps that order among equal costs.
        rows.sort_by_key(|&row| cost(row));
        rows.into_iter()
            .find_map(|row| self.cheapest_way(table, row).filter(|s| self.meets(s)))
    }

    /// The remaining lengths after the first piece that are `known` to have a way to a length
    /// within the tolerance, or so near to it that rounding may hide it. Those nearest to the
    /// curve's length come first.
    pub fn starts(&self, table: &CostTable, known: impl Fn(u32) -> bool) -> Vec<u32> {
        let Problem { pieces, task, .. } = self.problem;
        let first = pieces[self.first].width;
        let off = |row: u32| (first + f64::from(row) * table.units.length - task.length).abs();
        let slack = ROUNDED_ROWS * table.units.length + f64::EPSILON * task.length;
        let fits = |row: &u32| off(*row) <= task.tolerance + slack && known(*row);
        let count = table.to_go.start.len() as u32;
        let mut rows: Vec<u32> = (0..count).filter(fits).collect();
        rows.sort_by(|&a, &b| off(a).total_cmp(&off(b)).then(a.cmp(&b)));
        rows
    }

    /// Whether the sequence's length is within the tolerance.
    pub fn meets(&self, sequence: &Sequence) -> bool {
        let task = self.problem.task;
        (sequence.length - task.length).abs() <= task.tolerance * (1.0 + 1e-12)
    }

    /// The cheapest sequence with `length` rows after the first piece.
    fn cheapest_way(&self, table: &CostTable, length: u32) -> Option<Sequence> {
        let mut rest = Remaining {
            length,
            ..table.start
        };
        let (mut state, mut offset) = (0, 0.0);
        let mut sequence = vec![self.first];
        loop {
            match table.to_go.choice(state, rest) {
                Choice::None => return None,
                Choice::End => return self.sequence(sequence),
                Choice::Step(k) => {
                    let step = self.states.steps(state)[k];
                    offset += step.seam.rise;
                    let taken = table.quantized.lengths[self.states.step_base(state) + k];
                    let length = rest.length.checked_sub(taken)?;
                    rest = table.after(rest, &step, length, offset)?;
                    state = step.to;
                    sequence.push(self.states.pieces[state as usize] as usize);
                }
            }
        }
    }

    /// Adds up a sequence anew, from its pieces alone; none where two of them cannot be neighbours.
    pub fn sequence(&self, sequence: Vec<usize>) -> Option<Sequence> {
        let Problem {
            pieces,
            seams,
            task,
        } = self.problem;
        let joints = joints(seams, &sequence, task.closed)?;
        let counts = counts(pieces, &sequence, task.closed)?;
        let widths: f64 = sequence.iter().map(|&p| pieces[p].width).sum();
        Some(Sequence {
            cost: joints.iter().map(|s| s.cost).sum(),
            length: widths + joints.iter().map(|s| s.gap).sum::<f64>(),
            components: counts.components,
            holes: counts.holes,
            around: counts.around,
            pieces: sequence,
        })
    }

    /// How good a sequence of this value is.
    pub fn rank(&self, sequence: &Sequence, value: f64) -> Rank {
        let Problem {
            pieces,
            seams,
            task,
        } = self.problem;
        let alignment = Alignment::new(pieces, seams, &sequence.pieces, task.closed);
        let leaves = alignment.is_none_or(|alignment| {
            let [below, above] = task.drift.beyond(&sequence.pieces, &alignment.offsets);
            below.max(above) > 0.0
        });
        Rank { leaves, value }
    }
}

impl CostTable {
    /// Whether the pattern may end in `state` when this remains.
    pub fn ends(&self, states: &States, state: u32, rest: Remaining) -> bool {
        states.ends[state as usize].is_some_and(|end| {
            let counts = self.quantized.counted(end.components, end.holes);
            let (low, high) = self.quantized.end_levels;
            rest.length == self.quantized.ends[state as usize].0
                && [rest.components, rest.holes] == counts
                && (low..=high).contains(&rest.level)
        })
    }

    /// What remains after a step, at the given length and offset; none where the step closes more
    /// than there may be.
    pub fn after(
        &self,
        rest: Remaining,
        step: &Step,
        length: u32,
        offset: f64,
    ) -> Option<Remaining> {
        let [components, holes] = self.quantized.counted(step.components, step.holes);
        let after = Remaining {
            length,
            components: rest.components.checked_sub(components)?,
            holes: rest.holes.checked_sub(holes)?,
            level: 0,
        };
        Some(self.at(after, offset))
    }

    /// The same at another offset.
    pub fn at(&self, rest: Remaining, offset: f64) -> Remaining {
        Remaining {
            level: level(&self.units, &self.quantized, offset),
            ..rest
        }
    }
}

/// The level of an offset; 0 where offsets are not tracked.
fn level(units: &Units, quantized: &Quantized, offset: f64) -> u32 {
    let highest = i64::from(quantized.level_count) - 1;
    units.level_of(offset).clamp(0, highest) as u32
}

/// The counts of a sequence, found by merging the descriptors of its pieces one after the other;
/// none where they do not fit, or where an open pattern has open portals left.
pub fn counts(pieces: &[Piece], sequence: &[usize], closed: bool) -> Option<Loop> {
    let (&first, rest) = sequence.split_first()?;
    let mut whole = pieces[first].descriptor.clone();
    for &piece in rest {
        whole = whole.merge(&pieces[piece].descriptor)?;
    }
    if closed {
        return whole.close();
    }
    (whole.open_components() == 0).then_some(Loop {
        components: whole.components,
        holes: whole.holes,
        around: 0,
    })
}
