//! The alignments of several groups together. Groups are aligned one by one (rule R4), but a wildcard
//! has one length in all of them.

use std::collections::BTreeSet;

use crate::align::network::Network;
use crate::align::search::Alignment;

/// The most lengths of wildcards that are compared for one candidate. More would rarely differ in
/// their sizes, and each costs a search for co-optimal alignments; with fewer, the shortest
/// wildcards may be missed.
const MOST_LENGTHS: usize = 256;
/// The greatest length that is tried for one wildcard, beyond its least one, in steps. Lengths above
/// it lose against shorter ones that have the same error (rule R9).
const MOST_EXTRA: i64 = 64;

/// The alignments of each group, of which one a group is to be picked.
pub struct Picking<'a> {
    /// The alignments of each group.
    pub groups: &'a [Vec<Alignment>],
    /// The wildcards that several groups use.
    pub shared: &'a BTreeSet<usize>,
    /// The greatest error of all picked alignments together.
    pub bound: i64,
}

impl<'a> Picking<'a> {
    /// Calls `see` with every pick of one alignment a group whose lengths of shared wildcards agree.
    pub fn each(&self, see: &mut dyn FnMut(&[&'a Alignment])) {
        self.extend(&mut Vec::new(), see);
    }

    fn extend(&self, picked: &mut Vec<&'a Alignment>, see: &mut dyn FnMut(&[&'a Alignment])) {
        if picked.iter().map(|a| a.error).sum::<i64>() > self.bound {
            return;
        }
        let lengths = common_lengths(picked);
        let is_empty = |w: &usize| lengths.get(*w).is_some_and(|(least, most)| least > most);
        if self.shared.iter().any(is_empty) {
            return;
        }
        let Some(list) = self.groups.get(picked.len()) else {
            return see(picked);
        };
        for alignment in list {
            picked.push(alignment);
            self.extend(picked, see);
            picked.pop();
        }
    }
}

/// The number of letters of a wildcard in all groups.
pub fn copies(networks: &[Network], wildcard: usize) -> i64 {
    networks.iter().map(|n| n.wildcards[wildcard].copies).sum()
}

/// For each wildcard, the least and the greatest length that all picked alignments allow.
pub fn common_lengths(picked: &[&Alignment]) -> Vec<(i64, i64)> {
    let Some((first, rest)) = picked.split_first() else {
        return Vec::new();
    };
    let mut lengths = first.lengths.clone();
    for other in rest {
        for (a, b) in lengths.iter_mut().zip(&other.lengths) {
            *a = (a.0.max(b.0), a.1.min(b.1));
        }
    }
    lengths
}

/// The shortest lengths within `lengths` that make every row of every group as long as rule R5 asks;
/// `None` if no lengths do.
pub fn shortest_lengths(networks: &[Network], lengths: &[(i64, i64)]) -> Option<Vec<i64>> {
    let mut lengths = lengths.to_vec();
    for network in networks {
        let least = network.settle(&lengths)?;
        for (length, least) in lengths.iter_mut().zip(least) {
            length.0 = least;
        }
    }
    Some(lengths.into_iter().map(|l| l.0).collect())
}

/// Adds the whole lengths within `lengths` that make every row as long as rule R5 asks, as far as
/// there are not too many of them.
pub fn whole_lengths(networks: &[Network], lengths: &[(i64, i64)], found: &mut BTreeSet<Vec<i64>>) {
    let mut all = vec![Vec::new()];
    for (wildcard, (least, most)) in lengths.iter().enumerate() {
        let is_used = copies(networks, wildcard) > 0;
        let most = if is_used { *most } else { *least };
        let mut longer = Vec::new();
        for point in &all {
            for value in *least..=most.min(least + MOST_EXTRA) {
                let mut next: Vec<i64> = point.clone();
                next.push(value);
                longer.push(next);
            }
        }
        longer.truncate(MOST_LENGTHS);
        all = longer;
    }
    for point in all {
        if found.len() < MOST_LENGTHS {
            let exact: Vec<(i64, i64)> = point.iter().map(|v| (*v, *v)).collect();
            if shortest_lengths(networks, &exact).is_some() {
                found.insert(point);
            }
        }
    }
}
