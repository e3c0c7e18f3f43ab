//! Candidates (section 5.1, rules R2, R5): the words of each pattern that may fit the canvas. Alternatives
//! are taken in order: counters by their values, alternations from left to right. What words go together
//! is in `choice`.

use std::collections::{BTreeMap, BTreeSet};

use super::budget::Budget;
use super::grid::Grid;
use super::pattern::Pattern;
use super::row::{Cell, Length};
use super::sizing::Preference;
use super::word::{Environment, Letter, Words, extent};

/// One axis of a facade, with names replaced by numbers.
#[derive(Clone, Debug)]
pub struct Axis<'a> {
    /// The side of the canvas.
    pub canvas: f64,
    /// The step of its sizes.
    pub grid: Grid,
    /// The symbols in use.
    pub symbols: Vec<Symbol>,
    /// The numbers of those without a size.
    pub wildcards: Vec<usize>,
    /// The patterns in use.
    pub patterns: Vec<&'a Pattern>,
    /// A line per layer, the uppermost first.
    pub lines: Vec<Line>,
    /// How many groups the lines are in.
    pub groups: usize,
    /// The values of each counter in use.
    pub ranges: BTreeMap<char, Range>,
}

/// A symbol of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Symbol {
    pub name: char,
    pub size: Option<f64>,
    pub opaque: bool,
    pub attached: bool,
    pub unoccludable: bool,
    pub fixed: bool,
    pub weight: f64,
}

/// A layer's part in an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Number of its pattern.
    pub pattern: usize,
    /// Number of its group.
    pub group: usize,
}

/// The values a counter may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// The least.
    pub min: i64,
    /// The greatest; none: as far as the canvas.
    pub max: Option<i64>,
}

/// A word of a pattern.
#[derive(Clone, Debug)]
pub struct Word {
    /// The counters that make it.
    pub counters: Environment,
    /// Its letters.
    pub letters: Vec<Letter>,
    /// The same, as the alignment reads them.
    pub cells: Vec<Cell>,
    /// The length of the sized letters.
    pub sized: i64,
    /// The length of the opaque letters.
    pub opaque: i64,
    /// How many letters each of its wildcards has.
    pub wildcards: BTreeMap<usize, i64>,
}

/// Which words of a pattern are wanted.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// The least length of words without wildcards.
    pub least: i64,
    /// The greatest length.
    pub longest: i64,
    /// Only so many, those that come nearest to the canvas; none: all.
    pub few: Option<usize>,
}

/// What the canvas and the tolerance leave (rule R5).
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// The most that a word, or the columns, may take.
    pub longest: i64,
    /// The least that the uppermost word may take.
    pub shortest: i64,
    /// The most that the error may be.
    pub error: i64,
}

