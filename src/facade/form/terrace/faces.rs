//! From the planar map of a terrace's lines to its triangles: the tops, the back, and the walls
//! between them. The heights of faces come from `terrain`.

use super::corners::Corners;
use super::terrain::{Patch, Terrace, TerraceError};
use fretwork_geometry::mesh::{Mesh, triangulate};
use fretwork_geometry::{
    CurveLabels, Curves, FaceId, HalfEdge, PlanarMap, Point, Polygon, Ring, planar_map,
};

impl Terrace {
    /// The solid, with z up. It takes O(n log n) for n corners of rectangles and areas.
    ///
    /// # Errors
    /// The planar map cannot hold the areas, or an area touches itself.
    pub fn solid(&self) -> Result<Mesh, TerraceError> {
        let posts = self.posts();
        let mut curves = Curves::new();
        let (left, right) = (self.x[0], self.x[self.x.len() - 1]);
        let (low, high) = (self.y[0], self.y[self.y.len() - 1]);
        let mut line =
            |a: [f64; 2], b: [f64; 2]| curves.push([a, b].map(Point::from), CurveLabels::default());
        self.x.iter().for_each(|x| line([*x, low], [*x, high]));
        self.y.iter().for_each(|y| line([left, *y], [right, *y]));
        for ring in self
            .patches
            .iter()
            .chain(&posts)
            .flat_map(|p| &p.area)
            .flat_map(Polygon::rings)
        {
            curves.push(
                ring.iter().chain(ring.first()).copied(),
                CurveLabels::default(),
            );
        }
        let resolution = planar_map::resolution((right - left).max(high - low));
        let map = PlanarMap::build(&curves, resolution)?;
        Faces::new(self, &posts, &map).solid(&map)
    }
}

/// The two sides of a facade that are joined where it goes around a curve.
struct Seam {
    left: f64,
    right: f64,
    /// The heights along y at which there is a corner on either side, ascending.
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
    /// The faces of `map`, with `posts` besides the terrace's patches.
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

    /// The closed mesh.
    ///
    /// # Errors
    /// A face cannot be divided into triangles.
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

    /// The point that stands for a corner: one for both of the joined sides.
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

    /// Adds the upright faces between areas of different heights, and around the whole.
    fn walls(&mut self, map: &PlanarMap) {
        let mut steps: Vec<Step> = Vec::new();
        let mut seam_sides: Vec<SeamSide> = Vec::new();
        for edge in map.edges() {
            let half = HalfEdge {
                edge,
                reversed: false,
            };
            let height = |face: FaceId| self.heights[face.0 as usize];
            let (left, right) = (height(map.left(edge)), height(map.right(edge)));
            let points = map.half_edge_points(half);
            let mut chain = self.divided(&points);
            chain.extend(points.last());
            for pair in chain.windows(2) {
                let (from, to) = (pair[0], pair[1]);
                match self.seam.as_ref().filter(|seam| seam.is_on(from, to)) {
                    Some(seam) => seam_sides.push(SeamSide {
                        low: self.key(if from.y < to.y { from } else { to }),
                        high: self.key(if from.y < to.y { to } else { from }),
                        height: if map.left(edge) == FaceId::UNBOUNDED {
                            right
                        } else {
                            left
                        },
                        is_begin: from.x == seam.left,
                    }),
                    None => steps.push(Step {
                        from,
                        to,
                        left,
                        right,
                    }),
                }
            }
        }
        steps.extend(joined(seam_sides));
        self.stand(steps);
    }

    /// Adds a wall for each step between two heights.
    fn stand(&mut self, steps: Vec<Step>) {
        for step in &steps {
            for p in [self.key(step.from), self.key(step.to)] {
                self.solid.note(p, step.left);
                self.solid.note(p, step.right);
            }
        }
        for step in steps {
            let (a, b) = (self.key(step.from), self.key(step.to));
            if step.left > step.right {
                self.solid.wall(a, b, step.right, step.left);
            } else if step.right > step.left {
                self.solid.wall(b, a, step.left, step.right);
            }
        }
    }
}

/// A line with the heights to its left and to its right.
struct Step {
    from: Point,
    to: Point,
    left: f64,
    right: f64,
}

/// A piece of the seam with the height on one side of it.
struct SeamSide {
    low: Point,
    high: Point,
    height: f64,
    /// Whether the facade begins there; otherwise it ends there.
    is_begin: bool,
}

/// The steps along the seam. Both of its sides are divided at the same places, so that each piece comes
/// from either side. Seen upward along the seam, the end of the facade is on the left and its begin
/// on the right.
fn joined(mut sides: Vec<SeamSide>) -> Vec<Step> {
    sides.sort_by(|a, b| {
        let by_end = a.is_begin.cmp(&b.is_begin);
        a.low.y.total_cmp(&b.low.y).then(by_end)
    });
    let mut steps = Vec::new();
    for pair in sides.chunks(2) {
        if let [end, begin] = pair
            && !end.is_begin
            && begin.is_begin
        {
            steps.push(Step {
                from: end.low,
                to: end.high,
                left: end.height,
                right: begin.height,
            });
        }
    }
    steps
}
