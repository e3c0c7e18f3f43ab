//! The narrowest places of an area and of what is between its parts.

use super::{Bounds, Point, Polygon};

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

/// The narrowest neck inside `polygons`: where they would fall apart, or lose a bridge, if they were made thinner from all
/// sides. Sharp tips are no necks. None when nothing faces itself.
pub fn narrowest_neck(polygons: &[Polygon]) -> Option<Neck> {
    Outline::new(polygons, false).narrowest()
}

/// The narrowest gap beside `polygons`, between two of them or two parts of one.
pub fn narrowest_gap(polygons: &[Polygon]) -> Option<Neck> {
    Outline::new(polygons, true).narrowest()
}

/// Necks inside `polygons` below this width: one place of every neck, or several side by side.
pub fn necks_below(polygons: &[Polygon], width: f64) -> Vec<Neck> {
    Outline::new(polygons, false).below(width)
}

/// As [`necks_below`], for the gaps beside `polygons`.
pub fn gaps_below(polygons: &[Polygon], width: f64) -> Vec<Neck> {
    Outline::new(polygons, true).below(width)
}

/// Directions within this of a right angle to an outline count as facing: arcs are polylines.
const FACING: f64 = 0.05;

/// What is beyond a neck is a tip where it has less than this part of the neck's width times the length of its outline:
/// sides that are parallel up to the end enclose one half.
const TAPERED: f64 = 0.4;

/// The distance grows by this factor from search to search.
const GROWTH: f64 = 2.5;

struct Edge {
    /// The edges before and after it in its ring.
    previous: u32,
    next: u32,
    from: Point,
    to: Point,
    /// Of length one.
    direction: Point,
    /// The number of its ring.
    ring: u32,
    /// The run of the ring up to its beginning.
    before: Run,
}

/// The outline from the beginning of a ring to a place: its length, and twice the area that it and the chords to the ring's first
/// point enclose.
#[derive(Clone, Copy, Default)]
struct Run {
    length: f64,
    area: f64,
}

/// A place from which necks are sought: the directions of the edges before and after it, the region on their left.
struct Site {
    at: Point,
    before: Point,
    after: Point,
    /// The edges that meet here.
    edges: [u32; 2],
}

impl Run {
    /// The run on from `from`, where it ends, to `to`; `origin` is the first point of the ring.
    fn on(self, origin: Point, from: Point, to: Point) -> Run {
        Run { length: self.length + from.distance(to), area: self.area + (from - origin).cross(to - origin) }
    }
}

struct Outline {
    edges: Vec<Edge>,
    sites: Vec<Site>,
    /// The first point of every ring, and the run round it.
    rings: Vec<(Point, Run)>,
    bounds: Bounds,
}

impl Outline {
    fn new(polygons: &[Polygon], reversed: bool) -> Outline {
        let (mut edges, mut sites, mut rings) = (Vec::new(), Vec::new(), Vec::new());
        for ring in polygons.iter().flat_map(Polygon::rings) {
            let base = edges.len() as u32;
            let mut points: Vec<Point> = ring.clone();
            if reversed {
                points.reverse();
            }
            let n = points.len();
            let mut before = Run::default();
            for i in 0..n {
                let (from, to) = (points[i], points[(i + 1) % n]);
                let length = from.distance(to);
                if length > 0.0 {
                    let direction = (to - from) * (1.0 / length);
                    let k = edges.len() as u32;
                    let ring = rings.len() as u32;
                    edges.push(Edge { previous: k.wrapping_sub(1), next: k + 1, from, to, direction, ring, before });
                    before = before.on(points[0], from, to);
                }
            }
            rings.extend(points.first().map(|&p| (p, before)));
            let end = edges.len() as u32;
            if end > base {
                edges[base as usize].previous = end - 1;
                edges[end as usize - 1].next = base;
            }
            for k in base..end {
                let a: &Edge = &edges[k as usize];
                let after = edges[a.next as usize].direction;
                sites.push(Site { at: a.from.lerp(a.to, 0.5), before: a.direction, after: a.direction, edges: [k, k] });
                // A corner that points out of the region faces nothing.
                if a.direction.cross(after) < FACING {
                    sites.push(Site { at: a.to, before: a.direction, after, edges: [k, a.next] });
                }
            }
        }
        let bounds = Bounds::of(edges.iter().map(|e: &Edge| e.from));
        Outline { edges, sites, rings, bounds }
    }

