//! The choice of a layout at one tolerance (rule R9): all candidates compete, first by the error of
//! their alignments, then by how little the sizes must change, then by the length of their
//! wildcards, then by columns.

use std::collections::{BTreeMap, BTreeSet};

use super::assembly::{build, meet, pick};
use super::budget::Budget;
use super::candidate::{Axis, Window, Word};
use super::choice::{Choice, join};
use super::network::{Network, Place, Wildcard};
use super::search::{Alignment, Width, align};
use super::sizing::{Equation, Sizes};
use super::word::Environment;

/// A layout of an axis.
#[derive(Clone, Debug)]
pub struct Layout {
    /// The alignment error in steps.
    pub error: i64,
    /// A size per symbol, and what they differ from the preferred ones.
    pub sizes: Sizes,
    /// The total length of the letters of wildcards, in steps.
    pub length: i64,
    /// The counters.
    pub counters: Environment,
    /// Per group.
    pub groups: Vec<Aligned>,
    /// Whether it was compared with all others that may be as good.
    pub is_sure: bool,
}

/// A group's part in a layout.
#[derive(Clone, Debug)]
pub struct Aligned {
    /// The rows; lines with the same word may share one.
    pub network: Network,
    /// The row of each line of the group, and its word.
    pub lines: Vec<(usize, Word)>,
    /// Where the rows are read to: at the start, and after every column.
    pub path: Vec<Vec<Place>>,
}

/// What there is within a window.
pub struct Outcome {
    /// The best layout.
    pub layout: Option<Layout>,
    /// Whether there was an alignment that cannot be sized.
    pub is_unsizable: bool,
}

/// The best layout within `window`.
pub fn select(
    axis: &Axis,
    words: &[Vec<Word>],
    window: Window,
    width: Width,
    budget: &mut Budget,
) -> Outcome {
    let choices: Vec<Vec<Choice>> = (0..axis.groups)
        .map(|g| axis.choices(g, words, window, budget))
        .collect();
    let mut candidates = Vec::new();
    combine(
        &choices,
        &Environment::new(),
        &mut Vec::new(),
        0,
        window.error,
        budget,
        &mut candidates,
    );
    candidates.sort_by_key(|c| c.bound);
    let mut selection = Selection {
        axis,
        words,
        window,
        choices: &choices,
        memo: BTreeMap::new(),
        known_sizes: BTreeMap::new(),
        width,
        budget,
        best: None,
        is_sure: true,
        sizable: BTreeMap::new(),
    };
    let mut is_unsizable = false;
    // What cannot be sized is no layout: others compete in its place.
    while let Some(found) =
        Some(selection.least_error(&candidates)).filter(|found| !found.is_empty())
    {
        let tried: BTreeSet<Vec<usize>> =
            found.iter().map(|f| f.candidate.choices.clone()).collect();
        selection.sized(found);
        is_unsizable |= selection.best.is_none();
        if selection.best.is_some() || selection.budget.exhausted {
            break;
        }
        candidates.retain(|c| !tried.contains(&c.choices));
    }
    let is_sure = selection.is_sure;
    Outcome {
        layout: selection.best.map(|best| Layout { is_sure, ..best }),
        is_unsizable,
    }
}

/// A choice of words for every group.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Number of each group's choice.
    pub choices: Vec<usize>,
    /// The counters of all groups.
    pub counters: Environment,
    /// A lower bound of the error.
    pub bound: i64,
}

/// A group, its choice, and the wildcards that are kept.
type GroupKey = (usize, usize, Vec<usize>);

/// A candidate with its best alignments.
pub struct Found {
    /// The candidate.
    pub candidate: Candidate,
    /// The error of all groups.
    pub error: i64,
    /// The alignment of each group.
    pub groups: Vec<Alignment>,
}

/// The candidates at one tolerance, and the best layout so far.
pub struct Selection<'a, 'b> {
    /// The axis.
    pub axis: &'a Axis<'a>,
    words: &'a [Vec<Word>],
    window: Window,
    choices: &'a [Vec<Choice>],
    /// Alignments of groups by choice and kept wildcards, with the bound they were searched to.
    memo: BTreeMap<GroupKey, (i64, Vec<Alignment>)>,
    /// Sizes by what they must meet.
    pub known_sizes: BTreeMap<BTreeSet<Equation>, Option<Sizes>>,
    /// How widely to search.
    pub width: Width,
    /// The steps that are left.
    pub budget: &'b mut Budget,
    /// The best layout so far.
    pub best: Option<Layout>,
    /// Whether there are sizes that a candidate can have, whatever its alignment.
    pub sizable: BTreeMap<Vec<usize>, bool>,
    /// Whether all layouts were compared that may be as good as the best.
    pub is_sure: bool,
}

fn combine(
    choices: &[Vec<Choice>],
    counters: &Environment,
    taken: &mut Vec<usize>,
    bound: i64,
    most: i64,
    budget: &mut Budget,
    found: &mut Vec<Candidate>,
) {
    let Some(list) = choices.get(taken.len()) else {
        return found.push(Candidate {
            choices: taken.clone(),
            counters: counters.clone(),
            bound,
        });
    };
    for (number, choice) in list.iter().enumerate() {
        if !budget.spend(1) || bound + choice.bound > most {
            return;
        }
        if let Some(joined) = join(counters, &choice.counters) {
            taken.push(number);
            combine(
                choices,
                &joined,
                taken,
                bound + choice.bound,
                most,
                budget,
                found,
            );
            taken.pop();
        }
    }
}

