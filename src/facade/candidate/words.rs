//! The words of each pattern that may fit the canvas (section 5.1, rules R2 and R5). Words come in a
//! fixed order: counters by their values, then alternations from left to right. Which words go
//! together is found in `choice`.

use std::collections::{BTreeMap, BTreeSet};

use super::axis_task::AxisTask;
use super::letter::{Length, MeasuredLetter};
use crate::budget::Budget;
use crate::pattern::syntax::Pattern;
use crate::pattern::word::{Environment, Letter, Words, extent};

/// A word of a pattern.
#[derive(Clone, Debug)]
pub struct Word {
    /// The values of the counters that make it.
    pub counters: Environment,
    /// Its letters.
    pub letters: Vec<Letter>,
    /// The same letters, as the alignment reads them.
    pub measured: Vec<MeasuredLetter>,
    /// The length of the letters that have a size, in steps.
    pub sized: i64,
    /// The length of the opaque letters, in steps.
    pub opaque: i64,
    /// The number of letters of each wildcard in it.
    pub wildcards: BTreeMap<usize, i64>,
}

/// Which words of a pattern are wanted.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// The least length of a word without wildcards, in steps.
    pub least: i64,
    /// The greatest length, in steps.
    pub longest: i64,
    /// If only so many are wanted: those that come nearest to the canvas.
    pub few: Option<usize>,
}

/// The cost of interpreting a pattern once, in steps of the budget. It was measured on short words;
/// long words pay for their letters as well.
const WORD_STEPS: u64 = 8;
/// The letters that are interpreted for one step.
const LETTERS_PER_STEP: u64 = 4;
/// The cost of trying one value of a counter, in steps.
const VALUE_STEPS: u64 = 4;

impl AxisTask<'_> {
    /// The words of a pattern that are wanted. If the budget runs out, some are missing.
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
            .any(|w| pattern.uses(self.symbols[*w].name));
        let wanted = Wanted {
            least: if has_wildcards { 0 } else { wanted.least },
            ..wanted
        };
        let mut enumeration = Enumeration {
            task: self,
            pattern,
            size: &size,
            wanted,
            environment: Environment::new(),
            budget,
            found: Vec::new(),
        };
        enumeration.each_value(&pattern.counters());
        let mut found = enumeration.found;
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

    /// The length of the shortest word of a pattern, in steps. The word may be empty; each wildcard
    /// counts as one step.
    pub fn shortest(&self, pattern: usize) -> i64 {
        let pattern = self.patterns[pattern];
        let counters = pattern
            .counters()
            .into_iter()
            .map(|c| (c, self.range(c).nearest_to_zero()))
            .collect();
        extent(pattern, &counters, &|c| self.steps(c)).0
    }

    /// A word with its lengths and flags.
    fn word(&self, counters: &Environment, letters: Vec<Letter>) -> Word {
        let mut word = Word {
            counters: counters.clone(),
            measured: Vec::with_capacity(letters.len()),
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
            word.measured.push(MeasuredLetter {
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

/// The enumeration of a pattern's words.
struct Enumeration<'a> {
    task: &'a AxisTask<'a>,
    pattern: &'a Pattern,
    size: &'a dyn Fn(char) -> i64,
    wanted: Wanted,
    /// The values of the counters that are chosen so far.
    environment: Environment,
    budget: &'a mut Budget,
    found: Vec<Word>,
}

impl Enumeration<'_> {
    /// Tries every value of `counters`, and adds the words under each. A value is left out if even
    /// the shortest word under it is too long. Returns whether to go on.
    fn each_value(&mut self, counters: &[char]) -> bool {
        let Some((counter, rest)) = counters.split_first() else {
            return extent(self.pattern, &self.environment, self.size).1 < self.wanted.least
                || self.words_here();
        };
        let (range, most) = (self.task.range(*counter), self.most_repetitions());
        let max = range.max.unwrap_or(most.max(range.min));
        for k in range.min.max((-most).min(max))..=max {
            if !self.budget.spend(VALUE_STEPS) {
                return false;
            }
            self.environment.insert(*counter, k);
            if self.shortest(rest) <= self.wanted.longest {
                if !self.each_value(rest) {
                    return false;
                }
            } else if k >= 0 {
                break;
            }
        }
        self.environment.remove(counter);
        true
    }

    /// The length of the shortest word under the environment, if the counters `open` may still take
    /// any value.
    fn shortest(&self, open: &[char]) -> i64 {
        let mut probe = self.environment.clone();
        for counter in open {
            probe.insert(*counter, self.task.range(*counter).nearest_to_zero());
        }
        extent(self.pattern, &probe, self.size).0
    }

    /// A word with more letters than this is too long, mirrored or not.
    fn most_repetitions(&self) -> i64 {
        let sized = self.task.symbols.iter().filter(|s| s.size.is_some());
        let smallest = sized.map(|s| self.task.steps(s.name)).min();
        self.wanted.longest / smallest.unwrap_or(1)
    }

    /// Adds the words under the environment. Returns whether to go on with the next value.
    fn words_here(&mut self) -> bool {
        let mut seen = BTreeSet::new();
        let longest = self.wanted.longest;
        for word in Words::new(self.pattern, &self.environment, self.size, longest) {
            let letters = word.as_ref().map_or(0, |w| w.len() as u64);
            if !self.budget.spend(WORD_STEPS + letters / LETTERS_PER_STEP) {
                return false;
            }
            if let Some(letters) = word.filter(|w| !w.is_empty())
                && seen.insert(letters.clone())
            {
                let word = self.task.word(&self.environment, letters);
                if word.sized >= self.wanted.least {
                    self.found.push(word);
                }
            }
            // A choice of few words is made among the square of their number.
            let is_enough = |few: usize| seen.len() >= few || self.found.len() >= few * few;
            if self.wanted.few.is_some_and(is_enough) {
                break;
            }
        }
        let wanted = self.wanted.few;
        wanted.is_none_or(|few| self.found.len() < few * few)
    }
}
