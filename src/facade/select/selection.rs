//! The best layout at one tolerance (rule R9). All candidates compete: first by the error of their
//! alignments, then, in `tie_break`, by how little their sizes must change, by the length of their
//! wildcards, and by their columns.

use std::collections::{BTreeMap, BTreeSet};

use super::contest::{Candidate, Contest, Found, Layout};
use super::groups::{Picking, common_lengths};
use crate::align::network::Wildcard;
use crate::align::search::{Alignment, Effort, align};
use crate::budget::Budget;
use crate::candidate::axis_task::{AxisTask, Window};
use crate::candidate::choice::{Choice, join};
use crate::candidate::words::Word;
use crate::pattern::word::Environment;

/// What there is at one tolerance.
pub struct Outcome {
    /// The best layout.
    pub layout: Option<Layout>,
    /// Whether the best alignments of some candidates have no sizes.
    pub is_unsizable: bool,
}

/// The best layout within `window`; `words` holds the words of each pattern.
pub fn select(
    task: &AxisTask,
    words: &[Vec<Word>],
    window: Window,
    effort: Effort,
    budget: &mut Budget,
) -> Outcome {
    let choices: Vec<Vec<Choice>> = (0..task.groups)
        .map(|g| task.choices(g, words, window, budget))
        .collect();
    let mut candidates = candidates(&choices, window.error, budget);
    let mut contest = Contest {
        task,
        words,
        window,
        choices: &choices,
        memo: BTreeMap::new(),
        known_sizes: BTreeMap::new(),
        sizable: BTreeMap::new(),
        effort,
        budget,
        best: None,
        is_sure: true,
    };
    let mut is_unsizable = false;
    loop {
        let found = contest.least_error(&candidates);
        if found.is_empty() {
            break;
        }
        // A candidate that cannot be sized is no layout: the others compete without it.
        let tried: BTreeSet<Vec<usize>> =
            found.iter().map(|f| f.candidate.choices.clone()).collect();
        contest.break_ties(found);
        is_unsizable |= contest.best.is_none();
        if contest.best.is_some() || contest.budget.exhausted {
            break;
        }
        candidates.retain(|c| !tried.contains(&c.choices));
    }
    let is_sure = contest.is_sure;
    Outcome {
        layout: contest.best.map(|best| Layout { is_sure, ..best }),
        is_unsizable,
    }
}

/// The combinations of one choice a group whose counters agree, in the order of their bounds.
fn candidates(choices: &[Vec<Choice>], most: i64, budget: &mut Budget) -> Vec<Candidate> {
    let mut combining = Combining {
        choices,
        most,
        budget,
        found: Vec::new(),
    };
    combining.extend(&Candidate {
        choices: Vec::new(),
        counters: Environment::new(),
        bound: 0,
    });
    let mut found = combining.found;
    found.sort_by_key(|c| c.bound);
    found
}

struct Combining<'a> {
    choices: &'a [Vec<Choice>],
    /// The greatest bound of a candidate.
    most: i64,
    budget: &'a mut Budget,
    found: Vec<Candidate>,
}

impl Combining<'_> {
    /// Adds a choice of the next group in every way.
    fn extend(&mut self, candidate: &Candidate) {
        let Some(list) = self.choices.get(candidate.choices.len()) else {
            return self.found.push(candidate.clone());
        };
        for (number, choice) in list.iter().enumerate() {
            let bound = candidate.bound + choice.bound;
            if !self.budget.spend(1) || bound > self.most {
                return;
            }
            if let Some(counters) = join(&candidate.counters, &choice.counters) {
                let mut choices = candidate.choices.clone();
                choices.push(number);
                self.extend(&Candidate {
                    choices,
                    counters,
                    bound,
                });
            }
        }
    }
}

