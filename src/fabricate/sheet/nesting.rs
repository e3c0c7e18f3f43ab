//! How the closed lines of a sheet lie in one another, from which follows what is a part and what
//! is an opening, and what has to be cut before what. All tests are exact, on the cells of the
//! file.

use std::collections::BTreeMap;

use super::fixed_point::Cell;
use super::lines::is_closed;
use super::slabs::{Edge, Slabs};
use fretwork_geometry::Point;

/// On how many of its corners, and on as many middles of its segments, a line is looked at where it
/// runs on an outline. With fewer, a line that touches an outline at some corners might be taken
/// for one that follows it; with more, long lines that do follow one cost more.
const PROBES: usize = 8;

/// What coincident outlines have in common: the least corner, and twice the area.
type Key = (Cell, i128);

/// Closed lines, and an index of their edges.
pub struct Nesting {
    keys: Vec<Key>,
    known: BTreeMap<Key, Vec<u32>>,
    slabs: Slabs,
}

impl Nesting {
    /// The nesting of `outlines`, closed lines whose first point is also their last. O(n log n) for
    /// n points.
    pub fn new<'a>(outlines: impl IntoIterator<Item = &'a [Cell]>) -> Nesting {
        let (mut keys, mut edges) = (Vec::new(), Vec::new());
        for (number, outline) in outlines.into_iter().enumerate() {
            keys.push(key(outline));
            edges.extend(outline.windows(2).map(|w| Edge {
                a: plain(doubled(w[0])),
                b: plain(doubled(w[1])),
                outline: number as u32,
            }));
        }
        let mut known: BTreeMap<Key, Vec<u32>> = BTreeMap::new();
        for (number, key) in keys.iter().enumerate() {
            known.entry(*key).or_default().push(number as u32);
        }
        Nesting {
            keys,
            known,
            slabs: Slabs::new(edges),
        }
    }

    /// The numbers of the outlines that `line` lies in, ascending. An outline that the line follows
    /// does not count, so coincident outlines do not lie in one another. Of a line that crosses an
    /// outline its beginning decides.
    pub fn around(&self, line: &[Cell]) -> Vec<u32> {
        let own = if is_closed(line) {
            self.known.get(&key(line)).map_or(&[][..], Vec::as_slice)
        } else {
            &[]
        };
        let mut around = Vec::new();
        // The outlines that every probe so far lies on.
        let mut on: Option<Vec<u32>> = None;
        for probe in probes(line) {
            let (inside, touched) = self.locate(probe);
            let is_open = |o: &u32| on.as_ref().is_none_or(|on| on.contains(o));
            let is_decided = |o: &&u32| is_open(o) && !touched.contains(o) && !own.contains(o);
            around.extend(inside.iter().filter(is_decided));
            let still = |o: &u32| is_open(o) && !own.contains(o);
            on = Some(touched.iter().copied().filter(still).collect());
            if on.as_ref().is_some_and(Vec::is_empty) {
                break;
            }
        }
        around.sort_unstable();
        around
    }

    /// Whether an earlier outline is the same line.
    pub fn is_repeated(&self, outline: u32) -> bool {
        self.known[&self.keys[outline as usize]][0] < outline
    }

    /// A place where two outlines cross, and their numbers; none where they only touch.
    pub fn crossing(&self) -> Option<(u32, u32, Cell)> {
        self.slabs.edges().iter().find_map(|e| {
            let (low, high) = (e.a.y.min(e.b.y), e.a.y.max(e.b.y));
            let others = self.slabs.between(low, high);
            let crossing = others
                .filter(|other| other.outline != e.outline)
                .find(|other| cross(e, other));
            crossing.map(|other| {
                let middle = (e.a.lerp(e.b, 0.5), other.a.lerp(other.b, 0.5));
                let near = if e.a.distance(e.b) < other.a.distance(other.b) {
                    middle.0
                } else {
                    middle.1
                };
                let cell = ((near.x / 2.0).round() as i64, (near.y / 2.0).round() as i64);
                (e.outline, other.outline, cell)
            })
        })
    }

    /// The outlines that a point, in doubled cells, lies in or on, and those that it lies on; both
    /// ascending.
    fn locate(&self, probe: Cell) -> (Vec<u32>, Vec<u32>) {
        let p = plain(probe);
        let (mut crossed, mut touched) = (Vec::new(), Vec::new());
        for edge in self.slabs.between(p.y, p.y) {
            let side = side(edge.a, edge.b, p);
            if side == 0 && is_between(edge, p) {
                touched.push(edge.outline);
            }
            let is_crossed = (edge.a.y > p.y) != (edge.b.y > p.y);
            if is_crossed && (side > 0) == (edge.b.y > edge.a.y) {
                crossed.push(edge.outline);
            }
        }
        touched.sort_unstable();
        touched.dedup();
        crossed.sort_unstable();
        let runs = crossed.chunk_by(|a, b| a == b);
        let inside = runs.filter(|run| run.len() % 2 == 1).map(|run| run[0]);
        (inside.collect(), touched)
    }
}

/// Some points of a line in doubled cells, in which middles of segments are whole: corners first.
fn probes(line: &[Cell]) -> impl Iterator<Item = Cell> + '_ {
    let step = |count: usize| count.div_ceil(PROBES).max(1);
    let corners = line.iter().step_by(step(line.len())).map(|&c| doubled(c));
    let middles = line
        .windows(2)
        .step_by(step(line.len()))
        .map(|w| (w[0].0 + w[1].0, w[0].1 + w[1].1));
    corners.chain(middles)
}

