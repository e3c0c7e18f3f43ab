//! Areas in a window: a polygon cut by the four sides of a rectangle, one after another, and closed along the
//! cuts. Corners that stay keep their bits, and cut points are those of whole sides of the polygon.

use fretwork_geometry::{Bounds, Point, Polygon, Ring};

/// A corner of a ring and the whole side that leaves it, of which a part may be left.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: Point,
    side: (Point, Point),
}

/// A closed ring of corners.
type Loop = Vec<Corner>;

/// The half of the plane on one side of an upright or level line, the line with it.
#[derive(Clone, Copy, Debug)]
struct Half {
    is_x: bool,
    limit: f64,
    /// Whether what is kept lies above the limit.
    is_above: bool,
}

impl Half {
    fn coordinate(self, p: Point) -> f64 {
        if self.is_x { p.x } else { p.y }
    }

    /// The place along the line.
    fn along(self, p: Point) -> f64 {
        if self.is_x { p.y } else { p.x }
    }

    /// Whether `p` lies in it and not on its line.
    fn has(self, p: Point) -> bool {
        let v = self.coordinate(p);
        if self.is_above {
            v > self.limit
        } else {
            v < self.limit
        }
    }

    /// Where a side that leaves the half-plane towards `outside` meets the line: computed from the whole side.
    fn crossing(self, side: (Point, Point), outside: Point) -> Point {
        if self.coordinate(outside) == self.limit {
            return outside;
        }
        let met = if self.is_x {
            at_x(side.0, side.1, self.limit)
        } else {
            at_y(side.0, side.1, self.limit)
        };
        met.unwrap_or(outside)
    }
}

/// The parts of `area` in `window`, without those that have no area.
pub fn cut(area: &Polygon, window: &Bounds) -> Vec<Polygon> {
    let bounds = Bounds::of(area.outer.iter().copied());
    if !bounds.intersects(window) {
        return Vec::new();
    }
    if window.contains(bounds.min) && window.contains(bounds.max) {
        return vec![area.clone()];
    }
    let half = |is_x, limit, is_above| Half {
        is_x,
        limit,
        is_above,
    };
    let halves = [
        half(true, window.min.x, true),
        half(true, window.max.x, false),
        half(false, window.min.y, true),
        half(false, window.max.y, false),
    ];
    let mut loops: Vec<Loop> = vec![corners(&area.outer, true)];
    loops.extend(area.holes.iter().map(|hole| corners(hole, false)));
    for half in halves {
        loops = kept(loops, half);
    }
    let rings = loops.iter().map(|corners| ring(corners));
    nested(
        rings
            .filter(|ring| ring.len() > 2 && signed_area(ring) != 0.0)
            .collect(),
    )
}

/// The corners of a ring, which runs so that its area is above 0 if `is_outer`, and below it otherwise: the inside
/// of the polygon is on one side of all of its rings.
fn corners(ring: &[Point], is_outer: bool) -> Loop {
    let mut ring = ring.to_vec();
    if ring.len() > 2 && (signed_area(&ring) > 0.0) != is_outer {
        ring.reverse();
    }
    let next = ring.iter().cycle().skip(1);
    let pairs = ring.iter().zip(next);
    pairs
        .map(|(&at, &to)| Corner { at, side: (at, to) })
        .collect()
}

/// The ring of a loop: corners at one place are one.
fn ring(corners: &[Corner]) -> Ring {
    let mut ring: Ring = corners.iter().map(|corner| corner.at).collect();
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}

/// The loops cut at the line of `half`: chains of kept corners, joined along the line. Every chain begins and
/// ends on it. Along the line, ends and beginnings of chains take turns, for between them lies the
/// inside of the area: the first end belongs to the first beginning, and so on.
fn kept(loops: Vec<Loop>, half: Half) -> Vec<Loop> {
    let (mut whole, mut chains) = (Vec::new(), Vec::new());
    for corners in loops {
        match corners.iter().position(|corner| !half.has(corner.at)) {
            None => whole.push(corners),
            Some(start) => add_chains(&corners, start, half, &mut chains),
        }
    }
    let sorted = |end: &dyn Fn(&Loop) -> Point| {
        let mut numbers: Vec<usize> = (0..chains.len()).collect();
        let place = |n: usize| half.along(end(&chains[n]));
        numbers.sort_by(|a, b| place(*a).total_cmp(&place(*b)).then(a.cmp(b)));
        numbers
    };
    let begins = sorted(&|chain| chain[0].at);
    let ends = sorted(&|chain| chain[chain.len() - 1].at);
    let mut next = vec![0; chains.len()];
    for (end, begin) in ends.into_iter().zip(begins) {
        next[end] = begin;
    }
    whole.extend(joined(&chains, &next));
    whole
}

/// Adds the parts of a loop that are kept, each from where it enters the half-plane to where it leaves it. The
/// corner numbered `start` is outside.
fn add_chains(corners: &[Corner], start: usize, half: Half, chains: &mut Vec<Loop>) {
    let turned = (0..=corners.len()).map(|n| corners[(start + n) % corners.len()]);
    let turned: Vec<Corner> = turned.collect();
    let mut open: Option<Loop> = None;
    for pair in turned.windows(2) {
        let (here, there) = (pair[0], pair[1]);
        match (half.has(here.at), half.has(there.at)) {
            (false, true) => {
                let at = half.crossing(here.side, here.at);
                let side = here.side;
                open = Some(vec![Corner { at, side }]);
            }
            (true, is_kept) => {
                if let Some(chain) = &mut open {
                    chain.push(here);
                    if !is_kept {
                        let at = half.crossing(here.side, there.at);
                        let side = (at, at);
                        chain.push(Corner { at, side });
                        chains.extend(open.take());
                    }
                }
            }
            (false, false) => {}
        }
    }
}

