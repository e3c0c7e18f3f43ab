//! Sequences that repeat themselves less (Zhou 2014, section 3.7): autocorrelation, and a search that
//! weighs it against the cost of seams. Without `variety` nothing here is used.

use std::rc::Rc;

use super::seam::Seams;
use super::solver::{Failure, Filled, Search, Sequence};
use super::table::Rest;

/// A sequence that weighs repetition with `variety` is found among those that the table says can be finished: of every
/// remaining length the best few are kept, a few of them for each state, by cost so far, least cost to the end, and
/// autocorrelation so far. It is the best of those seen, and no worse than `cheapest` by the same measure; it need not be the best of all,
/// since what is good now may repeat itself later.
pub fn vary(search: &Search, cheapest: Sequence, variety: f64) -> Result<Sequence, Failure> {
    let measure = Measure::new(search.seams, variety);
    let free = search.fill_for_variety(false)?;
    let mut best = Beam { search, filled: &free, measure: &measure }.run();
    if best.is_none() && search.excess(&cheapest) <= 0.0 {
        let held = search.fill_for_variety(true)?;
        best = Beam { search, filled: &held, measure: &measure }.run();
    }
    let value = |s: &Sequence| measure.value(s, search.task.closed);
    Ok(match best {
        Some(found) if value(&found) < value(&cheapest) => found,
        _ => cheapest,
    })
}

/// What is made small: F + variety · mean seam cost · pieces · A.
pub struct Measure {
    weight: f64,
    likeness: Vec<f32>,
}

/// σ of section 3.7.
const SPREAD: f64 = 0.5;

impl Measure {
    /// The measure for these seams. The mean cost makes a weight mean the same for every exemplar.
    pub fn new(seams: &Seams, variety: f64) -> Measure {
        let unit = if seams.mean_cost() > 0.0 { seams.mean_cost() } else { 1.0 };
        let likeness = (0..256).map(|d| libm::exp(-f64::from(d) / SPREAD) as f32).collect();
        Measure { weight: variety * unit, likeness }
    }

    /// The measure of a whole sequence.
    pub fn value(&self, sequence: &Sequence, closed: bool) -> f64 {
        sequence.cost + self.weight * sequence.pieces.len() as f64 * autocorrelation(&sequence.pieces, closed)
    }

    fn alike(&self, a: u8, b: u8) -> f32 {
        self.likeness[usize::from(a.abs_diff(b))]
    }

    /// Adds the pairs of `piece` with those before it to the sums of the lags 1, 2, …; the largest mean.
    fn extend(&self, history: &[u8], sums: &[f32], piece: u8, into: &mut Vec<f32>) -> f64 {
        let count = history.len() + 1;
        into.clear();
        into.extend_from_slice(sums);
        into.resize(count - 1, 0.0);
        for (sum, &before) in into.iter_mut().zip(history.iter().rev()) {
            *sum += self.alike(piece, before);
        }
        let means = into.iter().take(count / 2).enumerate().map(|(i, &sum)| sum / (count - 1 - i) as f32);
        f64::from(means.fold(0.0, f32::max))
    }
}

/// A: the largest mean likeness e^(-|η_i - η_(i+j)| / σ) of pieces j apart, over lags j from 1 to half the number of pieces:
/// beyond that too few pairs are left. Round a loop every lag has as many pairs as there are pieces.
pub fn autocorrelation(pieces: &[usize], closed: bool) -> f64 {
    let n = pieces.len();
    let mean = |lag: usize| {
        let pairs = if closed { n } else { n - lag };
        let like = |i: usize| libm::exp(-(pieces[i].abs_diff(pieces[(i + lag) % n]) as f64) / SPREAD);
        (0..pairs).map(like).sum::<f64>() / pairs as f64
    };
    (1..=n / 2).map(mean).fold(0.0, f64::max)
}

/// An unfinished sequence.
struct Node {
    state: u32,
    rest: Rest,
    cost: u64,
    offset: f64,
    history: Vec<u8>,
    sums: Vec<f32>,
}

/// One that may be grown from a node by a step.
struct Candidate {
    score: f64,
    key: (u32, u32, u32, u32),
    parent: Rc<Node>,
    step: usize,
}

