//! What happens in one cell of the bins: where segments cross, which sites become nodes, and
//! which segments every node lies on. Cells that hold too many segments are split. What the
//! segments become is told in `noding`.

use crate::budget;
use crate::planar_map::noding::bins::{Bins, Cells};
use crate::planar_map::noding::candidate::{Candidate, MERGE, REACH};
use crate::planar_map::noding::clusters::merge;
use crate::planar_map::noding::exact::{Segment, before, crossing, distance};
use crate::planar_map::noding::order::in_reading_order;
use crate::planar_map::noding::snap_grid::Site;

/// Bends up to this are harmless: nothing else was within REACH + SLACK, hence nothing is within
/// REACH after them.
const BEND: f64 = REACH / 16.0;
const SLACK: f64 = 4.0 * BEND;

/// Cells with more segments are split if that helps.
const CROWD: usize = 48;

/// What is charged for, and the steps for a place where something may be and for a segment that meets a node.
const WORK: &str = "meetings of curves";
const CANDIDATE: usize = 10;
/// Steps for a segment when its cell is split.
const SPLIT: usize = 20;
const INCIDENCE: usize = 30;

/// With more nodes on segments than this the work is given up.
pub(in crate::planar_map) const MOST: usize = 1 << 28;

/// What was found in some cells.
#[derive(Default)]
pub(in crate::planar_map) struct Found {
    /// The nodes, in reading order at last.
    pub sites: Vec<Site>,
    /// What is to be added to the numbers of nodes here when the parts are put together.
    pub base: u32,
    /// For ends of segments (2 × segment, + 1 for b) the node they are at.
    pub ends: Vec<(u32, u32)>,
    /// Segment and node for nodes on segments, other than their ends.
    pub incidences: Vec<(u32, u32)>,
    /// Segments left out because they equal an earlier one, and that one.
    pub same: Vec<(u32, u32)>,
    /// Nodes for which a segment or a site moves farther than a harmless bend.
    pub moved: Vec<u32>,
    /// Nodes so little out of reach of a segment that a bend may bring them into it.
    pub close: Vec<u32>,
    /// Whether a segment bends at all.
    pub bent: bool,
}

/// A segment near the cell.
struct Local {
    segment: Segment,
    number: u32,
    left: f64,
    right: f64,
    /// Length × (REACH + SLACK): what the vector product with a site that matters does not exceed.
    reach: f64,
}

/// The work in one cell after another, with the buffers that it reuses.
pub(in crate::planar_map) struct CellWork<'a> {
    segments: &'a [Segment],
    /// The cell and the cells it was split from; a site is owned when all of them own it.
    territory: Vec<(Cells, usize)>,
    local: Vec<Local>,
    candidates: Vec<Candidate>,
    found: Found,
    /// Work that was not charged yet, in steps.
    steps: u64,
}

