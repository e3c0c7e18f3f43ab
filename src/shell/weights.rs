//! How much of itself each voxel of a body stands for, so that the voxels together are as stiff and as heavy as the body
//! that their border does not follow.
//!
//! A wall of two millimetres that holds three voxels of 0.8 would be stretched as one of 2.4 and bent as one of nearly twice
//! the stiffness. Along each axis the voxels of a body stand in runs, from where a line enters it to where it leaves. The voxels
//! of a run are weighted so that their mass, its middle and its second moment are those of the line inside of the body
//! (moment fitting; Müller, Kummer, Oberlack 2013, in one dimension): a run of three or more is then stretched and bent as what it stands for.
//! The weight of a voxel is the product along the three axes.

use fretwork_geometry::voxel::Voxels;
use rayon::prelude::*;

/// The least and the greatest weight along an axis: less would be next to nothing beside its neighbours.
const RANGE: [f64; 2] = [0.15, 2.5];
/// What the weights of all voxels may be scaled by, at most, so that they have the body's volume.
const SCALE: [f64; 2] = [0.8, 1.25];

/// How far the border is from the middle of a voxel up or down an axis, in pitches between 0 and 1, where the voxel beyond is not
/// of the body: by the voxel's number, the axis, and whether it is up.
pub type Border<'a> = &'a (dyn Fn(usize, usize, bool) -> f64 + Sync);

/// The weight of each voxel of a body of so many cubic pitches. O(n log n).
pub fn weights(voxels: &Voxels, volume: f64, border: Border) -> Vec<f32> {
    let mut all = vec![1.0f64; voxels.len()];
    for axis in 0..3 {
        let across = [(axis + 1) % 3, (axis + 2) % 3];
        let key = |voxel: &u32| {
            let cell = voxels.cells[*voxel as usize];
            (cell[across[0]], cell[across[1]], cell[axis])
        };
        let mut order: Vec<u32> = (0..voxels.len() as u32).collect();
        order.par_sort_unstable_by_key(key);
        let is_next = |a: &u32, b: &u32| {
            let (a, b) = (key(a), key(b));
            (a.0, a.1, a.2 + 1) == b
        };
        let runs: Vec<&[u32]> = order.chunk_by(is_next).collect();
        let fit = |run: &&[u32]| {
            let (first, last) = (run[0] as usize, run[run.len() - 1] as usize);
            let ends = [border(first, axis, false), border(last, axis, true)];
            Fit::new(run.len(), ends)
        };
        let fits: Vec<Fit> = runs.par_iter().map(fit).collect();
        for (run, fit) in runs.into_iter().zip(fits) {
            for (place, voxel) in run.iter().enumerate() {
                all[*voxel as usize] *= fit.weight(place);
            }
        }
    }
    let sum: f64 = all.iter().sum();
    let scale = (volume / sum).clamp(SCALE[0], SCALE[1]);
    all.into_iter()
        .map(|weight| (weight * scale) as f32)
        .collect()
}

/// The part of the voxels that stand in runs of fewer than three along some axis: they are not bent as what they stand for.
pub fn thin_part(voxels: &Voxels) -> f64 {
    let has = |cell: [u16; 3], axis: usize, by: i32| {
        let mut there = cell;
        let moved = u16::try_from(i32::from(cell[axis]) + by);
        moved.is_ok_and(|moved| {
            there[axis] = moved;
            voxels.find(there).is_some()
        })
    };
    let is_thin = |cell: &&[u16; 3]| {
        (0..3).any(|axis| {
            let [two_down, down, up, two_up] = [-2, -1, 1, 2].map(|by| has(**cell, axis, by));
            !(down && (up || two_down) || up && two_up)
        })
    };
    let thin = voxels.cells.par_iter().filter(is_thin).count();
    thin as f64 / voxels.len().max(1) as f64
}

/// The weights of a run, as a polynomial of the place from its middle.
struct Fit {
    middle: f64,
    terms: [f64; 3],
}

impl Fit {
    /// The least change from one that fits the moments of a run of `count` voxels whose border is so far from the middles of
    /// its first and its last. One voxel has a mass alone, two have no second moment.
    fn new(count: usize, [before, beyond]: [f64; 2]) -> Fit {
        let n = count as f64;
        let middle = (n - 1.0) / 2.0;
        let (low, high) = (-middle - before, middle + beyond);
        let moment = |power: i32| (high.powi(power) - low.powi(power)) / f64::from(power);
        let length = moment(1);
        let squares = n * (n * n - 1.0) / 12.0;
        let fourths = squares * (3.0 * n * n - 7.0) / 20.0;
        let missing = [length - n, moment(2), moment(3) - length / 12.0 - squares];
        let slope = if count > 1 { missing[1] / squares } else { 0.0 };
        let terms = if count < 3 {
            [missing[0] / n, slope, 0.0]
        } else {
            let determinant = n * fourths - squares * squares;
            let constant = (missing[0] * fourths - missing[2] * squares) / determinant;
            let curve = (n * missing[2] - squares * missing[0]) / determinant;
            [constant, slope, curve]
        };
        Fit { middle, terms }
    }

    fn weight(&self, place: usize) -> f64 {
        let z = place as f64 - self.middle;
        let [constant, slope, curve] = self.terms;
        (1.0 + constant + slope * z + curve * z * z).clamp(RANGE[0], RANGE[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sums that make a run as stiff as the line that it stands for.
    #[test]
    fn the_weights_of_a_run_have_the_moments_of_the_line() {
        for count in 1..9usize {
            for ends in [
                [0.5, 0.5],
                [0.3, 0.6],
                [0.7, 0.45],
                [0.25, 0.25],
                [0.9, 0.2],
            ] {
                let fit = Fit::new(count, ends);
                let middle = (count as f64 - 1.0) / 2.0;
                let sum = |of: &dyn Fn(f64) -> f64| -> f64 {
                    let term = |place: usize| fit.weight(place) * of(place as f64 - middle);
                    (0..count).map(term).sum()
                };
                let (low, high) = (-middle - ends[0], middle + ends[1]);
                let expected = [
                    high - low,
                    (high * high - low * low) / 2.0,
                    (high.powi(3) - low.powi(3)) / 3.0,
                ];
                let found = [sum(&|_| 1.0), sum(&|z| z), sum(&|z| z * z + 1.0 / 12.0)];
                for moment in 0..count.min(3) {
                    let (found, expected) = (found[moment], expected[moment]);
                    assert!(
                        (found - expected).abs() < 1e-12,
                        "{count} {ends:?}: {found} {expected}"
                    );
                }
            }
        }
        let whole = Fit::new(4, [0.5, 0.5]);
        assert!((0..4).all(|place| whole.weight(place) == 1.0));
    }
}
