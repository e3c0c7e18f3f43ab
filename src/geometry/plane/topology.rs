//! How many components and holes an area has, counted by a sweep over its edges, which also
//! proves that its rings are simple and do not touch. Nothing is repaired here.

use crate::numeric::UnionFind;
use crate::{Point, Polygon, Ring, budget};

/// The counts of an area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Topology {
    /// Connected components.
    pub components: usize,
    /// Bounded parts of the complement.
    pub holes: usize,
}

/// Why rings do not bound an area.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TopologyError {
    /// A coordinate is NaN or infinite.
    #[error("a coordinate is not finite")]
    NotFinite,
    /// Two edges cross, or overlap, near this point.
    #[error("edges cross near ({}, {})", .0.x, .0.y)]
    Crossing(Point),
    /// A vertex lies on another vertex or edge.
    #[error("the outline touches itself at ({}, {})", .0.x, .0.y)]
    Touching(Point),
    /// A ring runs the wrong way round, or lies in another where it must not.
    #[error("the rings near ({}, {}) have the interior on the wrong side", .0.x, .0.y)]
    Orientation(Point),
}

impl TopologyError {
    /// The place, if there is one.
    pub fn place(&self) -> Option<Point> {
        match self {
            TopologyError::NotFinite => None,
            TopologyError::Crossing(p)
            | TopologyError::Touching(p)
            | TopologyError::Orientation(p) => Some(*p),
        }
    }
}

/// Counts the components and holes of `polygons`.
///
/// A line sweeps the plane (Bentley, Ottmann 1979; Shamos, Hoey 1976 for the test of
/// simplicity) and keeps the intervals of the interior on it: one that begins is a new component
/// until it meets another, two that meet and belong together already close a hole. Nothing but
/// the edges is used, neither the order of the rings nor which of them are said to be holes.
///
/// # Errors
/// [`TopologyError`] where the rings cross, touch, or have the interior on their right.
///
/// Takes O(n log n + n m) for n edges of which a line meets at most m.
pub fn count<'a>(
    polygons: impl IntoIterator<Item = &'a Polygon>,
) -> Result<Topology, TopologyError> {
    count_rings(polygons.into_iter().flat_map(Polygon::rings))
}

/// As [`count`], for rings that have the interior on their left.
pub fn count_rings<'a>(
    rings: impl IntoIterator<Item = &'a Ring>,
) -> Result<Topology, TopologyError> {
    Sweep::new(rings)?.run()
}

/// Where `ring`, whichever way it runs, crosses or touches itself, if it does.
pub fn crossing(ring: &Ring) -> Option<Point> {
    let sweep = Sweep {
        is_oriented: false,
        ..Sweep::new([ring]).ok()?
    };
    sweep.run().err()?.place()
}

/// What is charged for, the steps for a corner, and so many edges of the line as are moved in a step.
const WORK: &str = "corners of outlines";
const VERTEX: u64 = 30;
const LONG: usize = 64;

/// The sweep goes along x + SHEAR·y: a shear changes no counts, and no edge of a drawing with
/// upright and level edges stands upright in it.
const SHEAR: f64 = 0.013_742_1;

struct Vertex {
    at: Point,
    previous: u32,
    next: u32,
}

/// An edge that the sweep line meets, from its earlier to its later vertex.
#[derive(Clone, Copy)]
struct Edge {
    from: u32,
    to: u32,
    /// It runs forward in its ring, so that the interior is above it.
    forward: bool,
    /// The interval that it bounds.
    interval: u32,
}

struct Sweep {
    vertices: Vec<Vertex>,
    /// From below upward; the interior lies between the first and the second, the third and the
    /// fourth, and so on.
    line: Vec<Edge>,
    /// Union-find over intervals.
    intervals: UnionFind,
    topology: Topology,
    /// Rings must have the interior on their left.
    is_oriented: bool,
}

