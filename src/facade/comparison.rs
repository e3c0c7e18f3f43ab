//! Comparing candidates whose alignments are equally good (rules R9, R10): by how little their sizes
//! must change, then by the length of their wildcards, then by columns. Where the first alignment
//! of a candidate is not clearly the best, all that are as good are tried.

use std::collections::BTreeSet;

use super::assembly::{copies, meet, pick, points, settle, with_lengths};
use super::balance::{Balance, canvas_equation, common_equations};
use super::budget::Budget;
use super::network::{Network, Place};
use super::search::{Width, align};
use super::selection::{Aligned, Candidate, Found, Layout, Selection};
use super::sizing::{Equation, Sizes, size};
use super::ties::{Tie, ties};

/// The steps that may be taken to compare alignments of one candidate that are equally good.
const TIE_STEPS: u64 = 300_000;
/// The alignments of one candidate whose sizes are compared.
const MOST_TIES: usize = 256;
/// What finding sizes costs, in steps.
pub const SIZE_STEPS: u64 = 200;

impl Selection<'_, '_> {
    /// Finds sizes for the candidates, and keeps the best layout.
    pub fn sized(&mut self, found: Vec<Found>) {
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
        for (least, one) in ranked {
            let is_beaten = self
                .best
                .as_ref()
                .is_some_and(|best| is_less(best.sizes.error, least));
            if is_beaten || !self.budget.spend(SIZE_STEPS) && self.best.is_some() {
                break;
            }
            self.size_candidate(&one, least);
        }
    }

    /// Whether there are sizes that meet what all alignments of a candidate demand.
    pub fn can_be_sized(&mut self, candidate: &Candidate) -> bool {
        if let Some(known) = self.sizable.get(&candidate.choices) {
            return *known;
        }
        let found = self.common_sizes(candidate).is_some();
        self.sizable.insert(candidate.choices.clone(), found);
        found
    }

    /// The sizes that meet what all alignments of a candidate demand.
    fn common_sizes(&mut self, candidate: &Candidate) -> Option<Sizes> {
        let common = self
            .networks(candidate)
            .iter()
            .flat_map(common_equations)
            .collect();
        self.sizes(common)
    }

    /// The rows of a candidate's groups.
    fn networks(&self, candidate: &Candidate) -> Vec<Network> {
        let none = BTreeSet::new();
        candidate
            .choices
            .iter()
            .enumerate()
            .map(|(g, c)| self.network(g, *c, &none).0)
            .collect()
    }

    /// The sizes that meet all of `equations`.
    fn sizes(&mut self, equations: BTreeSet<Equation>) -> Option<Sizes> {
        if let Some(known) = self.known_sizes.get(&equations) {
            return known.clone();
        }
        let list: Vec<Equation> = equations.iter().cloned().collect();
        let sizes = size(&self.axis.preferences(), &list, self.axis.canvas);
        self.known_sizes.insert(equations, sizes.clone());
        sizes
    }

    /// Sizes a candidate by its first alignment, and by the others as good where they may be better:
    /// `least` is a lower bound of the differences.
    fn size_candidate(&mut self, one: &Found, least: f64) {
        let networks = self.networks(&one.candidate);
        let idle = self.idle(&networks);
        let length = self.total(&networks, &meet(&one.groups.iter().collect::<Vec<_>>()));
        let balances: Vec<Balance> = networks
            .iter()
            .zip(&one.groups)
            .map(|(n, a)| Balance::of_path(n, &a.path, &idle))
            .collect();
        let sizes = self.sizes(equations(&networks, &balances, &idle));
        let is_best = sizes.as_ref().is_some_and(|s| !is_less(least, s.error));
        if let Some(sizes) = sizes {
            let paths = one.groups.iter().map(|a| a.path.clone()).collect();
            self.offer(one, &networks, paths, sizes, length);
        }
        if !is_best && self.width == Width::Exact {
            self.compare(one, &networks, &idle);
        }
    }

    /// Compares the sizes of all alignments of the candidate that have the least error, and the
    /// most columns for the lengths of their wildcards.
    fn compare(&mut self, one: &Found, networks: &[Network], idle: &[bool]) {
        let mut budget = self.budget.part(TIE_STEPS);
        for lengths in self.all_lengths(one, &mut budget) {
            let length = lengths
                .iter()
                .enumerate()
                .map(|(w, l)| l * copies(networks, w))
                .sum();
            let fixed: Vec<Network> = networks.iter().map(|n| with_lengths(n, &lengths)).collect();
            let (errors, lists): (Vec<i64>, Vec<Vec<Tie>>) = (fixed.iter().zip(self.bounds(one)))
                .map(|(network, bound)| ties(network, bound, idle, MOST_TIES, &mut budget))
                .unzip();
            if errors.iter().sum::<i64>() != one.error {
                continue;
            }
            let total = lists
                .iter()
                .map(Vec::len)
                .fold(1, usize::saturating_mul)
                .min(MOST_TIES * 8);
            for picked in (0..total).map(|number| nth(&lists, number)) {
                if !budget.spend(SIZE_STEPS) {
                    break;
                }
                let balances: Vec<Balance> = picked.iter().map(|t| t.balance.clone()).collect();
                if let Some(sizes) = self.sizes(equations(networks, &balances, idle)) {
                    self.offer(
                        one,
                        &fixed,
                        picked.iter().map(|t| t.path.clone()).collect(),
                        sizes,
                        length,
                    );
                }
            }
        }
        self.is_sure &= !budget.exhausted;
        self.budget.charge(&budget);
    }

