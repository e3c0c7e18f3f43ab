//! The topology solver (Zhou 2014, section 3.6): the cheapest sequence of pieces of the asked
//! length with the asked numbers of components and holes. Offsets of the pieces are only
//! watched here, not chosen.

use serde::{Deserialize, Serialize};

use crate::exemplar::descriptor::Loop;
use crate::exemplar::piece::Piece;
use crate::exemplar::seam::{Seam, Seams};
use crate::solve::a_star::BestFirst;
use crate::solve::autocorrelation::vary;
use crate::solve::beam::Beam;
use crate::solve::cost_to_go::{Choice, Keep, Rest, Scaled, Table, size};
use crate::solve::least_squares_offsets::settled;
use crate::solve::quantize::{Drift, Limits, Tracked, Units, scale};
use crate::solve::states::{Demand, States, Step, TooManyStates};

/// What is asked of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// The length of the curve.
    pub length: f64,
    /// How far the pieces' total may be from it.
    pub tolerance: f64,
    /// Whether the pattern runs round a closed curve.
    pub closed: bool,
    /// Components and holes.
    pub demand: Demand,
    /// Where the pieces may stand.
    pub drift: Drift,
    /// The weight of the autocorrelation.
    pub variety: f64,
}

/// A sequence of pieces with what it adds up to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sequence {
    /// The numbers of the pieces.
    pub pieces: Vec<usize>,
    /// F: the sum of the costs of the seams.
    pub cost: f64,
    /// The pieces' total width with the gaps between them.
    pub length: f64,
    /// Components.
    pub components: u32,
    /// Holes.
    pub holes: u32,
    /// Components that run round a closed curve.
    pub around: u32,
}

/// How good a sequence is: less is better.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Rank {
    /// Its final offsets leave the band.
    pub leaves: bool,
    /// What is made small.
    pub value: f64,
}

/// A sequence and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// How good.
    pub rank: Rank,
    /// The sequence.
    pub sequence: Sequence,
}

impl Found {
    /// The better of two, the first where they are as good.
    pub fn better(a: Option<Found>, b: Option<Found>) -> Option<Found> {
        match (&a, &b) {
            (Some(first), Some(second)) if second.rank < first.rank => b,
            (None, _) => b,
            _ => a,
        }
    }
}

/// Why there is no sequence.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// No sequence has the length and the counts.
    #[error("no sequence of pieces has the length and the counts")]
    Impossible,
    /// There is one, but only in a band of this height.
    #[error("the pieces drift: they need a height of {0}")]
    Drift(f64),
    /// See [`TooManyStates`].
    #[error(transparent)]
    States(#[from] TooManyStates),
    /// The table would be larger than memory.
    #[error("the pattern would consist of too many pieces")]
    TooLong,
}

/// The cheapest sequence.
///
/// With F counted in units of 2^-20 and, where lengths are multiples of one length (as with uniform slicing),
/// nothing is cheaper: the table holds every (length, last piece, descriptor, counts). Where they are not, a
/// length is off by the rounding of its steps, at most e for a whole sequence, and F is the least of all
/// sequences whose length is within the tolerance less 2 e ([`Units::rounding`] is e for one step).
/// Of equal costs the length nearest to the curve's is taken. When the cheapest sequence leaves the band, offsets
/// enter the table too, rounded to levels, and sequences with exact offsets are searched along it; what is found then stays in the
/// band, also with its final offsets where such a one is found, but need not be the cheapest.
pub fn solve(pieces: &[Piece], seams: &Seams, task: &Task) -> Result<Sequence, Failure> {
    if task.closed {
        crate::solve::closed::solve(pieces, seams, task)
    } else {
        open(pieces, seams, task)
    }
}

fn open(pieces: &[Piece], seams: &Seams, task: &Task) -> Result<Sequence, Failure> {
    let states = States::open(pieces, seams, task.demand)?;
    Search {
        pieces,
        seams,
        task,
        states: &states,
        first: 0,
    }
    .solve()
}

/// How many sequences are searched on from in low bands, for every row of the table: first, and where final offsets leave the band.
const QUICK: usize = 8;
const LONG: usize = 64;
/// Widths of the beam where that finds nothing that stays: the second is tried where the first loses all sequences.
const WIDTHS: [usize; 2] = [24, 120];

/// A search among the patterns that begin with one piece.
pub struct Search<'a> {
    /// The pieces.
    pub pieces: &'a [Piece],
    /// Their seams.
    pub seams: &'a Seams,
    /// What is asked.
    pub task: &'a Task,
    /// The states that begin with `first`.
    pub states: &'a States,
    /// The first piece.
    pub first: usize,
}

