//! The choice of a layout at one tolerance (rule R9): all candidates compete, first by the error of
//! their alignments, then by how little the sizes must change, then by the length of their
//! wildcards, then by columns.

use std::collections::{BTreeMap, BTreeSet};

use super::balance::{Balance, canvas_equation, common_equations};
use super::budget::Budget;
use super::candidate::{Axis, Choice, Window, Word, join};
use super::network::{ENDLESS, Network, Place, Wildcard};
use super::row::{Cell, Length, Row};
use super::search::{Alignment, Width, align};
use super::sizing::{Equation, Preference, Sizes, size};
use super::ties::ties;
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
    /// Per group.
    pub groups: Vec<Aligned>,
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

/// The steps that may be taken to compare alignments of one candidate that are equally good.
const TIE_STEPS: u64 = 400_000;
/// The alignments of one candidate whose sizes are compared.
const MOST_TIES: usize = 256;
/// The lengths of wildcards of one candidate that are compared.
const MOST_LENGTHS: usize = 256;

/// The best layout within `window`; none when there is none.
pub fn select(axis: &Axis, words: &[Vec<Word>], window: Window, width: Width, budget: &mut Budget) -> Option<Layout> {
    let choices: Vec<Vec<Choice>> = (0..axis.groups).map(|g| axis.choices(g, words, window, budget)).collect();
    let mut candidates = Vec::new();
    combine(&choices, &Environment::new(), &mut Vec::new(), 0, window.error, budget, &mut candidates);
    candidates.sort_by_key(|c| c.bound);
    let mut selection =
        Selection { axis, words, window, choices: &choices, memo: BTreeMap::new(), width, budget, best: None };
    let found = selection.least_error(&candidates);
    selection.sized(found);
    selection.best
}

/// A choice of words for every group.
#[derive(Clone, Debug)]
struct Candidate {
    /// Number of each group's choice.
    choices: Vec<usize>,
    bound: i64,
}

/// A group, its choice, and the wildcards that are kept.
type GroupKey = (usize, usize, Vec<usize>);

/// A candidate with its best alignments.
struct Found {
    candidate: Candidate,
    error: i64,
    groups: Vec<Alignment>,
}

struct Selection<'a, 'b> {
    axis: &'a Axis<'a>,
    words: &'a [Vec<Word>],
    window: Window,
    choices: &'a [Vec<Choice>],
    /// Alignments of groups by choice and kept wildcards, with the bound they were searched to.
    memo: BTreeMap<GroupKey, (i64, Vec<Alignment>)>,
    width: Width,
    budget: &'b mut Budget,
    best: Option<Layout>,
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
        return found.push(Candidate { choices: taken.clone(), bound });
    };
    for (number, choice) in list.iter().enumerate() {
        if !budget.spend(1) || bound + choice.bound > most {
            return;
        }
        if let Some(joined) = join(counters, &choice.counters) {
            taken.push(number);
            combine(choices, &joined, taken, bound + choice.bound, most, budget, found);
            taken.pop();
        }
    }
}

