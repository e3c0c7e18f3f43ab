//! How much a sequence repeats itself (Zhou 2014, section 3.7; rule B6). The search that weighs it
//! against the cost of seams is in `strategy`.

use super::task::Sequence;
use crate::exemplar::seam::Seams;

/// What is minimized where repetition counts: F + `variety` · mean seam cost · number of pieces ·
/// A, where A is the autocorrelation of the whole sequence.
pub struct Measure {
    weight: f64,
    likeness: Vec<f32>,
}

/// σ of section 3.7. Pieces that are one number apart count as alike by e^-2 = 0.14. With a greater
/// σ neighbours in the exemplar count as repetition; with a smaller one only equal pieces do.
const SPREAD: f64 = 0.5;

/// The likeness of two pieces whose numbers differ by this much.
fn likeness(difference: f64) -> f64 {
    libm::exp(-difference / SPREAD)
}

impl Measure {
    /// The measure for these seams. The mean cost lets a weight mean the same for every exemplar.
    pub fn new(seams: &Seams, variety: f64) -> Measure {
        let unit = if seams.mean_cost() > 0.0 {
            seams.mean_cost()
        } else {
            1.0
        };
        Measure::weighted(variety * unit)
    }

    fn weighted(weight: f64) -> Measure {
        Measure {
            weight,
            likeness: (0..256).map(|d| likeness(f64::from(d)) as f32).collect(),
        }
    }

    /// The measure of a whole sequence.
    pub fn value(&self, sequence: &Sequence, closed: bool) -> f64 {
        let repeats = autocorrelation(&sequence.pieces, closed);
        sequence.cost + self.penalty(sequence.pieces.len(), repeats)
    }

    /// What `count` pieces with this autocorrelation add to the cost.
    pub fn penalty(&self, count: usize, autocorrelation: f64) -> f64 {
        self.weight * count as f64 * autocorrelation
    }

    fn alike(&self, a: u8, b: u8) -> f32 {
        self.likeness[usize::from(a.abs_diff(b))]
    }

    /// Adds the pairs of `piece` with the pieces before it to the sums for the lags 1, 2, … and
    /// writes these to `into`. Returns the autocorrelation of the longer sequence.
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

/// A: the largest mean likeness e^(-|η_i - η_(i+j)| / σ) of pieces j apart. Lags j go from 1 to
/// half the number of pieces, because beyond that too few pairs are left. Round a loop every lag
/// has as many pairs as there are pieces.
pub fn autocorrelation(pieces: &[usize], closed: bool) -> f64 {
    let n = pieces.len();
    let mean = |lag: usize| {
        let pairs = if closed { n } else { n - lag };
        let alike = |i: usize| likeness(pieces[i].abs_diff(pieces[(i + lag) % n]) as f64);
        (0..pairs).map(alike).sum::<f64>() / pairs as f64
    };
    (1..=n / 2).map(mean).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_correlate_and_counting_does_not() {
        let period: Vec<usize> = (0..40).map(|i| i % 4).collect();
        assert!((autocorrelation(&period, false) - 1.0).abs() < 1e-12);
        assert!((autocorrelation(&period, true) - 1.0).abs() < 1e-12);
        let counting: Vec<usize> = (0..40).collect();
        assert!((autocorrelation(&counting, false) - libm::exp(-2.0)).abs() < 1e-12);
        assert_eq!(autocorrelation(&[3], false), 0.0);
    }

    #[test]
    fn sums_are_those_of_the_whole_sequence() {
        let measure = Measure::weighted(1.0);
        let pieces = [0u8, 1, 2, 1, 2, 3, 1, 2, 1, 2, 3, 0, 1, 2];
        let (mut sums, mut next, mut last) = (Vec::new(), Vec::new(), 0.0);
        for k in 1..pieces.len() {
            last = measure.extend(&pieces[..k], &sums, pieces[k], &mut next);
            std::mem::swap(&mut sums, &mut next);
        }
        let whole: Vec<usize> = pieces.iter().map(|&p| p.into()).collect();
        assert!((last - autocorrelation(&whole, false)).abs() < 1e-6);
    }
}
