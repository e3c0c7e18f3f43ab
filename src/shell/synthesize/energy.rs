//! What a choice of labels costs (Dumas et al. 2015, section 4.2.2).
//!
//! Two neighbours of one label see one piece of the exemplar, which costs nothing. For two of different
//! labels the plane of each shows both voxels' middles, and what it shows is compared with what the other
//! plane shows there: the printed formula has one of the two terms garbled, this is the one its figure 5
//! draws. Added to that, a voxel pays for the angle between its normal and its plane's, for the angle
//! between its orientation and its plane's up, and near the border of an exemplar that does not tile.
//!
//! Each pair counts once. What a voxel pays alone is multiplied by the number of its neighbours, so that the balance
//! is the same on the thin and the thick parts of a layer. All of it is whole numbers, so that sums do not depend
//! on their order, and a step that lowers what one voxel pays lowers the whole by exactly as much.

use fretwork_geometry::voxel::VoxelSurface;

use super::label::{Phase, Planes, Steps, direction};
use super::neighbors::Neighbors;
use super::stack::{Layer, Texel, UNIT, difference};

/// The most neighbours a voxel has.
const MOST: usize = 124;

/// What a plane at a right angle to the surface costs, in the most different distances of all neighbours.
const DISTORTION: f32 = 1.0;

/// What a plane whose up is at a right angle to the orientation costs, likewise.
const TURNING: f32 = 0.6;

/// What a place on the border of an exemplar that does not tile costs, likewise.
const BORDER: f32 = 1.0;

/// One level of voxels and what labels cost there.
pub(super) struct Problem<'a> {
    pub(super) surface: &'a VoxelSurface,
    pub(super) neighbors: &'a Neighbors,
    pub(super) planes: &'a Planes,
    pub(super) steps: &'a Steps,
    pub(super) layer: &'a Layer,
    /// For each voxel where the exemplar's up should point; the shorter, the less it matters.
    pub(super) orientation: &'a [[f32; 3]],
    /// Whether orientations have no sign.
    pub(super) is_axial: bool,
    /// What showing what is rarer than it should be is worth, in the most different distances of all neighbours: solid
    /// places if positive, empty ones if negative.
    pub(super) favour: f32,
    /// Which voxels must be solid; empty where none must.
    pub(super) bound: &'a [bool],
}

/// The labels of a level, and what the voxels show by them.
#[derive(Clone)]
pub(super) struct State {
    pub(super) labels: Vec<u32>,
    pub(super) texels: Vec<Texel>,
}

impl Problem<'_> {
    /// The state of some labels.
    pub(super) fn state(&self, labels: Vec<u32>) -> State {
        let texels = (0..labels.len())
            .map(|v| self.shown(v, labels[v]))
            .collect();
        State { labels, texels }
    }

    /// What a voxel shows by a label.
    #[inline]
    pub(super) fn shown(&self, voxel: usize, label: u32) -> Texel {
        self.layer.texel(self.phase(voxel, label))
    }

    /// Where a label puts the middle of a voxel.
    #[inline]
    pub(super) fn phase(&self, voxel: usize, label: u32) -> Phase {
        self.steps.phase(label, self.surface.voxels.cells[voxel])
    }

    /// Whether a voxel may have a label: it is free, or solid by it.
    #[inline]
    pub(super) fn allows(&self, voxel: usize, label: u32) -> bool {
        !self.is_bound(voxel) || self.layer.is_solid(self.phase(voxel, label))
    }

    /// Whether a voxel must be solid.
    #[inline]
    pub(super) fn is_bound(&self, voxel: usize) -> bool {
        self.bound.get(voxel).copied().unwrap_or(false)
    }

    /// What a voxel pays alone for a label that puts it at `phase`.
    #[inline]
    pub(super) fn alone(&self, voxel: usize, label: u32, phase: Phase) -> u32 {
        let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let normal = self.surface.normals[voxel];
        let lean = 1.0 - dot(normal, self.planes.normals[direction(label)]);
        let along = self.orientation[voxel];
        let mut aligned = dot(along, self.planes.up(label));
        if self.is_axial {
            aligned = aligned.abs();
        }
        let turned = dot(along, along).sqrt() - aligned;
        let cost = DISTORTION * lean.max(0.0)
            + TURNING * turned.max(0.0)
            + BORDER * self.layer.border(phase)
            + self.unfavoured(phase);
        let count = self.neighbors.row(voxel).len().max(1);
        (cost * UNIT * count as f32) as u32
    }

    /// What a place pays for not being of what is favoured.
    #[inline]
    fn unfavoured(&self, phase: Phase) -> f32 {
        if self.favour == 0.0 || self.layer.is_solid(phase) == (self.favour > 0.0) {
            return 0.0;
        }
        self.favour.abs()
    }

    /// Whether a voxel and its neighbours have one label.
    pub(super) fn is_settled(&self, state: &State, voxel: usize) -> bool {
        let own = state.labels[voxel];
        let mut row = self.neighbors.row(voxel).iter();
        row.all(|&other| state.labels[other as usize] == own)
    }

    /// What all voxels pay. Tests compare it with what passes gain.
    #[cfg(test)]
    pub(super) fn total(&self, state: &State) -> u64 {
        let mut site = Site::default();
        let pays = |voxel: usize| {
            site.visit(self, state, voxel);
            let label = state.labels[voxel];
            let alone = self.alone(voxel, label, self.phase(voxel, label));
            let all = site.cost(self, label, u32::MAX);
            u64::from(alone) * 2 + u64::from(all - alone)
        };
        (0..state.labels.len()).map(pays).sum::<u64>() / 2
    }
}

