//! Breaking ties between candidates whose alignments are equally good (rules R9 and R10): by how
//! little their sizes must change, then by the length of their wildcards, then by their columns.
//!
//! Sizes that meet the common equations of a candidate, those that hold in every alignment of it,
//! bound its size error from below. So candidates are tried in the order of these bounds, and the
//! rest is skipped once a bound is above the best error found. If the first alignment of a candidate
//! reaches its bound, no other alignment of it can be better; otherwise all that are as good are
//! compared.

use std::collections::BTreeSet;

use super::co_optimal::{CoOptimal, co_optimal};
use super::contest::{Aligned, Candidate, Contest, Found, Layout, SIZE_STEPS};
use super::groups::{Picking, common_lengths, copies, shortest_lengths, whole_lengths};
use crate::align::build_network::with_lengths;
use crate::align::network::Network;
use crate::align::place::Place;
use crate::align::search::{Alignment, Effort, align};
use crate::budget::Budget;
use crate::size::least_squares::{Equation, Sizes};
use crate::size::size_equations::{SizeEquations, canvas_equation, common_equations};

/// The steps for comparing the co-optimal alignments of one candidate. With fewer, layouts of many
/// symbols keep their first alignment, whose sizes change more than they must; with more, a single
/// candidate may use up what the others need.
const TIE_STEPS: u64 = 300_000;
/// The co-optimal alignments that are kept at each node of a network. They double with every free
/// choice, so that a limit is needed; what is beyond it differs in details only.
const MOST_TIES: usize = 256;
/// The combinations of several groups' alignments that are compared, as a multiple of
/// [`MOST_TIES`].
const MOST_COMBINATIONS: usize = MOST_TIES * 8;

impl Contest<'_, '_> {
    /// Finds sizes for candidates of the same error, and keeps the best layout.
    pub fn break_ties(&mut self, found: Vec<Found>) {
        let mut ranked: Vec<(f64, Found)> = Vec::new();
        for one in found {
            if !self.budget.spend(SIZE_STEPS) && !ranked.is_empty() {
                break;
            }
            if let Some(sizes) = self.common_sizes(&one.candidate) {
                ranked.push((sizes.error, one));
            }
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (bound, one) in ranked {
            let is_beaten = self
                .best
                .as_ref()
                .is_some_and(|best| is_less(best.sizes.error, bound));
            if is_beaten || !self.budget.spend(SIZE_STEPS) && self.best.is_some() {
                break;
            }
            self.size_candidate(&one, bound);
        }
    }

    /// Whether there are sizes that meet the common equations of a candidate.
    pub fn can_be_sized(&mut self, candidate: &Candidate) -> bool {
        if let Some(known) = self.sizable.get(&candidate.choices) {
            return *known;
        }
        let found = self.common_sizes(candidate).is_some();
        self.sizable.insert(candidate.choices.clone(), found);
        found
    }

    /// The best sizes that meet the equations which all alignments of a candidate have in common.
    fn common_sizes(&mut self, candidate: &Candidate) -> Option<Sizes> {
        let networks = self.networks(candidate, &BTreeSet::new());
        self.sizes(networks.iter().flat_map(common_equations).collect())
    }

    /// Sizes a candidate by its first alignment, and by its co-optimal ones where they may be better.
    /// `bound` is a lower bound of the size error.
    fn size_candidate(&mut self, one: &Found, bound: f64) {
        let networks = self.networks(&one.candidate, &BTreeSet::new());
        let idle = self.idle(&networks);
        let picked: Vec<&Alignment> = one.groups.iter().collect();
        let demands: Vec<SizeEquations> = networks
            .iter()
            .zip(&picked)
            .map(|(n, a)| SizeEquations::of_path(n, &a.path, &idle))
            .collect();
        let sizes = self.sizes(equations(&networks, demands.iter(), &idle));
        let is_best = sizes.as_ref().is_some_and(|s| !is_less(bound, s.error));
        if let Some(sizes) = sizes {
            self.offer(Offer {
                found: one,
                networks: &networks,
                paths: picked.iter().map(|a| a.path.clone()).collect(),
                sizes,
                length: total_length(&networks, &common_lengths(&picked)),
            });
        }
        if !is_best && self.effort == Effort::Exact {
            self.compare(one, &networks, &idle);
        }
    }

    /// Compares the sizes of all alignments of a candidate that have its least error and, for the
    /// lengths of their wildcards, the most columns.
    fn compare(&mut self, one: &Found, networks: &[Network], idle: &[bool]) {
        let mut budget = self.budget.part(TIE_STEPS);
        for lengths in self.all_lengths(one, &mut budget) {
            let fixed: Vec<Network> = networks.iter().map(|n| with_lengths(n, &lengths)).collect();
            let (errors, lists): (Vec<i64>, Vec<Vec<CoOptimal>>) = (fixed.iter())
                .zip(self.bounds(one))
                .map(|(network, bound)| co_optimal(network, bound, idle, MOST_TIES, &mut budget))
                .unzip();
            if errors.iter().sum::<i64>() != one.error {
                continue;
            }
            let combinations = lists
                .iter()
                .map(Vec::len)
                .fold(1, usize::saturating_mul)
                .min(MOST_COMBINATIONS);
            for picked in (0..combinations).map(|number| combination(&lists, number)) {
                if !budget.spend(SIZE_STEPS) {
                    break;
                }
                let demands = picked.iter().map(|t| &t.demands);
                if let Some(sizes) = self.sizes(equations(networks, demands, idle)) {
                    self.offer(Offer {
                        found: one,
                        networks: &fixed,
                        paths: picked.iter().map(|t| t.path.clone()).collect(),
                        sizes,
                        length: lengths
                            .iter()
                            .enumerate()
                            .map(|(w, l)| l * copies(networks, w))
                            .sum(),
                    });
                }
            }
        }
        self.is_sure &= !budget.exhausted;
        self.budget.charge(&budget);
    }

    /// The lengths of wildcards with which the least error is reached.
    fn all_lengths(&self, one: &Found, budget: &mut Budget) -> BTreeSet<Vec<i64>> {
        let all: BTreeSet<usize> = (0..self.task.wildcards.len()).collect();
        let networks = self.networks(&one.candidate, &all);
        let mut found = BTreeSet::new();
        let has_wildcards = |n: &Network| n.rows.iter().any(|r| !r.wildcards.is_empty());
        if !networks.iter().any(has_wildcards) {
            found.insert(vec![1; self.task.wildcards.len()]);
            return found;
        }
        let groups: Vec<_> = (networks.iter())
            .zip(self.bounds(one))
            .map(|(network, bound)| align(network, bound, Effort::Exact, budget))
            .collect();
        let picking = Picking {
            groups: &groups,
            shared: &all,
            bound: one.error,
        };
        picking.each(&mut |picked| {
            if picked.iter().map(|a| a.error).sum::<i64>() == one.error {
                whole_lengths(&networks, &common_lengths(picked), &mut found);
            }
        });
        found
    }

    /// The greatest error of each group while all groups together have the candidate's error. Groups
    /// that share a wildcard may trade errors.
    fn bounds(&self, one: &Found) -> Vec<i64> {
        let may_trade = !self.shared_wildcards(&one.candidate).is_empty();
        one.groups
            .iter()
            .map(|a| if may_trade { one.error } else { a.error })
            .collect()
    }

    /// For each symbol: whether it is a wildcard with a single letter, so that its size follows from
    /// the others.
    fn idle(&self, networks: &[Network]) -> Vec<bool> {
        let count = |symbol: usize| {
            let letters = networks
                .iter()
                .flat_map(|n| &n.rows)
                .flat_map(|row| &row.letters);
            letters.filter(|letter| letter.symbol == symbol).count()
        };
        self.task
            .symbols
            .iter()
            .enumerate()
            .map(|(i, s)| s.size.is_none() && count(i) == 1)
            .collect()
    }

    /// Keeps a layout if it is better than the best so far.
    fn offer(&mut self, offer: Offer) {
        if self.best.as_ref().is_some_and(|best| !offer.beats(best)) {
            return;
        }
        let candidate = &offer.found.candidate;
        let parts = offer.networks.iter().zip(offer.paths);
        let groups = parts.zip(&candidate.choices).enumerate();
        let groups = groups.map(|(g, ((network, path), choice))| {
            let rows = self.network(g, *choice, &BTreeSet::new()).row_of_line;
            let words = self.chosen(g, *choice).cloned();
            Aligned {
                network: network.clone(),
                lines: rows.into_iter().zip(words).collect(),
                path,
            }
        });
        let groups = groups.collect();
        self.best = Some(Layout {
            error: offer.found.error,
            sizes: offer.sizes,
            length: offer.length,
            counters: candidate.counters.clone(),
            groups,
            is_sure: true,
        });
    }
}

/// A layout that may be the best.
struct Offer<'a> {
    found: &'a Found,
    networks: &'a [Network],
    /// The path of each group.
    paths: Vec<Vec<Vec<Place>>>,
    sizes: Sizes,
    /// The total length of the letters of wildcards.
    length: i64,
}

