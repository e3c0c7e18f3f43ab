//! The search for necks.

use std::ops::Range;

use rayon::prelude::*;

use super::outline::{Edge, Neck, Outline, Run, Side, Site, faces};
use crate::budget::{self, Meter};
use crate::index::BucketGrid;
use crate::{Bounds, Point};

/// What is beyond a neck is a tip where it has less than this part of the neck's width times the length of its outline:
/// sides that are parallel up to the end enclose one half, those of a
/// triangle one quarter. With less than a quarter the tips of triangles would be necks; with a half and more the ends of bars
/// would not.
const TAPERED: f64 = 0.4;

/// One place of so many is searched from first. With fewer the first search takes as long as the second one; with more it finds
/// nothing narrow, and the second one has to look far from every place. A prime is unlikely to meet a pattern that repeats.
const SPREAD: usize = 61;

/// Edges that are searched from together.
pub(super) const CHUNK: u32 = 1024;

impl Outline {
    /// All edges, in parts that threads share.
    pub(super) fn chunks(&self) -> impl IndexedParallelIterator<Item = Range<u32>> {
        let end = self.all().end;
        (0..end.div_ceil(CHUNK))
            .into_par_iter()
            .map(move |i| i * CHUNK..((i + 1) * CHUNK).min(end))
    }

    pub(super) fn buckets(&self) -> BucketGrid {
        BucketGrid::of_segments(
            self.bounds,
            self.all().map(|k| [self.edge(k).from, self.end(k)]),
        )
    }

    /// Some places spread over the outline come first: the sooner a narrow neck is known, the less is looked at from the others.
    pub(super) fn narrowest(&self, side: Side) -> Option<Neck> {
        let reach = self.reach(f64::INFINITY)?;
        let grid = self.buckets();
        let search = |sites: &mut dyn Iterator<Item = Site>, mut best: Option<Neck>| {
            sites.for_each(|site| self.search(&grid, &site, side, reach, &mut best));
            best
        };
        let first = search(&mut self.sites(self.all(), side).step_by(SPREAD), None);
        let meter = Meter::current();
        let found = self
            .chunks()
            .filter_map(|edges| meter.during(|| search(&mut self.sites(edges, side), first)));
        // Of equal ones the first along the outline, whatever the threads do.
        found.reduce_with(|a, b| if b.width < a.width { b } else { a })
    }

    pub(super) fn below(&self, width: f64) -> Vec<Neck> {
        let Some(reach) = self.reach(width) else {
            return Vec::new();
        };
        let grid = self.buckets();
        let meter = Meter::current();
        let place = |site: &Site, side: Side| {
            let mut best: Option<Neck> = None;
            meter.during(|| self.search(&grid, site, side, reach, &mut best));
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
    pub(super) fn reach(&self, width: f64) -> Option<f64> {
        let size = self.bounds.longer_side();
        (size > 0.0 && size.is_finite() && width > 0.0).then(|| width.min(2.0 * size))
    }

    /// Takes the narrowest neck from a site where it is below `reach`, and below `best`.
    pub(super) fn search(
        &self,
        grid: &BucketGrid,
        site: &Site,
        side: Side,
        reach: f64,
        best: &mut Option<Neck>,
    ) {
        let mut limit = best.map_or(reach, |b| b.width);
        let mut seen = 0;
        grid.within(&site.view(limit), |k| {
            seen += 1;
            let found = self.facing(site, k, side, limit);
            if let Some(neck) = found
                .filter(|n| !self.is_blocked(grid, n, site, k) && !self.is_tip(n, site, k, side))
            {
                limit = neck.width;
                *best = Some(neck);
            }
        });
        budget::spend("places that may be narrow", 5 + seen / 2);
    }

    /// The neck from a site to an edge, if they face each other and are nearer than `limit`.
    pub(super) fn facing(&self, site: &Site, k: u32, side: Side, limit: f64) -> Option<Neck> {
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
    pub(super) fn is_tip(&self, neck: &Neck, site: &Site, k: u32, side: Side) -> bool {
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
    pub(super) fn is_blocked(&self, grid: &BucketGrid, neck: &Neck, site: &Site, k: u32) -> bool {
        let mut is_blocked = false;
        grid.within(&Bounds::of([neck.from, neck.to]), |other| {
            is_blocked |= other != k && !site.edges.contains(&other) && self.crosses(other, neck);
        });
        is_blocked
    }

    pub(super) fn crosses(&self, k: u32, neck: &Neck) -> bool {
        let (from, to) = (self.edge(k).from, self.end(k));
        let side = |a: Point, b: Point, p: Point| (b - a).cross(p - a);
        side(neck.from, neck.to, from) * side(neck.from, neck.to, to) < 0.0
            && side(from, to, neck.from) * side(from, to, neck.to) < 0.0
    }
}