    /// Searches within growing distances until something is found.
    fn narrowest(&self) -> Option<Neck> {
        let size = self.bounds.longer_side();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let mut reach = size / 4096.0;
        while reach < 2.0 * size {
            let found = self.within(reach);
            if found.is_some() {
                return found;
            }
            reach *= GROWTH;
        }
        None
    }

    fn below(&self, width: f64) -> Vec<Neck> {
        let size = self.bounds.longer_side();
        if !(size > 0.0 && size.is_finite() && width > 0.0) {
            return Vec::new();
        }
        let reach = width.min(2.0 * size);
        let grid = Buckets::new(self, reach);
        let mut necks = Vec::new();
        for site in &self.sites {
            let mut best: Option<Neck> = None;
            self.search(&grid, site, reach, &mut best);
            necks.extend(best);
        }
        necks
    }

    fn within(&self, reach: f64) -> Option<Neck> {
        let grid = Buckets::new(self, reach);
        let mut best: Option<Neck> = None;
        for site in &self.sites {
            self.search(&grid, site, reach, &mut best);
        }
        best
    }

    /// Takes the narrowest neck from a site where it is below `reach`, and below `best`.
    fn search(&self, grid: &Buckets, site: &Site, reach: f64, best: &mut Option<Neck>) {
        let limit = best.map_or(reach, |b| b.width);
        grid.about(site.at, limit, |k| {
            let limit = best.map_or(reach, |b| b.width);
            let narrower = self.facing(site, k).filter(|n| n.width < limit);
            if let Some(neck) = narrower.filter(|n| !self.blocked(grid, n, site, k) && !self.is_tip(n, site, k)) {
                *best = Some(neck);
            }
        });
    }

    /// The neck from a site to an edge, if they face each other.
    fn facing(&self, site: &Site, k: u32) -> Option<Neck> {
        if site.edges.contains(&k) {
            return None;
        }
        let edge = &self.edges[k as usize];
        let along = (site.at - edge.from).dot(edge.direction);
        let length = edge.from.distance(edge.to);
        // Beyond the ends it is a corner that is faced.
        let (to, before, after) = if along <= 0.0 {
            (edge.from, self.edges[edge.previous as usize].direction, edge.direction)
        } else if along >= length {
            (edge.to, edge.direction, self.edges[edge.next as usize].direction)
        } else {
            (edge.from + edge.direction * along, edge.direction, edge.direction)
        };
        let width = site.at.distance(to);
        if width == 0.0 {
            return None;
        }
        let d = (to - site.at) * (1.0 / width);
        (faces(d, site.before, site.after) && faces(-d, before, after)).then_some(Neck { from: site.at, to, width })
    }

    /// Whether one of the two parts on either side of the neck is a tip that tapers off.
    fn is_tip(&self, neck: &Neck, site: &Site, k: u32) -> bool {
        let (here, there) = (&self.edges[site.edges[0] as usize], &self.edges[k as usize]);
        if here.ring != there.ring {
            return false;
        }
        let (origin, round) = self.rings[here.ring as usize];
        let run = |edge: &Edge, p: Point| edge.before.on(origin, edge.from, p);
        let (from, to) = (run(here, neck.from), run(there, neck.to));
        // The outline from `a` to `b` and the chord back: the region, or what is beside it, lies on the left.
        let tapers = |a: Run, b: Run, chord: f64| {
            let whole = if b.length < a.length { round } else { Run::default() };
            let (length, area) = (b.length - a.length + whole.length, b.area - a.area + whole.area + chord);
            area > 0.0 && 0.5 * area < TAPERED * neck.width * length
        };
        let chord = (neck.to - origin).cross(neck.from - origin);
        tapers(from, to, chord) != tapers(to, from, -chord)
    }

