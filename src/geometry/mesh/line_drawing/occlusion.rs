//! What of an edge lies behind a triangle.

use super::features::Edge;
use super::{BEHIND_STEPS, budget};
use crate::index::{BucketGrid, Squares};
use crate::mesh::Mesh;
use crate::{Bounds, Point, View};

/// What is nearer than this part of the size of the mesh is in one place.
const NEAR: f64 = 1e-7;

/// The triangles that can hide something, by where they are drawn.
pub(super) struct Occluders<'a> {
    mesh: &'a Mesh,
    /// Where each corner is drawn, and how near it is to the viewer.
    flat: Vec<Point>,
    nearness: Vec<f64>,
    grid: BucketGrid,
    /// The side of a square of the grid, which long edges are asked by.
    side: f64,
    /// What is nearer than this is in one place.
    near: f64,
}

impl<'a> Occluders<'a> {
    /// Of a closed mesh the triangles that face the viewer hide what the others do; of an open one all do.
    pub fn new(mesh: &'a Mesh, view: &View, is_closed: bool) -> Occluders<'a> {
        let flat: Vec<Point> = mesh.positions.iter().map(|p| view.flat(*p)).collect();
        let nearness: Vec<f64> = mesh.positions.iter().map(|p| view.nearness(*p)).collect();
        let bounds = Bounds::of(flat.iter().copied());
        let near = NEAR * mesh.bounds().longest_side();
        let side = bounds.longer_side() / (1.0 + (mesh.triangles.len() as f64).sqrt());
        let side = side.max(near);
        let mut grid = BucketGrid::empty(Squares::over(&bounds, side));
        for (t, number) in mesh.triangles.iter().zip(0..) {
            let corners = t.map(|corner| flat[corner as usize]);
            let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let length = Bounds::of(corners).longer_side();
            // The drawing is mirrored: what faces the viewer runs clockwise in its coordinates.
            if area.abs() > near * length && (area < 0.0 || !is_closed) {
                grid.insert(number, &Bounds::of(corners).grown(near));
            }
        }
        Occluders {
            mesh,
            flat,
            nearness,
            grid,
            side,
            near,
        }
    }

    /// Where a corner is drawn.
    pub fn at(&self, corner: u32) -> Point {
        self.flat[corner as usize]
    }

    /// Whether an edge is drawn as a line, and not as a point because it leads to the viewer.
    pub fn is_line(&self, edge: &Edge) -> bool {
        let [a, b] = edge.corners;
        self.at(a).distance(self.at(b)) > self.near
    }

    /// The parts of an edge that are hidden, ascending and apart.
    pub fn hidden(&self, edge: &Edge) -> Vec<[f64; 2]> {
        let ends = edge.corners.map(|corner| self.at(corner));
        let mut parts: Vec<[f64; 2]> = Vec::new();
        for triangle in self.before(ends) {
            if !edge.beside.contains(&triangle) {
                parts.extend(self.behind(edge, ends, triangle));
            }
        }
        united(parts, self.near / ends[0].distance(ends[1]))
    }

    /// The triangles that may lie before the edge, each once, ascending. A long edge asks piece by piece.
    fn before(&self, [from, to]: [Point; 2]) -> Vec<u32> {
        let steps = (from.distance(to) / self.side).ceil().max(1.0) as usize;
        let mut found = Vec::new();
        let mut begin = from;
        for i in 1..=steps {
            let end = from.lerp(to, i as f64 / steps as f64);
            self.grid
                .within(&Bounds::of([begin, end]), |n| found.push(n));
            begin = end;
        }
        found.sort_unstable();
        found.dedup();
        budget::spend("triangles before edges", BEHIND_STEPS * found.len() as u64);
        found
    }

    /// The part of an edge that is drawn inside of a triangle and lies behind it.
    fn behind(&self, edge: &Edge, ends: [Point; 2], triangle: u32) -> Option<[f64; 2]> {
        let t = self.mesh.triangles[triangle as usize];
        let corners = t.map(|corner| self.at(corner));
        let area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        // Where the two share a corner, the edge leaves the triangle there, and is neither inside nor behind.
        let shared = edge
            .corners
            .map(|corner| t.iter().position(|c| *c == corner));
        let mut part = [0.0, 1.0];
        let mut depth = [0, 1].map(|end: usize| -self.nearness[edge.corners[end] as usize]);
        for i in 0..3 {
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            // How deep the ends lie inside of a side, as a length.
            let inside = [0, 1].map(|end: usize| {
                let cross = match shared[end] {
                    Some(at) if at != i => return 0.0,
                    _ => (b - a).cross(ends[end] - a),
                };
                depth[end] += cross / area * self.nearness[t[i] as usize];
                cross * area.signum() / a.distance(b) + self.near
            });
            part = clipped(part, inside)?;
        }
        let depth = match shared {
            [None, None] => depth.map(|depth| depth - self.near),
            [Some(_), _] => [0.0, depth[1] - self.near],
            [_, Some(_)] => [depth[0] - self.near, 0.0],
        };
        clipped(part, depth)
    }
}

/// The part of `part` in which a value that goes evenly from `ends[0]` at 0 to `ends[1]` at 1 is above 0.
fn clipped([from, to]: [f64; 2], ends: [f64; 2]) -> Option<[f64; 2]> {
    let [a, b] = ends;
    let root = a / (a - b);
    let part = match (a > 0.0, b > 0.0) {
        (true, true) => [from, to],
        (false, false) => return None,
        (true, false) => [from, to.min(root)],
        (false, true) => [from.max(root), to],
    };
    (part[1] > part[0]).then_some(part)
}

/// The union of parts, ascending; gaps between them up to `gap`, and parts up to that, are none.
fn united(mut parts: Vec<[f64; 2]>, gap: f64) -> Vec<[f64; 2]> {
    let gap = 4.0 * gap;
    parts.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut united: Vec<[f64; 2]> = Vec::new();
    for part in parts {
        match united.last_mut() {
            Some(last) if part[0] <= last[1] + gap => last[1] = last[1].max(part[1]),
            _ => united.push(part),
        }
    }
    united.retain(|part| part[1] - part[0] > gap);
    if let Some(first) = united.first_mut().filter(|first| first[0] <= gap) {
        first[0] = 0.0;
    }
    if let Some(last) = united.last_mut().filter(|last| last[1] >= 1.0 - gap) {
        last[1] = 1.0;
    }
    united
}
