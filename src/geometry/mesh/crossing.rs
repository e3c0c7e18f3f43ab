//! Where a mesh that follows a curve passes through itself. Parts that are near one another along the curve are not
//! compared: how sharply they are folded is asked elsewhere.

use super::{Bounds3, Mesh};
use crate::Point3;

/// Corners nearer to a triangle's plane than this part of the mesh's size are on it.
const ON_PLANE: f64 = 1e-7;
/// Cells that the grid has for each triangle, about.
const CELLS_A_TRIANGLE: f64 = 2.0;

/// Where the corners of a mesh are along a curve.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a> {
    /// The place of each corner.
    pub places: &'a [f64],
    /// Triangles nearer than this along the curve are not compared.
    pub far: f64,
    /// The length after which a closed curve begins again.
    pub period: Option<f64>,
}

impl Along<'_> {
    fn at(&self, triangle: [u32; 3]) -> f64 {
        self.places[triangle[0] as usize]
    }

    fn is_far(&self, s: [u32; 3], t: [u32; 3]) -> bool {
        let way = (self.at(s) - self.at(t)).abs();
        self.period.map_or(way, |period| way.min(period - way)) > self.far
    }
}

/// A place where an edge of one triangle passes through another one that is far from it along the curve, if there is such a place.
/// Triangles are sorted into the cells of a grid; O(n log n) for triangles of like sizes on a curve that is seldom near itself.
pub fn self_crossing(mesh: &Mesh, along: &Along) -> Option<Point3> {
    let bounds = mesh.bounds();
    let size = bounds.longest_side();
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let boxes: Vec<Bounds3> = mesh
        .triangles
        .iter()
        .map(|&t| Bounds3::of(mesh.corners(t)))
        .collect();
    let entries = sorted_into_cells(&boxes, bounds);
    let at = |entry: &([u32; 3], u32)| along.at(mesh.triangles[entry.1 as usize]);
    let spread = |cell: &[([u32; 3], u32)]| {
        let (low, high) = cell
            .iter()
            .map(at)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
                (l.min(v), h.max(v))
            });
        high - low
    };
    let cells = entries
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|cell| spread(cell) > along.far);
    let mut pairs = cells.flat_map(|cell| {
        (0..cell.len()).flat_map(move |i| {
            cell[i + 1..]
                .iter()
                .map(move |other| (cell[i].1 as usize, other.1 as usize))
        })
    });
    pairs.find_map(|(a, b)| {
        let (s, t) = (mesh.triangles[a], mesh.triangles[b]);
        let compared = along.is_far(s, t) && meet(&boxes[a], &boxes[b]);
        if compared {
            crossing(mesh.corners(s), mesh.corners(t), ON_PLANE * size)
        } else {
            None
        }
    })
}

/// Cells and numbers of the triangles whose boxes reach into them, in order.
fn sorted_into_cells(boxes: &[Bounds3], bounds: Bounds3) -> Vec<([u32; 3], u32)> {
    let count = boxes.len().max(1) as f64;
    // No cell is smaller than the triangles are on the whole, nor so small that most are empty.
    let mean = boxes.iter().map(Bounds3::longest_side).sum::<f64>() / count;
    let fair = bounds.longest_side() / (CELLS_A_TRIANGLE * count).sqrt();
    let cell = mean.max(fair).max(f64::MIN_POSITIVE);
    let index = |p: Point3| {
        let d = (p - bounds.min) * (1.0 / cell);
        [d.x as u32, d.y as u32, d.z as u32]
    };
    let mut entries = Vec::with_capacity(4 * boxes.len());
    for (b, triangle) in boxes.iter().zip(0..) {
        let (low, high) = (index(b.min), index(b.max));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                entries.extend((low[2]..=high[2]).map(|z| ([x, y, z], triangle)));
            }
        }
    }
    entries.sort_unstable();
    entries
}

fn meet(a: &Bounds3, b: &Bounds3) -> bool {
    let along = |low: f64, high: f64, other_low: f64, other_high: f64| {
        low <= other_high && other_low <= high
    };
    along(a.min.x, a.max.x, b.min.x, b.max.x)
        && along(a.min.y, a.max.y, b.min.y, b.max.y)
        && along(a.min.z, a.max.z, b.min.z, b.max.z)
}