/// A filled table with its units.
pub struct Filled {
    /// Steps and limits.
    pub scaled: Scaled,
    /// What they count.
    pub units: Units,
    /// The table.
    pub table: Table,
    /// What remains after the first piece, but for the length.
    pub start: Rest,
}

impl Search<'_> {
    /// What is asked: the cheapest sequence, or one that also repeats itself little.
    pub fn solve(&self) -> Result<Sequence, Failure> {
        let cheapest = self.cheapest(None)?.sequence;
        if self.task.variety > 0.0 {
            Ok(vary(self, cheapest)?.sequence)
        } else {
            Ok(cheapest)
        }
    }

    /// The cheapest sequence; of those that stay in the band when the cheapest does not. Nothing is [`Failure::Impossible`] where
    /// nothing can be better than `rival`.
    pub fn cheapest(&self, rival: Option<&Found>) -> Result<Found, Failure> {
        let free = self.fill(Tracked::Nothing, Keep::Choices)?;
        let sequence = self.best(&free).ok_or(Failure::Impossible)?;
        if rival.is_some_and(|r| {
            r.rank
                <= Rank {
                    leaves: false,
                    value: sequence.cost,
                }
        }) {
            return Err(Failure::Impossible);
        }
        let Task { drift, closed, .. } = self.task;
        let accumulated = offsets(self.seams, &sequence.pieces);
        let [below, above] = drift.beyond(&sequence.pieces, &accumulated);
        // A loop has no first piece that stands on the curve: it may be moved as a whole.
        let excess = if *closed {
            0.5 * (below + above)
        } else {
            below.max(above)
        };
        if excess <= 0.0 {
            return Ok(Found {
                rank: self.rank(&sequence, sequence.cost),
                sequence,
            });
        }
        let least = height(self.pieces, &sequence.pieces, &accumulated, *closed);
        self.held()?.ok_or(Failure::Drift(least))
    }

    /// The cheapest that is found of the sequences that stay in the band.
    fn held(&self) -> Result<Option<Found>, Failure> {
        let (within, settled) = (
            Tracked::Within(&self.task.drift),
            Tracked::Settled(&self.task.drift),
        );
        let stays = |found: &Option<Found>| found.as_ref().is_some_and(|f| !f.rank.leaves);
        let mut held = None;
        for (tracked, patience) in [(within, QUICK), (settled, LONG)] {
            if !stays(&held) {
                let filled = self.fill(tracked, Keep::Costs)?;
                held = Found::better(
                    held,
                    BestFirst {
                        search: self,
                        filled: &filled,
                        patience,
                    }
                    .run(),
                );
            }
        }
        for tracked in [settled, within] {
            if !stays(&held) {
                let filled = self.fill(tracked, Keep::Costs)?;
                let beam = |&width: &usize| {
                    Beam {
                        search: self,
                        filled: &filled,
                        measure: None,
                        width,
                    }
                    .run()
                };
                held = Found::better(held, WIDTHS.iter().find_map(beam));
            }
        }
        Ok(held)
    }

    /// How good a sequence of this value is.
    pub fn rank(&self, sequence: &Sequence, value: f64) -> Rank {
        let Task { drift, closed, .. } = self.task;
        let seams = joints(self.seams, &sequence.pieces, *closed).unwrap_or_default();
        let [below, above] = drift.beyond(
            &sequence.pieces,
            &settled(self.pieces, &sequence.pieces, &seams, *closed),
        );
        Rank {
            leaves: below.max(above) > 0.0,
            value,
        }
    }

    /// Fills the table.
    pub fn fill(&self, offsets: Tracked, keep: Keep) -> Result<Filled, Failure> {
        if self.states.is_empty() {
            return Err(Failure::Impossible);
        }
        let task = self.task;
        let (components, holes) = self.states.start;
        // That a pattern of one component has no other is seen to by the states.
        let tracked = |asked: Option<u32>, have: u32| asked.map(|n| n.checked_sub(have));
        let components = tracked(task.demand.components.filter(|&n| n != 1), components);
        let holes = tracked(task.demand.holes, holes);
        if components == Some(None) || holes == Some(None) {
            return Err(Failure::Impossible);
        }
        let longest = task.length + task.tolerance - self.pieces[self.first].width;
        let limits = Limits {
            longest: longest.max(0.0),
            components: components.flatten(),
            holes: holes.flatten(),
            keep,
        };
        let (scaled, units) = scale(self.states, &limits, offsets);
        if size(self.states, &scaled) > 200_000_000 {
            return Err(Failure::TooLong);
        }
        let level = level(&units, &scaled, 0.0);
        let start = Rest {
            length: 0,
            components: scaled.components,
            holes: scaled.holes,
            level,
        };
        let table = Table::fill(self.states, &scaled, start, keep);
        Ok(Filled {
            scaled,
            units,
            table,
            start,
        })
    }

    /// The cheapest sequence of a table whose length is within the tolerance.
    fn best(&self, filled: &Filled) -> Option<Sequence> {
        let mut rows = self.starts(filled, |row| filled.table.start[row as usize].is_some());
        // The rows come by distance; of equal costs the nearest stays first.
        rows.sort_by_key(|&row| filled.table.start[row as usize]);
        rows.into_iter()
            .find_map(|row| self.follow(filled, row).filter(|s| self.meets(s)))
    }

    /// The remaining lengths after the first piece that are `known` to have a way to a length within the tolerance, or
    /// so near that rounding may hide it; those nearest to the curve's length first.
    pub fn starts(&self, filled: &Filled, known: impl Fn(u32) -> bool) -> Vec<u32> {
        let task = self.task;
        let first = self.pieces[self.first].width;
        let off = |row: u32| (first + f64::from(row) * filled.units.length - task.length).abs();
        let slack = 3.0 * filled.units.length + f64::EPSILON * task.length;
        let fits = |row: &u32| off(*row) <= task.tolerance + slack && known(*row);
        let mut rows: Vec<u32> = (0..filled.table.start.len() as u32).filter(fits).collect();
        rows.sort_by(|&a, &b| off(a).total_cmp(&off(b)).then(a.cmp(&b)));
        rows
    }

    /// Whether the sequence's length is within the tolerance.
    pub fn meets(&self, sequence: &Sequence) -> bool {
        (sequence.length - self.task.length).abs() <= self.task.tolerance * (1.0 + 1e-12)
    }

    /// The cheapest sequence with `length` rows after the first piece.
    fn follow(&self, filled: &Filled, length: u32) -> Option<Sequence> {
        let mut rest = Rest {
            length,
            ..filled.start
        };
        let (mut state, mut offset) = (0, 0.0);
        let mut pieces = vec![self.first];
        loop {
            match filled.table.choice(state, rest) {
                Choice::None => return None,
                Choice::End => return self.sequence(pieces),
                Choice::Step(k) => {
                    let step = self.states.steps(state)[k];
                    offset += step.seam.rise;
                    let taken = filled.scaled.lengths[self.states.step_base(state) + k];
                    rest = filled.after(rest, &step, rest.length.checked_sub(taken)?, offset)?;
                    state = step.to;
                    pieces.push(self.states.pieces[state as usize] as usize);
                }
            }
        }
    }

    /// Adds up a sequence, anew from the pieces.
    pub fn sequence(&self, pieces: Vec<usize>) -> Option<Sequence> {
        let seams: Vec<Seam> = joints(self.seams, &pieces, self.task.closed)?;
        let counts = counts(self.pieces, &pieces, self.task.closed)?;
        let widths: f64 = pieces.iter().map(|&p| self.pieces[p].width).sum();
        Some(Sequence {
            cost: seams.iter().map(|s| s.cost).sum(),
            length: widths + seams.iter().map(|s| s.gap).sum::<f64>(),
            components: counts.components,
            holes: counts.holes,
            around: counts.around,
            pieces,
        })
    }
}

