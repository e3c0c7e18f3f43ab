//! What the steps of a selection share: the candidates' words, the networks made of them, the sizes
//! found so far, and the best layout so far.

use std::collections::{BTreeMap, BTreeSet};

use crate::align::build_network::{Built, build_network};
use crate::align::network::Network;
use crate::align::place::Place;
use crate::align::search::{Alignment, Effort};
use crate::budget::Budget;
use crate::candidate::axis_task::{AxisTask, Window};
use crate::candidate::choice::Choice;
use crate::candidate::words::Word;
use crate::pattern::word::Environment;
use crate::size::least_squares::{Equation, Sizes, size};

/// The cost of finding sizes, in steps: about the time of so many nodes of the search. If it is set
/// too low, the comparison of sizes takes longer than the search; if too high, ties are decided by
/// the first alignments that were found.
pub const SIZE_STEPS: u64 = 200;

/// A layout of an axis.
#[derive(Clone, Debug)]
pub struct Layout {
    /// The alignment error in steps.
    pub error: i64,
    /// A size for each symbol, and the size error.
    pub sizes: Sizes,
    /// The total length of the letters of wildcards, in steps.
    pub length: i64,
    /// The counters.
    pub counters: Environment,
    /// The alignment of each group.
    pub groups: Vec<Aligned>,
    /// Whether the layout was compared with all others that may be as good.
    pub is_sure: bool,
}

/// A group's part in a layout.
#[derive(Clone, Debug)]
pub struct Aligned {
    /// The rows; lines with the same word may share one.
    pub network: Network,
    /// For each line of the group: the number of its row, and its word.
    pub lines: Vec<(usize, Word)>,
    /// The places in all rows, at the start and after every column.
    pub path: Vec<Vec<Place>>,
}

/// A choice of words for every group.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The number of each group's choice.
    pub choices: Vec<usize>,
    /// The counters of all groups.
    pub counters: Environment,
    /// A lower bound of the error.
    pub bound: i64,
}

/// A candidate with its best alignments.
pub struct Found {
    /// The candidate.
    pub candidate: Candidate,
    /// The error of all groups together.
    pub error: i64,
    /// The alignment of each group.
    pub groups: Vec<Alignment>,
}

/// A group, its choice, and the wildcards that are kept.
pub type GroupKey = (usize, usize, Vec<usize>);

/// The contest of all candidates at one tolerance.
pub struct Contest<'a, 'b> {
    /// The axis.
    pub task: &'a AxisTask<'a>,
    /// The words of each pattern.
    pub words: &'a [Vec<Word>],
    /// What the canvas and the tolerance leave.
    pub window: Window,
    /// The choices of each group.
    pub choices: &'a [Vec<Choice>],
    /// Alignments of groups, with the bound that they were searched up to.
    pub memo: BTreeMap<GroupKey, (i64, Vec<Alignment>)>,
    /// Sizes by the equations that they meet; none if no sizes do.
    pub known_sizes: BTreeMap<BTreeSet<Equation>, Option<Sizes>>,
    /// Whether a candidate can be sized at all, by its choices.
    pub sizable: BTreeMap<Vec<usize>, bool>,
    /// How thoroughly to search.
    pub effort: Effort,
    /// The steps that are left.
    pub budget: &'b mut Budget,
    /// The best layout so far.
    pub best: Option<Layout>,
    /// Whether all layouts were compared that may be as good as the best.
    pub is_sure: bool,
}

impl Contest<'_, '_> {
    /// The words of a group's choice, one for each line of the group.
    pub fn chosen(&self, group: usize, choice: usize) -> impl Iterator<Item = &Word> {
        let lines = self.task.lines.iter().filter(move |l| l.group == group);
        let chosen = self.choices[group][choice].words.iter();
        lines
            .zip(chosen)
            .map(|(line, number)| &self.words[line.pattern][*number])
    }

    /// The network of a group's choice, and the row of each line.
    pub fn network(&self, group: usize, choice: usize, kept: &BTreeSet<usize>) -> Built {
        let words: Vec<&Word> = self.chosen(group, choice).collect();
        let mut built = build_network(self.task.wildcards.len(), &words, self.window, kept);
        built.network.is_thrifty = self.effort != Effort::Exact;
        built
    }

    /// The networks of a candidate's groups.
    pub fn networks(&self, candidate: &Candidate, kept: &BTreeSet<usize>) -> Vec<Network> {
        let choices = candidate.choices.iter().enumerate();
        choices
            .map(|(group, choice)| self.network(group, *choice, kept).network)
            .collect()
    }

    /// The wildcards that several groups of a candidate use.
    pub fn shared_wildcards(&self, candidate: &Candidate) -> BTreeSet<usize> {
        let mut seen = BTreeSet::new();
        let mut shared = BTreeSet::new();
        for (group, choice) in candidate.choices.iter().enumerate() {
            let own: BTreeSet<usize> = self
                .chosen(group, *choice)
                .flat_map(|w| w.wildcards.keys().copied())
                .collect();
            shared.extend(own.intersection(&seen).copied().collect::<Vec<_>>());
            seen.extend(own);
        }
        shared
    }

    /// The sizes that meet all of `equations`, found once.
    pub fn sizes(&mut self, equations: BTreeSet<Equation>) -> Option<Sizes> {
        if let Some(known) = self.known_sizes.get(&equations) {
            return known.clone();
        }
        let list: Vec<Equation> = equations.iter().cloned().collect();
        let sizes = size(&self.task.preferences(), &list, self.task.canvas);
        self.known_sizes.insert(equations, sizes.clone());
        sizes
    }
}