/// Where an edge of one triangle passes through the other.
fn crossing(s: [Point3; 3], t: [Point3; 3], on_plane: f64) -> Option<Point3> {
    let through = |s: [Point3; 3], t: [Point3; 3]| {
        (0..3).find_map(|i| passage(s[i], s[(i + 1) % 3], t, on_plane))
    };
    through(s, t).or_else(|| through(t, s))
}

/// Where the way from `p` to `q` passes through the inside of triangle `t`, clearly from one side to the other.
pub(super) fn passage(
    p: Point3,
    q: Point3,
    [a, b, c]: [Point3; 3],
    on_plane: f64,
) -> Option<Point3> {
    let normal = (b - a).cross(c - a).unit()?;
    let (above, below) = (normal.dot(p - a), normal.dot(q - a));
    if above.abs() <= on_plane || below.abs() <= on_plane || (above > 0.0) == (below > 0.0) {
        return None;
    }
    let at = p.lerp(q, above / (above - below));
    let inside = |a: Point3, b: Point3| normal.dot((b - a).cross(at - a)) > 0.0;
    (inside(a, b) && inside(b, c) && inside(c, a)).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    fn bar(from: Point3, size: [f64; 3]) -> Mesh {
        Mesh::cuboid(from, from + Point3::from(size))
    }

    fn both(a: Mesh, b: &Mesh) -> Mesh {
        let base = a.positions.len() as u32;
        let mut whole = a;
        whole.positions.extend(&b.positions);
        whole
            .triangles
            .extend(b.triangles.iter().map(|t| t.map(|i| i + base)));
        whole
    }

    /// As if every triangle stood in a place of its own.
    fn crossing_of(mesh: &Mesh) -> Option<Point3> {
        let places: Vec<f64> = (0..mesh.positions.len()).map(|i| (i / 3) as f64).collect();
        self_crossing(
            mesh,
            &Along {
                places: &places,
                far: 0.5,
                period: None,
            },
        )
    }

    /// A mesh of two bars.
    fn crossing_of_bars(mesh: &Mesh) -> Option<Point3> {
        let places: Vec<f64> = (0..mesh.positions.len())
            .map(|i| 10.0 * (i / 8) as f64)
            .collect();
        self_crossing(
            mesh,
            &Along {
                places: &places,
                far: 1.0,
                period: None,
            },
        )
    }

    #[test]
    fn bars_that_cross_are_told_with_the_place() {
        let long = bar(Point3::ORIGIN, [20.0, 1.0, 1.0]);
        assert_eq!(crossing_of_bars(&long), None);
        let across = bar(Point3::new(8.0, -5.0, 0.25), [1.0, 10.0, 0.5]);
        let at = crossing_of_bars(&both(long.clone(), &across)).unwrap();
        assert!(
            (8.0..=9.0).contains(&at.x) && (0.0..=1.0).contains(&at.y),
            "{at:?}"
        );
        let above = bar(Point3::new(8.0, -5.0, 1.0), [1.0, 10.0, 0.5]);
        assert_eq!(
            crossing_of_bars(&both(long.clone(), &above)),
            None,
            "what touches does not cross"
        );
        assert_eq!(crossing_of_bars(&Mesh::default()), None);
        let crossed = both(long, &across);
        let places = vec![0.0; 8]
            .into_iter()
            .chain(vec![99.5; 8])
            .collect::<Vec<f64>>();
        let near = Along {
            places: &places,
            far: 1.0,
            period: Some(100.0),
        };
        assert_eq!(
            self_crossing(&crossed, &near),
            None,
            "neighbours are not compared"
        );
    }

    #[test]
    fn the_grid_finds_what_all_pairs_have() {
        let seed = Seed::root(4);
        for case in 0..60 {
            let s = seed.number(case);
            let point = |n: u64| Point3::new(s.unit(3 * n), s.unit(3 * n + 1), s.unit(3 * n + 2));
            let small = |n: u64| point(n) * 0.3;
            let positions = (0..12).flat_map(|t| (0..3).map(move |k| (t, k)));
            let positions: Vec<Point3> = positions
                .map(|(t, k)| point(100 + t) + small(4 * t + k))
                .collect();
            let mesh = Mesh {
                positions,
                triangles: (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            };
            let corners = |t: usize| mesh.corners(mesh.triangles[t]);
            let pairs = (0..12).flat_map(|a| (a + 1..12).map(move |b| (a, b)));
            let any = pairs
                .filter(|&(a, b)| crossing(corners(a), corners(b), 1e-9).is_some())
                .count()
                > 0;
            assert_eq!(crossing_of(&mesh).is_some(), any, "case {case}");
        }
    }
}