fn doubled((x, y): Cell) -> Cell {
    (2 * x, 2 * y)
}

fn plain((x, y): Cell) -> Point {
    Point::new(x as f64, y as f64)
}

fn key(outline: &[Cell]) -> Key {
    let wide = |c: Cell| (i128::from(c.0), i128::from(c.1));
    let doubled_area: i128 = outline
        .windows(2)
        .map(|w| (wide(w[0]), wide(w[1])))
        .map(|((ax, ay), (bx, by))| ax * by - bx * ay)
        .sum();
    let least = outline.iter().min().copied().unwrap_or_default();
    (least, doubled_area.abs())
}

/// On which side of the line through `a` and `b`, whole numbers, `p` lies: positive to the left
/// where y points up.
fn side(a: Point, b: Point, p: Point) -> i128 {
    let wide = |v: f64| i128::from(v as i64);
    let (ux, uy) = (wide(b.x - a.x), wide(b.y - a.y));
    let (vx, vy) = (wide(p.x - a.x), wide(p.y - a.y));
    ux * vy - uy * vx
}

/// Whether `p`, on the line through an edge, lies on the edge.
fn is_between(edge: &Edge, p: Point) -> bool {
    let within = |a: f64, b: f64, v: f64| a.min(b) <= v && v <= a.max(b);
    within(edge.a.x, edge.b.x, p.x) && within(edge.a.y, edge.b.y, p.y)
}

/// Whether two edges cross at a point that is an end of neither.
fn cross(e: &Edge, f: &Edge) -> bool {
    let (p, q) = (side(e.a, e.b, f.a), side(e.a, e.b, f.b));
    let (r, s) = (side(f.a, f.b, e.a), side(f.a, f.b, e.b));
    p.signum() * q.signum() < 0 && r.signum() * s.signum() < 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{Polygon, Seed};

    fn square(x: i64, y: i64, side: i64) -> Vec<Cell> {
        vec![
            (x, y),
            (x + side, y),
            (x + side, y + side),
            (x, y + side),
            (x, y),
        ]
    }

    fn nesting(outlines: &[Vec<Cell>]) -> Nesting {
        Nesting::new(outlines.iter().map(Vec::as_slice))
    }

    #[test]
    fn outlines_that_touch_lie_in_one_another() {
        // A sheet, an opening that touches its side, an island that touches the opening's corner,
        // and the opening once more.
        let outlines = [
            square(0, 0, 100),
            square(0, 20, 30),
            square(20, 40, 10),
            square(0, 20, 30),
        ];
        let nesting = nesting(&outlines);
        let around: Vec<_> = outlines.iter().map(|o| nesting.around(o)).collect();
        assert_eq!(around, [vec![], vec![0], vec![0, 1, 3], vec![0u32]]);
        assert!(nesting.is_repeated(3) && !nesting.is_repeated(1));
        assert_eq!(nesting.crossing(), None);
        // A diamond whose corners are the middles of a square's sides; pieces of outlines.
        let inner = vec![(50, 0), (100, 50), (50, 100), (0, 50), (50, 0)];
        assert_eq!(nesting.around(&inner), [0]);
        assert!(nesting.around(&[(0, 0), (100, 0), (100, 100)]).is_empty());
        assert_eq!(nesting.around(&[(30, 25), (40, 25)]), [0]);
    }

    #[test]
    fn outlines_that_cross_are_found() {
        let crossing = nesting(&[square(0, 0, 10), square(5, 5, 10)]).crossing();
        assert_eq!(crossing.map(|(a, b, _)| (a.min(b), a.max(b))), Some((0, 1)));
        assert_eq!(
            nesting(&[square(0, 0, 10), square(10, 0, 10)]).crossing(),
            None
        );
    }

    #[test]
    fn nesting_agrees_with_looking_at_every_outline() {
        let seed = Seed::root(12);
        let at = |i: i64, k: u64| (seed.number(i).unit(k) * 90.0) as i64;
        let outlines: Vec<Vec<Cell>> = (0..60)
            .map(|i| square(at(i, 0), at(i, 1), at(i, 2) / 3 + 1))
            .collect();
        let nesting = nesting(&outlines);
        for i in 0..300 {
            // Points beside the grid of the corners lie on no outline.
            let line = [(at(i, 5), at(i, 6)), (at(i, 5), at(i, 6) + 1)];
            let off = Point::new(line[0].0 as f64, line[0].1 as f64 + 0.5);
            let is_on = |o: &[Cell]| {
                o.windows(2)
                    .any(|w| w[0].0 == w[1].0 && w[0].0 == line[0].0)
            };
            if outlines.iter().any(|o| is_on(o)) {
                continue;
            }
            let has = |o: &Vec<Cell>| {
                let outer = o[..4].iter().map(|&c| plain(c)).collect();
                Polygon {
                    outer,
                    holes: vec![],
                }
                .contains(off)
            };
            let expected: Vec<u32> = (0..60u32).filter(|&o| has(&outlines[o as usize])).collect();
            assert_eq!(nesting.around(&line), expected, "{line:?}");
        }
    }
}
