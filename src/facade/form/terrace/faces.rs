//! From the planar map of a terrace's lines to its triangles. Heights are found in the parent.

use super::corners::Corners;
use super::{Patch, Terrace, TerraceError};
use fretwork_geometry::mesh::{Mesh, triangulate};
use fretwork_geometry::{FaceId, HalfEdge, PlanarMap, Point, Polygon, Ring};

/// The two sides that are joined.
struct Seam {
    left: f64,
    right: f64,
    /// Where corners stand on either side.
    at: Vec<f64>,
}

impl Seam {
    fn of(map: &PlanarMap) -> Seam {
        let xs = || map.vertices().map(|v| map.location(v).x);
        let (left, right) = (
            xs().fold(f64::INFINITY, f64::min),
            xs().fold(f64::NEG_INFINITY, f64::max),
        );
        let points = map
            .edges()
            .flat_map(|e| map.points(e))
            .filter(|p| p.x == left || p.x == right);
        let mut at: Vec<f64> = points.map(|p| p.y).collect();
        at.sort_by(f64::total_cmp);
        at.dedup();
        Seam { left, right, at }
    }

    fn is_on(&self, a: Point, b: Point) -> bool {
        a.x == b.x && (a.x == self.left || a.x == self.right)
    }

    /// The points between `a` and `b`, which lie on a joined side.
    fn between(&self, a: Point, b: Point) -> Vec<Point> {
        let (low, high) = (a.y.min(b.y), a.y.max(b.y));
        let inside = self
            .at
            .iter()
            .filter(|y| **y > low && **y < high)
            .map(|y| Point::new(a.x, *y));
        let mut points: Vec<Point> = inside.collect();
        if b.y < a.y {
            points.reverse();
        }
        points
    }
}

/// The faces of the planar map of all lines, with their heights.
pub struct Faces<'a> {
    terrace: &'a Terrace,
    posts: &'a [Patch],
    seam: Option<Seam>,
    /// The heights of the faces by their numbers.
    heights: Vec<f64>,
    solid: Corners,
}

