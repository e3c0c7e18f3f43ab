//! The narrowest places of an area and of what is between its parts.

use std::ops::Range;

use rayon::prelude::*;

use crate::index::BucketGrid;
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

/// The narrowest neck inside `polygons`: where they would fall apart, or lose a bridge, if they were made thinner from all
/// sides. Sharp tips are no necks. None when nothing faces itself.
pub fn narrowest_neck(polygons: &[Polygon]) -> Option<Neck> {
    Outline::new(polygons).narrowest(Side::Inside)
}

/// The narrowest gap beside `polygons`, between two of them or two parts of one.
pub fn narrowest_gap(polygons: &[Polygon]) -> Option<Neck> {
    Outline::new(polygons).narrowest(Side::Outside)
}

/// Necks inside `polygons` and gaps beside them below this width: one place of each, or several side by side.
pub fn below(polygons: &[Polygon], width: f64) -> Vec<Neck> {
    Outline::new(polygons).below(width)
}

/// Directions within this of a right angle to an outline count as facing: arcs are polylines.
const FACING: f64 = 0.05;

/// What is beyond a neck is a tip where it has less than this part of the neck's width times the length of its outline:
/// sides that are parallel up to the end enclose one half.
const TAPERED: f64 = 0.4;

/// One place of so many is searched from first.
const SPREAD: usize = 61;

/// Edges that are searched from together.
const CHUNK: u32 = 1024;

/// Where places face each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    /// In the area.
    Inside,
    /// Beside it.
    Outside,
}