impl Filled {
    /// Whether the pattern may end in `state` with `rest`.
    pub fn ends(&self, states: &States, state: u32, rest: Rest) -> bool {
        states.ends[state as usize].is_some_and(|end| {
            let of = |tracked: bool, count: u32| if tracked { count } else { 0 };
            let counts = (
                of(self.scaled.tracked[0], end.components),
                of(self.scaled.tracked[1], end.holes),
            );
            let (low, high) = self.scaled.end_levels;
            rest.length == self.scaled.ends[state as usize].0
                && (rest.components, rest.holes) == counts
                && (low..=high).contains(&rest.level)
        })
    }

    /// What remains after a step at the given length and offset; none where it closes more than there may be.
    pub fn after(&self, rest: Rest, step: &Step, length: u32, offset: f64) -> Option<Rest> {
        let counted = |tracked: bool, count: u32| if tracked { count } else { 0 };
        let [components, holes] = self.scaled.tracked;
        let after = Rest {
            length,
            components: rest
                .components
                .checked_sub(counted(components, step.components))?,
            holes: rest.holes.checked_sub(counted(holes, step.holes))?,
            level: 0,
        };
        Some(self.at(after, offset))
    }

    /// The same at another offset.
    pub fn at(&self, rest: Rest, offset: f64) -> Rest {
        Rest {
            level: level(&self.units, &self.scaled, offset),
            ..rest
        }
    }
}