impl<'a> Faces<'a> {
    /// The faces of `map`; `posts` are added to the terrace's patches.
    pub fn new(terrace: &'a Terrace, posts: &'a [Patch], map: &PlanarMap) -> Faces<'a> {
        let seam = terrace.is_around.then(|| Seam::of(map));
        let heights = vec![terrace.base; map.face_count() + 1];
        Faces {
            terrace,
            posts,
            seam,
            heights,
            solid: Corners::default(),
        }
    }

    /// The tops, the back, and the walls between them.
    ///
    /// # Errors
    /// A face that cannot be divided into triangles.
    pub fn solid(mut self, map: &PlanarMap) -> Result<Mesh, TerraceError> {
        for face in map.bounded_faces() {
            let polygon = self.polygon(map, face);
            let corners: Vec<Point> = polygon.rings().flatten().copied().collect();
            let triangles = triangulate(&polygon)?;
            let at = |t: &[u32; 3]| t.map(|i| corners[i as usize]);
            let area = |t: &&[u32; 3]| {
                let [a, b, c] = at(t);
                (b - a).cross(c - a)
            };
            let Some(widest) = triangles.iter().max_by(|a, b| area(a).total_cmp(&area(b))) else {
                continue;
            };
            let [a, b, c] = at(widest);
            let height = self
                .terrace
                .height_at((a + b + c) * (1.0 / 3.0), self.posts);
            self.heights[face.0 as usize] = height;
            for point in &corners {
                self.solid.note(self.key(*point), height);
            }
            for triangle in &triangles {
                let [a, b, c] = at(triangle).map(|p| self.key(p));
                self.solid.push([(a, height), (b, height), (c, height)]);
                self.solid.push([
                    (c, self.terrace.base),
                    (b, self.terrace.base),
                    (a, self.terrace.base),
                ]);
            }
        }
        self.walls(map);
        Ok(self.solid.mesh)
    }

    /// A corner; one for both of the joined sides.
    fn key(&self, p: Point) -> Point {
        match &self.seam {
            Some(seam) if p.x == seam.right => Point::new(seam.left, p.y),
            _ => p,
        }
    }

    /// The area of a face, with the corners that it needs on a joined side.
    fn polygon(&self, map: &PlanarMap, face: FaceId) -> Polygon {
        let ring = |cycle: &mut dyn Iterator<Item = HalfEdge>| -> Ring {
            let sides = cycle.filter(|h| map.face(h.twin()) != face);
            sides
                .flat_map(|h| self.divided(&map.half_edge_points(h)))
                .collect()
        };
        let holes: Vec<Ring> = map
            .inner_boundaries(face)
            .map(|mut cycle| ring(&mut cycle))
            .collect();
        let holes = holes.into_iter().filter(|hole| hole.len() > 2).collect();
        Polygon {
            outer: ring(&mut map.outer_boundary(face)),
            holes,
        }
    }

    /// A line with the corners that it needs on a joined side, without its last point.
    fn divided(&self, points: &[Point]) -> Vec<Point> {
        let mut all = Vec::with_capacity(points.len());
        for pair in points.windows(2) {
            all.push(pair[0]);
            if let Some(seam) = self
                .seam
                .as_ref()
                .filter(|seam| seam.is_on(pair[0], pair[1]))
            {
                all.extend(seam.between(pair[0], pair[1]));
            }
        }
        all
    }

    /// The upright faces between areas of different heights, and round the whole.
    fn walls(&mut self, map: &PlanarMap) {
        let mut walls: Vec<(Point, Point, f64, f64)> = Vec::new();
        // The heights on either side of the pieces of the seam, by the place of their lower end.
        let mut joined: Vec<(Point, Point, Option<f64>, Option<f64>)> = Vec::new();
        for edge in map.edges() {
            let half = HalfEdge {
                edge,
                reversed: false,
            };
            let (left, right) = (
                self.heights[map.left(edge).0 as usize],
                self.heights[map.right(edge).0 as usize],
            );
            let points = map.half_edge_points(half);
            let mut chain = self.divided(&points);
            chain.extend(points.last());
            for pair in chain.windows(2) {
                if self
                    .seam
                    .as_ref()
                    .is_some_and(|seam| seam.is_on(pair[0], pair[1]))
                {
                    let inner = if map.left(edge) == FaceId::UNBOUNDED {
                        right
                    } else {
                        left
                    };
                    let is_left = self
                        .seam
                        .as_ref()
                        .is_some_and(|seam| pair[0].x == seam.left);
                    let (low, high) = if pair[0].y < pair[1].y {
                        (pair[0], pair[1])
                    } else {
                        (pair[1], pair[0])
                    };
                    let (low, high) = (self.key(low), self.key(high));
                    // Seen upward along the seam, the end of the facade is on the left and its begin on the right.
                    let sides = if is_left {
                        (None, Some(inner))
                    } else {
                        (Some(inner), None)
                    };
                    joined.push((low, high, sides.0, sides.1));
                } else {
                    walls.push((pair[0], pair[1], left, right));
                }
            }
        }
        joined.sort_by(|a, b| {
            a.0.y
                .total_cmp(&b.0.y)
                .then(a.2.is_none().cmp(&b.2.is_none()))
        });
        for pair in joined.chunks(2) {
            if let [(low, high, Some(left), _), (_, _, _, Some(right))] = pair {
                walls.push((*low, *high, *left, *right));
            }
        }
        for (a, b, left, right) in &walls {
            let (a, b) = (self.key(*a), self.key(*b));
            for p in [a, b] {
                self.solid.note(p, *left);
                self.solid.note(p, *right);
            }
        }
        for (a, b, left, right) in walls {
            let (a, b) = (self.key(a), self.key(b));
            if left > right {
                self.solid.wall(a, b, right, left);
            } else if right > left {
                self.solid.wall(b, a, left, right);
            }
        }
    }
}
