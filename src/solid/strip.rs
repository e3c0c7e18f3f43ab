//! A polygon on the strip along a curve, divided into triangles that follow the strip: lines across it at the curve's joints are
//! edges. What becomes of them is known elsewhere.

use super::SolidError;
use fretwork_geometry::mesh::TriangulationError;
use fretwork_geometry::mesh::delaunay::{Constrained, Delaunay};
use fretwork_geometry::{
    Bounds, Carrier, Cutout, Mesh, Point, Point3, Polygon, Ribbon, Ring, topology,
};

/// Corners within this part of the curve's length of a joint lie on it.
const ON_JOINT: f64 = 2e-9;
/// Shorter sides than this part of the whole's longer side are dropped.
const SHORTEST: f64 = 1e-6;

/// The polygons without sides so short that the formats of solids cannot tell their ends apart and, in the plane, without corners
/// on straight lines; as they are where that would change their counts.
pub(crate) fn tidied(cutout: &Cutout) -> Vec<Polygon> {
    let bounds = cutout
        .polygons
        .iter()
        .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
    let least = SHORTEST * bounds.longer_side();
    let is_flat = matches!(cutout.carrier, Carrier::Plane);
    let ring = |ring: &Ring| -> Ring {
        let mut kept: Ring = Vec::with_capacity(ring.len());
        for (i, &p) in ring.iter().enumerate() {
            let next = ring[(i + 1) % ring.len()];
            let is_near = kept.last().is_some_and(|q| q.distance(p) < least)
                || (i + 1 == ring.len() && p.distance(ring[0]) < least);
            let is_straight = |q: &Point| {
                let way = next - *q;
                (p - *q).cross(way).abs() < least * way.length() && (p - *q).dot(way) > 0.0
            };
            let is_inner = i > 0 && i + 1 < ring.len();
            let is_idle = is_flat && is_inner && kept.last().is_some_and(is_straight);
            if !(is_near || is_idle) {
                kept.push(p);
            }
        }
        if kept.len() < 3 { ring.clone() } else { kept }
    };
    let tidy = |p: &Polygon| Polygon {
        outer: ring(&p.outer),
        holes: p.holes.iter().map(ring).collect(),
    };
    let polygons: Vec<Polygon> = cutout.polygons.iter().map(tidy).collect();
    let counts = topology::count(&polygons);
    if counts.is_ok() && counts == topology::count(&cutout.polygons) {
        polygons
    } else {
        cutout.polygons.clone()
    }
}

/// A polygon in triangles, its corners in the coordinates of the strip.
pub(crate) struct Sheet {
    /// Along and across the curve, ring after ring.
    pub corners: Vec<(f64, f64)>,
    /// Where each ring begins, and the end of the last.
    starts: Vec<usize>,
    /// Counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
}

impl Sheet {
    pub fn new(polygon: &Polygon, cutout: &Cutout, ribbon: &Ribbon) -> Result<Sheet, SolidError> {
        let points: Vec<Point> = polygon.rings().flatten().copied().collect();
        let mut starts = vec![0];
        for ring in polygon.rings() {
            starts.push(starts[starts.len() - 1] + ring.len());
        }
        let corners: Vec<(f64, f64)> = points.iter().map(|&p| cutout.along_and_across(p)).collect();
        let mut sheet = Sheet {
            corners,
            starts,
            triangles: Vec::new(),
        };
        let chords = sheet.chords(&points, ribbon);
        sheet.triangles = sheet.triangulate(&points, &chords)?;
        Ok(sheet)
    }

    /// The corners before and after a corner in its ring.
    fn neighbours(&self, corner: usize) -> (usize, usize) {
        let ring = self.starts.partition_point(|&s| s <= corner) - 1;
        let (first, end) = (self.starts[ring], self.starts[ring + 1]);
        let before = if corner == first { end - 1 } else { corner - 1 };
        (before, if corner + 1 == end { first } else { corner + 1 })
    }

    /// Pairs of corners that follow one another on the line across the strip at a joint, where that line is inside.
    fn chords(&self, points: &[Point], ribbon: &Ribbon) -> Vec<(usize, usize)> {
        let joints = ribbon.joints();
        let length = ribbon.curve().length();
        let clear = ON_JOINT * length;
        let mut on_lines: Vec<(usize, f64, usize)> = Vec::new();
        for (corner, &(u, v)) in self.corners.iter().enumerate() {
            let after = joints.partition_point(|&j| j < u - clear);
            if joints.get(after).is_some_and(|j| (j - u).abs() <= clear) {
                // The end of a loop is its beginning.
                let line = if ribbon.curve().is_closed() && after + 1 == joints.len() {
                    0
                } else {
                    after
                };
                on_lines.push((line, v, corner));
            }
        }
        on_lines.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let pairs = on_lines
            .windows(2)
            .filter(|w| w[0].0 == w[1].0)
            .map(|w| (w[0].2, w[1].2));
        pairs
            .filter(|&(a, b)| self.is_inside(points, a, b))
            .collect()
    }

