//! Sequences that repeat themselves less (Zhou 2014, section 3.7): autocorrelation, and a search that
//! weighs it against the cost of seams. Without `variety` nothing here is used.

use crate::exemplar::seam::Seams;
use crate::solve::beam::Beam;
use crate::solve::cost_to_go::Keep;
use crate::solve::quantize::Tracked;
use crate::solve::search::{Failure, Found, Search, Sequence};

/// A sequence that weighs repetition with the task's `variety`. It is the best of those that the beam sees, and no worse than
/// `cheapest` by the same measure; it need not be the best of all, since what is good now may repeat itself later.
pub fn vary(search: &Search, cheapest: Sequence) -> Result<Found, Failure> {
    let measure = Measure::new(search.seams, search.task.variety);
    let beam = |tracked| -> Result<Option<Found>, Failure> {
        let filled = search.fill(tracked, Keep::Costs)?;
        Ok(Beam {
            search,
            filled: &filled,
            measure: Some(&measure),
            width: WIDTH,
        }
        .run())
    };
    let rank = search.rank(&cheapest, measure.value(&cheapest, search.task.closed));
    let mut best = Found::better(
        Some(Found {
            rank,
            sequence: cheapest,
        }),
        beam(Tracked::Nothing)?,
    );
    if best.as_ref().is_none_or(|found| found.rank.leaves) {
        best = Found::better(best, beam(Tracked::Settled(&search.task.drift))?);
    }
    best.ok_or(Failure::Impossible)
}

/// What is made small: F + variety · mean seam cost · pieces · A.
pub struct Measure {
    weight: f64,
    likeness: Vec<f32>,
}

/// The width of the beam.
const WIDTH: usize = 20;
/// σ of section 3.7.
const SPREAD: f64 = 0.5;

impl Measure {
    /// The measure for these seams. The mean cost makes a weight mean the same for every exemplar.
    pub fn new(seams: &Seams, variety: f64) -> Measure {
        let unit = if seams.mean_cost() > 0.0 {
            seams.mean_cost()
        } else {
            1.0
        };
        let likeness = (0..256)
            .map(|d| libm::exp(-f64::from(d) / SPREAD) as f32)
            .collect();
        Measure {
            weight: variety * unit,
            likeness,
        }
    }

    /// The measure of a whole sequence.
    pub fn value(&self, sequence: &Sequence, closed: bool) -> f64 {
        sequence.cost
            + self.penalty(
                sequence.pieces.len(),
                autocorrelation(&sequence.pieces, closed),
            )
    }

    /// What `count` pieces with this autocorrelation add to the cost.
    pub fn penalty(&self, count: usize, autocorrelation: f64) -> f64 {
        self.weight * count as f64 * autocorrelation
    }

    fn alike(&self, a: u8, b: u8) -> f32 {
        self.likeness[usize::from(a.abs_diff(b))]
    }

    /// Adds the pairs of `piece` with those before it to the sums of the lags 1, 2, …; the largest mean.
    pub fn extend(&self, history: &[u8], sums: &[f32], piece: u8, into: &mut Vec<f32>) -> f64 {
        let count = history.len() + 1;
        into.clear();
        into.extend_from_slice(sums);
        into.resize(count - 1, 0.0);
        for (sum, &before) in into.iter_mut().zip(history.iter().rev()) {
            *sum += self.alike(piece, before);
        }
        let means = into
            .iter()
            .take(count / 2)
            .enumerate()
            .map(|(i, &sum)| sum / (count - 1 - i) as f32);
        f64::from(means.fold(0.0, f32::max))
    }
}

/// A: the largest mean likeness e^(-|η_i - η_(i+j)| / σ) of pieces j apart, over lags j from 1 to half the number of pieces:
/// beyond that too few pairs are left. Round a loop every lag has as many pairs as there are pieces.
pub fn autocorrelation(pieces: &[usize], closed: bool) -> f64 {
    let n = pieces.len();
    let mean = |lag: usize| {
        let pairs = if closed { n } else { n - lag };
        let like =
            |i: usize| libm::exp(-(pieces[i].abs_diff(pieces[(i + lag) % n]) as f64) / SPREAD);
        (0..pairs).map(like).sum::<f64>() / pairs as f64
    };
    (1..=n / 2).map(mean).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exemplar::slicing::{Slicing, slice};
    use crate::sample::{Sample, exemplar};
    use crate::solve::quantize::Drift;
    use crate::solve::search::{Task, solve};
    use crate::solve::states::Demand;

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
        let measure = Measure {
            weight: 1.0,
            likeness: (0..256)
                .map(|d| libm::exp(-f64::from(d) / SPREAD) as f32)
                .collect(),
        };
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
            let sample = Sample {
                columns: 12,
                rows: 3 + 2 * (seed as usize % 3),
                filled: 0.3,
                jitter: [0.3, 0.1],
            };
            let exemplar = exemplar(sample, seed);
            let (pieces, _) = slice(
                &exemplar,
                Slicing::Topology {
                    event_tolerance: 0.02,
                },
                0.0,
            )
            .unwrap();
            let seams = Seams::new(&pieces, 0.2);
            let length = 4.0 * exemplar.width;
            let demand = Demand {
                components: Some(1),
                ..Demand::default()
            };
            let drift = Drift {
                ranges: vec![(-1e9, 1e9); pieces.len()],
            };
            let mut task = Task {
                length,
                tolerance: 0.05 * length,
                closed: seed % 2 == 1,
                demand,
                drift,
                variety: 0.0,
            };
            let Ok(plain) = solve(&pieces, &seams, &task) else {
                continue;
            };
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
            let less = autocorrelation(&varied.pieces, task.closed)
                < autocorrelation(&plain.pieces, task.closed) - 0.05;
            gained += usize::from(less);
        }
        assert!(gained >= 6, "{gained}");
    }
}
