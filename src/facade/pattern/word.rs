//! From patterns to words (rules R1 and R3), one word at a time. They come in the lexicographic order of
//! the choices made from left to right, control before content. Values of counters and lengths are
//! chosen in `candidate`.

use std::collections::BTreeMap;

use crate::pattern::syntax::{Exponent, MAX_LETTERS, Pattern, PatternTree};

/// A symbol's instance in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Letter {
    /// The symbol.
    pub symbol: char,
    /// Whether the number of negative exponents around it is odd.
    pub mirrored: bool,
    /// Whether it is a letter of a control pattern that nothing replaced.
    pub transparent: bool,
}

/// The values of counters.
pub type Environment = BTreeMap<char, i64>;

/// An iterator over the words of a pattern whose length does not exceed `limit`. A word may come twice.
/// Each call of `next` interprets the pattern once; the item is `None` if that word is too long.
pub struct Words<'a> {
    pattern: &'a Pattern,
    counters: &'a Environment,
    size: &'a dyn Fn(char) -> i64,
    limit: i64,
    /// For each use of an alternation that the last word came to: the number of the alternative taken,
    /// and how many there are.
    choices: Vec<(usize, usize)>,
    done: bool,
    /// Whether a word was given up because it has too many letters, although it is not too long.
    pub too_many_letters: bool,
}

impl<'a> Words<'a> {
    /// The words with these values of counters, measured by `size`. A missing counter is 0.
    pub fn new(
        pattern: &'a Pattern,
        counters: &'a Environment,
        size: &'a dyn Fn(char) -> i64,
        limit: i64,
    ) -> Words<'a> {
        Words {
            pattern,
            counters,
            size,
            limit,
            choices: Vec::new(),
            done: false,
            too_many_letters: false,
        }
    }

    /// Moves the last use that has an alternative left to its next one.
    fn advance(&mut self, read: usize) {
        self.choices.truncate(read);
        while let Some((taken, of)) = self.choices.pop() {
            if taken + 1 < of {
                self.choices.push((taken + 1, of));
                return;
            }
        }
        self.done = true;
    }
}

impl Iterator for Words<'_> {
    type Item = Option<Vec<Letter>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let mut reader = Reader {
            counters: self.counters,
            size: self.size,
            choices: std::mem::take(&mut self.choices),
            read: 0,
            length: 0,
            limit: self.limit,
            crowded: false,
        };
        let word = reader.word(self.pattern);
        self.too_many_letters |= reader.crowded;
        self.choices = reader.choices;
        self.advance(reader.read);
        Some(word)
    }
}

/// Bounds of the lengths of all words: no word is shorter than the first or longer than the second.
pub fn extent(pattern: &Pattern, counters: &Environment, size: &dyn Fn(char) -> i64) -> (i64, i64) {
    let content = pattern.content.iter().flatten();
    let content: BTreeMap<char, (i64, i64)> = content
        .map(|(c, tree)| (*c, extent_of(tree, counters, &|c| (size(c), size(c)))))
        .collect();
    extent_of(&pattern.control, counters, &|c| {
        content
            .get(&c)
            .copied()
            .unwrap_or_else(|| (size(c), size(c)))
    })
}

fn extent_of(
    tree: &PatternTree,
    counters: &Environment,
    size: &dyn Fn(char) -> (i64, i64),
) -> (i64, i64) {
    let of = |part: &PatternTree| extent_of(part, counters, size);
    match tree {
        PatternTree::Letter(c) => size(*c),
        PatternTree::Sequence(parts) => parts.iter().map(of).fold((0i64, 0i64), |sum, part| {
            (sum.0.saturating_add(part.0), sum.1.saturating_add(part.1))
        }),
        PatternTree::Choice(parts) => {
            let parts: Vec<(i64, i64)> = parts.iter().map(of).collect();
            (
                parts.iter().map(|p| p.0).min().unwrap_or(0),
                parts.iter().map(|p| p.1).max().unwrap_or(0),
            )
        }
        PatternTree::Power(base, exponent) => {
            let (base, times) = (of(base), exponent.value(counters).saturating_abs());
            (base.0.saturating_mul(times), base.1.saturating_mul(times))
        }
    }
}

impl Exponent {
    /// The number that it stands for; a counter without a value is 0.
    pub fn value(self, counters: &Environment) -> i64 {
        match self {
            Exponent::Number(k) => k,
            Exponent::Counter { name, negative } => {
                let k = counters.get(&name).copied().unwrap_or(0);
                if negative { k.saturating_neg() } else { k }
            }
        }
    }
}

