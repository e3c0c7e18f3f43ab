//! Sites that are nearer to one another than the resolution become one. Only sites of one cell
//! are seen here; neighbours in different cells are merged in `noding`, along the segment that they share.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::planar_map::noding::candidate::{Candidate, MERGE};
use crate::planar_map::noding::exact::{before, distance};
use crate::planar_map::noding::snap_grid::Site;

/// Moves every candidate within [`MERGE`] of a better one to the site of that one; ends of segments are
/// better than crossings, then reading order decides. Expects and leaves the candidates in
/// order. When any moved, the sites to which one came from farther than `bend`.
pub(in crate::planar_map) fn merge(candidates: &mut [Candidate], bend: f64) -> Option<Vec<Site>> {
    if !crowded(candidates) {
        return None;
    }
    let mut kept = Kept::default();
    let mut target: HashMap<[u64; 2], Site> = HashMap::new();
    let (mut moved, mut far) = (false, Vec::new());
    for crossings in [false, true] {
        for c in candidates
            .iter()
            .filter(|c| (c.end == Candidate::CROSSING) == crossings)
        {
            let Entry::Vacant(slot) = target.entry(c.site.map(f64::to_bits)) else {
                continue;
            };
            let site = kept.beside(c.site).unwrap_or(c.site);
            moved |= site != c.site;
            if distance(site, c.site) > bend {
                far.push(site);
            }
            kept.insert(site);
            slot.insert(site);
        }
    }
    for c in candidates.iter_mut() {
        c.site = target[&c.site.map(f64::to_bits)];
    }
    candidates.sort_unstable_by(Candidate::order);
    moved.then_some(far)
}

/// Whether any two different sites are within [`MERGE`].
fn crowded(candidates: &[Candidate]) -> bool {
    candidates.iter().enumerate().any(|(i, p)| {
        let mut after = candidates[i + 1..]
            .iter()
            .take_while(|q| q.site[1] - p.site[1] <= MERGE);
        after.any(|q| q.site != p.site && (q.site[0] - p.site[0]).abs() <= MERGE)
    })
}

/// The sites that stay, none within [`MERGE`] of another, in squares of that side.
#[derive(Default)]
struct Kept(HashMap<[i64; 2], Vec<Site>>);

impl Kept {
    fn square(site: Site) -> [i64; 2] {
        site.map(|v| (v / MERGE) as i64)
    }

    /// The first site that stays and is within [`MERGE`] of this one.
    fn beside(&self, site: Site) -> Option<Site> {
        let [x, y] = Kept::square(site);
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let near = around
            .filter_map(|square| self.0.get(&square))
            .flatten()
            .filter(|k| distance(**k, site) <= MERGE);
        near.copied().min_by(|p, q| before(*p, *q))
    }

    fn insert(&mut self, site: Site) {
        let sites = self.0.entry(Kept::square(site)).or_default();
        if !sites.contains(&site) {
            sites.push(site);
        }
    }
}
