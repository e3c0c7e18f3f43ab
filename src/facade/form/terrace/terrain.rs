//! Heights over the canvas: a grid of rectangles, and areas in which the height differs. The solid under
//! them is watertight.

use std::ops::Range;

use fretwork_geometry::mesh::TriangulationError;
use fretwork_geometry::{PlanarMapError, Point, Polygon};

/// Heights over a grid of rectangles, and areas in which they differ.
#[derive(Clone, Debug, Default)]
pub struct Terrace {
    /// The lines of the grid along x, ascending, at least two.
    pub x: Vec<f64>,
    /// The lines of the grid along y, ascending, at least two.
    pub y: Vec<f64>,
    /// The heights of the rectangles: row by row from the lowest, each from the left.
    pub heights: Vec<f64>,
    /// The areas whose heights differ from those of the rectangles.
    pub patches: Vec<Patch>,
    /// The level of the back, below all heights.
    pub base: f64,
    /// Whether the right side is joined to the left one.
    pub is_around: bool,
}

/// An area with a height of its own.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The area, within the grid.
    pub area: Vec<Polygon>,
    /// The columns and rows in which it counts.
    pub within: Vec<[Range<usize>; 2]>,
    /// The height.
    pub height: PatchHeight,
}

/// The height of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PatchHeight {
    /// So much above the rectangle.
    Over(f64),
    /// The height of the rectangle, but at least this.
    AtLeast(f64),
}

