//! What happens in one cell of the bins: where segments cross, which sites become nodes, and
//! which segments every node lies on. What the segments become is told in `noding`.

use super::exact::{Segment, before, crossing, distance};
use super::lattice::{RESOLUTION, Site};

/// A node this near to a segment, in grid units, lies on it.
const REACH: f64 = RESOLUTION;

/// Sites this near become one node. Less than [`REACH`] by more than the rounding of a crossing,
/// so that a segment through a site is also near to the node that replaces the site.
pub(super) const MERGE: f64 = RESOLUTION - 1.0;

/// Bends up to this are harmless: nothing else was within REACH + SLACK, hence nothing is within
/// REACH after them.
const BEND: f64 = RESOLUTION / 32.0;
const SLACK: f64 = 4.0 * BEND;

/// A node on a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Incidence {
    pub segment: u32,
    pub node: u32,
    /// [`Segment::position`] of the node.
    pub position: f64,
}

/// What was found in some cells.
#[derive(Default)]
pub(super) struct Found {
    /// The nodes.
    pub sites: Vec<Site>,
    /// For ends of segments (2 × segment, + 1 for b) the node they are at.
    pub ends: Vec<(u32, u32)>,
    /// Nodes on segments, other than their ends.
    pub incidences: Vec<Incidence>,
    /// A segment or a site moves farther than a harmless bend.
    pub moved: bool,
    /// A segment bends at all.
    pub bent: bool,
    /// A node is so little farther from a segment than the resolution that a bend may bring it near.
    pub close: bool,
}

impl Found {
    /// Whether the segments must be looked at again after they were led through their nodes.
    pub fn unsettled(&self) -> bool {
        self.moved || (self.bent && self.close)
    }
}

/// A site of the cell: an end of a segment (its number as in [`Found::ends`]) or a crossing.
#[derive(Clone, Copy)]
struct Candidate {
    site: Site,
    end: u32,
    node: u32,
}

const CROSSING: u32 = u32::MAX;

/// Reused buffers for the work in one cell after another.
#[derive(Default)]
pub(super) struct CellWork {
    local: Vec<(u32, Segment)>,
    candidates: Vec<Candidate>,
}

impl CellWork {
    /// Finds nodes and incidences in the cell that owns the sites for which `owned` holds, given
    /// the segments near it.
    pub fn run(&mut self, segments: &[Segment], bucket: &[u32], owned: impl Fn(Site) -> bool, found: &mut Found) {
        self.local.clear();
        self.local.extend(bucket.iter().map(|&i| (i, segments[i as usize])));
        self.candidates.clear();
        for &(i, s) in &self.local {
            for (site, end) in [(s.a, 2 * i), (s.b, 2 * i + 1)] {
                if owned(site) {
                    self.candidates.push(Candidate { site, end, node: 0 });
                }
            }
        }
        self.cross(owned);
        let first = found.sites.len();
        self.name_nodes(found);
        for node in first..found.sites.len() {
            self.place(node, found);
        }
    }

    /// Adds the crossings of all pairs.
    fn cross(&mut self, owned: impl Fn(Site) -> bool) {
        for (k, (_, s)) in self.local.iter().enumerate() {
            for (_, t) in &self.local[k + 1..] {
                if s.a[0] > t.b[0] || t.a[0] > s.b[0] || s.a == t.a || s.b == t.b || s.a == t.b || s.b == t.a {
                    continue;
                }
                let Some(site) = crossing(s, t).filter(|p| owned(*p)) else { continue };
                // A crossing beside an end is the end's own touch.
                if [s.a, s.b, t.a, t.b].iter().all(|e| distance(*e, site) > MERGE) {
                    self.candidates.push(Candidate { site, end: CROSSING, node: 0 });
                }
            }
        }
    }

    /// Makes nodes of the candidates: one of all that are at the same site or within [`MERGE`] of
    /// a node. Ends of segments come before crossings, then lexicographic order decides.
    fn name_nodes(&mut self, found: &mut Found) {
        self.candidates.sort_unstable_by(|p, q| before(p.site, q.site).then(p.end.cmp(&q.end)));
        let crowded = |(i, p): (usize, &Candidate)| {
            let right = self.candidates[i + 1..].iter().take_while(|q| q.site[0] - p.site[0] <= MERGE);
            right.clone().any(|q| q.site != p.site && (q.site[1] - p.site[1]).abs() <= MERGE)
        };
        if self.candidates.iter().enumerate().any(crowded) {
            self.merge(found);
        }
        let mut last = None;
        for c in &mut self.candidates {
            if last != Some(c.site) {
                found.sites.push(c.site);
                last = Some(c.site);
            }
            c.node = found.sites.len() as u32 - 1;
            if c.end != CROSSING {
                found.ends.push((c.end, c.node));
            }
        }
    }

    /// Moves every candidate within [`MERGE`] of a better one onto it; keeps the order by site.
    fn merge(&mut self, found: &mut Found) {
        let mut order: Vec<usize> = (0..self.candidates.len()).collect();
        order.sort_by_key(|&i| self.candidates[i].end == CROSSING);
        let mut kept = vec![false; order.len()];
        let sites: Vec<Site> = self.candidates.iter().map(|c| c.site).collect();
        for i in order {
            let p = sites[i];
            let near = |j: &usize| kept[*j] && distance(sites[*j], p) <= MERGE;
            let before = (0..i).rev().take_while(|j| p[0] - sites[*j][0] <= MERGE).find(near);
            let best = before.or_else(|| (i..sites.len()).take_while(|j| sites[*j][0] - p[0] <= MERGE).find(near));
            match best {
                Some(j) => {
                    found.moved |= distance(sites[j], p) > BEND;
                    found.bent |= sites[j] != p;
                    self.candidates[i].site = sites[j];
                }
                None => kept[i] = true,
            }
        }
        self.candidates.sort_unstable_by(|p, q| before(p.site, q.site).then(p.end.cmp(&q.end)));
    }

    /// Finds the segments that a node lies on.
    fn place(&self, node: usize, found: &mut Found) {
        let site = found.sites[node];
        for &(segment, s) in &self.local {
            if s.a == site || s.b == site {
                continue;
            }
            let d = s.distance(site);
            if d > REACH + SLACK {
                continue;
            }
            if d > REACH {
                found.close = true;
                continue;
            }
            found.bent |= d > 0.0;
            found.moved |= d > BEND;
            found.incidences.push(Incidence { segment, node: node as u32, position: s.position(site) });
        }
    }
}