struct Beam<'a> {
    search: &'a Search<'a>,
    filled: &'a Filled,
    measure: &'a Measure,
}

/// Sequences that are kept of one remaining length, and of those with the same state and counts.
const KEPT: usize = 20;
const KEPT_ALIKE: usize = 3;
/// Lengths that are tried.
const STARTS: usize = 12;

impl Beam<'_> {
    fn run(&self) -> Option<Sequence> {
        let starts = self.search.starts(self.filled);
        let highest = starts.iter().copied().max()?;
        let mut rows: Vec<Vec<Candidate>> = (0..=highest).map(|_| Vec::new()).collect();
        let mut best: Option<(f64, Sequence)> = None;
        let mut sums = Vec::new();
        // Lengths near the curve's, spread over the tolerance.
        let every = starts.len().div_ceil(STARTS).max(1);
        let starts: Vec<u32> = starts.into_iter().step_by(every).collect();
        for row in (0..=highest).rev() {
            let mut nodes: Vec<Rc<Node>> = Vec::new();
            if starts.contains(&row) {
                nodes.push(Rc::new(self.first(row)));
            }
            let candidates = std::mem::take(&mut rows[row as usize]);
            nodes.extend(select(candidates).into_iter().map(|c| Rc::new(self.grown(&c, &mut sums))));
            for node in nodes {
                self.finish(&node, &mut best);
                self.expand(&node, &mut rows, &mut sums);
            }
        }
        best.map(|b| b.1)
    }

    fn first(&self, row: u32) -> Node {
        let rest = Rest { length: row, ..self.filled.start };
        Node { state: 0, rest, cost: 0, offset: 0.0, history: vec![self.search.first as u8], sums: Vec::new() }
    }

    /// The node that a candidate stands for.
    fn grown(&self, c: &Candidate, sums: &mut Vec<f32>) -> Node {
        let states = self.search.states;
        let number = states.step_base(c.parent.state) + c.step;
        let step = states.steps(c.parent.state)[c.step];
        let piece = states.pieces[step.to as usize] as u8;
        self.measure.extend(&c.parent.history, &c.parent.sums, piece, sums);
        let mut history = Vec::with_capacity(c.parent.history.len() + 1);
        history.extend_from_slice(&c.parent.history);
        history.push(piece);
        let rest = self.filled.after(c.parent.rest, number, step.components, step.holes);
        Node {
            state: step.to,
            rest: rest.unwrap_or(c.parent.rest),
            cost: c.parent.cost + self.filled.scaled.costs[number],
            offset: c.parent.offset + step.seam.rise,
            history,
            sums: sums.clone(),
        }
    }

    /// Notes a node that may end.
    fn finish(&self, node: &Node, best: &mut Option<(f64, Sequence)>) {
        if !self.filled.ends(self.search.states, node.state, node.rest) {
            return;
        }
        let Some(sequence) = self.search.sequence(node.history.iter().map(|&p| p.into()).collect()) else { return };
        let value = self.measure.value(&sequence, self.search.task.closed);
        if self.search.meets(&sequence) && best.as_ref().is_none_or(|b| value < b.0) {
            *best = Some((value, sequence));
        }
    }

    fn expand(&self, node: &Rc<Node>, rows: &mut [Vec<Candidate>], sums: &mut Vec<f32>) {
        let (states, filled) = (self.search.states, self.filled);
        for (k, step) in states.steps(node.state).iter().enumerate() {
            let number = states.step_base(node.state) + k;
            let Some(rest) = filled.after(node.rest, number, step.components, step.holes) else { continue };
            let Some(to_go) = filled.table.cost(step.to, rest) else { continue };
            let piece = states.pieces[step.to as usize];
            let (low, high) = self.search.task.drift.ranges[piece as usize];
            let offset = node.offset + step.seam.rise;
            if !(low..=high).contains(&offset) {
                continue;
            }
            let repeats = self.measure.extend(&node.history, &node.sums, piece as u8, sums);
            let cost = (node.cost + filled.scaled.costs[number]) as f64 + to_go;
            let score = cost * filled.units.cost + self.measure.weight * (node.history.len() + 1) as f64 * repeats;
            let key = (step.to, rest.components, rest.holes, rest.level);
            let list = &mut rows[rest.length as usize];
            list.push(Candidate { score, key, parent: node.clone(), step: k });
            if list.len() > 8 * KEPT {
                *list = select(std::mem::take(list));
            }
        }
    }
}

