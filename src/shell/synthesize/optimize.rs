//! Passes over the voxels of a level, each of which lowers what the labels cost (Dumas et al. 2015,
//! algorithms 2 and 3).

use fretwork_geometry::voxel::Voxel;
use fretwork_geometry::{Seed, budget};
use rayon::prelude::*;

use super::candidates::Candidates;
use super::energy::{Problem, Site, State};
use super::label::{SHIFTS, TURNS, direction, label, turn};

/// Sub-passes: voxels whose coordinates have the same remainders by three are never neighbours.
const COLORS: usize = 27;

/// Steps of the budget for each voxel in a pass: it takes three microseconds.
const STEPS: u64 = 300;

/// Voxels that a task takes at once, at least.
const GRAIN: usize = 64;

/// The voxels of a level that may change, by sub-pass.
pub(super) struct Schedule(Vec<Vec<u32>>);

impl Schedule {
    /// That of the voxels that `may_change`.
    pub(super) fn of(cells: &[Voxel], may_change: impl Fn(usize) -> bool) -> Schedule {
        let mut colors = vec![Vec::new(); COLORS];
        for (number, cell) in cells.iter().enumerate() {
            if may_change(number) {
                let [x, y, z] = cell.map(|n| usize::from(n % 3));
                colors[x * 9 + y * 3 + z].push(number as u32);
            }
        }
        Schedule(colors)
    }

    /// How many voxels there are.
    fn len(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }

    /// All voxels, in no useful order.
    pub(super) fn voxels(&self) -> impl Iterator<Item = u32> {
        self.0.iter().flatten().copied()
    }
}

/// Gives a random label to a part of the voxels of a schedule.
pub(super) fn jitter(
    problem: &Problem,
    state: &mut State,
    schedule: &Schedule,
    (part, seed): (f64, Seed),
) {
    let mut candidates = Candidates::default();
    for voxel in schedule.voxels() {
        let voxel = voxel as usize;
        let seed = seed_of(seed, problem.surface.voxels.cells[voxel]);
        if seed.unit(0) >= part {
            continue;
        }
        candidates.visit(problem, voxel);
        let label = candidates.draw(problem, seed, 1);
        if problem.allows(voxel, label) {
            set(problem, state, voxel, label);
        }
    }
}

/// Gives those voxels of a schedule that must be solid and are not the label that costs least among the
/// translations of their own that make them so; where no translation does, those of the next turn. Those of a
/// sub-pass are no neighbours, so that they change at once.
pub(super) fn enforce(problem: &Problem, state: &mut State, schedule: &Schedule) {
    for color in &schedule.0 {
        let changed: Vec<(usize, u32)> = color
            .par_iter()
            .with_min_len(GRAIN)
            .map_init(Site::default, |site, &voxel| {
                let voxel = voxel as usize;
                if problem.allows(voxel, state.labels[voxel]) {
                    return None;
                }
                site.visit(problem, state, voxel);
                Some((voxel, solid_label(problem, state, site)?))
            })
            .flatten()
            .collect();
        for (voxel, label) in changed {
            set(problem, state, voxel, label);
        }
    }
}

/// The label by which the voxel of a site is solid, in its own plane, at the first turn from its own that has one. Of
/// those the one that costs least, and of labels that cost the same the smallest.
fn solid_label(problem: &Problem, state: &State, site: &Site) -> Option<u32> {
    let own = state.labels[site.voxel];
    (0..TURNS).find_map(|by| {
        let mut best = None;
        for n in 0..SHIFTS * SHIFTS {
            let shift = [n % SHIFTS, n / SHIFTS];
            let label = label(direction(own), shift, turn(own) + by);
            if problem.allows(site.voxel, label) {
                let limit = best.map_or(u32::MAX, |(cost, _)| cost);
                let found = (site.cost(problem, label, limit), label);
                best = Some(best.map_or(found, |best| found.min(best)));
            }
        }
        best.map(|(_, label)| label)
    })
}

/// One pass over the voxels of a schedule, sub-pass after sub-pass. The voxels of a sub-pass are not
/// neighbours, so that each is updated as if it were alone, by any thread; what the whole costs
/// falls by the number returned.
///
/// Only the first pass tries voxels all of whose neighbours have their own label: no transition is seen
/// there, and the middle of a piece of the exemplar is best left whole.
pub(super) fn pass(
    problem: &Problem,
    state: &mut State,
    schedule: &Schedule,
    (number, seed): (i64, Seed),
) -> u64 {
    let mut gain = 0;
    budget::spend("voxels of a texture", STEPS * schedule.len() as u64);
    let seed = seed.number(number);
    for color in &schedule.0 {
        let better: Vec<Option<(u32, u32)>> = color
            .par_iter()
            .with_min_len(GRAIN)
            .map_init(
                <(Site, Candidates)>::default,
                |(site, candidates), &voxel| {
                    let voxel = voxel as usize;
                    if number > 0 && problem.is_settled(state, voxel) {
                        return None;
                    }
                    site.visit(problem, state, voxel);
                    let seed = seed_of(seed, problem.surface.voxels.cells[voxel]);
                    candidates.gather(problem, site, seed);
                    improve(problem, state, (site, candidates))
                },
            )
            .collect();
        for (&voxel, better) in color.iter().zip(better) {
            if let Some((label, less)) = better {
                set(problem, state, voxel as usize, label);
                gain += u64::from(less);
            }
        }
    }
    gain
}

/// The best label of a voxel where it is better than its own, and by how much. Of labels that cost the
/// same the smaller is better.
fn improve(
    problem: &Problem,
    state: &State,
    (site, candidates): (&Site, &Candidates),
) -> Option<(u32, u32)> {
    let own = state.labels[site.voxel];
    let before = site.cost(problem, own, u32::MAX);
    let mut best = (before, own);
    for &label in &candidates.labels {
        if label == best.1 || !problem.allows(site.voxel, label) {
            continue;
        }
        let cost = site.cost(problem, label, best.0);
        best = best.min((cost, label));
    }
    (best.1 != own).then_some((best.1, before - best.0))
}

fn set(problem: &Problem, state: &mut State, voxel: usize, label: u32) {
    state.labels[voxel] = label;
    state.texels[voxel] = problem.shown(voxel, label);
}

fn seed_of(seed: Seed, [x, y, z]: Voxel) -> Seed {
    seed.number((i64::from(x) << 32) | (i64::from(y) << 16) | i64::from(z))
}
