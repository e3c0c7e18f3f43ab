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
        }
    }

    /// Begins a subpath at `p`.
    pub fn move_to(&mut self, p: Point) {
        self.finish_subpath();
        let q = self.checked(p);
        self.first.get_or_insert(q);
        self.current = vec![q];
    }

    /// A straight line to `p`.
    pub fn line_to(&mut self, p: Point) {
        let q = self.checked(p);
        self.drawn = true;
        self.current.push(q);
    }

    /// A cubic Bézier from the current point.
    pub fn cubic_to(&mut self, b: Point, c: Point, d: Point) {
        self.drawn = true;
        let from = *self.current.last().expect("a path begins with a move");
        let [b, c, d] = [self.checked(b), self.checked(c), self.checked(d)];
        flatten::cubic([from, b, c, d], self.tolerance, &mut self.current);
    }

    /// A quadratic Bézier from the current point.
    pub fn quadratic_to(&mut self, b: Point, c: Point) {
        self.drawn = true;
        let from = *self.current.last().expect("a path begins with a move");
        let [b, c] = [self.checked(b), self.checked(c)];
        flatten::quadratic([from, b, c], self.tolerance, &mut self.current);
    }

    /// The arc, which begins at the current point and ends at `p`.
    pub fn arc_to(&mut self, arc: &EllipticalArc, p: Point) {
        self.drawn = true;
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
    }

    /// The polylines: consecutive points differ; one of a single point is a subpath of no length.
    pub fn finish(mut self) -> Outline {
        self.finish_subpath();
        Outline {
            paths: self.paths,
            first: self.first,
            out_of_range: self.out_of_range,
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
}