/// A voxel with its neighbours, gathered to try many labels in it.
pub(super) struct Site {
    pub(super) voxel: usize,
    count: usize,
    /// The steps to the neighbours, as wrapping numbers.
    steps: [[u32; 3]; MOST],
    labels: [u32; MOST],
    /// What the neighbours show.
    there: [Texel; MOST],
    /// What the voxel itself would show by the labels of its neighbours.
    here: [Texel; MOST],
}

impl Default for Site {
    fn default() -> Site {
        Site {
            voxel: 0,
            count: 0,
            steps: [[0; 3]; MOST],
            labels: [0; MOST],
            there: [[0; 4]; MOST],
            here: [[0; 4]; MOST],
        }
    }
}

impl Site {
    /// Gathers the neighbours of a voxel.
    pub(super) fn visit(&mut self, problem: &Problem, state: &State, voxel: usize) {
        let cells = &problem.surface.voxels.cells;
        let from = cells[voxel];
        let row = problem.neighbors.row(voxel);
        (self.voxel, self.count) = (voxel, row.len());
        for (n, &other) in row.iter().enumerate() {
            let other = other as usize;
            let to = cells[other];
            self.steps[n] =
                [0, 1, 2].map(|axis| u32::from(to[axis]).wrapping_sub(u32::from(from[axis])));
            self.there[n] = state.texels[other];
            let label = state.labels[other];
            self.labels[n] = label;
            // Neighbours mostly share their labels.
            self.here[n] = if n > 0 && self.labels[n - 1] == label {
                self.here[n - 1]
            } else {
                problem.shown(voxel, label)
            };
        }
    }

    /// The labels of the neighbours.
    pub(super) fn labels(&self) -> &[u32] {
        &self.labels[..self.count]
    }

    /// What the voxel pays for a label, alone and with its neighbours; any number above `limit` where it
    /// is more than that.
    #[inline]
    pub(super) fn cost(&self, problem: &Problem, label: u32, limit: u32) -> u32 {
        let [x, y] = problem.phase(self.voxel, label);
        let mut cost = problem.alone(self.voxel, label, [x, y]);
        if cost > limit {
            return cost;
        }
        let shown = problem.layer.texel([x, y]);
        let step = *problem.steps.of(label);
        let along = |from: u32, by: &[u32; 3], to: &[u32; 3]| {
            from.wrapping_add(by[0].wrapping_mul(to[0]))
                .wrapping_add(by[1].wrapping_mul(to[1]))
                .wrapping_add(by[2].wrapping_mul(to[2]))
        };
        for n in 0..self.count {
            if self.labels[n] == label {
                continue;
            }
            let to = &self.steps[n];
            let phase = [along(x, &step.x, to), along(y, &step.y, to)];
            cost += difference(shown, self.here[n])
                + difference(problem.layer.texel(phase), self.there[n]);
            if cost > limit {
                break;
            }
        }
        cost
    }
}
