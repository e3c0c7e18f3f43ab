//! Syntheses, from the coarsest level to the finest (Dumas et al. 2015, algorithm 2).

use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Pixels, Seed, budget};

use super::check::{self, SynthesizeError};
use super::distance::feature_radius;
use super::energy::{Problem, State};
use super::label::{Planes, Steps};
use super::neighbors::Neighbors;
use super::optimize::{Schedule, enforce, jitter, pass};
use super::pattern::{Options, Pattern};
use super::stack::{Layer, layers};
use super::{orientation, region};
use crate::voxelize::Level;

/// Passes over each level but the finest, where they cost most. On a sphere three passes leave a fifth less
/// to pay than two, and five a fifth less than three.
const PASSES: i64 = 6;

/// Passes over the finest level.
const LAST_PASSES: i64 = 4;

/// How far the solid part may be from the exemplar's before another pattern is tried, as a part of the rarer of solid and empty,
/// and how near is enough then.
const TOLERATED: f64 = 0.3;
const ENOUGH: f64 = 0.15;

/// How much the rarer is favoured where it is missing altogether, one try after the other, in the most different distances of all
/// neighbours. More tears a pattern apart that would be right with less.
const FAVOURS: [f64; 4] = [0.03, 0.08, 0.2, 0.4];

/// Bytes a pixel of the exemplar, while its features are measured and blurred.
const PIXEL: usize = 64;

/// What does not change from one synthesis to the next.
pub struct Synthesizer<'a> {
    pyramid: &'a [Level],
    seed: Seed,
    jitter: f64,
    is_axial: bool,
    /// Which voxels of the finest level must always be solid; empty where none must.
    keep: Vec<bool>,
    planes: Planes,
    levels: Vec<Stage>,
    /// How many levels a local synthesis goes back.
    pub(super) back: usize,
}

/// What one level needs.
struct Stage {
    neighbors: Neighbors,
    steps: Steps,
    layer: Layer,
    orientation: Vec<[f32; 3]>,
}