    /// Whether another part of the outline lies between the two places.
    fn blocked(&self, grid: &Buckets, neck: &Neck, site: &Site, k: u32) -> bool {
        let mut blocked = false;
        grid.about(neck.middle(), 0.5 * neck.width, |other| {
            let e = &self.edges[other as usize];
            if other == k || site.edges.contains(&other) {
                return;
            }
            let side = |a: Point, b: Point, p: Point| (b - a).cross(p - a);
            let crosses = side(neck.from, neck.to, e.from) * side(neck.from, neck.to, e.to) < 0.0
                && side(e.from, e.to, neck.from) * side(e.from, e.to, neck.to) < 0.0;
            blocked |= crosses;
        });
        blocked
    }
}

/// Whether the direction `d` leads from a place of the outline straight into the region: square to the outline, or between the
/// directions that are square to the edges `before` and `after` a corner.
fn faces(d: Point, before: Point, after: Point) -> bool {
    let square = d.dot(before) >= -FACING && d.dot(after) <= FACING;
    square && (before.cross(d) > 0.0 || after.cross(d) > 0.0)
}

/// The edges by the squares of a grid that they touch.
struct Buckets {
    origin: Point,
    cell: f64,
    columns: usize,
    rows: usize,
    starts: Vec<u32>,
    edges: Vec<u32>,
}

/// No grid has more squares an edge.
const MOST_SQUARES: f64 = 4.0;
/// Squares in the distance that is searched: few edges are looked at in vain.
const SQUARES_IN_REACH: f64 = 3.0;

