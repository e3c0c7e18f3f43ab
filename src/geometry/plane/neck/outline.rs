//! The outline of an area as edges that know their neighbours, and the places from which necks are sought.

use std::ops::Range;

use crate::{Bounds, Point, Polygon};

/// Two places of an outline that face each other and that are nearer than their neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neck {
    /// One place.
    pub from: Point,
    /// The other.
    pub to: Point,
    /// Their distance.
    pub width: f64,
}

impl Neck {
    /// The place between the two.
    pub fn middle(&self) -> Point {
        self.from.lerp(self.to, 0.5)
    }
}

/// Directions within this of a right angle to an outline count as facing: arcs are polylines.
const FACING: f64 = 0.05;

/// Where places face each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// In the area.
    Inside,
    /// Beside it.
    Outside,
}

pub(super) struct Edge {
    /// The edges before and after it in its ring.
    pub(super) previous: u32,
    pub(super) next: u32,
    /// The number of its ring.
    pub(super) ring: u32,
    pub(super) from: Point,
    /// Of length one.
    pub(super) direction: Point,
    pub(super) length: f64,
    /// The run of the ring up to its beginning.
    pub(super) before: Run,
}

/// The outline from the beginning of a ring to a place: its length, and twice the area that it and the chords to the ring's first
/// point enclose.
#[derive(Clone, Copy, Default)]
pub(super) struct Run {
    pub(super) length: f64,
    pub(super) area: f64,
}

impl Run {
    /// The run on by `length` from `from`, where it ends, to `to`; `origin` is the first point of the ring.
    pub(super) fn on(self, origin: Point, from: Point, to: Point, length: f64) -> Run {
        Run {
            length: self.length + length,
            area: self.area + (from - origin).cross(to - origin),
        }
    }
}

/// A place from which necks are sought: the directions of the edges before and after it, the region on their left.
pub(super) struct Site {
    pub(super) at: Point,
    pub(super) before: Point,
    pub(super) after: Point,
    /// The edges that meet here.
    pub(super) edges: [u32; 2],
}

impl Site {
    /// A rectangle around all places up to `reach` away that may face this one.
    pub(super) fn view(&self, reach: f64) -> Bounds {
        let left = |d: Point| Point::new(-d.y, d.x);
        let mut view = Bounds {
            min: Point::ORIGIN,
            max: Point::ORIGIN,
        }
        .with(left(self.before));
        if self.edges[0] != self.edges[1] {
            view = view.with(left(self.after));
            let is_left = |d: Point| self.before.cross(d) >= 0.0 || self.after.cross(d) >= 0.0;
            for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)] {
                let d = Point::new(x, y);
                if is_left(d) && is_square(d, self.before, self.after) {
                    view = view.with(d);
                }
            }
        }
        let margin = Point::new(2.0 * FACING, 2.0 * FACING);
        Bounds {
            min: self.at + (view.min - margin) * reach,
            max: self.at + (view.max + margin) * reach,
        }
    }
}

pub(super) struct Outline {
    pub(super) edges: Vec<Edge>,
    /// The first point of every ring, and the run round it.
    pub(super) rings: Vec<(Point, Run)>,
    pub(super) bounds: Bounds,
}

impl Outline {
    pub(super) fn new(polygons: &[Polygon]) -> Outline {
        let count = polygons.iter().flat_map(Polygon::rings).map(Vec::len).sum();
        let mut outline = Outline {
            edges: Vec::with_capacity(count),
            rings: Vec::new(),
            bounds: Bounds::EMPTY,
        };
        for ring in polygons.iter().flat_map(Polygon::rings) {
            outline.add(ring);
        }
        outline
    }

    pub(super) fn add(&mut self, points: &[Point]) {
        let Some(&origin) = points.first() else {
            return;
        };
        let (base, ring) = (self.edges.len() as u32, self.rings.len() as u32);
        let mut before = Run::default();
        for (&from, &to) in points.iter().zip(points.iter().cycle().skip(1)) {
            let length = from.distance(to);
            if length > 0.0 {
                let direction = (to - from) * (1.0 / length);
                let k = self.edges.len() as u32;
                self.edges.push(Edge {
                    previous: k.wrapping_sub(1),
                    next: k + 1,
                    ring,
                    from,
                    direction,
                    length,
                    before,
                });
                before = before.on(origin, from, to, length);
                self.bounds = self.bounds.with(from);
            }
        }
        self.rings.push((origin, before));
        let end = self.edges.len() as u32;
        if end > base {
            self.edges[base as usize].previous = end - 1;
            self.edges[end as usize - 1].next = base;
        }
    }

    pub(super) fn edge(&self, k: u32) -> &Edge {
        &self.edges[k as usize]
    }

    /// Where an edge ends.
    pub(super) fn end(&self, k: u32) -> Point {
        self.edge(self.edge(k).next).from
    }

    /// The directions in which one passes from the edge `before` to the edge `after`, with the region on the left.
    pub(super) fn directions(&self, before: u32, after: u32, side: Side) -> (Point, Point) {
        let (before, after) = (self.edge(before).direction, self.edge(after).direction);
        if side == Side::Inside {
            (before, after)
        } else {
            (-after, -before)
        }
    }

    /// The corner at the end of an edge, unless it points out of the region: then it faces nothing.
    pub(super) fn corner(&self, k: u32, side: Side) -> Option<Site> {
        let next = self.edge(k).next;
        let (before, after) = self.directions(k, next, side);
        let turn = before.cross(after);
        let faces = turn <= 0.0 || (turn < FACING && before.dot(after) > 0.0);
        faces.then(|| Site {
            at: self.end(k),
            before,
            after,
            edges: [k, next],
        })
    }

    /// The places from which necks are sought. Where two outlines are nearest one of them has a corner, or they are parallel:
    /// the middle of an edge is only needed where a corner at an end of it faces nothing.
    pub(super) fn sites(&self, edges: Range<u32>, side: Side) -> impl Iterator<Item = Site> {
        edges.flat_map(move |k| {
            let corner = self.corner(k, side);
            let is_bare = corner.is_none() || self.corner(self.edge(k).previous, side).is_none();
            let middle = is_bare.then(|| {
                let (before, after) = self.directions(k, k, side);
                Site {
                    at: self.edge(k).from.lerp(self.end(k), 0.5),
                    before,
                    after,
                    edges: [k, k],
                }
            });
            middle.into_iter().chain(corner)
        })
    }

    /// The numbers of all edges.
    pub(super) fn all(&self) -> Range<u32> {
        0..self.edges.len() as u32
    }
}

/// Whether the direction `d` leads from a place of the outline straight into the region.
pub(super) fn faces(d: Point, before: Point, after: Point) -> bool {
    is_square(d, before, after) && (before.cross(d) > 0.0 || after.cross(d) > 0.0)
}

/// Whether the direction `d` is square to the outline, or between the directions that are square to the edges `before` and
/// `after` a corner.
pub(super) fn is_square(d: Point, before: Point, after: Point) -> bool {
    d.dot(before) >= -FACING && d.dot(after) <= FACING
}