/// Why there is no solid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TerraceError {
    /// The areas cannot be put together into a planar map.
    #[error(transparent)]
    Map(#[from] PlanarMapError),
    /// A part of an area cannot be divided into triangles.
    #[error(transparent)]
    Triangulation(#[from] TriangulationError),
}

/// The side of a post, as a part of the narrowest gap between lines. Two posts in one gap must not
/// meet, so it is below a half.
const POST_IN_GAP: f64 = 0.2;
/// The greatest side of a post, as a part of the canvas's longer side. A larger post would be seen; a
/// much smaller one would come near to the resolution of the planar map.
const GREATEST_POST: f64 = 1e-4;

impl Terrace {
    fn columns(&self) -> usize {
        self.x.len() - 1
    }

    fn rows(&self) -> usize {
        self.y.len() - 1
    }

    fn height(&self, column: usize, row: usize) -> f64 {
        self.heights[row * self.columns() + column]
    }

    /// Posts where two rectangles would touch in an upright line only, which no solid may do.
    pub fn posts(&self) -> Vec<Patch> {
        let gap = |lines: &[f64]| {
            lines
                .windows(2)
                .map(|w| w[1] - w[0])
                .fold(f64::INFINITY, f64::min)
        };
        let longer = (self.x[self.columns()] - self.x[0]).max(self.y[self.rows()] - self.y[0]);
        let narrowest = gap(&self.x).min(gap(&self.y));
        let side = (POST_IN_GAP * narrowest).min(GREATEST_POST * longer);
        let mut posts = Vec::new();
        let seam = usize::from(!self.is_around);
        for row in 1..self.rows() {
            for column in seam..self.columns() {
                let before = if column == 0 {
                    self.columns() - 1
                } else {
                    column - 1
                };
                let at = |c: usize, r: usize| self.height(c, r);
                let one = at(before, row - 1).min(at(column, row));
                let other = at(before, row).min(at(column, row - 1));
                let (one_high, other_high) = (
                    at(before, row - 1).max(at(column, row)),
                    at(before, row).max(at(column, row - 1)),
                );
                if one <= other_high && other <= one_high {
                    continue;
                }
                let height = PatchHeight::AtLeast(one.max(other));
                let mut post = |x: f64| posts.push(self.post(x, self.y[row], side, row, height));
                post(self.x[column]);
                if column == 0 {
                    post(self.x[self.columns()]);
                }
            }
        }
        posts
    }

    fn post(&self, x: f64, y: f64, side: f64, row: usize, height: PatchHeight) -> Patch {
        let (left, right) = (
            (x - side).max(self.x[0]),
            (x + side).min(self.x[self.columns()]),
        );
        let corners = [
            [left, y - side],
            [right, y - side],
            [right, y + side],
            [left, y + side],
        ];
        let area = vec![Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: Vec::new(),
        }];
        Patch {
            area,
            within: vec![[0..self.columns(), row - 1..row + 1]],
            height,
        }
    }

    /// The height at a point that lies on no line; `posts` come after the patches.
    pub fn height_at(&self, p: Point, posts: &[Patch]) -> f64 {
        let find = |lines: &[f64], v: f64| {
            lines
                .partition_point(|line| *line < v)
                .clamp(1, lines.len() - 1)
                - 1
        };
        let (column, row) = (find(&self.x, p.x), find(&self.y, p.y));
        let mut height = self.height(column, row);
        for patch in self.patches.iter().chain(posts) {
            let may = |[columns, rows]: &[Range<usize>; 2]| {
                columns.contains(&column) && rows.contains(&row)
            };
            if patch.within.iter().any(may) && patch.area.iter().any(|a| a.contains(p)) {
                height = match patch.height {
                    PatchHeight::Over(by) => height + by,
                    PatchHeight::AtLeast(least) => height.max(least),
                };
            }
        }
        height
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Point3;

    fn square(a: [f64; 2], b: [f64; 2]) -> Polygon {
        let corners = [a, [b[0], a[1]], b, [a[0], b[1]]];
        Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: Vec::new(),
        }
    }

    fn grid(columns: usize, rows: usize, heights: &[f64]) -> Terrace {
        let lines = |n: usize| (0..=n).map(|i| i as f64).collect();
        Terrace {
            x: lines(columns),
            y: lines(rows),
            heights: heights.to_vec(),
            base: -1.0,
            ..Terrace::default()
        }
    }

    #[track_caller]
    fn check(terrace: &Terrace, volume: f64, genus: usize) {
        let mesh = terrace.solid().unwrap();
        let topology = mesh.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(genus)));
        assert!((mesh.volume() - volume).abs() < 1e-6, "{}", mesh.volume());
    }

    #[test]
    fn steps_are_closed() {
        check(&grid(1, 1, &[2.0]), 3.0, 0);
        check(&grid(2, 2, &[0.0, 1.0, 2.0, 3.0]), 10.0, 0);
        check(&grid(3, 2, &[0.0, 1.0, 0.0, 2.0, -0.5, 2.5]), 11.0, 0);
    }

    #[test]
    fn corners_that_touch_are_joined_by_a_post() {
        let terrace = grid(2, 2, &[1.0, 0.0, 0.0, 2.0]);
        let mesh = terrace.solid().unwrap();
        assert!(mesh.check_closed().is_ok());
        assert!((mesh.volume() - 7.0).abs() < 1e-3);
    }

    #[test]
    fn patches_raise_and_lower() {
        let mut terrace = grid(2, 1, &[1.0, 1.0]);
        let patch = |area: Vec<Polygon>, by: f64| Patch {
            area,
            within: vec![[0..2, 0..1]],
            height: PatchHeight::Over(by),
        };
        terrace
            .patches
            .push(patch(vec![square([0.5, 0.25], [1.5, 0.5])], 0.5));
        check(&terrace, 4.125, 0);
        terrace
            .patches
            .push(patch(vec![square([0.25, 0.75], [1.0, 1.0])], -0.5));
        check(&terrace, 4.125 - 0.09375, 0);
        terrace.patches[1].within = vec![[1..2, 0..1]];
        check(&terrace, 4.125, 0);
    }

    #[test]
    fn joined_sides_make_a_ring() {
        let mut ring = grid(4, 2, &[0.0, 1.0, 2.0, 0.5, 1.0, 0.0, 1.0, 3.0]);
        ring.is_around = true;
        let bent = |ring: &Terrace| {
            let mut mesh = ring.solid().unwrap();
            for p in &mut mesh.positions {
                let angle = p.x * std::f64::consts::FRAC_PI_2;
                *p = Point3::new(
                    (9.0 + p.z) * libm::cos(angle),
                    (9.0 + p.z) * libm::sin(angle),
                    p.y,
                );
            }
            mesh.check_closed().map(|t| (t.components, t.genus))
        };
        assert_eq!(bent(&ring), Ok((1, Some(1))));
        ring.patches.push(Patch {
            area: vec![
                square([0.0, 0.3], [0.5, 0.4]),
                square([3.5, 1.2], [4.0, 1.4]),
            ],
            within: vec![[0..4, 0..2]],
            height: PatchHeight::Over(0.25),
        });
        assert_eq!(bent(&ring), Ok((1, Some(1))));
    }
}
