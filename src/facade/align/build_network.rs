//! From the words of a group to the rows of an alignment network. Which words are aligned is chosen
//! in `select`.

use std::collections::BTreeSet;

use super::network::{Network, Wildcard};
use super::place::ENDLESS;
use super::row::Row;
use crate::candidate::axis_task::Window;
use crate::candidate::letter::{Length, MeasuredLetter};
use crate::candidate::words::Word;

/// With more words than this, equal words are merged even if that may lose alignments. With a higher
/// limit, facades of many layers that share a word have one row for each, and their search ends at
/// the budget; with a lower one, small facades could miss the best alignment, though theirs can be
/// searched as it is.
const FEW_WORDS: usize = 6;

/// A network, and the row of each line of its group.
pub struct Built {
    /// The network.
    pub network: Network,
    /// The number of each line's row.
    pub row_of_line: Vec<usize>,
}

/// The network of a group's words, the uppermost first. `wildcards` is the number of wildcards on the
/// axis. The alignment tells the lengths of the wildcards in `kept` apart, because other groups use
/// them too.
///
/// Equal words become one row if they may as well be read alike: a control word that several layers
/// share is aligned once. Among few words, only those are merged where it is certain that nothing is
/// lost; among many, all that any entry may cover.
pub fn build_network(
    wildcards: usize,
    words: &[&Word],
    window: Window,
    kept: &BTreeSet<usize>,
) -> Built {
    let merging = Merging::of(words);
    let mut rows: Vec<Row> = Vec::new();
    let mut row_of_line = Vec::new();
    let mut above = 0;
    let mut copies = vec![0; wildcards];
    for word in words {
        for (wildcard, count) in &word.wildcards {
            copies[*wildcard] += count;
        }
        let may_merge = merging.allows(word);
        let same = rows
            .iter()
            .position(|row| row.letters == word.measured && may_merge);
        row_of_line.push(same.unwrap_or(rows.len()));
        if same.is_none() {
            let need = window.shortest - above;
            rows.push(Row::new(word.measured.clone(), above > 0, need));
        }
        above += word.opaque;
    }
    let wildcards = copies
        .into_iter()
        .enumerate()
        .map(|(w, copies)| wildcard(w, &rows, copies, kept.contains(&w)))
        .collect();
    let network = Network {
        rows,
        wildcards,
        longest: window.longest,
        is_thrifty: false,
        lower_bound: None,
    };
    Built {
        network,
        row_of_line,
    }
}

/// Which equal words may become one row.
struct Merging {
    /// No flag of any letter can decide whether two equal words are read alike.
    flags_idle: bool,
    is_crowded: bool,
}

impl Merging {
    fn of(words: &[&Word]) -> Merging {
        let letters = || words.iter().flat_map(|w| &w.measured);
        let base_is_opaque = words
            .first()
            .is_some_and(|w| w.measured.iter().all(|l| l.opaque));
        let no_conflict =
            letters().all(|l| !l.unoccludable) || letters().all(|l| l.opaque || l.transparent);
        Merging {
            flags_idle: base_is_opaque && no_conflict,
            is_crowded: words.len() > FEW_WORDS,
        }
    }

    fn allows(&self, word: &Word) -> bool {
        let bears_all = word.measured.iter().all(|l| !l.unoccludable);
        let is_plain = bears_all && word.measured.iter().all(|l| !l.opaque);
        self.flags_idle || is_plain || self.is_crowded && bears_all
    }
}

/// What the rows demand of a wildcard: where it is the only one of a row, it fills what rule R5 asks
/// of that row.
fn wildcard(number: usize, rows: &[Row], copies: i64, kept: bool) -> Wildcard {
    let letters = rows
        .iter()
        .flat_map(|r| &r.wildcards)
        .filter(|(_, v)| *v == number)
        .count();
    let only = rows
        .iter()
        .filter(|r| !r.wildcards.is_empty() && r.wildcards.iter().all(|(_, v)| *v == number));
    let least = only.map(|r| {
        let count = r.wildcards.len() as i64;
        (r.need - r.steps(0, r.count()) + count - 1).div_euclid(count)
    });
    Wildcard {
        least: least.max().unwrap_or(1).clamp(1, ENDLESS),
        loose: letters == 1 && !kept,
        kept,
        copies,
    }
}

/// The network with these lengths in place of its wildcards.
pub fn with_lengths(network: &Network, lengths: &[i64]) -> Network {
    let known = |letter: &MeasuredLetter| match letter.length {
        Length::Wildcard(w) => MeasuredLetter {
            length: Length::Steps(lengths[w]),
            ..*letter
        },
        Length::Steps(_) => *letter,
    };
    let rows = network
        .rows
        .iter()
        .map(|r| Row::new(r.letters.iter().map(known).collect(), r.yields, r.need))
        .collect();
    Network {
        rows,
        wildcards: network.wildcards.clone(),
        lower_bound: None,
        ..*network
    }
}
