//! Where on a surface the pattern is: a smooth border through the steps of its voxels.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::{Voxel, VoxelSurface};

/// The reach of a voxel's weight, in pitches. A straight border of voxels stays where it is, a strip
/// of two voxels keeps its width, and steps of one voxel are gone.
const REACH: f64 = 1.5;

/// The slope of the covered part at a straight border, times the reach: the weights of a cone over a
/// disc, 3 / π.
const SLOPE: f64 = 0.954_929_658_551_372;

/// The part of the surface around a place that the pattern covers.
pub struct Coverage<'a> {
    surface: &'a VoxelSurface,
    solid: &'a [bool],
    columns: Columns,
}

impl<'a> Coverage<'a> {
    /// The coverage by the solid voxels of a surface.
    pub fn new(surface: &'a VoxelSurface, solid: &'a [bool]) -> Coverage<'a> {
        Coverage {
            columns: Columns::of(&surface.voxels.cells),
            surface,
            solid,
        }
    }

    /// The side of a voxel.
    pub fn pitch(&self) -> f64 {
        self.surface.voxels.lattice.pitch
    }

    /// How far the place `p` of the surface is from the border of the pattern, as a length: negative
    /// where it is covered. True near the border; elsewhere it is bounded by the reach of a voxel. Only
    /// voxels whose normals do not lean away from `normal` count: they may be of another sheet. With the
    /// gradient, a vector of space.
    pub fn outside(&self, p: Point3, normal: Point3) -> (f64, Point3) {
        let lattice = &self.surface.voxels.lattice;
        let place = lattice.place(p);
        let low = place.map(|c| (c - REACH - 0.5).ceil().max(0.0));
        let high = place.map(|c| (c + REACH - 0.5).floor().min(f64::from(u16::MAX)));
        if (0..3).any(|axis| high[axis] < low[axis]) {
            return (f64::INFINITY, Point3::ORIGIN);
        }
        let (low, high) = (low.map(|c| c as u16), high.map(|c| c as u16));
        let (mut covered, mut all) = ((0.0, Point3::ORIGIN), (0.0, Point3::ORIGIN));
        let cells = &self.surface.voxels.cells;
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for number in self.columns.part(cells, [x, y, low[2]], high[2]) {
                    let cell = cells[number];
                    let away = Point3::from(place) - Point3::from(cell.map(|c| f64::from(c) + 0.5));
                    let lean = Point3::from(self.surface.normals[number].map(f64::from));
                    let distance = away.length();
                    let weight = 1.0 - distance / REACH;
                    if weight <= 0.0 || lean.dot(normal) < -0.5 {
                        continue;
                    }
                    let slope = away * (-1.0 / (REACH * distance.max(1e-9)));
                    all = (all.0 + weight, all.1 + slope);
                    if self.solid[number] {
                        covered = (covered.0 + weight, covered.1 + slope);
                    }
                }
            }
        }
        if all.0 <= 0.0 {
            return (f64::INFINITY, Point3::ORIGIN);
        }
        let part = covered.0 / all.0;
        let slope = (covered.1 - all.1 * part) * (1.0 / all.0);
        let unit = REACH / SLOPE;
        ((0.5 - part) * unit * lattice.pitch, slope * -unit)
    }
}

/// Where the voxels of each column along z begin among all, which are in order.
struct Columns {
    /// The least place along x and y.
    low: [u16; 2],
    /// How many columns there are along x and y.
    size: [usize; 2],
    /// Where each column begins, and the last one ends.
    starts: Vec<u32>,
}

impl Columns {
    fn of(cells: &[Voxel]) -> Columns {
        let range = |axis: usize| {
            let places = || cells.iter().map(|cell| cell[axis]);
            let low = places().min().unwrap_or(0);
            (low, usize::from(places().max().unwrap_or(0) - low) + 1)
        };
        let [(x, wide), (y, deep)] = [range(0), range(1)];
        let mut columns = Columns {
            low: [x, y],
            size: [wide, deep],
            starts: vec![0; wide * deep + 1],
        };
        for cell in cells {
            let column = columns.number([cell[0], cell[1]]);
            columns.starts[column.expect("all voxels are in the range of all") + 1] += 1;
        }
        (1..columns.starts.len()).for_each(|n| columns.starts[n] += columns.starts[n - 1]);
        columns
    }

    fn number(&self, place: [u16; 2]) -> Option<usize> {
        let along = |axis: usize| {
            let at = usize::from(place[axis].checked_sub(self.low[axis])?);
            (at < self.size[axis]).then_some(at)
        };
        Some(along(0)? * self.size[1] + along(1)?)
    }

    /// The numbers of the voxels of a column from `low` up to the height `high`.
    #[inline]
    fn part(&self, cells: &[Voxel], low: Voxel, high: u16) -> std::ops::Range<usize> {
        let Some(column) = self.number([low[0], low[1]]) else {
            return 0..0;
        };
        let [from, to] = [0, 1].map(|beyond| self.starts[column + beyond] as usize);
        let column = &cells[from..to];
        let first = from + column.partition_point(|cell| cell[2] < low[2]);
        let above = cells[first..to].iter().take_while(|cell| cell[2] <= high);
        first..first + above.count()
    }
}
