//! Labels: a plane in space, and how the exemplar lies in it.
//!
//! A label says with which plane a voxel is projected onto the exemplar: 26 directions of the plane's
//! normal, 16 × 16 translations over the exemplar's extent, 64 rotations (Dumas et al. 2015, section
//! 6.1; S3). It is one number, `(direction · 256 + shift) · 64 + turn`. Voxels with one label see
//! one undistorted piece of the exemplar, wherever they lie.
//!
//! Places on the exemplar are *phases*: parts of its extent as 32-bit fractions, right and down from its top left.
//! A step of one voxel adds a constant to a phase, and an overflow is the step across the exemplar's
//! border, so that integers alone say which pixel a voxel sees, and they say the same everywhere.

use fretwork_geometry::voxel::Voxel;

/// Directions of planes: the middles of the faces, edges and corners of a cube.
pub(super) const DIRECTIONS: usize = 26;

/// Translations along each side of the exemplar.
pub(super) const SHIFTS: u32 = 16;

/// Rotations.
pub(super) const TURNS: u32 = 64;

/// How far a label's shift is to the left: the turn stands below it.
const SHIFT_BITS: u32 = 6;

/// How far its direction is.
const DIRECTION_BITS: u32 = 14;

/// A phase is cut into sixteen shifts by its four highest bits.
const PHASE_BITS: u32 = 28;

/// A phase along x and along y.
pub(super) type Phase = [u32; 2];

/// The label of a direction, a shift along x and y, and a turn.
pub(super) fn label(direction: usize, [x, y]: [u32; 2], turn: u32) -> u32 {
    let shift = (y % SHIFTS) * SHIFTS + x % SHIFTS;
    ((direction as u32) << DIRECTION_BITS) | (shift << SHIFT_BITS) | (turn % TURNS)
}

/// The direction of a label.
#[inline]
pub(super) fn direction(label: u32) -> usize {
    (label >> DIRECTION_BITS) as usize
}

/// The turn of a label.
#[inline]
pub(super) fn turn(label: u32) -> u32 {
    label % TURNS
}

/// Direction and turn of a label as one number below `DIRECTIONS · TURNS`.
#[inline]
fn pose(label: u32) -> usize {
    direction(label) * TURNS as usize + turn(label) as usize
}

/// The shift of a label as a phase.
#[inline]
fn shift(label: u32) -> Phase {
    let shift = (label >> SHIFT_BITS) % (SHIFTS * SHIFTS);
    [shift % SHIFTS, shift / SHIFTS].map(|n| n << PHASE_BITS)
}

/// The shifts nearest to a phase.
pub(super) fn nearest_shift(phase: Phase) -> [u32; 2] {
    phase.map(|p| p.wrapping_add(1 << (PHASE_BITS - 1)) >> PHASE_BITS)
}

/// The directions of planes with their axes.
pub(super) struct Planes {
    /// Unit normals.
    pub(super) normals: Vec<[f32; 3]>,
    /// For each direction and turn the unit vectors along which the exemplar's right and up lie.
    axes: Vec<[[f64; 3]; 2]>,
}

impl Planes {
    pub(super) fn new() -> Planes {
        let (mut normals, mut axes) = (Vec::with_capacity(DIRECTIONS), Vec::new());
        for n in (0..27).filter(|n| *n != 13) {
            let normal = unit([n / 9, n / 3 % 3, n % 3].map(|c| f64::from(c) - 1.0));
            // Up is as far up as the plane allows; on level planes it is along y.
            let is_level = normal[0] == 0.0 && normal[1] == 0.0;
            let high = if is_level { [0., 1., 0.] } else { [0., 0., 1.] };
            let lean = dot(high, normal);
            let up = unit([0, 1, 2].map(|i| high[i] - lean * normal[i]));
            let right = cross(up, normal);
            for turn in 0..TURNS {
                let angle = f64::from(turn) / f64::from(TURNS) * std::f64::consts::TAU;
                let (s, c) = (libm::sin(angle), libm::cos(angle));
                let turned = |a: f64, b: f64| [0, 1, 2].map(|i| a * right[i] + b * up[i]);
                axes.push([turned(c, s), turned(-s, c)]);
            }
            normals.push(normal.map(|c| c as f32));
        }
        Planes { normals, axes }
    }

    /// The direction in space of a label's up.
    #[inline]
    pub(super) fn up(&self, label: u32) -> [f32; 3] {
        self.axes[pose(label)][1].map(|c| c as f32)
    }

