//! Drawing commands to polylines.

use fretwork_geometry::flatten::{self, EllipticalArc};
use fretwork_geometry::{Affine, Point};

/// Coordinates beyond this are refused.
pub const LARGEST: f64 = 1e12;

/// Takes commands in user space and keeps the polylines in spec units.
pub struct Pen {
    map: Affine,
    tolerance: f64,
    paths: Vec<Vec<Point>>,
    /// The subpath being drawn; empty before the first move.
    current: Vec<Point>,
    /// Whether something was drawn since the last move, even of no length.
    drawn: bool,
    first: Option<Point>,
    out_of_range: Option<Point>,
    /// The last place in user space.
    at: Point,
    /// The ends of all segments, where they are asked for.
    vertices: Option<Vec<Vertex>>,
    /// The number of the vertex that the subpath begins with.
    start: usize,
}

/// The end of a segment in user space, with the directions in which the line comes to it and goes
/// on; none where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// The place.
    pub at: Point,
    /// How the line comes.
    pub into: Option<Point>,
    /// How it goes on.
    pub out: Option<Point>,
}

impl Pen {
    /// A pen for user space that `map` takes to spec units, in which the tolerance is meant.
    pub fn new(map: Affine, tolerance: f64) -> Pen {
        let paths = Vec::new();
        Pen {
            map,
            tolerance,
            paths,
            current: Vec::new(),
            drawn: false,
            first: None,
            out_of_range: None,
            at: Point::ORIGIN,
            vertices: None,
            start: 0,
        }
    }

    /// As [`Pen::new`], but the vertices of the line are kept too.
    pub fn with_vertices(map: Affine, tolerance: f64) -> Pen {
        Pen {
            vertices: Some(Vec::new()),
            ..Pen::new(map, tolerance)
        }
    }

    /// Begins a subpath at `p`.
    pub fn move_to(&mut self, p: Point) {
        self.finish_subpath();
        let q = self.checked(p);
        self.first.get_or_insert(q);
        self.current = vec![q];
        self.at = p;
        if let Some(vertices) = &mut self.vertices {
            self.start = vertices.len();
            vertices.push(Vertex {
                at: p,
                into: None,
                out: None,
            });
        }
    }

    /// A straight line to `p`.
    pub fn line_to(&mut self, p: Point) {
        let q = self.checked(p);
        self.drawn = true;
        self.current.push(q);
        self.vertex(p - self.at, p - self.at, p);
    }

    /// A cubic Bézier from the current point.
    pub fn cubic_to(&mut self, b: Point, c: Point, d: Point) {
        self.drawn = true;
        let from = *self.current.last().expect("a path begins with a move");
        let ends = [self.at, b, c, d];
        self.vertex(departure(&ends), arrival(&ends), d);
        let [b, c, d] = [self.checked(b), self.checked(c), self.checked(d)];
        flatten::cubic([from, b, c, d], self.tolerance, &mut self.current);
    }

    /// A quadratic Bézier from the current point.
    pub fn quadratic_to(&mut self, b: Point, c: Point) {
        self.drawn = true;
        let from = *self.current.last().expect("a path begins with a move");
        let ends = [self.at, b, c];
        self.vertex(departure(&ends), arrival(&ends), c);
        let [b, c] = [self.checked(b), self.checked(c)];
        flatten::quadratic([from, b, c], self.tolerance, &mut self.current);
    }

    /// The arc, which begins at the current point and ends at `p`.
    pub fn arc_to(&mut self, arc: &EllipticalArc, p: Point) {
        self.drawn = true;
        self.vertex(
            tangent(arc, arc.start),
            tangent(arc, arc.start + arc.sweep),
            p,
        );
        let q = self.checked(p);
        // A huge arc may pass through allowed end points; its far points are checked as well.
        let image = arc.transformed(&self.map);
        for corner in [
            image.center + image.u + image.v,
            image.center - image.u - image.v,
        ] {
            self.check(corner);
        }
        if self.out_of_range.is_none() {
            image.flatten(self.tolerance, q, &mut self.current);
        }
    }