impl Contest<'_, '_> {
    /// The candidates whose alignments have the least error of all, and that can be sized.
    ///
    /// A search for errors up to a bound takes longer the greater the bound is. So the exact search
    /// begins with the least bound of any candidate, and doubles it until something is found. The
    /// last search then costs about as much as all before it.
    fn least_error(&mut self, candidates: &[Candidate]) -> Vec<Found> {
        let Some(first) = candidates.first() else {
            return Vec::new();
        };
        let mut bound = if self.effort == Effort::Exact {
            first.bound
        } else {
            self.window.error
        };
        loop {
            let is_first = bound <= first.bound;
            let found = self.within(candidates, bound, is_first);
            if !found.is_empty() || bound >= self.window.error || self.budget.exhausted {
                return found;
            }
            bound = (bound * 2).max(1).min(self.window.error);
        }
    }

    /// The candidates of least error up to `bound`.
    fn within(&mut self, candidates: &[Candidate], bound: i64, is_first: bool) -> Vec<Found> {
        let mut found: Vec<Found> = Vec::new();
        let mut least = bound;
        for candidate in candidates.iter().take_while(|c| c.bound <= bound) {
            if candidate.bound > least {
                break;
            }
            // With the first, small bound the search takes less time than finding sizes.
            if !is_first && !self.can_be_sized(candidate) {
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
        found.retain(|f| f.error == least);
        found
    }

    /// One alignment a group, of least error, then of least length of wildcards, then of most
    /// columns.
    fn aligned(&mut self, candidate: &Candidate, bound: i64) -> Option<Vec<Alignment>> {
        let shared = self.shared_wildcards(candidate);
        let choices = candidate.choices.iter().enumerate();
        let bounds: Vec<i64> = choices.map(|(g, c)| self.choices[g][*c].bound).collect();
        // Each group may take what the groups before it left, but for the bounds of those after it.
        let mut rest: i64 = bounds.iter().sum();
        let mut used = 0;
        let mut groups = Vec::new();
        for (group, choice) in candidate.choices.iter().enumerate() {
            rest -= bounds[group];
            let all = self.align_group((group, *choice), &shared, bound - used - rest);
            used += all.iter().map(|a| a.error).min()?;
            groups.push(all);
        }
        let networks = self.networks(candidate, &shared);
        let wildcards: Vec<Vec<Wildcard>> = networks.into_iter().map(|n| n.wildcards).collect();
        let mut best: Option<((i64, i64, i64), Vec<Alignment>)> = None;
        let picking = Picking {
            groups: &groups,
            shared: &shared,
            bound,
        };
        picking.each(&mut |picked| {
            let rank = rank(picked, &wildcards);
            if best.as_ref().is_none_or(|(other, _)| rank < *other) {
                best = Some((rank, picked.iter().map(|a| (*a).clone()).collect()));
            }
        });
        best.map(|(_, picked)| picked)
    }

    /// The best alignments of a group and its choice with errors up to `bound`.
    fn align_group(
        &mut self,
        (group, choice): (usize, usize),
        kept: &BTreeSet<usize>,
        bound: i64,
    ) -> Vec<Alignment> {
        let key = (group, choice, kept.iter().copied().collect::<Vec<_>>());
        if let Some((searched, all)) = self.memo.get(&key)
            && (*searched >= bound || !all.is_empty() && kept.is_empty())
        {
            return all.iter().filter(|a| a.error <= bound).cloned().collect();
        }
        let network = self.network(group, choice, kept).network;
        let found = match self.effort {
            Effort::Exact => align(&network, bound, self.effort, self.budget),
            _ => self.align_in_few_steps(&network, bound),
        };
        if self.task.groups > 1 {
            self.memo.insert(key, (bound, found.clone()));
        }
        found
    }
}

/// The error, the total length of wildcards, and minus the number of columns: the lesser the better.
fn rank(picked: &[&Alignment], wildcards: &[Vec<Wildcard>]) -> (i64, i64, i64) {
    let error = picked.iter().map(|a| a.error).sum();
    let columns: i64 = picked.iter().map(|a| a.path.len() as i64).sum();
    let copies = |w: usize| wildcards.iter().map(|g| g[w].copies).sum::<i64>();
    let length = common_lengths(picked)
        .iter()
        .enumerate()
        .map(|(w, l)| l.0.saturating_mul(copies(w)))
        .sum();
    (error, length, -columns)
}