impl Selection<'_, '_> {
    /// The candidates whose alignments have the least error of all.
    fn least_error(&mut self, candidates: &[Candidate]) -> Vec<Found> {
        let Some(first) = candidates.first() else {
            return Vec::new();
        };
        let mut bound = if self.width != Width::Exact {
            self.window.error
        } else {
            first.bound
        };
        loop {
            let mut found: Vec<Found> = Vec::new();
            let mut least = bound;
            for candidate in candidates.iter().take_while(|c| c.bound <= bound) {
                if candidate.bound > least {
                    break;
                }
                // At first a search is cheaper than the question.
                if bound > first.bound && !self.can_be_sized(candidate) {
                    continue;
                }
                if let Some(groups) = self
                    .aligned(candidate, least)
                    .filter(|_| self.can_be_sized(candidate))
                {
                    let error = groups.iter().map(|a| a.error).sum();
                    if error < least {
                        found.clear();
                        least = error;
                    }
                    found.push(Found {
                        candidate: candidate.clone(),
                        error,
                        groups,
                    });
                }
                if self.budget.exhausted {
                    break;
                }
            }
            if !found.is_empty() || bound >= self.window.error || self.budget.exhausted {
                found.retain(|f| f.error == least);
                return found;
            }
            bound = (bound * 2).max(1).min(self.window.error);
        }
    }

    /// The groups' alignments of least error, then least length of wildcards, then most columns.
    fn aligned(&mut self, candidate: &Candidate, bound: i64) -> Option<Vec<Alignment>> {
        let shared = self.shared_wildcards(candidate);
        let bounds: Vec<i64> = candidate
            .choices
            .iter()
            .enumerate()
            .map(|(g, c)| self.choices[g][*c].bound)
            .collect();
        let mut rest: i64 = bounds.iter().sum();
        let mut used = 0;
        let mut per_group = Vec::new();
        for (group, choice) in candidate.choices.iter().enumerate() {
            rest -= bounds[group];
            let all = self.align_group(group, *choice, &shared, bound - used - rest);
            used += all.iter().map(|a| a.error).min()?;
            per_group.push(all);
        }
        let copies = |group: usize| {
            self.network(group, candidate.choices[group], &shared)
                .0
                .wildcards
        };
        let wildcards: Vec<Vec<Wildcard>> = (0..per_group.len()).map(copies).collect();
        let mut best: Option<((i64, i64, i64), Vec<Alignment>)> = None;
        pick(&per_group, &shared, bound, &mut Vec::new(), &mut |picked| {
            let error: i64 = picked.iter().map(|a| a.error).sum();
            let columns: i64 = picked.iter().map(|a| a.path.len() as i64).sum();
            let lengths = meet(picked);
            let copies = |w: usize| wildcards.iter().map(|g| g[w].copies).sum::<i64>();
            let length = lengths
                .iter()
                .enumerate()
                .map(|(w, l)| l.0.saturating_mul(copies(w)))
                .sum();
            let rank = (error, length, -columns);
            if best.as_ref().is_none_or(|(other, _)| rank < *other) {
                best = Some((rank, picked.iter().map(|a| (*a).clone()).collect()));
            }
        });
        best.map(|(_, picked)| picked)
    }

    fn align_group(
        &mut self,
        group: usize,
        choice: usize,
        kept: &BTreeSet<usize>,
        bound: i64,
    ) -> Vec<Alignment> {
        let key = (group, choice, kept.iter().copied().collect::<Vec<_>>());
        if let Some((searched, all)) = self.memo.get(&key)
            && (*searched >= bound || !all.is_empty() && kept.is_empty())
        {
            return all.iter().filter(|a| a.error <= bound).cloned().collect();
        }
        let network = self.network(group, choice, kept).0;
        let found = match self.width {
            Width::Exact => align(&network, bound, self.width, self.budget),
            _ => self.align_narrow(&network, bound),
        };
        if self.axis.groups > 1 {
            self.memo.insert(key, (bound, found.clone()));
        }
        found
    }

    /// The wildcards that several groups use.
    pub fn shared_wildcards(&self, candidate: &Candidate) -> BTreeSet<usize> {
        let mut seen = BTreeSet::new();
        let mut shared = BTreeSet::new();
        for group in 0..candidate.choices.len() {
            let mine: BTreeSet<usize> = self
                .words_of(candidate, group)
                .flat_map(|w| w.wildcards.keys().copied())
                .collect();
            shared.extend(mine.intersection(&seen).copied().collect::<Vec<_>>());
            seen.extend(mine);
        }
        shared
    }

    fn words_of<'c>(
        &'c self,
        candidate: &'c Candidate,
        group: usize,
    ) -> impl Iterator<Item = &'c Word> + 'c {
        self.chosen(group, candidate.choices[group])
    }

    /// The words of a group's choice.
    pub fn chosen(&self, group: usize, choice: usize) -> impl Iterator<Item = &Word> {
        let lines = self.axis.lines.iter().filter(move |l| l.group == group);
        let chosen = self.choices[group][choice].words.iter();
        lines
            .zip(chosen)
            .map(|(line, number)| &self.words[line.pattern][*number])
    }

    /// The rows of a group's choice, without those that may as well be read like an equal one above
    /// them, and the row of each line.
    pub fn network(
        &self,
        group: usize,
        choice: usize,
        kept: &BTreeSet<usize>,
    ) -> (Network, Vec<usize>) {
        let words: Vec<&Word> = self.chosen(group, choice).collect();
        let (network, of_line) = build(self.axis.wildcards.len(), &words, self.window, kept);
        (
            Network {
                is_thrifty: self.width != Width::Exact,
                ..network
            },
            of_line,
        )
    }
}