impl<'a> CellWork<'a> {
    /// No cells yet.
    pub fn new(segments: &'a [Segment]) -> CellWork<'a> {
        let (territory, local, candidates) = (Vec::new(), Vec::new(), Vec::new());
        CellWork {
            segments,
            territory,
            local,
            candidates,
            found: Found::default(),
            steps: 0,
        }
    }

    /// What was found, with the nodes in reading order.
    pub fn finish(self) -> Found {
        budget::spend(WORK, self.steps);
        let mut found = self.found;
        let order = in_reading_order(&found.sites);
        let mut number = vec![0u32; order.len()];
        found.sites.clear();
        for (place, (site, i)) in (0u32..).zip(order) {
            number[i as usize] = place;
            found.sites.push(site);
        }
        found.sites.shrink_to_fit();
        let renumber = |v: &mut u32| *v = number[*v as usize];
        found
            .ends
            .iter_mut()
            .chain(&mut found.incidences)
            .for_each(|e| renumber(&mut e.1));
        found
            .moved
            .iter_mut()
            .chain(&mut found.close)
            .for_each(renumber);
        found.ends.shrink_to_fit();
        found.incidences.shrink_to_fit();
        found
    }

    /// Finds nodes and incidences in a cell, given the segments near it.
    pub fn explore(&mut self, cells: &Cells, cell: usize, bucket: &[u32]) {
        if bucket.is_empty() || self.found.incidences.len() > MOST {
            return;
        }
        self.territory.push((*cells, cell));
        if bucket.len() > CROWD {
            self.split(cells, cell, bucket);
        } else {
            self.meet(bucket);
        }
        self.territory.pop();
    }

    /// Explores the parts of a crowded cell, or the cell at once when its parts would be as crowded.
    fn split(&mut self, cells: &Cells, cell: usize, bucket: &[u32]) {
        self.charge(SPLIT * bucket.len());
        let bucket = self.without_copies(bucket);
        let segments = self.segments;
        if let Some(parts) = cells.split(cell, bucket.iter().map(|&i| segments[i as usize])) {
            let bins = Bins::fill(parts, bucket.len(), |i| segments[bucket[i] as usize]);
            let pairs: usize = (0..parts.len()).map(|p| bins.members(p).len().pow(2)).sum();
            if 2 * pairs < bucket.len().pow(2) {
                let mut inside = Vec::new();
                for part in 0..parts.len() {
                    inside.clear();
                    inside.extend(bins.members(part).iter().map(|&i| bucket[i as usize]));
                    self.explore(&parts, part, &inside);
                }
                return;
            }
        }
        self.meet(&bucket);
    }

    /// The bucket without segments that equal another; these are noted.
    fn without_copies(&mut self, bucket: &[u32]) -> Vec<u32> {
        let segment = |i: u32| &self.segments[i as usize];
        let mut sorted = bucket.to_vec();
        sorted.sort_unstable_by(|&i, &j| {
            let (s, t) = (segment(i), segment(j));
            before(s.a, t.a)
                .then_with(|| before(s.b, t.b))
                .then(i.cmp(&j))
        });
        let mut kept: Vec<u32> = Vec::with_capacity(sorted.len());
        for i in sorted {
            match kept.last() {
                Some(&first) if segment(first) == segment(i) => self.found.same.push((i, first)),
                _ => kept.push(i),
            }
        }
        kept
    }

    /// Compares all segments of a bucket with one another.
    fn meet(&mut self, bucket: &[u32]) {
        self.local.clear();
        self.candidates.clear();
        for &number in bucket {
            let s = self.segments[number as usize];
            let (left, right) = (s.a[0].min(s.b[0]), s.a[0].max(s.b[0]));
            let reach = distance(s.a, s.b) * (REACH + SLACK);
            self.local.push(Local {
                segment: s,
                number,
                left,
                right,
                reach,
            });
            for (site, end) in [(s.a, 2 * number), (s.b, 2 * number + 1)] {
                if self.owns(site) {
                    self.candidates.push(Candidate { site, end });
                }
            }
        }
        // Half as many pairs, which mostly are apart.
        self.charge(bucket.len() * bucket.len() / 5);
        self.cross();
        let first = self.found.sites.len();
        self.charge(CANDIDATE * self.candidates.len());
        self.name_nodes();
        self.charge((self.found.sites.len() - first) * bucket.len() / 4);
        let before = self.found.incidences.len();
        for node in first..self.found.sites.len() {
            self.place(node);
        }
        self.charge(INCIDENCE * (self.found.incidences.len() - before));
    }

    /// Charges for `steps` steps, many cells at a time.
    fn charge(&mut self, steps: usize) {
        self.steps += steps as u64;
        if self.steps > 100_000 {
            budget::spend(WORK, std::mem::take(&mut self.steps));
        }
    }

    fn owns(&self, site: Site) -> bool {
        self.territory
            .iter()
            .all(|(cells, cell)| cells.owner(site) == *cell)
    }

    /// Adds the crossings of all pairs.
    fn cross(&mut self) {
        let mut limit = 1 << 16;
        for (k, p) in self.local.iter().enumerate() {
            let s = &p.segment;
            for q in &self.local[k + 1..] {
                let t = &q.segment;
                let apart =
                    s.a[1] > t.b[1] || t.a[1] > s.b[1] || p.left > q.right || q.left > p.right;
                if apart || s.a == t.a || s.b == t.b || s.a == t.b || s.b == t.a {
                    continue;
                }
                let Some(site) = crossing(s, t) else { continue };
                // A crossing beside an end is the end's own touch.
                if self.owns(site)
                    && [s.a, s.b, t.a, t.b]
                        .iter()
                        .all(|e| distance(*e, site) > MERGE)
                {
                    self.candidates.push(Candidate {
                        site,
                        end: Candidate::CROSSING,
                    });
                }
            }
            // Where thousands of segments cross in few sites the copies are not all kept.
            if self.candidates.len() > limit {
                self.candidates.sort_unstable_by(Candidate::order);
                self.candidates
                    .dedup_by(|b, a| a.site == b.site && b.end == Candidate::CROSSING);
                limit = 2 * self.candidates.len() + (1 << 16);
            }
        }
    }

    /// Makes nodes of the candidates, one of all that are at the same site.
    fn name_nodes(&mut self) {
        self.candidates.sort_unstable_by(Candidate::order);
        let far = merge(&mut self.candidates, BEND);
        self.found.bent |= far.is_some();
        let far = far.unwrap_or_default();
        let mut last = None;
        for c in &self.candidates {
            if last != Some(c.site) {
                if far.contains(&c.site) {
                    self.found.moved.push(self.found.sites.len() as u32);
                }
                self.found.sites.push(c.site);
                last = Some(c.site);
            }
            if c.end != Candidate::CROSSING {
                self.found
                    .ends
                    .push((c.end, self.found.sites.len() as u32 - 1));
            }
        }
    }

    /// Finds the segments that a node lies on.
    fn place(&mut self, node: usize) {
        let site = self.found.sites[node];
        for local in &self.local {
            let s = &local.segment;
            let (d, w) = (s.delta(), [site[0] - s.a[0], site[1] - s.a[1]]);
            if (d[0] * w[1] - d[1] * w[0]).abs() > local.reach || s.a == site || s.b == site {
                continue;
            }
            let along = d[0] * w[0] + d[1] * w[1];
            if along <= 0.0 || along >= d[0] * d[0] + d[1] * d[1] {
                // Beyond an end only the end counts. It may be another cell's: `routes` merges the two.
                if distance(site, s.a) <= REACH || distance(site, s.b) <= REACH {
                    self.found.moved.push(node as u32);
                    self.found.incidences.push((local.number, node as u32));
                }
                continue;
            }
            let distance = s.distance(site);
            if distance <= REACH {
                self.found.bent |= distance > 0.0;
                if distance > BEND {
                    self.found.moved.push(node as u32);
                }
                self.found.incidences.push((local.number, node as u32));
            } else if distance <= REACH + SLACK {
                self.found.close.push(node as u32);
            }
        }
    }
}