/// The level of an offset; 0 where offsets are not tracked.
fn level(units: &Units, scaled: &Scaled, offset: f64) -> u32 {
    units
        .level_of(offset)
        .clamp(0, i64::from(scaled.level_count) - 1) as u32
}

/// The seams of a sequence, with that from the last to the first piece when it is closed.
pub fn joints(seams: &Seams, pieces: &[usize], closed: bool) -> Option<Vec<Seam>> {
    let mut joints = pieces
        .windows(2)
        .map(|w| seams.get(w[0], w[1]))
        .collect::<Option<Vec<_>>>()?;
    if closed {
        joints.push(seams.get(*pieces.last()?, pieces[0])?);
    }
    Some(joints)
}

/// The counts of a sequence by merging the descriptors of its pieces one after the other.
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

/// The height of a band that the pieces of a sequence at these offsets do not leave.
pub fn height(pieces: &[Piece], sequence: &[usize], offsets: &[f64], closed: bool) -> f64 {
    let (mut lowest, mut highest) = (0.0f64, 0.0f64);
    for (offset, &piece) in offsets.iter().zip(sequence) {
        let bounds = pieces[piece].bounds;
        lowest = lowest.min(bounds.min.y + offset);
        highest = highest.max(bounds.max.y + offset);
    }
    if closed {
        highest - lowest
    } else {
        2.0 * highest.max(-lowest)
    }
}

