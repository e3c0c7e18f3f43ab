//! Which labels are tried in a voxel (Dumas et al. 2015, section 4.3).

use fretwork_geometry::Seed;

use super::energy::{Problem, Site};
use super::label::{SHIFTS, TURNS, direction, label, nearest_shift, turn};

/// Random labels that are tried in a voxel.
const RANDOM: u32 = 24;

/// Labels of neighbours that are carried over into planes that fit the voxel better.
const CARRIED: usize = 6;

/// Of this many planes that lean least from the surface one is drawn, the first most often. They are those of
/// a cone about the normal: 26 planes are about 45 degrees apart.
const PLANES: usize = 4;

/// How far a random turn is from the orientation, at most, in turns of a 64th: about 17 degrees.
const SPREAD: u32 = 3;

/// Below this length an orientation says nothing about turns.
const VAGUE: f32 = 0.25;

/// The labels to be tried in one voxel. Reused from voxel to voxel.
#[derive(Default)]
pub(super) struct Candidates {
    pub(super) labels: Vec<u32>,
    near: [usize; PLANES],
    along: [f32; 3],
    is_vague: bool,
}

impl Candidates {
    /// Gathers candidates for the voxel of a site: the labels around it, those carried over into better
    /// planes, and random ones.
    pub(super) fn gather(&mut self, problem: &Problem, site: &Site, seed: Seed) {
        self.visit(problem, site.voxel);
        self.labels.clear();
        self.labels.extend_from_slice(site.labels());
        self.labels.sort_unstable();
        self.labels.dedup();
        for n in 0..self.labels.len().min(CARRIED) {
            self.carry(problem, site.voxel, self.labels[n]);
        }
        for n in 0..RANDOM {
            let label = self.draw(problem, seed, u64::from(n));
            self.labels.push(label);
        }
    }

    /// Prepares to draw labels for a voxel.
    pub(super) fn visit(&mut self, problem: &Problem, voxel: usize) {
        self.near = problem.planes.nearest(problem.surface.normals[voxel]);
        self.along = problem.orientation[voxel];
        self.is_vague = self.along.iter().map(|c| c * c).sum::<f32>() < VAGUE * VAGUE;
    }

    /// A random label that suits the voxel: a plane in a cone about its normal, a turn near its orientation, any
    /// translation.
    pub(super) fn draw(&self, problem: &Problem, seed: Seed, n: u64) -> u32 {
        // 53 random bits are enough for all that is drawn.
        let bits = (seed.unit(n) * (1u64 << 53) as f64) as u64;
        let part = |from: u32, below: u32| ((bits >> from) as u32) % below;
        let plane = [0, 0, 0, 0, 1, 1, 2, 3][part(0, 8) as usize];
        let direction = self.near[plane];
        let turn = if self.is_vague {
            part(8, TURNS)
        } else {
            let about = problem.planes.nearest_turn(direction, self.along);
            let half = if problem.is_axial {
                part(20, 2) * TURNS / 2
            } else {
                0
            };
            about + half + TURNS + part(8, 2 * SPREAD + 1) - SPREAD
        };
        label(direction, [part(32, SHIFTS), part(40, SHIFTS)], turn)
    }

    /// Adds what continues the exemplar as `other` shows it here in a plane that leans less, or in a turn
    /// nearer to the orientation: of the 256 translations the one that puts the voxel nearest to the same
    /// place.
    fn carry(&mut self, problem: &Problem, voxel: usize, other: u32) {
        let wanted = problem.phase(voxel, other);
        for plane in 0..2 {
            let direction_there = self.near[plane];
            let up = problem.planes.up(other);
            let straight = problem.planes.nearest_turn(direction_there, up);
            let mut turns = [straight; 2];
            if !self.is_vague {
                let mut wished = problem.planes.nearest_turn(direction_there, self.along);
                // Of an orientation without a sign that way round which is nearer.
                let off = (wished + TURNS - straight) % TURNS;
                if problem.is_axial && (TURNS / 4..3 * TURNS / 4).contains(&off) {
                    wished = (wished + TURNS / 2) % TURNS;
                }
                turns[1] = wished;
            }
            for (n, to) in turns.into_iter().enumerate() {
                let is_same = direction_there == direction(other) && to == turn(other);
                if is_same || (n == 1 && turns[0] == turns[1]) {
                    continue;
                }
                let plain = problem.phase(voxel, label(direction_there, [0, 0], to));
                let off = [0, 1].map(|axis| wanted[axis].wrapping_sub(plain[axis]));
                self.labels
                    .push(label(direction_there, nearest_shift(off), to));
            }
        }
    }
}