impl<'a> Synthesizer<'a> {
    /// Prepares syntheses of `exemplar` on the voxels of `pyramid`, whose first level is the finest.
    ///
    /// # Errors
    /// An exemplar without pixels, all solid or all empty, smaller than a neighbourhood of voxels, or with an impossible
    /// pixel size; options that are not of this surface.
    pub fn new(
        pyramid: &'a [Level],
        exemplar: &Pixels,
        options: &Options,
    ) -> Result<Synthesizer<'a>, SynthesizeError> {
        check::check(pyramid, exemplar, options)?;
        budget::make("pixels of an exemplar", exemplar.rgb.len(), PIXEL);
        let pitch = pyramid[0].surface.voxels.lattice.pitch;
        let planes = Planes::new();
        let layers = layers(exemplar, pitch, pyramid.len());
        let extent = [exemplar.width, exemplar.height()]
            .map(|pixels| pixels as f64 * exemplar.pixel_size / pitch);
        let orientations = orientation::levels(pyramid, options);
        let parts = pyramid.iter().zip(layers).zip(orientations);
        let stage = |(number, ((level, layer), orientation)): (usize, ((&Level, _), _))| Stage {
            neighbors: Neighbors::of(&level.surface),
            steps: planes.steps(extent.map(|e| e / (1u64 << number) as f64)),
            layer,
            orientation,
        };
        let levels: Vec<Stage> = parts.enumerate().map(stage).collect();
        Ok(Synthesizer {
            pyramid,
            seed: options.seed,
            jitter: options.jitter,
            is_axial: options.is_axial,
            keep: options.keep.clone(),
            planes,
            levels,
            back: region::levels_back(feature_radius(exemplar) / pitch, pyramid.len()),
        })
    }

    /// A texture for all voxels. O(n).
    ///
    /// A pattern of few figures is cheapest without any, since what is empty fits to what is empty everywhere. Where its solid
    /// part is far from the exemplar's (S4) it is made again, and what is missing is favoured, more and more; the nearest is taken.
    pub fn synthesize(&self) -> Pattern {
        let mut best = self.synthesized(0.0);
        let mut least = self.missing(&best);
        if least <= TOLERATED {
            return best;
        }
        for favour in FAVOURS {
            let next = self.synthesized(favour);
            let missing = self.missing(&next);
            if missing < least {
                (best, least) = (next, missing);
            }
            if least <= ENOUGH {
                break;
            }
        }
        best
    }

    /// How far the solid part of a pattern is from the exemplar's, as a part of the rarer of solid and empty.
    fn missing(&self, pattern: &Pattern) -> f64 {
        let is_free = |voxel: &usize| !self.keep.get(*voxel).copied().unwrap_or(false);
        let free = || (0..pattern.solid.len()).filter(is_free);
        let solid = free().filter(|voxel| pattern.solid[*voxel]).count();
        missing(&self.levels[0].layer, (solid, free().count())).abs()
    }

    /// The texture that favours so much what is missing.
    fn synthesized(&self, favour: f64) -> Pattern {
        let bound = region::raised(self.pyramid, &self.keep, self.back + 1);
        let coarsest = self.pyramid.len() - 1;
        let mut labels = vec![Vec::new(); self.pyramid.len()];
        for level in (0..=coarsest).rev() {
            let from = if level == coarsest {
                vec![0; self.surface(level).voxels.len()]
            } else {
                let above: &Vec<u32> = &labels[level + 1];
                let parents = &self.pyramid[level].parents;
                parents.iter().map(|&p| above[p as usize]).collect()
            };
            let schedule = Schedule::of(&self.surface(level).voxels.cells, |_| true);
            let bound = bound.get(level).map_or(&[][..], Vec::as_slice);
            let problem = self.problem(level, bound);
            let part = self.shuffled(level);
            labels[level] = self.improved(problem, from, &schedule, (level, part, favour));
        }
        self.pattern(labels, &self.keep)
    }

    /// The texture `pattern` with all voxels of `forced` solid (section 4.4). Those that are not yet
    /// take other labels, as do the voxels near them: all below their ancestors on the level that
    /// is as coarse as the features of the exemplar. Every other voxel stays as it is.
    ///
    /// # Errors
    /// A pattern or `forced` of another surface.
    pub fn resynthesize(
        &self,
        pattern: &Pattern,
        forced: &[bool],
    ) -> Result<Pattern, SynthesizeError> {
        check::check_pattern(self.pyramid, pattern, forced)?;
        let kept = |voxel: usize| self.keep.get(voxel).copied().unwrap_or(false);
        let must: Vec<bool> = (0..forced.len()).map(|v| forced[v] || kept(v)).collect();
        let missing: Vec<bool> = must
            .iter()
            .zip(&pattern.solid)
            .map(|(m, s)| *m && !s)
            .collect();
        if !missing.contains(&true) {
            return Ok(pattern.clone());
        }
        let bound = region::raised(self.pyramid, &must, self.back + 1);
        let region = region::below(self.pyramid, &missing, self.back);
        let mut labels = pattern.labels.clone();
        for level in (0..=self.back).rev() {
            let mut from = labels[level].clone();
            if level < self.back {
                for (voxel, label) in from.iter_mut().enumerate() {
                    if region[level][voxel] {
                        *label = labels[level + 1][self.pyramid[level].parents[voxel] as usize];
                    }
                }
            }
            let may_change = |voxel: usize| region[level][voxel];
            let schedule = Schedule::of(&self.surface(level).voxels.cells, may_change);
            let problem = self.problem(level, &bound[level]);
            labels[level] = self.improved(problem, from, &schedule, (level, 0.0, 0.0));
        }
        let mut next = self.pattern(labels, &must);
        // What was solid by force, and not by its label, stays so.
        for (voxel, solid) in next.solid.iter_mut().enumerate() {
            if !region[0][voxel] {
                *solid = pattern.solid[voxel];
            }
        }
        Ok(next)
    }

    /// The part of the voxels of a level that is shuffled. Below the level of the exemplar's features
    /// order is not what is shuffled but the features themselves: there the number of shuffled voxels stays,
    /// and levels have four times the voxels of those above.
    fn shuffled(&self, level: usize) -> f64 {
        let finer = self.back.saturating_sub(level).min(30);
        self.jitter / (1u64 << (2 * finer)) as f64
    }

    fn surface(&self, level: usize) -> &VoxelSurface {
        &self.pyramid[level].surface
    }

    pub(super) fn problem<'b>(&'b self, level: usize, bound: &'b [bool]) -> Problem<'b> {
        let stage = &self.levels[level];
        Problem {
            surface: self.surface(level),
            neighbors: &stage.neighbors,
            planes: &self.planes,
            steps: &stage.steps,
            layer: &stage.layer,
            orientation: &stage.orientation,
            is_axial: self.is_axial,
            favour: 0.0,
            bound,
        }
    }

    /// The labels after jitter and passes.
    fn improved(
        &self,
        mut problem: Problem,
        labels: Vec<u32>,
        schedule: &Schedule,
        (level, part, favoured): (usize, f64, f64),
    ) -> Vec<u32> {
        let seed = self.seed.number(level as i64);
        let mut state: State = problem.state(labels);
        jitter(&problem, &mut state, schedule, (part, seed.number(0)));
        enforce(&problem, &mut state, schedule);
        let passes = if level == 0 { LAST_PASSES } else { PASSES };
        for number in 0..passes {
            if favoured > 0.0 {
                problem.favour = (favoured * favour(&problem, &state, schedule)) as f32;
            }
            pass(&problem, &mut state, schedule, (number, seed.number(1)));
        }
        state.labels
    }

    /// What the labels show on the finest level, with `must` solid whatever they show.
    fn pattern(&self, labels: Vec<Vec<u32>>, must: &[bool]) -> Pattern {
        let problem = self.problem(0, &[]);
        let phases = || {
            let numbered = labels[0].iter().enumerate();
            numbered.map(|(voxel, label)| problem.phase(voxel, *label))
        };
        let must = |voxel: usize| must.get(voxel).copied().unwrap_or(false);
        let solid = phases().map(|phase| problem.layer.is_solid(phase));
        Pattern {
            solid: solid
                .enumerate()
                .map(|(v, solid)| solid || must(v))
                .collect(),
            colors: phases().map(|phase| problem.layer.color(phase)).collect(),
            labels,
        }
    }
}

/// What is to be favoured so that the solid part of the voxels of a schedule comes near the exemplar's, from -1 for what is empty to 1
/// for what is solid: an occurrence that is far from the exemplar's is paid for (after Kaspar and others, Self Tuning
/// Texture Optimization, 2015).
fn favour(problem: &Problem, state: &State, schedule: &Schedule) -> f64 {
    let free = || {
        let voxels = schedule.voxels().map(|voxel| voxel as usize);
        voxels.filter(|voxel| !problem.is_bound(*voxel))
    };
    let is_solid = |voxel: &usize| {
        let phase = problem.phase(*voxel, state.labels[*voxel]);
        problem.layer.is_solid(phase)
    };
    let found = (free().filter(is_solid).count(), free().count());
    missing(problem.layer, found).clamp(-1.0, 1.0)
}

/// What is missing of the solid part of a layer where so many voxels of some are solid, as a part of the rarer of solid and
/// empty; negative where there is too much.
fn missing(layer: &Layer, (solid, all): (usize, usize)) -> f64 {
    let wanted = layer.solid_fraction();
    let rarer = wanted.min(1.0 - wanted).max(f64::MIN_POSITIVE);
    (wanted - solid as f64 / all.max(1) as f64) / rarer
}