impl Axis<'_> {
    /// The window at a tolerance.
    pub fn window(&self, tolerance: f64) -> Window {
        Window {
            longest: self.grid.floor(self.canvas + tolerance),
            shortest: self.grid.ceil(self.canvas - tolerance),
            error: self.grid.floor(tolerance),
        }
    }

    /// What each symbol would like.
    pub fn preferences(&self) -> Vec<Preference> {
        let symbols = self.symbols.iter();
        symbols
            .map(|s| Preference {
                size: s.size,
                weight: s.weight,
                fixed: s.fixed,
            })
            .collect()
    }

    fn steps(&self, symbol: char) -> i64 {
        let known = self
            .symbols
            .iter()
            .find(|s| s.name == symbol)
            .and_then(|s| s.size);
        known.map_or(1, |size| self.grid.steps(size))
    }

    /// The words of a pattern that are wanted.
    pub fn words(&self, pattern: usize, wanted: Wanted, budget: &mut Budget) -> Vec<Word> {
        let pattern = self.patterns[pattern];
        let sizes: BTreeMap<char, i64> = self
            .symbols
            .iter()
            .map(|s| (s.name, self.steps(s.name)))
            .collect();
        let size = |c: char| sizes.get(&c).copied().unwrap_or(1);
        let has_wildcards = self
            .wildcards
            .iter()
            .any(|w| uses(pattern, self.symbols[*w].name));
        let wanted = Wanted {
            least: if has_wildcards { 0 } else { wanted.least },
            ..wanted
        };
        let mut found = Vec::new();
        let mut see = |env: &Environment, budget: &mut Budget| {
            extent(pattern, env, &size).1 < wanted.least
                || self.words_under(pattern, env, wanted, &size, budget, &mut found)
        };
        let counters = counters_of(pattern);
        self.each_value(
            pattern,
            &counters,
            &mut Environment::new(),
            wanted.longest,
            &size,
            budget,
            &mut see,
        );
        if let Some(few) = wanted.few {
            let canvas = self.grid.floor(self.canvas);
            found.sort_by_key(|word| {
                if has_wildcards {
                    0
                } else {
                    (word.sized - canvas).abs()
                }
            });
            found.truncate(few);
        }
        found
    }

    /// Adds the words under these counters; whether more are wanted, and may be looked for.
    fn words_under(
        &self,
        pattern: &Pattern,
        env: &Environment,
        wanted: Wanted,
        size: &dyn Fn(char) -> i64,
        budget: &mut Budget,
        found: &mut Vec<Word>,
    ) -> bool {
        let mut seen = BTreeSet::new();
        for word in Words::new(pattern, env, size, wanted.longest) {
            if !budget.spend(8 + word.as_ref().map_or(0, |w| w.len() as u64 / 4)) {
                return false;
            }
            if let Some(letters) = word.filter(|w| !w.is_empty())
                && seen.insert(letters.clone())
            {
                let word = self.word(env, letters);
                if word.sized >= wanted.least {
                    found.push(word);
                }
            }
            if wanted
                .few
                .is_some_and(|few| seen.len() >= few || found.len() >= few * few)
            {
                break;
            }
        }
        wanted.few.is_none_or(|few| found.len() < few * few)
    }

    /// Calls `see` with every value of the counters from the first missing one on that the shortest
    /// word does not exceed `longest` under, until it returns false.
    #[allow(clippy::too_many_arguments)]
    fn each_value(
        &self,
        pattern: &Pattern,
        counters: &[char],
        env: &mut Environment,
        longest: i64,
        size: &dyn Fn(char) -> i64,
        budget: &mut Budget,
        see: &mut dyn FnMut(&Environment, &mut Budget) -> bool,
    ) -> bool {
        let Some((counter, rest)) = counters.split_first() else {
            return see(env, budget);
        };
        let range = self
            .ranges
            .get(counter)
            .copied()
            .unwrap_or(Range { min: 1, max: None });
        let smallest = self
            .symbols
            .iter()
            .filter(|s| s.size.is_some())
            .map(|s| self.steps(s.name))
            .min();
        // More letters than this are too long, mirrored or not.
        let most = longest / smallest.unwrap_or(1);
        let max = range.max.unwrap_or(most.max(range.min));
        for k in range.min.max((-most).min(max))..=max {
            if !budget.spend(4) {
                return false;
            }
            env.insert(*counter, k);
            let mut probe = env.clone();
            for other in rest {
                let range = self
                    .ranges
                    .get(other)
                    .copied()
                    .unwrap_or(Range { min: 1, max: None });
                probe.insert(
                    *other,
                    0i64.clamp(range.min, range.max.unwrap_or(i64::MAX).max(range.min)),
                );
            }
            if extent(pattern, &probe, size).0 <= longest {
                if !self.each_value(pattern, rest, env, longest, size, budget, see) {
                    return false;
                }
            } else if k >= 0 {
                break;
            }
        }
        env.remove(counter);
        true
    }

    /// The length of the shortest word of a pattern, which may be empty; each wildcard counts one step.
    pub fn shortest(&self, pattern: usize) -> i64 {
        let pattern = self.patterns[pattern];
        let least = |counter: char| {
            let range = self
                .ranges
                .get(&counter)
                .copied()
                .unwrap_or(Range { min: 1, max: None });
            0i64.clamp(range.min, range.max.unwrap_or(i64::MAX).max(range.min))
        };
        let counters = counters_of(pattern)
            .into_iter()
            .map(|c| (c, least(c)))
            .collect();
        extent(pattern, &counters, &|c| self.steps(c)).0
    }

    /// Whether no word above a pattern's lines can have opaque letters, so that its words must fill the canvas.
    pub fn is_rigid(&self, pattern: usize) -> bool {
        let opaque = |line: &Line| {
            let symbols = self.symbols.iter().filter(|s| s.opaque);
            symbols
                .into_iter()
                .any(|s| uses(self.patterns[line.pattern], s.name))
        };
        let mine = self
            .lines
            .iter()
            .enumerate()
            .filter(|(_, line)| line.pattern == pattern);
        mine.into_iter().all(|(i, line)| {
            !self.lines[..i]
                .iter()
                .any(|above| above.group == line.group && opaque(above))
        })
    }

    fn word(&self, env: &Environment, letters: Vec<Letter>) -> Word {
        let mut word = Word {
            counters: env.clone(),
            cells: Vec::with_capacity(letters.len()),
            letters,
            sized: 0,
            opaque: 0,
            wildcards: BTreeMap::new(),
        };
        for letter in &word.letters {
            let Some(number) = self.symbols.iter().position(|s| s.name == letter.symbol) else {
                continue;
            };
            let symbol = &self.symbols[number];
            let length = match symbol.size {
                Some(size) => Length::Steps(self.grid.steps(size)),
                None => Length::Wildcard(self.wildcards.partition_point(|w| *w < number)),
            };
            let solid = !letter.transparent && symbol.size.is_some();
            match length {
                Length::Steps(steps) => {
                    word.sized += steps;
                    word.opaque += if solid && symbol.opaque { steps } else { 0 };
                }
                Length::Wildcard(w) => *word.wildcards.entry(w).or_insert(0) += 1,
            }
            word.cells.push(Cell {
                symbol: number,
                length,
                opaque: solid && symbol.opaque,
                attached: solid && symbol.attached,
                unoccludable: solid && symbol.unoccludable,
                transparent: !solid,
            });
        }
        word
    }
}

/// Whether letters of the words can be of this symbol.
fn uses(pattern: &Pattern, symbol: char) -> bool {
    let content = pattern.content.as_ref();
    content
        .into_iter()
        .flatten()
        .any(|(_, node)| node.symbols().contains(&symbol))
        || pattern.control.symbols().contains(&symbol)
            && content.is_none_or(|c| !c.contains_key(&symbol))
}

/// The counters of a pattern in order of appearance.
pub fn counters_of(pattern: &Pattern) -> Vec<char> {
    let mut all = pattern.control.counters();
    for node in pattern.content.iter().flatten().map(|(_, node)| node) {
        for counter in node.counters() {
            if !all.contains(&counter) {
                all.push(counter);
            }
        }
    }
    all
}