struct Edge {
    /// The edges before and after it in its ring.
    previous: u32,
    next: u32,
    /// The number of its ring.
    ring: u32,
    from: Point,
    /// Of length one.
    direction: Point,
    length: f64,
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

impl Run {
    /// The run on by `length` from `from`, where it ends, to `to`; `origin` is the first point of the ring.
    fn on(self, origin: Point, from: Point, to: Point, length: f64) -> Run {
        Run {
            length: self.length + length,
            area: self.area + (from - origin).cross(to - origin),
        }
    }
}

/// A place from which necks are sought: the directions of the edges before and after it, the region on their left.
struct Site {
    at: Point,
    before: Point,
    after: Point,
    /// The edges that meet here.
    edges: [u32; 2],
}

impl Site {
    /// A rectangle around all places up to `reach` away that may face this one.
    fn view(&self, reach: f64) -> Bounds {
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

struct Outline {
    edges: Vec<Edge>,
    /// The first point of every ring, and the run round it.
    rings: Vec<(Point, Run)>,
    bounds: Bounds,
}

impl Outline {
    fn new(polygons: &[Polygon]) -> Outline {
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

    fn add(&mut self, points: &[Point]) {
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

    fn edge(&self, k: u32) -> &Edge {
        &self.edges[k as usize]
    }

    /// Where an edge ends.
    fn end(&self, k: u32) -> Point {
        self.edge(self.edge(k).next).from
    }

    /// The directions in which one passes from the edge `before` to the edge `after`, with the region on the left.
    fn directions(&self, before: u32, after: u32, side: Side) -> (Point, Point) {
        let (before, after) = (self.edge(before).direction, self.edge(after).direction);
        if side == Side::Inside {
            (before, after)
        } else {
            (-after, -before)
        }
    }

    /// The corner at the end of an edge, unless it points out of the region: then it faces nothing.
    fn corner(&self, k: u32, side: Side) -> Option<Site> {
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
    fn sites(&self, edges: Range<u32>, side: Side) -> impl Iterator<Item = Site> {
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
    fn all(&self) -> Range<u32> {
        0..self.edges.len() as u32
    }

    /// All edges, in parts that threads share.
    fn chunks(&self) -> impl IndexedParallelIterator<Item = Range<u32>> {
        let end = self.all().end;
        (0..end.div_ceil(CHUNK))
            .into_par_iter()
            .map(move |i| i * CHUNK..((i + 1) * CHUNK).min(end))
    }

    fn buckets(&self) -> BucketGrid {
        BucketGrid::of_segments(
            self.bounds,
            self.all().map(|k| [self.edge(k).from, self.end(k)]),
        )
    }

    /// Some places spread over the outline come first: the sooner a narrow neck is known, the less is looked at from the others.
    fn narrowest(&self, side: Side) -> Option<Neck> {
        let reach = self.reach(f64::INFINITY)?;
        let grid = self.buckets();
        let search = |sites: &mut dyn Iterator<Item = Site>, mut best: Option<Neck>| {
            sites.for_each(|site| self.search(&grid, &site, side, reach, &mut best));
            best
        };
        let first = search(&mut self.sites(self.all(), side).step_by(SPREAD), None);
        let found = self
            .chunks()
            .filter_map(|edges| search(&mut self.sites(edges, side), first));
        // Of equal ones the first along the outline, whatever the threads do.
        found.reduce_with(|a, b| if b.width < a.width { b } else { a })
    }

    fn below(&self, width: f64) -> Vec<Neck> {
        let Some(reach) = self.reach(width) else {
            return Vec::new();
        };
        let grid = self.buckets();
        let place = |site: &Site, side: Side| {
            let mut best: Option<Neck> = None;
            self.search(&grid, site, side, reach, &mut best);
            best
        };
        let sides = [Side::Inside, Side::Outside].into_par_iter();
        let parts = sides.flat_map(|side| self.chunks().map(move |edges| (edges, side)));
        parts
            .flat_map_iter(|(edges, side)| {
                self.sites(edges, side)
                    .filter_map(move |site| place(&site, side))
            })
            .collect()
    }

    /// How far is searched for what is narrower than `width`; none where nothing is found.
    fn reach(&self, width: f64) -> Option<f64> {
        let size = self.bounds.longer_side();
        (size > 0.0 && size.is_finite() && width > 0.0).then(|| width.min(2.0 * size))
    }

    /// Takes the narrowest neck from a site where it is below `reach`, and below `best`.
    fn search(
        &self,
        grid: &BucketGrid,
        site: &Site,
        side: Side,
        reach: f64,
        best: &mut Option<Neck>,
    ) {
        let mut limit = best.map_or(reach, |b| b.width);
        grid.within(&site.view(limit), |k| {
            let found = self.facing(site, k, side, limit);
            if let Some(neck) = found
                .filter(|n| !self.is_blocked(grid, n, site, k) && !self.is_tip(n, site, k, side))
            {
                limit = neck.width;
                *best = Some(neck);
            }
        });
    }

    /// The neck from a site to an edge, if they face each other and are nearer than `limit`.
    fn facing(&self, site: &Site, k: u32, side: Side, limit: f64) -> Option<Neck> {
        let edge = self.edge(k);
        let along = (site.at - edge.from).dot(edge.direction);
        // Beyond the ends it is a corner that is faced.
        let (to, before, after) = if along <= 0.0 {
            (edge.from, edge.previous, k)
        } else if along >= edge.length {
            (self.end(k), k, edge.next)
        } else {
            (edge.from + edge.direction * along, k, k)
        };
        let d = to - site.at;
        let squared = d.dot(d);
        if squared >= limit * limit || squared == 0.0 || site.edges.contains(&k) {
            return None;
        }
        let width = squared.sqrt();
        let d = d * (1.0 / width);
        let (before, after) = self.directions(before, after, side);
        let face = faces(d, site.before, site.after) && faces(-d, before, after);
        face.then_some(Neck {
            from: site.at,
            to,
            width,
        })
    }

    /// Whether one of the two parts on either side of the neck is a tip that tapers off.
    fn is_tip(&self, neck: &Neck, site: &Site, k: u32, side: Side) -> bool {
        let (here, there) = (self.edge(site.edges[0]), self.edge(k));
        if here.ring != there.ring {
            return false;
        }
        let (origin, round) = self.rings[here.ring as usize];
        let run =
            |edge: &Edge, p: Point| edge.before.on(origin, edge.from, p, edge.from.distance(p));
        let (from, to) = (run(here, neck.from), run(there, neck.to));
        let sign = if side == Side::Inside { 1.0 } else { -1.0 };
        // The outline from `a` to `b` and the chord back enclose the region, or what is beside it.
        let tapers = |a: Run, b: Run, chord: f64| {
            let whole = if b.length < a.length {
                round
            } else {
                Run::default()
            };
            let length = b.length - a.length + whole.length;
            let area = sign * (b.area - a.area + whole.area + chord);
            area > 0.0 && 0.5 * area < TAPERED * neck.width * length
        };
        let chord = (neck.to - origin).cross(neck.from - origin);
        tapers(from, to, chord) != tapers(to, from, -chord)
    }

    /// Whether another part of the outline lies between the two places.
    fn is_blocked(&self, grid: &BucketGrid, neck: &Neck, site: &Site, k: u32) -> bool {
        let mut is_blocked = false;
        grid.within(&Bounds::of([neck.from, neck.to]), |other| {
            is_blocked |= other != k && !site.edges.contains(&other) && self.crosses(other, neck);
        });
        is_blocked
    }

    fn crosses(&self, k: u32, neck: &Neck) -> bool {
        let (from, to) = (self.edge(k).from, self.end(k));
        let side = |a: Point, b: Point, p: Point| (b - a).cross(p - a);
        side(neck.from, neck.to, from) * side(neck.from, neck.to, to) < 0.0
            && side(from, to, neck.from) * side(from, to, neck.to) < 0.0
    }
}

/// Whether the direction `d` leads from a place of the outline straight into the region.
fn faces(d: Point, before: Point, after: Point) -> bool {
    is_square(d, before, after) && (before.cross(d) > 0.0 || after.cross(d) > 0.0)
}

/// Whether the direction `d` is square to the outline, or between the directions that are square to the edges `before` and
/// `after` a corner.
fn is_square(d: Point, before: Point, after: Point) -> bool {
    d.dot(before) >= -FACING && d.dot(after) <= FACING
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ring, Seed};

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    fn polygon(outer: &[[f64; 2]], holes: &[&[[f64; 2]]]) -> Polygon {
        Polygon {
            outer: ring(outer),
            holes: holes.iter().map(|h| ring(h)).collect(),
        }
    }

    #[test]
    fn what_is_found_is_the_narrowest_of_all_pairs() {
        let seed = Seed::root(8);
        for case in 0..40 {
            let seed = seed.number(case);
            let star = |centre: Point, k: u64| -> Ring {
                let radius = |i: u64| seed.range(100 * k + i, 1.0, 4.0);
                (0..40)
                    .map(|i| {
                        centre + Point::unit(i as f64 * std::f64::consts::TAU / 40.0) * radius(i)
                    })
                    .collect()
            };
            let at = |k: u64| Point::new(8.5 * (k % 3) as f64, 8.5 * (k / 3) as f64);
            let polygons: Vec<Polygon> = (0..6)
                .map(|k| Polygon {
                    outer: star(at(k), k),
                    holes: Vec::new(),
                })
                .collect();
            let outline = Outline::new(&polygons);
            let mut all = Vec::new();
            for side in [Side::Inside, Side::Outside] {
                let mut narrowest = f64::INFINITY;
                for site in outline.sites(outline.all(), side) {
                    let pairs = (0..outline.edges.len() as u32)
                        .filter_map(|k| Some((k, outline.facing(&site, k, side, 1e9)?)));
                    let free = pairs.filter(|(k, n)| {
                        !(0..outline.edges.len() as u32)
                            .any(|o| o != *k && !site.edges.contains(&o) && outline.crosses(o, n))
                            && !outline.is_tip(n, &site, *k, side)
                    });
                    let best = free.map(|f| f.1).min_by(|a, b| a.width.total_cmp(&b.width));
                    narrowest = best.map_or(narrowest, |b| narrowest.min(b.width));
                    all.extend(best);
                }
                assert_eq!(
                    outline.narrowest(side).map(|n| n.width),
                    Some(narrowest),
                    "case {case}"
                );
            }
            all.retain(|n| n.width < 1.5);
            assert!(all.len() > 10);
            let widths = |necks: &[Neck]| necks.iter().map(|n| n.width).collect::<Vec<_>>();
            assert_eq!(widths(&outline.below(1.5)), widths(&all), "case {case}");
        }
    }

    #[test]
    fn threads_find_what_one_search_finds() {
        let seed = Seed::root(9);
        let circle = |k: u64| -> Ring {
            let radius = |i: u64| seed.range(10_000 * k + i, 3.0, 4.0);
            (0..900)
                .map(|i| Point::unit(i as f64 * std::f64::consts::TAU / 900.0) * radius(i))
                .collect()
        };
        let moved = |k: u64| {
            circle(k)
                .into_iter()
                .map(|p| p + Point::new(8.5 * k as f64, 0.0))
                .collect()
        };
        let polygons: Vec<Polygon> = (0..5)
            .map(|k| Polygon {
                outer: moved(k),
                holes: Vec::new(),
            })
            .collect();
        let outline = Outline::new(&polygons);
        assert!(outline.all().end > 3 * CHUNK);
        let (grid, reach) = (outline.buckets(), outline.reach(f64::INFINITY).unwrap());
        let mut places = Vec::new();
        for side in [Side::Inside, Side::Outside] {
            let mut best = None;
            for site in outline.sites(outline.all(), side) {
                outline.search(&grid, &site, side, reach, &mut best);
                let mut near = None;
                outline.search(&grid, &site, side, 1.0, &mut near);
                places.extend(near);
            }
            assert_eq!(
                outline.narrowest(side).map(|n| n.width),
                best.map(|n| n.width)
            );
        }
        assert!(places.len() > 100);
        assert_eq!(outline.below(1.0), places);
    }

    #[test]
    fn a_frame_is_as_wide_as_its_thinnest_side() {
        let frame = polygon(
            &[[0., 0.], [10., 0.], [10., 6.], [0., 6.]],
            &[&[[2., 1.], [2., 5.5], [7., 5.5], [7., 1.]]],
        );
        assert_eq!(
            narrowest_neck(std::slice::from_ref(&frame)).unwrap().width,
            0.5
        );
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
            &[
                [0., 0.],
                [100., 0.],
                [100., 50.],
                [0., 50.],
                [0., 25.9],
                [-40., 25.001],
                [-40., 25.],
                [0., 24.],
            ],
            &[],
        );
        let found = narrowest_neck(&[needle]).unwrap().width;
        assert!(found > 40.0, "{found}");
        // As wide at its end as at its root.
        let arm = polygon(
            &[
                [0., 0.],
                [100., 0.],
                [100., 50.],
                [0., 50.],
                [0., 26.],
                [-40., 26.],
                [-40., 25.],
                [0., 25.],
            ],
            &[],
        );
        assert_eq!(narrowest_neck(&[arm]).unwrap().width, 1.0);
    }

    #[test]
    fn the_tip_of_a_slit_faces_what_is_beside_it() {
        // A narrow slit from above ends beside the steep side of a hole.
        let slit = [
            [0., 0.],
            [20., 0.],
            [20., 20.],
            [10.5, 20.],
            [10., 9.],
            [9.5, 20.],
            [0., 20.],
        ];
        let hole: &[[f64; 2]] = &[[10.0, 2.0], [5.0, 2.0], [9.0, 8.0]];
        let found = narrowest_neck(&[polygon(&slit, &[hole])]).unwrap();
        assert_eq!(
            (found.middle(), found.width),
            (Point::new(9.5, 8.5), 2f64.sqrt())
        );
        let beside: &[[f64; 2]] = &[[9.0, 4.0], [4.0, 4.0], [4.0, 14.0], [7.0, 14.0]];
        let found = narrowest_neck(&[polygon(&slit, &[beside])]).unwrap();
        assert_eq!(found.from, Point::new(10.0, 9.0));
        assert!(
            (found.width - 2.0 * 104f64.sqrt().recip() * 10.0).abs() < 1e-9,
            "{}",
            found.width
        );
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
        assert_eq!(
            narrowest_gap(&[bar(0.0), bar(2.25), bar(9.0)])
                .unwrap()
                .width,
            0.25
        );
        assert_eq!(narrowest_gap(&[bar(0.0), bar(9.0)]).unwrap().width, 7.0);
        assert_eq!(narrowest_gap(&[bar(0.0)]), None);
    }

    #[test]
    fn round_rings_have_their_thickness() {
        let circle = |r: f64, x: f64, sign: f64| -> Ring {
            (0..200)
                .map(|i| {
                    Point::unit(sign * std::f64::consts::TAU * f64::from(i) / 200.0) * r
                        + Point::new(x, 0.0)
                })
                .collect()
        };
        let ring = Polygon {
            outer: circle(10.0, 0.0, 1.0),
            holes: vec![circle(7.0, 1.0, -1.0)],
        };
        assert!((narrowest_neck(&[ring]).unwrap().width - 2.0).abs() < 0.01);
    }
}
