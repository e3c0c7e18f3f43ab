//! Which faces a drawing fills. Faces that no outline parts are filled together, and one place of them is looked up.

use fretwork_geometry::index::{Filler, Rows};
use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::{Bounds, PlanarMap, Point, Polygon};

use super::OUTLINE;
use super::divide::Divided;
use super::edges::edges;
use crate::chart::Chart;

/// For each face of the map whether the area fills it; false for faces that are on no triangle of the chart.
pub fn filled(chart: &Chart, map: &PlanarMap, divided: &Divided, area: &[Polygon]) -> Vec<bool> {
    let count = map.face_count() + 1;
    let mut parts = UnionFind::new(count);
    let mut on_chart = vec![false; count];
    divided
        .faces
        .iter()
        .for_each(|face| on_chart[face.0 as usize] = true);
    for edge in map.edges() {
        let (left, right) = (map.left(edge).0, map.right(edge).0);
        let is_open = !map.labels(edge).edge.contains(OUTLINE);
        if is_open && on_chart[left as usize] && on_chart[right as usize] {
            parts.unite(left, right);
        }
    }
    // The largest triangle of each part, which rounding moves least.
    let mut largest: Vec<Option<(f64, usize)>> = vec![None; count];
    for (t, face) in divided.faces.iter().enumerate() {
        let part = parts.find(face.0) as usize;
        let size = size(chart, divided, t);
        if largest[part].is_none_or(|(most, _)| size > most) {
            largest[part] = Some((size, t));
        }
    }
    let lines = Lines::new(area);
    let is_filled: Vec<bool> = largest
        .iter()
        .map(|found| found.is_some_and(|(_, t)| lines.surround(middle(chart, divided, t))))
        .collect();
    (0..count as u32)
        .map(|face| on_chart[face as usize] && is_filled[parts.find(face) as usize])
        .collect()
}

/// The corners of a divided triangle in the drawing.
fn drawn(chart: &Chart, divided: &Divided, t: usize) -> [Point; 3] {
    let flap = &chart.flaps[divided.flaps[t] as usize];
    divided.triangles[t].map(|corner| {
        let place = &divided.places[corner as usize];
        let mut p = Point::ORIGIN;
        for (of, weight) in place.of.iter().zip(place.weights) {
            if weight > 0.0
                && let Some(i) = flap.corners.iter().position(|corner| corner == of)
            {
                p = p + flap.drawn[i] * weight;
            }
        }
        p
    })
}

fn size(chart: &Chart, divided: &Divided, t: usize) -> f64 {
    let [a, b, c] = drawn(chart, divided, t);
    (b - a).cross(c - a)
}

fn middle(chart: &Chart, divided: &Divided, t: usize) -> Point {
    let corners = drawn(chart, divided, t);
    (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0)
}

/// The edges of an area in rows, to tell quickly whether it surrounds a place.
struct Lines {
    edges: Vec<[Point; 2]>,
    rows: Rows,
    bounds: Bounds,
}

impl Lines {
    fn new(area: &[Polygon]) -> Lines {
        let edges: Vec<[Point; 2]> = edges(area).collect();
        let bounds = area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
        let count = ((edges.len() as f64).sqrt() as usize).clamp(1, 4096);
        let row = |y: f64| row(&bounds, count, y);
        let visit = |filler: &mut Filler| {
            for (number, [a, b]) in (0..).zip(&edges) {
                for r in row(a.y.min(b.y))..=row(a.y.max(b.y)) {
                    filler.put(r, number);
                }
            }
        };
        let rows = Rows::fill(count, visit);
        Lines {
            edges,
            rows,
            bounds,
        }
    }

    /// Whether a place lies inside, by the edges that a ray to its right crosses.
    fn surround(&self, p: Point) -> bool {
        if !self.bounds.contains(p) {
            return false;
        }
        let near = self.rows.row(row(&self.bounds, self.rows.len(), p.y));
        let crosses = |number: &&u32| {
            let [a, b] = self.edges[**number as usize];
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
        };
        near.iter().filter(crosses).count() % 2 == 1
    }
}

fn row(bounds: &Bounds, count: usize, y: f64) -> usize {
    let part = (y - bounds.min.y) / bounds.height().max(f64::MIN_POSITIVE);
    ((part * count as f64) as usize).min(count - 1)
}
