//! What is asked: a body, what holds it and what pulls at it.

use fretwork_geometry::voxel::Voxels;
use fretwork_geometry::{Bounds3, Point3};

/// A body of voxels, each of them one finite element.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// Its voxels.
    pub voxels: &'a Voxels,
    /// How many metres one unit of their lattice is.
    pub metres_per_unit: f64,
}

/// Which places are meant, in units of the lattice. Nodes, the corners of voxels, are asked for.
pub type Places<'a> = &'a (dyn Fn(Point3) -> bool + Sync);

/// A force on some nodes, which share it equally. What falls on nodes that are held goes straight to the
/// supports.
#[derive(Clone, Copy)]
pub struct Load<'a> {
    /// Where it acts.
    pub at: Places<'a>,
    /// Newtons.
    pub force: [f64; 3],
}

/// One thing that happens to a body.
#[derive(Clone, Default)]
pub struct Case<'a> {
    /// The acceleration of all of the body, in m/s².
    pub gravity: [f64; 3],
    /// Forces beside it.
    pub loads: Vec<Load<'a>>,
}

/// A part of space by its place on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Zone {
    /// Up to this height above the lowest point, along z.
    Lowest(f64),
    /// Down to this depth below the highest point, along z.
    Highest(f64),
    /// A box with its faces.
    Box(Bounds3),
    /// A ball with its surface.
    Ball {
        /// Its middle.
        center: Point3,
        /// Its radius.
        radius: f64,
    },
}

/// Places that differ by this part of a body's size are the same: nodes come from products of rounded
/// numbers.
const SAME: f64 = 1e-9;

impl Body<'_> {
    /// The box of the voxels; empty without any.
    pub fn bounds(&self) -> Bounds3 {
        let lattice = &self.voxels.lattice;
        let ends =
            self.voxels.cells.iter().flat_map(|cell| {
                [0.0, 1.0].map(|end| lattice.point(cell.map(|n| f64::from(n) + end)))
            });
        Bounds3::of(ends)
    }
}

impl Zone {
    /// Whether `p` is in the zone of a body with these bounds.
    pub fn contains(&self, p: Point3, body: &Bounds3) -> bool {
        let near = SAME * body.longest_side();
        match *self {
            Zone::Lowest(height) => p.z <= body.min.z + height + near,
            Zone::Highest(depth) => p.z >= body.max.z - depth - near,
            Zone::Ball { center, radius } => p.distance(center) <= radius + near,
            Zone::Box(Bounds3 { min, max }) => {
                let within = |x: f64, a: f64, b: f64| x >= a - near && x <= b + near;
                within(p.x, min.x, max.x) && within(p.y, min.y, max.y) && within(p.z, min.z, max.z)
            }
        }
    }
}