impl Buckets {
    fn new(outline: &Outline, reach: f64) -> Buckets {
        let bounds = outline.bounds;
        let (w, h) = (bounds.width(), bounds.height());
        // A flat outline has squares along one axis only.
        let least = (w * h / (MOST_SQUARES * outline.edges.len() as f64)).sqrt();
        let cell = (reach / SQUARES_IN_REACH).max(least).max((w + h) / (MOST_SQUARES * outline.edges.len() as f64));
        let count = |extent: f64| (extent / cell) as usize + 1;
        let mut grid = Buckets {
            origin: bounds.min,
            cell,
            columns: count(bounds.width()),
            rows: count(bounds.height()),
            starts: Vec::new(),
            edges: Vec::new(),
        };
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for (k, e) in outline.edges.iter().enumerate() {
            // Long edges are entered piece by piece, not by their box.
            let steps = (e.from.distance(e.to) / cell).ceil().max(1.0) as usize;
            for i in 0..steps {
                let at = |j: usize| e.from.lerp(e.to, j as f64 / steps as f64);
                let ((c0, r0), (c1, r1)) = (grid.square(at(i)), grid.square(at(i + 1)));
                for r in r0.min(r1)..=r0.max(r1) {
                    pairs.extend((c0.min(c1)..=c0.max(c1)).map(|c| ((r * grid.columns + c) as u32, k as u32)));
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        grid.starts = vec![0; grid.columns * grid.rows + 1];
        pairs.iter().for_each(|p| grid.starts[p.0 as usize + 1] += 1);
        for i in 1..grid.starts.len() {
            grid.starts[i] += grid.starts[i - 1];
        }
        grid.edges = pairs.into_iter().map(|p| p.1).collect();
        grid
    }

    fn square(&self, p: Point) -> (usize, usize) {
        let index = |x: f64, most: usize| ((x / self.cell).max(0.0) as usize).min(most - 1);
        (index(p.x - self.origin.x, self.columns), index(p.y - self.origin.y, self.rows))
    }

    /// Calls `visit` with all edges nearer than `reach` to `p`, and with others; with some of them more than once.
    fn about(&self, p: Point, reach: f64, mut visit: impl FnMut(u32)) {
        let corner = Point::new(reach, reach);
        let ((c0, r0), (c1, r1)) = (self.square(p - corner), self.square(p + corner));
        for r in r0..=r1 {
            let row = r * self.columns;
            let range = self.starts[row + c0] as usize..self.starts[row + c1 + 1] as usize;
            self.edges[range].iter().for_each(|&k| visit(k));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ring;

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    fn polygon(outer: &[[f64; 2]], holes: &[&[[f64; 2]]]) -> Polygon {
        Polygon { outer: ring(outer), holes: holes.iter().map(|h| ring(h)).collect() }
    }

    #[test]
    fn a_frame_is_as_wide_as_its_thinnest_side() {
        let frame =
            polygon(&[[0., 0.], [10., 0.], [10., 6.], [0., 6.]], &[&[[2., 1.], [2., 5.5], [7., 5.5], [7., 1.]]]);
        assert_eq!(narrowest_neck(std::slice::from_ref(&frame)).unwrap().width, 0.5);
        assert_eq!(narrowest_gap(&[frame]).unwrap().width, 4.5);
    }

    #[test]
    fn tips_are_no_necks() {
        let wedge = polygon(&[[0., 0.], [100., 0.], [100., 15.]], &[]);
        assert_eq!(narrowest_neck(&[wedge]), None);
        let bar = polygon(&[[0., 0.], [100., 0.], [100., 3.], [0., 3.]], &[]);
        assert_eq!(narrowest_neck(&[bar]).unwrap().width, 3.0);
    }

    #[test]
    fn needles_are_no_necks_and_arms_are() {
        // The sides of the needle are nearly parallel up to its tip, which is cut off.
        let needle = polygon(
            &[[0., 0.], [100., 0.], [100., 50.], [0., 50.], [0., 25.9], [-40., 25.001], [-40., 25.], [0., 24.]],
            &[],
        );
        let found = narrowest_neck(&[needle]).unwrap().width;
        assert!(found > 40.0, "{found}");
        // As wide at its end as at its root.
        let arm = polygon(
            &[[0., 0.], [100., 0.], [100., 50.], [0., 50.], [0., 26.], [-40., 26.], [-40., 25.], [0., 25.]],
            &[],
        );
        assert_eq!(narrowest_neck(&[arm]).unwrap().width, 1.0);
    }

    #[test]
    fn the_tip_of_a_slit_faces_what_is_beside_it() {
        // A narrow slit from above ends beside the steep side of a hole.
        let slit = [[0., 0.], [20., 0.], [20., 20.], [10.5, 20.], [10., 9.], [9.5, 20.], [0., 20.]];
        let hole: &[[f64; 2]] = &[[10.0, 2.0], [5.0, 2.0], [9.0, 8.0]];
        let found = narrowest_neck(&[polygon(&slit, &[hole])]).unwrap();
        assert_eq!((found.from, found.to), (Point::new(10.0, 9.0), Point::new(9.0, 8.0)));
        let beside: &[[f64; 2]] = &[[9.0, 4.0], [4.0, 4.0], [4.0, 14.0], [7.0, 14.0]];
        let found = narrowest_neck(&[polygon(&slit, &[beside])]).unwrap();
        assert_eq!(found.from, Point::new(10.0, 9.0));
        assert!((found.width - 2.0 * 104f64.sqrt().recip() * 10.0).abs() < 1e-9, "{}", found.width);
    }

    #[test]
    fn points_that_face_each_other_are_as_near_as_their_tips() {
        let left = polygon(&[[0., 0.], [10., 5.], [0., 10.]], &[]);
        let right = polygon(&[[10.5, 5.], [20., 0.], [20., 10.]], &[]);
        assert_eq!(narrowest_gap(&[left, right]).unwrap().width, 0.5);
    }

    #[test]
    fn a_gap_between_two_parts_is_found_and_what_lies_behind_is_not() {
        let bar = |y: f64| polygon(&[[0., y], [50., y], [50., y + 2.], [0., y + 2.]], &[]);
        assert_eq!(narrowest_gap(&[bar(0.0), bar(2.25), bar(9.0)]).unwrap().width, 0.25);
        assert_eq!(narrowest_gap(&[bar(0.0), bar(9.0)]).unwrap().width, 7.0);
        assert_eq!(narrowest_gap(&[bar(0.0)]), None);
    }

    #[test]
    fn round_rings_have_their_thickness() {
        let circle = |r: f64, x: f64, sign: f64| -> Ring {
            (0..200)
                .map(|i| Point::unit(sign * std::f64::consts::TAU * f64::from(i) / 200.0) * r + Point::new(x, 0.0))
                .collect()
        };
        let ring = Polygon { outer: circle(10.0, 0.0, 1.0), holes: vec![circle(7.0, 1.0, -1.0)] };
        assert!((narrowest_neck(&[ring]).unwrap().width - 2.0).abs() < 0.01);
    }
}