    /// Closes the subpath. What is drawn next begins at its first point.
    pub fn close(&mut self) {
        let Some(&start) = self.current.first() else {
            return;
        };
        self.drawn = true;
        if self.current.last() != Some(&start) {
            self.current.push(start);
        }
        self.finish_subpath();
        self.current = vec![start];
        self.close_vertices();
    }

    /// Notes a segment with these directions at its ends, which goes to `to`.
    fn vertex(&mut self, departure: Point, arrival: Point, to: Point) {
        self.at = to;
        let Some(vertices) = &mut self.vertices else {
            return;
        };
        if let Some(last) = vertices.last_mut() {
            last.out = direction(departure);
        }
        vertices.push(Vertex {
            at: to,
            into: direction(arrival),
            out: None,
        });
    }

    /// Joins the last vertex of a closed subpath to its first: the line goes on from one as from the
    /// other.
    fn close_vertices(&mut self) {
        let Some(first) = self
            .vertices
            .as_ref()
            .and_then(|v| v.get(self.start).copied())
        else {
            return;
        };
        if self.at != first.at {
            self.vertex(first.at - self.at, first.at - self.at, first.at);
        }
        let start = self.start;
        if let Some(vertices) = &mut self.vertices
            && let Some(last) = vertices.last_mut()
        {
            last.out = first.out;
            vertices[start].into = vertices[vertices.len() - 1].into;
        }
    }

    /// The polylines: consecutive points differ; one of a single point is a subpath of no length.
    pub fn finish(mut self) -> Outline {
        self.finish_subpath();
        Outline {
            paths: self.paths,
            first: self.first,
            out_of_range: self.out_of_range,
            vertices: self.vertices.unwrap_or_default(),
        }
    }

    fn finish_subpath(&mut self) {
        let mut path = std::mem::take(&mut self.current);
        if std::mem::take(&mut self.drawn) {
            path.dedup();
            path.shrink_to_fit();
            self.paths.push(path);
        }
    }

    fn checked(&mut self, p: Point) -> Point {
        let q = self.map.apply(p);
        self.check(q);
        q
    }

    fn check(&mut self, q: Point) {
        if !(q.x.abs() <= LARGEST && q.y.abs() <= LARGEST) {
            self.out_of_range.get_or_insert(q);
        }
    }
}

/// What was drawn.
pub struct Outline {
    /// The polylines; a closed one repeats its first point.
    pub paths: Vec<Vec<Point>>,
    /// Where the first subpath begins, even if nothing was drawn from there.
    pub first: Option<Point>,
    /// A point that cannot be used, if there was one: then the polylines are void.
    pub out_of_range: Option<Point>,
    /// The vertices, where they were asked for.
    pub vertices: Vec<Vertex>,
}

fn direction(along: Point) -> Option<Point> {
    let length = along.length();
    (length > 0.0 && length.is_finite()).then(|| along * (1.0 / length))
}

/// How a Bézier curve leaves its first point: toward the next one that is elsewhere.
fn departure(points: &[Point]) -> Point {
    let first = points[0];
    let next = points.iter().find(|p| **p != first);
    next.map_or(Point::ORIGIN, |p| *p - first)
}

/// How it comes to its last point.
fn arrival(points: &[Point]) -> Point {
    let last = points[points.len() - 1];
    let before = points.iter().rev().find(|p| **p != last);
    before.map_or(Point::ORIGIN, |p| last - *p)
}

/// The direction of an arc at an angle of its parameter.
fn tangent(arc: &EllipticalArc, angle: f64) -> Point {
    let along = arc.v * libm::cos(angle) - arc.u * libm::sin(angle);
    if arc.sweep < 0.0 { along * -1.0 } else { along }
}