/// The offset of each piece when each is aligned to the one before it.
pub fn offsets(seams: &Seams, pieces: &[usize]) -> Vec<f64> {
    let mut at = 0.0;
    let mut offsets = vec![at];
    for w in pieces.windows(2) {
        at += seams.get(w[0], w[1]).map_or(0.0, |s| s.rise);
        offsets.push(at);
    }
    offsets
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exemplar::slicing::{Slicing, slice};
    use crate::sample::{Sample, exemplar};
    use crate::solve::oracle::{Counts, all_counts, least, some_counts};

    fn wide(pieces: &[Piece]) -> Drift {
        Drift {
            ranges: vec![(-1e9, 1e9); pieces.len()],
        }
    }

    fn demands(found: &Counts, closed: bool) -> Vec<Demand> {
        let mut demands = vec![
            Demand::default(),
            Demand {
                components: Some(1),
                ..Demand::default()
            },
        ];
        for &(c, h, around) in found.keys() {
            demands.push(Demand {
                components: Some(c),
                holes: Some(h),
                around,
            });
            demands.push(Demand {
                components: Some(c),
                holes: None,
                around: false,
            });
            demands.push(Demand {
                components: None,
                holes: Some(h),
                around: closed,
            });
            demands.push(Demand {
                components: Some(c + 1),
                holes: Some(h),
                around: false,
            });
        }
        demands.dedup();
        demands
    }

    /// Compares the solver with all sequences of random exemplars; how many demands were met.
    fn compare(closed: bool, jitter: [f64; 2], seeds: std::ops::Range<u64>) -> (usize, usize) {
        let (mut met, mut refused) = (0, 0);
        for seed in seeds {
            // Corners moved along u give many short pieces, and too many sequences.
            let (columns, event_tolerance) = if jitter[1] == 0.0 {
                (7, 0.02)
            } else {
                (5, 0.1)
            };
            let sample = Sample {
                columns,
                rows: 3 + 2 * (seed as usize % 2),
                filled: 0.35,
                jitter,
            };
            let exemplar = exemplar(sample, seed);
            let (pieces, _) = slice(&exemplar, Slicing::Topology { event_tolerance }, 0.0).unwrap();
            let seams = Seams::new(&pieces, 0.2);
            let length =
                exemplar.width * (1.1 + 0.25 * (seed % 3) as f64) - if closed { 3.0 } else { 0.0 };
            let mut task = Task {
                length,
                tolerance: 0.05 * length,
                closed,
                demand: Demand::default(),
                drift: wide(&pieces),
                variety: 0.0,
            };
            let Some(found) = all_counts(&pieces, &seams, &task, task.tolerance) else {
                continue;
            };
            let strict = all_counts(&pieces, &seams, &task, 0.2 * task.tolerance).unwrap();
            for demand in demands(&found, closed) {
                task.demand = demand;
                let solved = solve(&pieces, &seams, &task);
                let least_cost = least(&found, demand);
                match (&solved, least_cost) {
                    (Ok(s), Some(cost)) => {
                        assert!(
                            s.cost >= cost - 1e-9,
                            "seed {seed} {demand:?}: {s:?} below {cost}"
                        );
                        assert!((s.length - length).abs() <= task.tolerance + 1e-9);
                        assert!(demand.components.is_none_or(|n| n == s.components));
                        assert!(demand.holes.is_none_or(|n| n == s.holes));
                        assert!(s.around > 0 || !demand.around);
                        let most = if jitter[1] == 0.0 {
                            Some(cost)
                        } else {
                            least(&strict, demand)
                        };
                        assert!(
                            most.is_none_or(|m| s.cost <= m + 1e-4),
                            "seed {seed} {demand:?}: {s:?}, not {most:?}"
                        );
                        met += 1;
                    }
                    (Err(Failure::Impossible), None) => refused += 1,
                    (Err(_), Some(_)) if jitter[1] > 0.0 => {
                        assert_eq!(least(&strict, demand), None)
                    }
                    _ => panic!(
                        "seed {seed} {demand:?}: {solved:?}, all sequences say {least_cost:?}"
                    ),
                }
            }
        }
        (met, refused)
    }

    #[test]
    fn open_patterns_are_the_cheapest_of_all_sequences() {
        let (met, refused) = compare(false, [0.3, 0.0], 0..60);
        assert!(met > 300 && refused > 20, "{met} {refused}");
    }

    #[test]
    fn loops_are_the_cheapest_of_all_cycles() {
        let (met, refused) = compare(true, [0.3, 0.0], 0..40);
        assert!(met > 150 && refused > 20, "{met} {refused}");
    }

    #[test]
    fn low_bands_are_filled_wherever_that_is_possible() {
        let mut met = 0;
        for seed in 0..150 {
            let sample = Sample {
                columns: 5,
                rows: 3 + 2 * (seed as usize % 2),
                filled: 0.35,
                jitter: [0.5, 0.3],
            };
            let exemplar = exemplar(sample, seed);
            let (pieces, _) = slice(
                &exemplar,
                Slicing::Topology {
                    event_tolerance: 0.1,
                },
                0.0,
            )
            .unwrap();
            let seams = Seams::new(&pieces, 0.2);
            let length = exemplar.width * (1.5 + 0.25 * (seed % 3) as f64);
            let demand = Demand {
                components: Some(1),
                ..Demand::default()
            };
            let tolerance = 0.1 * length;
            let mut task = Task {
                length,
                tolerance,
                closed: false,
                demand,
                drift: wide(&pieces),
                variety: 0.0,
            };
            let Ok(free) = solve(&pieces, &seams, &task) else {
                continue;
            };
            // Too low for the cheapest sequence.
            let farthest = offsets(&seams, &free.pieces)
                .into_iter()
                .map(f64::abs)
                .fold(0.0, f64::max);
            task.drift.ranges.fill((-0.6 * farthest, 0.6 * farthest));
            let Some(found) = all_counts(&pieces, &seams, &task, task.tolerance) else {
                continue;
            };
            let settles = |sequence: &[usize]| {
                let joints = joints(&seams, sequence, false).unwrap();
                settled(&pieces, sequence, &joints, false)
                    .into_iter()
                    .all(|o| o.abs() <= 0.6 * farthest)
            };
            let best = some_counts(&pieces, &seams, &task, task.tolerance, &settles).unwrap();
            match (
                solve(&pieces, &seams, &task),
                least(&best, demand).or(least(&found, demand)),
            ) {
                (Ok(s), Some(cost)) => {
                    assert!(
                        offsets(&seams, &s.pieces)
                            .into_iter()
                            .all(|o| o.abs() <= 0.6 * farthest),
                        "seed {seed}"
                    );
                    assert_eq!(
                        settles(&s.pieces),
                        least(&best, demand).is_some(),
                        "seed {seed}"
                    );
                    assert!(
                        s.cost >= cost - 1e-9 && s.cost <= 1.05 * cost,
                        "seed {seed}: {} {cost}",
                        s.cost
                    );
                    assert!((s.length - length).abs() <= tolerance + 1e-9, "seed {seed}");
                    met += 1;
                }
                (Err(Failure::Drift(_)), None) => {}
                (solved, least) => panic!("seed {seed}: {solved:?}, all sequences say {least:?}"),
            }
        }
        assert!(met >= 8, "{met}");
    }

    #[test]
    fn odd_lengths_cost_no_more_than_the_best_well_inside_the_tolerance() {
        let (met, _) = compare(false, [0.3, 0.3], 0..80);
        assert!(met > 100, "{met}");
        let (met, _) = compare(true, [0.3, 0.3], 0..40);
        assert!(met > 50, "{met}");
    }
}
