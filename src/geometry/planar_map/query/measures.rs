//! Lengths, areas, centroids and point location.

use crate::Point;
use crate::planar_map::query::locate::Index;
use crate::planar_map::{EdgeId, FaceId, HalfEdge, PlanarMap};

impl PlanarMap {
    /// The sum of the lengths of all edges.
    pub fn length(&self) -> f64 {
        // A sum of nothing is a negative zero.
        self.edges().map(|e| self.edge_length(e)).sum::<f64>() + 0.0
    }

    /// The length of an edge.
    pub fn edge_length(&self, e: EdgeId) -> f64 {
        self.points(e)
            .zip(self.points(e).skip(1))
            .map(|(a, b)| a.distance(b))
            .sum()
    }

    /// The sum of the areas of all bounded faces.
    pub fn area(&self) -> f64 {
        self.bounded_faces().map(|f| self.face_area(f)).sum::<f64>() + 0.0
    }

    /// The area of a bounded face without what lies in its holes; infinite for the unbounded face.
    pub fn face_area(&self, f: FaceId) -> f64 {
        if f == FaceId::UNBOUNDED {
            f64::INFINITY
        } else {
            self.moments(f).0
        }
    }

    /// The centroid of the area of a bounded face, holes subtracted; NaN for the unbounded face.
    pub fn centroid(&self, f: FaceId) -> Point {
        let (area, moment, origin) = self.moments(f);
        if f == FaceId::UNBOUNDED {
            Point::new(f64::NAN, f64::NAN)
        } else {
            origin + moment * (1.0 / area)
        }
    }

    /// The face around a point, which is taken to its grid site; of a point on an edge or a vertex
    /// one of the faces there. The first call builds an index of the edges.
    pub fn face_at(&self, p: Point) -> FaceId {
        let edges = || {
            self.edges()
                .map(|e| self.points(e).map(|p| self.grid.snap(p)))
        };
        let index = self.index.get_or_init(|| Index::build(edges()));
        index
            .left_of(self.grid.clamped(p))
            .map_or(FaceId::UNBOUNDED, |h| FaceId(self.faces.of[h as usize]))
    }

    /// Area, first moments about a point of the boundary, and this point.
    fn moments(&self, f: FaceId) -> (f64, Point, Point) {
        let mut sum = (0.0, Point::ORIGIN);
        let Some(first) = self.outer_boundary(f).next() else {
            return (0.0, Point::ORIGIN, Point::ORIGIN);
        };
        let origin = self.location(self.origin(first));
        let mut add = |h: HalfEdge| {
            let sign = if h.reversed { -0.5 } else { 0.5 };
            for (a, b) in self.points(h.edge).zip(self.points(h.edge).skip(1)) {
                let (a, b) = (a - origin, b - origin);
                let area = sign * a.cross(b);
                sum = (sum.0 + area, sum.1 + (a + b) * (area / 3.0));
            }
        };
        self.outer_boundary(f).for_each(&mut add);
        self.inner_boundaries(f).flatten().for_each(&mut add);
        (sum.0, sum.1, origin)
    }
}
