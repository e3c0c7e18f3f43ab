//! Samples: solid voxels spread evenly, a given number of them, none of a piece forgotten.

use fretwork_geometry::Seed;

use super::forest::Forest;
use super::pieces::Pieces;
use super::surface_graph::{SurfaceGraph, Touch, UNIT};

/// The least distance of two samples, in pitches. Closer samples would make beams as short as a voxel
/// is wide, which bend like nothing in the pattern; a small pattern gets fewer samples instead.
const LEAST_RADIUS: u32 = 3 * UNIT;
/// How far the number of samples may be from the wanted one: another search of the radius would take
/// longer than it would gain.
const TOLERANCE: f64 = 0.07;
/// Looks at the radius. Each divides the range by more than two.
const SEARCHES: usize = 12;

/// About `target` of the solid voxels, ascending: a Poisson-disk sample (dart throwing) by distances in
/// the solid graph, its radius found by searching between what gave too many and too few (Dumas 2015,
/// 5.1). Every piece of the solid voxels has at least one sample, so that there are more where there
/// are more pieces, and fewer where the pattern is small.
pub fn sample(graph: &SurfaceGraph, solid: &[bool], target: usize, seed: Seed) -> Vec<u32> {
    let order = dart_order(solid, seed);
    let pieces = Pieces::of(graph, Touch::Corner, |v| solid[v as usize]).len();
    // Where one voxel of each piece is most of the samples already, others must tell what lies between.
    let wanted = (target.max(pieces + pieces / 4)).max(1) as f64;
    let mut range = Range {
        least: f64::from(LEAST_RADIUS),
        greatest: f64::from(u32::MAX / 4),
    };
    // As many disks as squares of this side would cover the voxels.
    let side = (order.len() as f64 / wanted).sqrt() * f64::from(UNIT);
    let mut radius = Some(side.clamp(range.least, range.greatest));
    let mut best: Option<(f64, Vec<u32>)> = None;
    for _ in 0..SEARCHES {
        let Some(now) = radius else {
            break;
        };
        let most = (wanted * 2.0) as usize;
        let samples = sample_at(graph, solid, &order, now as u32, most);
        let is_whole = samples.len() <= most;
        let ratio = samples.len() as f64 / wanted;
        let error = (ratio - 1.0).abs();
        if is_whole && best.as_ref().is_none_or(|(known, _)| error < *known) {
            best = Some((error, samples));
        }
        let is_near = is_whole && error <= TOLERANCE;
        radius = range.next(now, ratio).filter(|_| !is_near);
    }
    best.map_or_else(
        || sample_at(graph, solid, &order, u32::MAX / 4, usize::MAX),
        |(_, samples)| samples,
    )
}

/// Where the radius must lie.
struct Range {
    least: f64,
    greatest: f64,
}

impl Range {
    /// The next radius to look at when `radius` has given `ratio` times the samples wanted: none at the ends of
    /// the range. Disks grow with the square of the radius; where that guess leaves the range, half of the
    /// range is taken.
    fn next(&mut self, radius: f64, ratio: f64) -> Option<f64> {
        let end = if ratio > 1.0 {
            &mut self.least
        } else {
            &mut self.greatest
        };
        *end = radius;
        let guess = radius * ratio.min(2.0).sqrt();
        let is_inside = guess > self.least && guess < self.greatest;
        let next = if is_inside {
            guess
        } else {
            (self.least * self.greatest).sqrt()
        };
        // No voxel is nearer to another by less than a unit.
        (self.greatest - self.least > 1.0).then_some(next)
    }
}

/// The solid voxels in a random order that a change of the pattern elsewhere leaves as it is.
fn dart_order(solid: &[bool], seed: Seed) -> Vec<u32> {
    let mut keyed: Vec<(f64, u32)> = (0u32..)
        .zip(solid)
        .filter(|(_, solid)| **solid)
        .map(|(v, _)| (seed.unit(u64::from(v)), v))
        .collect();
    keyed.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    keyed.into_iter().map(|(_, v)| v).collect()
}

/// The samples of a radius, in units of [`UNIT`], ascending: no two are as close as that through solid
/// voxels, and no voxel of `order` is farther from all. Gives up as soon as there are more than `most`.
///
/// A first pass also keeps half the radius across gaps, because the pads of two samples face to face
/// would have no room; the second pass takes what that has left uncovered.
pub fn sample_at(
    graph: &SurfaceGraph,
    solid: &[bool],
    order: &[u32],
    radius: u32,
    most: usize,
) -> Vec<u32> {
    let mut samples: Vec<u32> = Vec::new();
    let mut through = Forest::new(graph.len());
    let mut across = Forest::new(graph.len());
    for keeps_apart in [true, false] {
        for &v in order {
            let is_covered = through.distances[v as usize] != u32::MAX;
            if is_covered || (keeps_apart && across.distances[v as usize] != u32::MAX) {
                continue;
            }
            if samples.len() > most {
                return samples;
            }
            let owner = samples.len() as u32;
            samples.push(v);
            through.plant(v, owner);
            through.grow(graph, Touch::Corner, radius, |w| solid[w as usize]);
            if keeps_apart {
                across.plant(v, owner);
                across.grow(graph, Touch::Corner, radius / 2, |_| true);
            }
        }
    }
    samples.sort_unstable();
    samples
}