    /// The lengths of wildcards that the least error is reached with.
    fn all_lengths(&self, one: &Found, budget: &mut Budget) -> BTreeSet<Vec<i64>> {
        let all: BTreeSet<usize> = (0..self.axis.wildcards.len()).collect();
        let choices = one.candidate.choices.iter().enumerate();
        let networks: Vec<Network> = choices.map(|(g, c)| self.network(g, *c, &all).0).collect();
        let mut found = BTreeSet::new();
        if networks
            .iter()
            .all(|n| n.rows.iter().all(|r| r.wildcards.is_empty()))
        {
            found.insert(vec![1; self.axis.wildcards.len()]);
            return found;
        }
        let per_group: Vec<_> = (networks.iter().zip(self.bounds(one)))
            .map(|(network, bound)| align(network, bound, Width::Exact, budget))
            .collect();
        pick(
            &per_group,
            &all,
            one.error,
            &mut Vec::new(),
            &mut |picked| {
                if picked.iter().map(|a| a.error).sum::<i64>() == one.error {
                    points(&networks, &meet(picked), &mut found);
                }
            },
        );
        found
    }

    /// The most error that each group can have while all have that of the candidate together.
    fn bounds(&self, one: &Found) -> Vec<i64> {
        let trade = !self.shared_wildcards(&one.candidate).is_empty();
        one.groups
            .iter()
            .map(|a| if trade { one.error } else { a.error })
            .collect()
    }

    /// The symbols of which the alignment holds a single letter, without a size.
    fn idle(&self, networks: &[Network]) -> Vec<bool> {
        let count = |symbol: usize| {
            let cells = networks
                .iter()
                .flat_map(|n| &n.rows)
                .flat_map(|row| &row.cells);
            cells.filter(|cell| cell.symbol == symbol).count()
        };
        self.axis
            .symbols
            .iter()
            .enumerate()
            .map(|(i, s)| s.size.is_none() && count(i) == 1)
            .collect()
    }

    fn total(&self, networks: &[Network], lengths: &[(i64, i64)]) -> i64 {
        let needed =
            settle(networks, lengths).unwrap_or_else(|| lengths.iter().map(|l| l.0).collect());
        needed
            .iter()
            .enumerate()
            .map(|(w, l)| l.saturating_mul(copies(networks, w)))
            .sum()
    }

    /// Keeps a layout if it is better than the best so far.
    fn offer(
        &mut self,
        one: &Found,
        networks: &[Network],
        paths: Vec<Vec<Vec<Place>>>,
        sizes: Sizes,
        length: i64,
    ) {
        let columns: usize = paths.iter().map(Vec::len).sum();
        if let Some(best) = &self.best {
            let best_columns: usize = best.groups.iter().map(|g| g.path.len()).sum();
            let worse = is_less(best.sizes.error, sizes.error);
            let equal = !worse && !is_less(sizes.error, best.sizes.error);
            if worse
                || equal
                    && (best.length, usize::MAX - best_columns) <= (length, usize::MAX - columns)
            {
                return;
            }
        }
        let none = BTreeSet::new();
        let groups = networks
            .iter()
            .zip(paths)
            .zip(&one.candidate.choices)
            .enumerate();
        let groups = groups.map(|(g, ((network, path), choice))| {
            let rows = self.network(g, *choice, &none).1;
            let words = self.chosen(g, *choice).cloned();
            Aligned {
                network: network.clone(),
                lines: rows.into_iter().zip(words).collect(),
                path,
            }
        });
        let groups = groups.collect();
        let counters = one.candidate.counters.clone();
        self.best = Some(Layout {
            error: one.error,
            sizes,
            length,
            counters,
            groups,
            is_sure: true,
        });
    }
}

/// The choice of one item per list with this number.
fn nth(lists: &[Vec<Tie>], number: usize) -> Vec<&Tie> {
    let mut rest = number;
    let mut picked = Vec::new();
    for list in lists {
        picked.push(&list[rest % list.len()]);
        rest /= list.len();
    }
    picked
}

/// Whether a sum of squares is less than another by more than rounding.
fn is_less(a: f64, b: f64) -> bool {
    a < b - 1e-9 * b.abs().max(1e-3)
}

fn equations(networks: &[Network], balances: &[Balance], idle: &[bool]) -> BTreeSet<Equation> {
    let mut all: BTreeSet<Equation> = networks.iter().map(|n| canvas_equation(n, idle)).collect();
    let demands = balances.iter().flat_map(|b| b.equations.iter());
    all.extend(demands.map(|terms| Equation {
        terms: terms.clone(),
        is_canvas: false,
    }));
    all
}