/// One interpretation of a pattern.
struct Reader<'a> {
    counters: &'a Environment,
    size: &'a dyn Fn(char) -> i64,
    choices: Vec<(usize, usize)>,
    read: usize,
    length: i64,
    limit: i64,
    crowded: bool,
}

impl Reader<'_> {
    fn word(&mut self, pattern: &Pattern) -> Option<Vec<Letter>> {
        let Some(content) = &pattern.content else {
            let mut word = Vec::new();
            self.tree(&pattern.control, &|_| 1, &mut word)?;
            return Some(word);
        };
        let mut control = Vec::new();
        self.tree(
            &pattern.control,
            &|c| i64::from(!content.contains_key(&c)),
            &mut control,
        )?;
        let mut words = BTreeMap::new();
        for (key, tree) in content {
            let times = control.iter().filter(|l| l.symbol == *key).count() as i64;
            let mut word = Vec::new();
            self.tree(tree, &|_| times, &mut word)?;
            words.insert(*key, word);
        }
        let mut word = Vec::with_capacity(control.len());
        for letter in control {
            match words.get(&letter.symbol) {
                None => word.push(Letter {
                    transparent: true,
                    ..letter
                }),
                Some(inner) if letter.mirrored => {
                    word.extend(inner.iter().rev().map(|l| l.flipped()))
                }
                Some(inner) => word.extend_from_slice(inner),
            }
            self.count(word.len())?;
        }
        Some(word)
    }

    /// Appends a word of `tree`. Each letter of it will be in the whole word `times(letter)` times.
    /// `None` if that is too long.
    fn tree(
        &mut self,
        tree: &PatternTree,
        times: &dyn Fn(char) -> i64,
        out: &mut Vec<Letter>,
    ) -> Option<()> {
        match tree {
            PatternTree::Letter(symbol) => {
                out.push(Letter {
                    symbol: *symbol,
                    mirrored: false,
                    transparent: false,
                });
                self.grow(
                    (self.size)(*symbol).saturating_mul(times(*symbol)),
                    out.len(),
                )
            }
            PatternTree::Sequence(parts) => parts.iter().try_for_each(|p| self.tree(p, times, out)),
            PatternTree::Choice(parts) => {
                let taken = self.choose(parts.len())?;
                self.tree(&parts[taken], times, out)
            }
            PatternTree::Power(base, exponent) => {
                self.power(base, exponent.value(self.counters), times, out)
            }
        }
    }

    fn power(
        &mut self,
        base: &PatternTree,
        k: i64,
        times: &dyn Fn(char) -> i64,
        out: &mut Vec<Letter>,
    ) -> Option<()> {
        let mut left = k.unsigned_abs();
        while left > 0 {
            let (start, read, length) = (out.len(), self.read, self.length);
            self.tree(base, times, out)?;
            if k < 0 {
                out[start..].reverse();
                out[start..].iter_mut().for_each(|l| *l = l.flipped());
            }
            left -= 1;
            if self.read == read {
                return self.repeat(start, length, left, out);
            }
        }
        Some(())
    }

    /// Appends what follows `start` so many more times; it holds no choice.
    fn repeat(
        &mut self,
        start: usize,
        length: i64,
        times: u64,
        out: &mut Vec<Letter>,
    ) -> Option<()> {
        let end = out.len();
        let times = times.min(i64::MAX as u64) as i64;
        let letters = ((end - start) as i64)
            .saturating_mul(times)
            .saturating_add(end as i64);
        let added = (self.length - length).saturating_mul(times);
        self.grow(added, letters.clamp(0, i64::MAX / 2) as usize)?;
        if end > start {
            (0..times).for_each(|_| out.extend_from_within(start..end));
        }
        Some(())
    }

    fn choose(&mut self, of: usize) -> Option<usize> {
        if self.read == self.choices.len() {
            self.choices.push((0, of));
        }
        let (taken, _) = self.choices[self.read];
        self.read += 1;
        self.count(self.read)?;
        Some(taken)
    }

    fn grow(&mut self, by: i64, letters: usize) -> Option<()> {
        self.length = self.length.saturating_add(by);
        if self.length > self.limit {
            return None;
        }
        self.count(letters)
    }

    fn count(&mut self, letters: usize) -> Option<()> {
        self.crowded |= letters as i64 > MAX_LETTERS;
        (!self.crowded).then_some(())
    }
}

impl Letter {
    fn flipped(self) -> Letter {
        Letter {
            mirrored: !self.mirrored,
            ..self
        }
    }
}