/// The best few candidates, not too many of a kind.
fn select(mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    candidates.sort_by(|a, b| a.score.total_cmp(&b.score));
    let mut kept: Vec<Candidate> = Vec::with_capacity(KEPT);
    for c in candidates {
        if kept.len() == KEPT {
            break;
        }
        if kept.iter().filter(|k| k.key == c.key).count() < KEPT_ALIKE {
            kept.push(c);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::band::sample::{Sample, exemplar};
    use crate::band::scale::Drift;
    use crate::band::slicing::{Slicing, slice};
    use crate::band::solver::{Task, solve};
    use crate::band::states::Demand;

    #[test]
    fn periods_correlate_and_counting_does_not() {
        let period: Vec<usize> = (0..40).map(|i| i % 4).collect();
        assert!((autocorrelation(&period, false) - 1.0).abs() < 1e-12);
        assert!((autocorrelation(&period, true) - 1.0).abs() < 1e-12);
        let counting: Vec<usize> = (0..40).collect();
        assert!((autocorrelation(&counting, false) - (-2f64).exp()).abs() < 1e-12);
        assert_eq!(autocorrelation(&[3], false), 0.0);
    }

    #[test]
    fn sums_are_those_of_the_whole_sequence() {
        let measure =
            Measure { weight: 1.0, likeness: (0..256).map(|d| libm::exp(-f64::from(d) / SPREAD) as f32).collect() };
        let pieces = [0u8, 1, 2, 1, 2, 3, 1, 2, 1, 2, 3, 0, 1, 2];
        let (mut sums, mut next, mut last) = (Vec::new(), Vec::new(), 0.0);
        for k in 1..pieces.len() {
            last = measure.extend(&pieces[..k], &sums, pieces[k], &mut next);
            std::mem::swap(&mut sums, &mut next);
        }
        let whole: Vec<usize> = pieces.iter().map(|&p| p.into()).collect();
        assert!((last - autocorrelation(&whole, false)).abs() < 1e-6);
    }

    #[test]
    fn variety_keeps_the_counts_and_repeats_less() {
        let mut gained = 0;
        for seed in 0..24 {
            let sample = Sample { columns: 12, rows: 3 + 2 * (seed as usize % 3), filled: 0.3, jitter: [0.3, 0.1] };
            let exemplar = exemplar(sample, seed);
            let (pieces, _) = slice(&exemplar, Slicing::Topology { event_tolerance: 0.02 }, 0.0).unwrap();
            let seams = Seams::new(&pieces, 0.2);
            let length = 4.0 * exemplar.width;
            let demand = Demand { components: Some(1), ..Demand::default() };
            let drift = Drift { ranges: vec![(-1e9, 1e9); pieces.len()] };
            let mut task =
                Task { length, tolerance: 0.05 * length, closed: seed % 2 == 1, demand, drift, variety: 0.0 };
            let Ok(plain) = solve(&pieces, &seams, &task) else { continue };
            task.variety = 0.5;
            task.demand.holes = (seed % 4 < 2).then_some(plain.holes);
            let varied = solve(&pieces, &seams, &task).unwrap();
            assert_eq!(varied.components, 1);
            assert!(task.demand.holes.is_none_or(|h| h == varied.holes));
            assert!((varied.length - length).abs() <= task.tolerance);
            let measure = Measure::new(&seams, 0.5);
            assert!(
                measure.value(&varied, task.closed) <= measure.value(&plain, task.closed) + 1e-9
                    || task.demand.holes.is_some()
            );
            let less =
                autocorrelation(&varied.pieces, task.closed) < autocorrelation(&plain.pieces, task.closed) - 0.05;
            gained += usize::from(less);
        }
        assert!(gained >= 6, "{gained}");
    }
}