    /// Whether the way from corner `a` to `b` begins inside the polygon.
    fn is_inside(&self, points: &[Point], a: usize, b: usize) -> bool {
        let (before, after) = self.neighbours(a);
        if before == b || after == b {
            return false;
        }
        let (d, next, back) = (
            points[b] - points[a],
            points[after] - points[a],
            points[before] - points[a],
        );
        // The inside lies from the next side, counter-clockwise, to the one before.
        let (from_next, to_back) = (next.cross(d) > 0.0, d.cross(back) > 0.0);
        if next.cross(back) > 0.0 {
            from_next && to_back
        } else {
            from_next || to_back
        }
    }

    fn triangulate(
        &self,
        points: &[Point],
        chords: &[(usize, usize)],
    ) -> Result<Vec<[u32; 3]>, SolidError> {
        let mut delaunay = Delaunay::new(points)?;
        if !delaunay.is_distinct() {
            return Err(self.crossing(points, 0));
        }
        let mut sides = Vec::with_capacity(points.len());
        for corner in 0..points.len() {
            let (_, next) = self.neighbours(corner);
            if delaunay.constrain(corner, next) == Constrained::Blocked {
                return Err(self.crossing(points, corner));
            }
            sides.push(ordered(delaunay.vertex(corner), delaunay.vertex(next)));
        }
        sides.sort_unstable();
        for &(a, b) in chords {
            // A chord that has something in its way is left out: the sheet is coarser there.
            delaunay.constrain(a, b);
        }
        let mut corner_of = vec![0; points.len()];
        (0..points.len()).for_each(|corner| corner_of[delaunay.vertex(corner)] = corner as u32);
        let faces = delaunay.inside(|edge| {
            let (a, b) = (edge.from().index(), edge.to().index());
            sides.binary_search(&ordered(a, b)).is_ok()
        });
        Ok(faces
            .iter()
            .map(|face| face.vertices().map(|vertex| corner_of[vertex.index()]))
            .collect())
    }

    fn crossing(&self, points: &[Point], corner: usize) -> SolidError {
        TriangulationError::Crossing {
            x: points[corner].x,
            y: points[corner].y,
        }
        .into()
    }

    /// Adds the closed body to `mesh`.
    pub fn push_body(&self, mesh: &mut Mesh, ribbon: &Ribbon, between: [f64; 2]) {
        let low = mesh.positions.len() as u32;
        let high = low + self.corners.len() as u32;
        for w in between {
            mesh.positions
                .extend(self.corners.iter().map(|&(u, v)| ribbon.place(u, v, w)));
        }
        for &[a, b, c] in &self.triangles {
            mesh.triangles.push([low + a, low + c, low + b]);
            mesh.triangles.push([high + a, high + b, high + c]);
        }
        for corner in 0..self.corners.len() {
            let (a, b) = (corner as u32, self.neighbours(corner).1 as u32);
            mesh.triangles.push([low + a, low + b, high + b]);
            mesh.triangles.push([low + a, high + b, high + a]);
        }
    }

    /// The middle of the first triangle that one face of the body shows from its other side.
    pub fn fold(&self, ribbon: &Ribbon, between: [f64; 2]) -> Option<Point3> {
        self.triangles.iter().find_map(|triangle| {
            let corners = triangle.map(|corner| self.corners[corner as usize]);
            let at = |w: f64| corners.map(|(u, v)| ribbon.place(u, v, w));
            let [low, high] = between.map(at);
            let normal = |[a, b, c]: [Point3; 3]| (b - a).cross(c - a);
            let (below, above) = (normal(low), normal(high));
            // From the one face to the other is the way that both look.
            let out = (high[0] - low[0]) + (high[1] - low[1]) + (high[2] - low[2]);
            let folded = below.dot(out) < 0.0 || above.dot(out) < 0.0;
            folded.then(|| (low[0] + low[1] + low[2] + high[0] + high[1] + high[2]) * (1.0 / 6.0))
        })
    }
}

fn ordered(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}