impl Offer<'_> {
    /// Whether the offer has a lesser size error than a layout; then shorter wildcards; then more
    /// columns.
    fn beats(&self, best: &Layout) -> bool {
        let columns: usize = self.paths.iter().map(Vec::len).sum();
        let best_columns: usize = best.groups.iter().map(|g| g.path.len()).sum();
        if is_less(best.sizes.error, self.sizes.error) {
            return false;
        }
        is_less(self.sizes.error, best.sizes.error)
            || (self.length, best_columns) < (best.length, columns)
    }
}

/// The combination of one item a list with this number.
fn combination(lists: &[Vec<CoOptimal>], number: usize) -> Vec<&CoOptimal> {
    let mut rest = number;
    let mut picked = Vec::new();
    for list in lists {
        picked.push(&list[rest % list.len()]);
        rest /= list.len();
    }
    picked
}

/// The total length of the letters of wildcards, each as short as it can be.
fn total_length(networks: &[Network], lengths: &[(i64, i64)]) -> i64 {
    let shortest = shortest_lengths(networks, lengths);
    let shortest = shortest.unwrap_or_else(|| lengths.iter().map(|l| l.0).collect());
    shortest
        .iter()
        .enumerate()
        .map(|(w, l)| l.saturating_mul(copies(networks, w)))
        .sum()
}

/// Whether a sum of squares is less than another by more than rounding errors.
fn is_less(a: f64, b: f64) -> bool {
    a < b - 1e-9 * b.abs().max(1e-3)
}

/// The equations of an alignment of all groups.
fn equations<'a>(
    networks: &[Network],
    demands: impl Iterator<Item = &'a SizeEquations>,
    idle: &[bool],
) -> BTreeSet<Equation> {
    let mut all: BTreeSet<Equation> = networks.iter().map(|n| canvas_equation(n, idle)).collect();
    all.extend(demands.flat_map(|d| &d.equations).map(|terms| Equation {
        terms: terms.clone(),
        is_canvas: false,
    }));
    all
}