impl Sweep {
    fn new<'a>(rings: impl IntoIterator<Item = &'a Ring>) -> Result<Sweep, TopologyError> {
        let mut vertices: Vec<Vertex> = Vec::new();
        for ring in rings {
            let base = vertices.len() as u32;
            for (i, &p) in ring.iter().enumerate() {
                if !(p.x + SHEAR * p.y).is_finite() || !p.is_finite() {
                    return Err(TopologyError::NotFinite);
                }
                if i == 0 || p != ring[i - 1] {
                    let at = vertices.len() as u32;
                    vertices.push(Vertex {
                        at: p,
                        previous: at.wrapping_sub(1),
                        next: at + 1,
                    });
                }
            }
            while vertices.len() as u32 > base + 1
                && vertices[vertices.len() - 1].at == vertices[base as usize].at
            {
                vertices.pop();
            }
            match vertices.len() as u32 - base {
                0 => {}
                1 | 2 => vertices.truncate(base as usize),
                n => {
                    vertices[base as usize].previous = base + n - 1;
                    vertices[(base + n - 1) as usize].next = base;
                }
            }
        }
        Ok(Sweep {
            vertices,
            line: Vec::new(),
            intervals: UnionFind::default(),
            topology: Topology::default(),
            is_oriented: true,
        })
    }

    fn run(mut self) -> Result<Topology, TopologyError> {
        let mut order: Vec<(f64, f64, u32)> = self
            .vertices
            .iter()
            .zip(0..)
            .map(|(v, i)| (v.at.x + SHEAR * v.at.y, v.at.y, i))
            .collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        if let Some(w) = order
            .windows(2)
            .find(|w| self.at(w[0].2) == self.at(w[1].2))
        {
            return Err(TopologyError::Touching(self.at(w[0].2)));
        }
        budget::spend(WORK, VERTEX * order.len() as u64);
        let mut rank = vec![0u32; order.len()];
        order
            .iter()
            .zip(0..)
            .for_each(|(&(_, _, v), r)| rank[v as usize] = r);
        for &(_, _, v) in &order {
            let Vertex { previous, next, .. } = self.vertices[v as usize];
            // Edges are put into the line and taken out of it by moving those above.
            if self.line.len() > LONG {
                budget::spend(WORK, (self.line.len() / LONG) as u64);
            }
            let later = |w: u32| rank[w as usize] > rank[v as usize];
            match (later(previous), later(next)) {
                (true, true) => self.begin(v, &rank)?,
                (false, false) => self.end(v, &rank)?,
                (false, true) => self.go_on(v, next, true, &rank)?,
                (true, false) => self.go_on(v, previous, false, &rank)?,
            }
        }
        Ok(Topology {
            components: self.intervals.count(),
            ..self.topology
        })
    }

    fn at(&self, v: u32) -> Point {
        self.vertices[v as usize].at
    }

    /// Positive where `p` lies above the edge.
    fn side(&self, e: Edge, p: Point) -> f64 {
        let a = self.at(e.from);
        (self.at(e.to) - a).cross(p - a)
    }

    /// How many edges of the line pass below vertex `v`; those that end in it do not.
    fn below(&self, v: u32) -> usize {
        let p = self.at(v);
        self.line
            .partition_point(|&e| e.to != v && self.side(e, p) > 0.0)
    }

    /// The edge at `i` ends in `v`, as it must when nothing was touched.
    fn ends_at(&self, i: usize, v: u32) -> Result<(), TopologyError> {
        let ends = self.line.get(i).is_some_and(|e| e.to == v);
        if ends {
            Ok(())
        } else {
            Err(TopologyError::Crossing(self.at(v)))
        }
    }

    fn go_on(&mut self, v: u32, to: u32, forward: bool, rank: &[u32]) -> Result<(), TopologyError> {
        let i = self.below(v);
        self.ends_at(i, v)?;
        self.line[i] = Edge {
            from: v,
            to,
            forward,
            ..self.line[i]
        };
        self.check(i, rank)?;
        self.check(i + 1, rank)
    }

    fn begin(&mut self, v: u32, rank: &[u32]) -> Result<(), TopologyError> {
        let p = self.at(v);
        let i = self.below(v);
        if self.line.get(i).is_some_and(|&e| self.side(e, p) == 0.0) {
            return Err(TopologyError::Touching(p));
        }
        let Vertex { previous, next, .. } = self.vertices[v as usize];
        let turn = (self.at(next) - p).cross(self.at(previous) - p);
        if turn == 0.0 {
            return Err(TopologyError::Crossing(p));
        }
        let interval = self.intervals.push();
        let next = Edge {
            from: v,
            to: next,
            forward: true,
            interval,
        };
        let previous = Edge {
            from: v,
            to: previous,
            forward: false,
            interval,
        };
        let mut pair = if turn > 0.0 {
            [next, previous]
        } else {
            [previous, next]
        };
        // The lower edge of an interval runs forward; an interval that splits is the other way.
        if self.is_oriented && pair[0].forward != i.is_multiple_of(2) {
            return Err(TopologyError::Orientation(p));
        }
        if i % 2 == 1 {
            let whole = self.line[i - 1].interval;
            pair[0].interval = whole;
            self.line[i].interval = interval;
            self.intervals.unite(whole, interval);
        }
        self.line.splice(i..i, pair);
        self.check(i, rank)?;
        self.check(i + 2, rank)
    }

    fn end(&mut self, v: u32, rank: &[u32]) -> Result<(), TopologyError> {
        let i = self.below(v);
        self.ends_at(i, v)?;
        self.ends_at(i + 1, v)?;
        if i % 2 == 1 {
            let (a, b) = (self.line[i].interval, self.line[i + 1].interval);
            if !self.intervals.unite(a, b) {
                self.topology.holes += 1;
            }
        }
        self.line.drain(i..i + 2);
        self.check(i, rank)
    }

    /// That the edges at `i - 1` and `i` do not meet before the earlier of them ends.
    fn check(&self, i: usize, rank: &[u32]) -> Result<(), TopologyError> {
        if i == 0 || i >= self.line.len() {
            return Ok(());
        }
        let (low, high) = (self.line[i - 1], self.line[i]);
        let apart = match rank[low.to as usize].cmp(&rank[high.to as usize]) {
            std::cmp::Ordering::Equal => true,
            std::cmp::Ordering::Less => self.side(high, self.at(low.to)) < 0.0,
            std::cmp::Ordering::Greater => self.side(low, self.at(high.to)) > 0.0,
        };
        if apart {
            Ok(())
        } else {
            Err(TopologyError::Crossing(
                self.at(high.from).lerp(self.at(high.to), 0.5),
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    fn square(a: f64, b: f64) -> Ring {
        ring(&[[a, a], [b, a], [b, b], [a, b]])
    }

    fn hole(a: f64, b: f64) -> Ring {
        square(a, b).into_iter().rev().collect()
    }

    #[test]
    fn nested_rings_are_counted() {
        let rings = [
            square(0.0, 10.0),
            hole(1.0, 4.0),
            hole(5.0, 9.0),
            square(6.0, 8.0),
            hole(6.5, 7.5),
        ];
        assert_eq!(
            count_rings(&rings),
            Ok(Topology {
                components: 2,
                holes: 3
            })
        );
        assert_eq!(count_rings(&[]), Ok(Topology::default()));
    }

    #[test]
    fn a_bent_outline_is_one_component() {
        let comb = ring(&[
            [0., 0.],
            [9., 0.],
            [9., 5.],
            [7., 5.],
            [7., 2.],
            [5., 2.],
            [5., 5.],
            [3., 5.],
            [3., 1.],
        ]);
        assert_eq!(
            count_rings(&[comb]),
            Ok(Topology {
                components: 1,
                holes: 0
            })
        );
    }

    #[test]
    fn crossings_are_found_whichever_way_a_ring_runs() {
        assert_eq!(
            (crossing(&square(0.0, 1.0)), crossing(&hole(0.0, 1.0))),
            (None, None)
        );
        let mut eight = ring(&[[0., 0.], [2., 2.], [2., 0.], [0., 2.]]);
        assert!(crossing(&eight).is_some());
        eight.reverse();
        assert!(crossing(&eight).is_some());
    }

    #[test]
    fn what_is_not_simple_is_refused() {
        let eight = ring(&[[0., 0.], [2., 2.], [2., 0.], [0., 2.]]);
        assert!(matches!(
            count_rings(&[eight]),
            Err(TopologyError::Crossing(_) | TopologyError::Orientation(_))
        ));
        let shifted: Ring = square(0.0, 2.0)
            .iter()
            .map(|&p| p + Point::new(1.0, 1.0))
            .collect();
        assert!(count_rings(&[square(0.0, 2.0), shifted]).is_err());
        assert!(matches!(
            count_rings(&[square(0.0, 2.0), square(2.0, 3.0)]),
            Err(TopologyError::Touching(_))
        ));
        assert!(matches!(
            count_rings(&[hole(0.0, 1.0)]),
            Err(TopologyError::Orientation(_))
        ));
        assert!(matches!(
            count_rings(&[square(0.0, 4.0), square(1.0, 2.0)]),
            Err(TopologyError::Orientation(_))
        ));
        let on_edge = ring(&[[1.0, 0.0], [2.0, 1.0], [1.0, 2.0]]);
        assert!(count_rings(&[square(0.0, 1.0), on_edge]).is_err());
        assert_eq!(
            count_rings(&[square(f64::NAN, 1.0)]),
            Err(TopologyError::NotFinite)
        );
    }
}