impl Selection<'_, '_> {
    /// The candidates whose alignments have the least error of all.
    fn least_error(&mut self, candidates: &[Candidate]) -> Vec<Found> {
        let Some(first) = candidates.first() else { return Vec::new() };
        let mut bound = if self.width == Width::Exact { first.bound } else { self.window.error };
        loop {
            let mut found: Vec<Found> = Vec::new();
            let mut least = bound;
            for candidate in candidates.iter().take_while(|c| c.bound <= bound) {
                if candidate.bound > least {
                    break;
                }
                if let Some(groups) = self.aligned(candidate, least) {
                    let error = groups.iter().map(|a| a.error).sum();
                    if error < least {
                        found.clear();
                        least = error;
                    }
                    found.push(Found { candidate: candidate.clone(), error, groups });
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
        let bounds: Vec<i64> = candidate.choices.iter().enumerate().map(|(g, c)| self.choices[g][*c].bound).collect();
        let mut rest: i64 = bounds.iter().sum();
        let mut used = 0;
        let mut per_group = Vec::new();
        for (group, choice) in candidate.choices.iter().enumerate() {
            rest -= bounds[group];
            let all = self.align_group(group, *choice, &shared, bound - used - rest);
            used += all.iter().map(|a| a.error).min()?;
            per_group.push(all);
        }
        let copies = |group: usize| self.network(group, candidate.choices[group], &shared).0.wildcards;
        let wildcards: Vec<Vec<Wildcard>> = (0..per_group.len()).map(copies).collect();
        let mut best: Option<((i64, i64, i64), Vec<Alignment>)> = None;
        pick(&per_group, &shared, bound, &mut Vec::new(), &mut |picked| {
            let error: i64 = picked.iter().map(|a| a.error).sum();
            let columns: i64 = picked.iter().map(|a| a.path.len() as i64).sum();
            let lengths = meet(picked);
            let copies = |w: usize| wildcards.iter().map(|g| g[w].copies).sum::<i64>();
            let length = lengths.iter().enumerate().map(|(w, l)| l.0.saturating_mul(copies(w))).sum();
            let rank = (error, length, -columns);
            if best.as_ref().is_none_or(|(other, _)| rank < *other) {
                best = Some((rank, picked.iter().map(|a| (*a).clone()).collect()));
            }
        });
        best.map(|(_, picked)| picked)
    }

    fn align_group(&mut self, group: usize, choice: usize, kept: &BTreeSet<usize>, bound: i64) -> Vec<Alignment> {
        let key = (group, choice, kept.iter().copied().collect::<Vec<_>>());
        if let Some((searched, all)) = self.memo.get(&key)
            && (*searched >= bound || !all.is_empty() && kept.is_empty())
        {
            return all.iter().filter(|a| a.error <= bound).cloned().collect();
        }
        let network = self.network(group, choice, kept).0;
        let found = align(&network, bound, self.width, self.budget);
        if self.axis.groups > 1 {
            self.memo.insert(key, (bound, found.clone()));
        }
        found
    }

    /// The wildcards that several groups use.
    fn shared_wildcards(&self, candidate: &Candidate) -> BTreeSet<usize> {
        let mut seen = BTreeSet::new();
        let mut shared = BTreeSet::new();
        for group in 0..candidate.choices.len() {
            let mine: BTreeSet<usize> =
                self.words_of(candidate, group).flat_map(|w| w.wildcards.keys().copied()).collect();
            shared.extend(mine.intersection(&seen).copied().collect::<Vec<_>>());
            seen.extend(mine);
        }
        shared
    }

    fn words_of<'c>(&'c self, candidate: &'c Candidate, group: usize) -> impl Iterator<Item = &'c Word> + 'c {
        self.chosen(group, candidate.choices[group])
    }

    fn chosen(&self, group: usize, choice: usize) -> impl Iterator<Item = &Word> {
        let lines = self.axis.lines.iter().filter(move |l| l.group == group);
        let chosen = self.choices[group][choice].words.iter();
        lines.zip(chosen).map(|(line, number)| &self.words[line.pattern][*number])
    }

    /// The rows of a group's choice, without those that may as well be read like an equal one above
    /// them, and the row of each line.
    fn network(&self, group: usize, choice: usize, kept: &BTreeSet<usize>) -> (Network, Vec<usize>) {
        let words: Vec<&Word> = self.chosen(group, choice).collect();
        build(self.axis.wildcards.len(), &words, self.window, kept)
    }

    /// Finds sizes for the candidates, and keeps the best layout.
    fn sized(&mut self, found: Vec<Found>) {
        let none = BTreeSet::new();
        let mut ranked: Vec<(f64, Found)> = Vec::new();
        for one in found {
            let common = one.candidate.choices.iter().enumerate();
            let common: Vec<Equation> =
                common.flat_map(|(g, c)| common_equations(&self.network(g, *c, &none).0)).collect();
            if let Some(sizes) = size(&self.preferences(), &common, self.axis.canvas) {
                ranked.push((sizes.error, one));
            }
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (least, one) in ranked {
            if self.best.as_ref().is_some_and(|best| is_less(best.sizes.error, least)) {
                break;
            }
            self.size_candidate(&one, least);
            if self.budget.exhausted && self.best.is_some() {
                break;
            }
        }
    }

    fn preferences(&self) -> Vec<Preference> {
        let symbols = self.axis.symbols.iter();
        symbols.map(|s| Preference { size: s.size, weight: s.weight, fixed: s.fixed }).collect()
    }

    fn size_candidate(&mut self, one: &Found, least: f64) {
        let none = BTreeSet::new();
        let networks: Vec<Network> =
            one.candidate.choices.iter().enumerate().map(|(g, c)| self.network(g, *c, &none).0).collect();
        let idle = self.idle(&networks);
        let paths = one.groups.iter().map(|a| a.path.clone()).collect();
        let length = self.total(&networks, &meet(&one.groups.iter().collect::<Vec<_>>()));
        let balances: Vec<Balance> =
            networks.iter().zip(&one.groups).map(|(n, a)| Balance::of_path(n, &a.path, &idle)).collect();
        let sizes = self.sizes(&networks, &balances, &idle);
        let is_best = sizes.as_ref().is_some_and(|s| !is_less(least, s.error));
        if let Some(sizes) = sizes {
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
        let mut memo: BTreeMap<BTreeSet<Equation>, Option<Sizes>> = BTreeMap::new();
        for lengths in self.all_lengths(one, &mut budget) {
            let length = lengths.iter().enumerate().map(|(w, l)| l * copies(networks, w)).sum();
            let fixed: Vec<Network> = networks.iter().map(|n| with_lengths(n, &lengths)).collect();
            let per_group: Vec<_> = (fixed.iter().zip(self.bounds(one)))
                .map(|(network, bound)| ties(network, bound, idle, MOST_TIES, &mut budget))
                .collect();
            if per_group.iter().map(|(error, _)| error).sum::<i64>() != one.error {
                continue;
            }
            let lists: Vec<_> = per_group.into_iter().map(|(_, list)| list).collect();
            let total: usize = lists.iter().map(Vec::len).fold(1, usize::saturating_mul);
            for number in 0..total.min(MOST_TIES * 8) {
                let mut rest = number;
                let picked: Vec<_> = lists
                    .iter()
                    .map(|list| {
                        let tie = &list[rest % list.len()];
                        rest /= list.len();
                        tie
                    })
                    .collect();
                let balances: Vec<Balance> = picked.iter().map(|t| t.balance.clone()).collect();
                let key = equations(networks, &balances, idle);
                if !memo.contains_key(&key) && !budget.spend(2000) {
                    break;
                }
                let sizes = memo.entry(key).or_insert_with_key(|key| {
                    size(&self.preferences(), &key.iter().cloned().collect::<Vec<_>>(), self.axis.canvas)
                });
                if let Some(sizes) = sizes.clone() {
                    self.offer(one, &fixed, picked.iter().map(|t| t.path.clone()).collect(), sizes, length);
                }
            }
        }
        self.budget.charge(TIE_STEPS, &budget);
    }

    /// The lengths of wildcards that the least error is reached with.
    fn all_lengths(&self, one: &Found, budget: &mut Budget) -> BTreeSet<Vec<i64>> {
        let all: BTreeSet<usize> = (0..self.axis.wildcards.len()).collect();
        let networks: Vec<Network> =
            one.candidate.choices.iter().enumerate().map(|(g, c)| self.network(g, *c, &all).0).collect();
        let mut found = BTreeSet::new();
        if networks.iter().all(|n| n.rows.iter().all(|r| r.wildcards.is_empty())) {
            found.insert(vec![1; self.axis.wildcards.len()]);
            return found;
        }
        let per_group: Vec<_> = (networks.iter().zip(self.bounds(one)))
            .map(|(network, bound)| align(network, bound, Width::Exact, budget))
            .collect();
        pick(&per_group, &all, one.error, &mut Vec::new(), &mut |picked| {
            if picked.iter().map(|a| a.error).sum::<i64>() == one.error {
                points(&networks, &meet(picked), &mut found);
            }
        });
        found
    }

    /// The most error that each group can have while all have that of the candidate together.
    fn bounds(&self, one: &Found) -> Vec<i64> {
        let trade = !self.shared_wildcards(&one.candidate).is_empty();
        one.groups.iter().map(|a| if trade { one.error } else { a.error }).collect()
    }

    /// The symbols of which the alignment holds a single letter, without a size.
    fn idle(&self, networks: &[Network]) -> Vec<bool> {
        let count = |symbol: usize| {
            let cells = networks.iter().flat_map(|n| &n.rows).flat_map(|row| &row.cells);
            cells.filter(|cell| cell.symbol == symbol).count()
        };
        self.axis.symbols.iter().enumerate().map(|(i, s)| s.size.is_none() && count(i) == 1).collect()
    }

    fn sizes(&self, networks: &[Network], balances: &[Balance], idle: &[bool]) -> Option<Sizes> {
        let equations: Vec<Equation> = equations(networks, balances, idle).into_iter().collect();
        size(&self.preferences(), &equations, self.axis.canvas)
    }

    fn total(&self, networks: &[Network], lengths: &[(i64, i64)]) -> i64 {
        let needed = settle(networks, lengths).unwrap_or_else(|| lengths.iter().map(|l| l.0).collect());
        needed.iter().enumerate().map(|(w, l)| l.saturating_mul(copies(networks, w))).sum()
    }

    /// Keeps a layout if it is better than the best so far.
    fn offer(&mut self, one: &Found, networks: &[Network], paths: Vec<Vec<Vec<Place>>>, sizes: Sizes, length: i64) {
        let columns: usize = paths.iter().map(Vec::len).sum();
        if let Some(best) = &self.best {
            let best_columns: usize = best.groups.iter().map(|g| g.path.len()).sum();
            let worse = is_less(best.sizes.error, sizes.error);
            let equal = !worse && !is_less(sizes.error, best.sizes.error);
            if worse || equal && (best.length, usize::MAX - best_columns) <= (length, usize::MAX - columns) {
                return;
            }
        }
        let none = BTreeSet::new();
        let groups = networks.iter().zip(paths).zip(&one.candidate.choices).enumerate();
        let groups = groups.map(|(g, ((network, path), choice))| {
            let rows = self.network(g, *choice, &none).1;
            let words = self.chosen(g, *choice).cloned();
            Aligned { network: network.clone(), lines: rows.into_iter().zip(words).collect(), path }
        });
        let groups = groups.collect();
        self.best = Some(Layout { error: one.error, sizes, length, groups });
    }
}

/// Whether a sum of squares is less than another by more than rounding.
fn is_less(a: f64, b: f64) -> bool {
    a < b - 1e-9 * b.abs().max(1e-3)
}

fn copies(networks: &[Network], wildcard: usize) -> i64 {
    networks.iter().map(|n| n.wildcards[wildcard].copies).sum()
}

fn equations(networks: &[Network], balances: &[Balance], idle: &[bool]) -> BTreeSet<Equation> {
    let mut all: BTreeSet<Equation> = networks.iter().map(|n| canvas_equation(n, idle)).collect();
    let demands = balances.iter().flat_map(|b| b.equations.iter());
    all.extend(demands.map(|terms| Equation { terms: terms.clone(), is_canvas: false }));
    all
}

/// Calls `see` with one alignment per group, where the lengths of `shared` wildcards agree.
fn pick<'a>(
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
    if shared.iter().any(|w| lengths.get(*w).is_some_and(|(least, most)| least > most)) {
        return;
    }
    let Some(list) = groups.get(picked.len()) else { return see(picked) };
    for alignment in list {
        picked.push(alignment);
        pick(groups, shared, bound, picked, see);
        picked.pop();
    }
}

/// The lengths that all alignments allow.
fn meet(picked: &[&Alignment]) -> Vec<(i64, i64)> {
    let Some((first, rest)) = picked.split_first() else { return Vec::new() };
    let mut lengths = first.lengths.clone();
    for other in rest {
        lengths.iter_mut().zip(&other.lengths).for_each(|(a, b)| *a = (a.0.max(b.0), a.1.min(b.1)));
    }
    lengths
}

/// The shortest lengths within `lengths` that make every row of every group as long as it must be.
fn settle(networks: &[Network], lengths: &[(i64, i64)]) -> Option<Vec<i64>> {
    let mut lengths = lengths.to_vec();
    for network in networks {
        let least = network.settle(&lengths)?;
        lengths.iter_mut().zip(least).for_each(|(l, least)| l.0 = least);
    }
    Some(lengths.into_iter().map(|l| l.0).collect())
}

/// Adds the whole lengths within `lengths` that meet the rows' needs: all of them where they are few.
fn points(networks: &[Network], lengths: &[(i64, i64)], found: &mut BTreeSet<Vec<i64>>) {
    let used: Vec<bool> = (0..lengths.len()).map(|w| copies(networks, w) > 0).collect();
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
fn with_lengths(network: &Network, lengths: &[i64]) -> Network {
    let known = |cell: &Cell| match cell.length {
        Length::Wildcard(w) => Cell { length: Length::Steps(lengths[w]), ..*cell },
        Length::Steps(_) => *cell,
    };
    let rows = network.rows.iter().map(|r| Row::new(r.cells.iter().map(known).collect(), r.yields, r.need)).collect();
    Network { rows, wildcards: network.wildcards.clone(), longest: network.longest }
}

/// See [`Selection::network`].
fn build(wildcards: usize, words: &[&Word], window: Window, kept: &BTreeSet<usize>) -> (Network, Vec<usize>) {
    let cells = || words.iter().flat_map(|w| &w.cells);
    let is_plain = |w: &Word| w.cells.iter().all(|c| !c.opaque && !c.unoccludable);
    let flags_idle = words.first().is_some_and(|w| w.cells.iter().all(|c| c.opaque))
        && (cells().all(|c| !c.unoccludable) || cells().all(|c| c.opaque || c.transparent));
    let mut rows: Vec<Row> = Vec::new();
    let mut of_line = Vec::new();
    let mut above = 0;
    let mut copies = vec![0; wildcards];
    for word in words {
        word.wildcards.iter().for_each(|(w, count)| copies[*w] += count);
        let same = rows.iter().position(|row| row.cells == word.cells && (flags_idle || is_plain(word)));
        of_line.push(same.unwrap_or(rows.len()));
        if same.is_none() {
            rows.push(Row::new(word.cells.clone(), above > 0, window.shortest - above));
        }
        above += word.opaque;
    }
    let wildcards = (0..wildcards).map(|w| {
        let letters = rows.iter().flat_map(|r| &r.wildcards).filter(|(_, v)| *v == w).count();
        let only = rows.iter().filter(|r| !r.wildcards.is_empty() && r.wildcards.iter().all(|(_, v)| *v == w));
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
    (Network { rows, wildcards, longest: window.longest }, of_line)
}
