//! Putting the rows of a group's words together for the alignment, and the alignments of several
//! groups together for the facade. Which of them are wanted is not known here.

use std::collections::BTreeSet;

use super::candidate::{Window, Word};
use super::network::{ENDLESS, Network, Wildcard};
use super::row::{Cell, Length, Row};
use super::search::Alignment;

/// The different lengths of wildcards of one candidate that are compared.
const MOST_LENGTHS: usize = 256;

/// The letters of a wildcard in all groups.
pub fn copies(networks: &[Network], wildcard: usize) -> i64 {
    networks.iter().map(|n| n.wildcards[wildcard].copies).sum()
}

/// Calls `see` with one alignment per group, where the lengths of `shared` wildcards agree.
pub fn pick<'a>(
    groups: &'a [Vec<Alignment>],
    shared: &BTreeSet<usize>,
    bound: i64,
    picked: &mut Vec<&'a Alignment>,
    see: &mut dyn FnMut(&[&'a Alignment]),
) {
    if picked.iter().map(|a| a.error).sum::<i64>() > bound {
        return;
    }
    let lengths = meet(picked);
    if shared
        .iter()
        .any(|w| lengths.get(*w).is_some_and(|(least, most)| least > most))
    {
        return;
    }
    let Some(list) = groups.get(picked.len()) else {
        return see(picked);
    };
    for alignment in list {
        picked.push(alignment);
        pick(groups, shared, bound, picked, see);
        picked.pop();
    }
}

/// The lengths that all alignments allow.
pub fn meet(picked: &[&Alignment]) -> Vec<(i64, i64)> {
    let Some((first, rest)) = picked.split_first() else {
        return Vec::new();
    };
    let mut lengths = first.lengths.clone();
    for other in rest {
        lengths
            .iter_mut()
            .zip(&other.lengths)
            .for_each(|(a, b)| *a = (a.0.max(b.0), a.1.min(b.1)));
    }
    lengths
}

/// The shortest lengths within `lengths` that make every row of every group as long as it must be.
pub fn settle(networks: &[Network], lengths: &[(i64, i64)]) -> Option<Vec<i64>> {
    let mut lengths = lengths.to_vec();
    for network in networks {
        let least = network.settle(&lengths)?;
        lengths
            .iter_mut()
            .zip(least)
            .for_each(|(l, least)| l.0 = least);
    }
    Some(lengths.into_iter().map(|l| l.0).collect())
}

/// Adds the whole lengths within `lengths` that meet the rows' needs: all of them where they are few.
pub fn points(networks: &[Network], lengths: &[(i64, i64)], found: &mut BTreeSet<Vec<i64>>) {
    let used: Vec<bool> = (0..lengths.len())
        .map(|w| copies(networks, w) > 0)
        .collect();
    let mut all = vec![Vec::new()];
    for ((least, most), used) in lengths.iter().zip(used) {
        let most = if used { *most } else { *least };
        let mut longer = Vec::new();
        for point in &all {
            for value in *least..=most.min(least + 64) {
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
            if settle(networks, &exact).is_some() {
                found.insert(point);
            }
        }
    }
}

/// The network with the lengths of its wildcards put in.
pub fn with_lengths(network: &Network, lengths: &[i64]) -> Network {
    let known = |cell: &Cell| match cell.length {
        Length::Wildcard(w) => Cell {
            length: Length::Steps(lengths[w]),
            ..*cell
        },
        Length::Steps(_) => *cell,
    };
    let rows = network
        .rows
        .iter()
        .map(|r| Row::new(r.cells.iter().map(known).collect(), r.yields, r.need))
        .collect();
    Network {
        rows,
        wildcards: network.wildcards.clone(),
        outlook: None,
        ..*network
    }
}

/// With more words than this, all equal ones are read alike.
const FEW_WORDS: usize = 6;

/// The rows of a group's words, without those that may as well be read like an equal one above them
/// (control words that layers share are aligned once), and the row of each line. Of few words only those are left out of
/// which that is sure; of many, all that bear the same above them. Lengths of the
/// wildcards in `kept` are told apart by the alignment.
pub fn build(
    wildcards: usize,
    words: &[&Word],
    window: Window,
    kept: &BTreeSet<usize>,
) -> (Network, Vec<usize>) {
    let cells = || words.iter().flat_map(|w| &w.cells);
    let is_plain = |w: &Word| w.cells.iter().all(|c| !c.opaque && !c.unoccludable);
    let flags_idle = words
        .first()
        .is_some_and(|w| w.cells.iter().all(|c| c.opaque))
        && (cells().all(|c| !c.unoccludable) || cells().all(|c| c.opaque || c.transparent));
    let bears_all = |w: &Word| w.cells.iter().all(|c| !c.unoccludable);
    let mut rows: Vec<Row> = Vec::new();
    let mut of_line = Vec::new();
    let mut above = 0;
    let mut copies = vec![0; wildcards];
    for word in words {
        word.wildcards
            .iter()
            .for_each(|(w, count)| copies[*w] += count);
        let is_alike = flags_idle || is_plain(word) || words.len() > FEW_WORDS && bears_all(word);
        let same = rows
            .iter()
            .position(|row| row.cells == word.cells && is_alike);
        of_line.push(same.unwrap_or(rows.len()));
        if same.is_none() {
            rows.push(Row::new(
                word.cells.clone(),
                above > 0,
                window.shortest - above,
            ));
        }
        above += word.opaque;
    }
    let wildcards = (0..wildcards).map(|w| {
        let letters = rows
            .iter()
            .flat_map(|r| &r.wildcards)
            .filter(|(_, v)| *v == w)
            .count();
        let only = rows
            .iter()
            .filter(|r| !r.wildcards.is_empty() && r.wildcards.iter().all(|(_, v)| *v == w));
        let least = only.map(|r| {
            let count = r.wildcards.len() as i64;
            (r.need - r.steps(0, r.letters()) + count - 1).div_euclid(count)
        });
        Wildcard {
            least: least.max().unwrap_or(1).clamp(1, ENDLESS),
            loose: letters == 1 && !kept.contains(&w),
            kept: kept.contains(&w),
            copies: copies[w],
        }
    });
    let wildcards = wildcards.collect();
    (
        Network {
            rows,
            wildcards,
            longest: window.longest,
            is_thrifty: false,
            outlook: None,
        },
        of_line,
    )
}