/// The loops that chains form when each goes on with its next one.
fn joined(chains: &[Loop], next: &[usize]) -> Vec<Loop> {
    let mut is_done = vec![false; chains.len()];
    let mut loops = Vec::new();
    for start in 0..chains.len() {
        let (mut at, mut corners) = (start, Loop::new());
        while !is_done[at] {
            is_done[at] = true;
            corners.extend(&chains[at]);
            let to = chains[next[at]][0].at;
            if let Some(last) = corners.last_mut() {
                last.side = (last.at, to);
            }
            at = next[at];
        }
        if !corners.is_empty() {
            loops.push(corners);
        }
    }
    loops
}

fn signed_area(ring: &[Point]) -> f64 {
    let origin = ring[0];
    let pairs = ring.windows(2);
    pairs
        .map(|w| (w[0] - origin).cross(w[1] - origin))
        .sum::<f64>()
        / 2.0
}

/// The polygons of rings, of which holes have an area below 0.
fn nested(rings: Vec<Ring>) -> Vec<Polygon> {
    let is_outer = |ring: &Ring| signed_area(ring) > 0.0;
    let (outer, holes): (Vec<Ring>, Vec<Ring>) = rings.into_iter().partition(is_outer);
    let mut polygons: Vec<Polygon> = outer
        .into_iter()
        .map(|outer| Polygon {
            outer,
            holes: Vec::new(),
        })
        .collect();
    for hole in holes {
        let inside = |polygon: &&mut Polygon| {
            let whole = Polygon {
                outer: polygon.outer.clone(),
                holes: Vec::new(),
            };
            // A corner of a hole may touch the outline: that of most of them decides.
            let count = hole.iter().filter(|p| whole.contains(**p)).count();
            2 * count > hole.len()
        };
        if let Some(polygon) = polygons.iter_mut().find(inside) {
            polygon.holes.push(hole);
        }
    }
    polygons
}

/// Where the segment crosses the line of this x, inside of it.
pub(super) fn at_x(a: Point, b: Point, x: f64) -> Option<Point> {
    let (a, b) = ordered(a, b);
    if !(a.x < x && x < b.x) {
        return None;
    }
    let y = a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
    Some(Point::new(x, y.clamp(a.y.min(b.y), a.y.max(b.y))))
}

/// Where the segment crosses the line of this y, inside of it.
pub(super) fn at_y(a: Point, b: Point, y: f64) -> Option<Point> {
    let (a, b) = ordered(a, b);
    if !(a.y.min(b.y) < y && y < a.y.max(b.y)) {
        return None;
    }
    let x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
    Some(Point::new(x.clamp(a.x, b.x), y))
}

/// The ends of a segment in the order of their coordinates.
fn ordered(a: Point, b: Point) -> (Point, Point) {
    if (b.x, b.y) < (a.x, a.y) {
        (b, a)
    } else {
        (a, b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;
    use fretwork_geometry::polygon::intersect;

    fn window(x: [f64; 2], y: [f64; 2]) -> Bounds {
        Bounds {
            min: Point::new(x[0], y[0]),
            max: Point::new(x[1], y[1]),
        }
    }

    /// A comb around the origin with a hole, its corners at random distances.
    fn star(seed: Seed) -> Polygon {
        let ring = |key: Seed, n: u64, low: f64, high: f64| -> Ring {
            let at = |i: u64| {
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                Point::unit(angle) * key.range(i, low, high)
            };
            (0..n).map(at).collect()
        };
        let mut hole = ring(seed.number(1), 7, 1.0, 2.0);
        hole.reverse();
        Polygon {
            outer: ring(seed.number(2), 24, 2.5, 10.0),
            holes: vec![hole],
        }
    }

    #[test]
    fn areas_in_windows_are_those_of_the_general_intersection() {
        for round in 0..200 {
            let seed = Seed::root(round);
            let area = star(seed);
            let side = |n: u64| {
                let low = seed.range(n, -9.0, 5.0);
                [low, low + seed.range(n + 1, 0.5, 8.0)]
            };
            let window = window(side(10), side(20));
            let corner = |x: f64, y: f64| Point::new(x, y);
            let rectangle = Polygon {
                outer: vec![
                    window.min,
                    corner(window.max.x, window.min.y),
                    window.max,
                    corner(window.min.x, window.max.y),
                ],
                holes: vec![],
            };
            let expected = intersect(std::slice::from_ref(&area), &[rectangle]).unwrap();
            let total = |areas: &[Polygon]| areas.iter().map(Polygon::area).sum::<f64>();
            let found = cut(&area, &window);
            assert!((total(&found) - total(&expected)).abs() < 1e-6, "{round}");
            let points = found.iter().flat_map(|p| p.rings()).flatten();
            assert!(points.into_iter().all(|p| window.contains(*p)), "{round}");
        }
    }

    #[test]
    fn corners_and_sides_on_the_cut_leave_no_specks() {
        let at = |points: &[[f64; 2]]| -> Ring { points.iter().map(|&p| p.into()).collect() };
        let area = Polygon {
            outer: at(&[[0., 0.], [4., 0.], [4., 4.], [2., 2.], [0., 4.]]),
            holes: vec![],
        };
        let upper = cut(&area, &window([-1.0, 5.0], [2.0, 9.0]));
        assert_eq!(upper.len(), 2);
        assert!(upper.iter().all(|part| part.area() == 2.0));
        assert!(cut(&area, &window([4.0, 9.0], [0.0, 4.0])).is_empty());
        let same = cut(&area, &window([0.0, 4.0], [0.0, 4.0]));
        assert_eq!(same, [area]);
    }
}