    /// The turn in the plane of `direction` whose up is nearest to `along`.
    pub(super) fn nearest_turn(&self, direction: usize, along: [f32; 3]) -> u32 {
        let [right, up] = self.axes[direction * TURNS as usize];
        let along = along.map(f64::from);
        let angle = libm::atan2(-dot(along, right), dot(along, up)) / std::f64::consts::TAU;
        libm::round((angle + 1.0) * f64::from(TURNS)) as u32 % TURNS
    }

    /// The directions nearest to a normal, the nearest first.
    pub(super) fn nearest<const N: usize>(&self, normal: [f32; 3]) -> [usize; N] {
        let mut best = [(f32::NEG_INFINITY, 0); N];
        for (direction, n) in self.normals.iter().enumerate() {
            let mut next = (
                n[0] * normal[0] + n[1] * normal[1] + n[2] * normal[2],
                direction,
            );
            for place in &mut best {
                if next.0 > place.0 {
                    std::mem::swap(&mut next, place);
                }
            }
        }
        best.map(|(_, direction)| direction)
    }

    /// How phases change from voxel to voxel, of an exemplar of some width and height, both in voxels.
    pub(super) fn steps(&self, extent: [f64; 2]) -> Steps {
        let of = |[right, up]: &[[f64; 3]; 2]| {
            let x = right.map(|c| c / extent[0]);
            let y = up.map(|c| -c / extent[1]);
            let middle = [x, y].map(|by| phase(0.5 * (by[0] + by[1] + by[2])));
            Step {
                x: x.map(phase),
                y: y.map(phase),
                middle,
            }
        };
        Steps(self.axes.iter().map(of).collect())
    }
}

/// How the phases of a direction and a turn change by a step of one voxel along each axis.
#[derive(Clone, Copy)]
pub(super) struct Step {
    /// The phase along the exemplar's width.
    pub(super) x: [u32; 3],
    /// The phase along its height, downward.
    pub(super) y: [u32; 3],
    /// The phase of the middle of the voxel [0, 0, 0].
    middle: Phase,
}

/// The steps of all directions and turns on one level.
pub(super) struct Steps(Vec<Step>);

impl Steps {
    /// The step of a label.
    #[inline]
    pub(super) fn of(&self, label: u32) -> &Step {
        &self.0[pose(label)]
    }

    /// Where a label puts the middle of a voxel.
    #[inline]
    pub(super) fn phase(&self, label: u32, voxel: Voxel) -> Phase {
        let step = self.of(label);
        let shift = shift(label);
        let along = |by: &[u32; 3]| {
            (0..3).fold(0u32, |sum, axis| {
                sum.wrapping_add(by[axis].wrapping_mul(u32::from(voxel[axis])))
            })
        };
        [
            along(&step.x)
                .wrapping_add(step.middle[0])
                .wrapping_add(shift[0]),
            along(&step.y)
                .wrapping_add(step.middle[1])
                .wrapping_add(shift[1]),
        ]
    }
}

/// A number of extents as a phase.
fn phase(extents: f64) -> u32 {
    let part = extents - extents.floor();
    (part * (1u64 << 32) as f64) as u64 as u32
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_their_parts() {
        let given = label(25, [3, 14], 63);
        assert_eq!((direction(given), turn(given)), (25, 63));
        assert_eq!(shift(given), [3 << 28, 14 << 28]);
        assert_eq!(nearest_shift([(3 << 28) + 5, (14 << 28) - 5]), [3, 14]);
        assert_eq!(nearest_shift([u32::MAX, 0]), [0, 0]);
    }

    #[test]
    fn the_exemplar_stands_upright_seen_from_outside() {
        let planes = Planes::new();
        let front = planes.nearest::<1>([0.1, -1.0, 0.1])[0];
        assert_eq!(planes.normals[front], [0.0, -1.0, 0.0]);
        let steps = planes.steps([8.0, 8.0]);
        let at = |voxel| steps.phase(label(front, [0, 0], 0), voxel);
        let [x, y] = at([0, 0, 0]);
        assert_eq!(at([1, 0, 0]), [x.wrapping_add(1 << 29), y]);
        assert_eq!(at([0, 1, 0]), [x, y]);
        assert_eq!(at([0, 0, 1]), [x, y.wrapping_sub(1 << 29)]);
    }

    #[test]
    fn turns_follow_a_direction() {
        let planes = Planes::new();
        for direction in 0..DIRECTIONS {
            for turn in 0..TURNS {
                let up = planes.up(label(direction, [0, 0], turn));
                assert_eq!(planes.nearest_turn(direction, up), turn);
            }
        }
    }
}
