//! The pattern language (rule R1): from a text to a tree, with the place of every mistake. The words
//! of a tree are in `word`; the sizes of symbols are not known here.

use std::collections::{BTreeMap, BTreeSet};

/// A pattern: a tree of letters, or a control tree with trees to put in place of some of its letters.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pattern {
    /// The tree that is read first.
    pub control: PatternTree,
    /// The trees that replace letters of the control tree; `None` for a plain pattern, all of whose
    /// letters stand for themselves.
    pub content: Option<BTreeMap<char, PatternTree>>,
}

/// A part of a pattern.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PatternTree {
    /// One symbol.
    Letter(char),
    /// One after another; at least two.
    Sequence(Vec<PatternTree>),
    /// One of these, chosen anew at each use; at least two.
    Choice(Vec<PatternTree>),
    /// A repetition; a negative exponent mirrors.
    Power(Box<PatternTree>, Exponent),
}

/// How often a base is repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exponent {
    /// This often.
    Number(i64),
    /// As often as the counter says, mirrored when `negative` and the counter differ in sign.
    Counter {
        /// The letter of the counter.
        name: char,
        /// Whether a minus stands before it.
        negative: bool,
    },
}

/// The greatest depth of nested groups and exponents. Patterns are read by recursion, and no pattern
/// written by hand comes near to it.
pub const MAX_DEPTH: usize = 200;
/// The most letters of a word. More would not be told apart on any facade, and their alignment takes
/// too long.
pub const MAX_LETTERS: i64 = 100_000;

/// What is wrong in a pattern's text, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind}")]
pub struct PatternError {
    /// The first character that the mistake is about, counted in characters from 0.
    pub offset: usize,
    /// The number of characters; 0 at the end of the text.
    pub length: usize,
    /// The mistake.
    pub kind: PatternErrorKind,
}

/// The mistakes that a pattern's text can hold.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[allow(missing_docs)]
pub enum PatternErrorKind {
    #[error("the pattern is empty")]
    Empty,
    #[error("`{0}` is not a symbol: a symbol is one letter")]
    NotASymbol(char),
    #[error("a symbol or a group is missing before `{0}`")]
    MissingBefore(char),
    #[error("a symbol or a group is missing at the end of the pattern")]
    MissingAtEnd,
    #[error("the group is empty")]
    EmptyGroup,
    #[error("unbalanced group: `)` without `(`")]
    Unopened,
    #[error("unbalanced group: `(` without `)`")]
    Unclosed,
    #[error("groups and exponents are nested deeper than {MAX_DEPTH}")]
    TooDeep,
    #[error("a number or the letter of a counter is missing after `^`")]
    MissingExponent,
    #[error("the exponent is above {MAX_LETTERS}")]
    HugeExponent,
    #[error("every word of the pattern has more than {MAX_LETTERS} letters")]
    TooLong,
}

/// Parses one text. White space is ignored. `^` binds tightest, then `|`, then concatenation, with or
/// without a dot: `A|B.C` has the words AC and BC (table in section 3.2 of the paper).
///
/// # Errors
/// The first mistake, with its place.
pub fn parse(text: &str) -> Result<PatternTree, PatternError> {
    let chars: Vec<(usize, char)> = text
        .chars()
        .enumerate()
        .filter(|(_, c)| !c.is_whitespace())
        .collect();
    let mut parser = Parser {
        chars: &chars,
        at: 0,
        end: text.chars().count(),
    };
    if chars.is_empty() {
        return Err(PatternError {
            offset: 0,
            length: parser.end,
            kind: PatternErrorKind::Empty,
        });
    }
    let (tree, _) = parser.sequence(0)?;
    match parser.peek() {
        Some(_) => Err(parser.error(PatternErrorKind::Unopened)),
        None if tree.fewest_letters() > MAX_LETTERS => Err(PatternError {
            offset: 0,
            length: parser.end,
            kind: PatternErrorKind::TooLong,
        }),
        None => Ok(tree),
    }
}

impl Pattern {
    /// The counters of the pattern in order of appearance.
    pub fn counters(&self) -> Vec<char> {
        let mut all = self.control.counters();
        for tree in self.content.iter().flatten().map(|(_, tree)| tree) {
            for counter in tree.counters() {
                if !all.contains(&counter) {
                    all.push(counter);
                }
            }
        }
        all
    }

    /// The symbols that letters of its words can be.
    pub fn letters(&self) -> BTreeSet<char> {
        let replaced = |c: &char| self.content.as_ref().is_some_and(|own| own.contains_key(c));
        let kept = self.control.symbols().into_iter().filter(|c| !replaced(c));
        kept.chain(self.content.iter().flatten().flat_map(|(_, t)| t.symbols()))
            .collect()
    }

    /// The symbols of letters that are drawn: those of the content, or all of a plain pattern.
    pub fn solid_letters(&self) -> BTreeSet<char> {
        match &self.content {
            None => self.letters(),
            Some(content) => content.values().flat_map(PatternTree::symbols).collect(),
        }
    }

    /// Whether letters of its words can be of this symbol.
    pub fn uses(&self, symbol: char) -> bool {
        let content = self.content.as_ref();
        content
            .into_iter()
            .flatten()
            .any(|(_, tree)| tree.symbols().contains(&symbol))
            || self.control.symbols().contains(&symbol)
                && content.is_none_or(|c| !c.contains_key(&symbol))
    }
}

impl PatternTree {
    /// The distinct symbols in order of appearance.
    pub fn symbols(&self) -> Vec<char> {
        let mut found = Vec::new();
        self.visit(&mut |tree| {
            if let PatternTree::Letter(c) = tree
                && !found.contains(c)
            {
                found.push(*c);
            }
        });
        found
    }

    /// The distinct counters in order of appearance.
    pub fn counters(&self) -> Vec<char> {
        let mut found = Vec::new();
        self.visit(&mut |tree| {
            if let PatternTree::Power(_, Exponent::Counter { name, .. }) = tree
                && !found.contains(name)
            {
                found.push(*name);
            }
        });
        found
    }

    fn visit<'a>(&'a self, see: &mut impl FnMut(&'a PatternTree)) {
        see(self);
        match self {
            PatternTree::Letter(_) => {}
            PatternTree::Sequence(parts) | PatternTree::Choice(parts) => {
                parts.iter().for_each(|p| p.visit(see))
            }
            PatternTree::Power(base, _) => base.visit(see),
        }
    }

    /// A lower bound of the number of letters of any word, whatever the counters are.
    fn fewest_letters(&self) -> i64 {
        match self {
            PatternTree::Letter(_) => 1,
            PatternTree::Sequence(parts) => parts
                .iter()
                .fold(0, |sum: i64, p| sum.saturating_add(p.fewest_letters())),
            PatternTree::Choice(parts) => parts
                .iter()
                .map(PatternTree::fewest_letters)
                .min()
                .unwrap_or(0),
            PatternTree::Power(base, Exponent::Number(k)) => {
                base.fewest_letters().saturating_mul(k.abs())
            }
            PatternTree::Power(_, Exponent::Counter { .. }) => 0,
        }
    }
}

struct Parser<'a> {
    chars: &'a [(usize, char)],
    at: usize,
    end: usize,
}

/// A tree and the depth of the groups and exponents in it.
type Deep = (PatternTree, usize);

impl Parser<'_> {
    fn peek(&self) -> Option<char> {
        self.chars.get(self.at).map(|(_, c)| *c)
    }

    fn error(&self, kind: PatternErrorKind) -> PatternError {
        match self.chars.get(self.at) {
            Some((offset, _)) => PatternError {
                offset: *offset,
                length: 1,
                kind,
            },
            None => PatternError {
                offset: self.end,
                length: 0,
                kind,
            },
        }
    }

    fn sequence(&mut self, outside: usize) -> Result<Deep, PatternError> {
        let (first, mut depth) = self.choice(outside)?;
        let mut parts = vec![first];
        while let Some(c) = self.peek()
            && c != ')'
        {
            if c == '.' {
                self.at += 1;
            }
            let (part, deep) = self.choice(outside)?;
            depth = depth.max(deep);
            parts.push(part);
        }
        Ok((one_or(parts, PatternTree::Sequence), depth))
    }

    fn choice(&mut self, outside: usize) -> Result<Deep, PatternError> {
        let (first, mut depth) = self.power(outside)?;
        let mut parts = vec![first];
        while self.peek() == Some('|') {
            self.at += 1;
            let (part, deep) = self.power(outside)?;
            depth = depth.max(deep);
            parts.push(part);
        }
        Ok((one_or(parts, PatternTree::Choice), depth))
    }

    fn power(&mut self, outside: usize) -> Result<Deep, PatternError> {
        let (mut tree, mut depth) = self.atom(outside)?;
        while self.peek() == Some('^') {
            if outside + depth >= MAX_DEPTH {
                return Err(self.error(PatternErrorKind::TooDeep));
            }
            self.at += 1;
            tree = PatternTree::Power(Box::new(tree), self.exponent()?);
            depth += 1;
        }
        Ok((tree, depth))
    }

    fn atom(&mut self, outside: usize) -> Result<Deep, PatternError> {
        match self.peek() {
            None => Err(self.error(PatternErrorKind::MissingAtEnd)),
            Some('(') => self.group(outside),
            Some(')') if outside == 0 => Err(self.error(PatternErrorKind::Unopened)),
            Some(c @ (')' | '|' | '.' | '^')) => {
                Err(self.error(PatternErrorKind::MissingBefore(c)))
            }
            Some(c) if c.is_alphabetic() => {
                self.at += 1;
                Ok((PatternTree::Letter(c), 0))
            }
            Some(c) => Err(self.error(PatternErrorKind::NotASymbol(c))),
        }
    }

    fn group(&mut self, outside: usize) -> Result<Deep, PatternError> {
        if outside >= MAX_DEPTH {
            return Err(self.error(PatternErrorKind::TooDeep));
        }
        let opening = self.at;
        self.at += 1;
        let start = self.chars[opening].0;
        match self.peek() {
            Some(')') => {
                let length = self.chars[self.at].0 + 1 - start;
                return Err(PatternError {
                    offset: start,
                    length,
                    kind: PatternErrorKind::EmptyGroup,
                });
            }
            None => {
                return Err(PatternError {
                    offset: start,
                    length: 1,
                    kind: PatternErrorKind::Unclosed,
                });
            }
            Some(_) => {}
        }
        let (tree, depth) = self.sequence(outside + 1)?;
        if self.peek() != Some(')') {
            return Err(PatternError {
                offset: start,
                length: 1,
                kind: PatternErrorKind::Unclosed,
            });
        }
        self.at += 1;
        Ok((tree, depth + 1))
    }

    fn exponent(&mut self) -> Result<Exponent, PatternError> {
        let start = self.at;
        let negative = self.peek() == Some('-');
        if negative {
            self.at += 1;
        }
        match self.peek() {
            Some(c) if c.is_ascii_digit() => {
                let mut value = 0i64;
                while let Some(digit) = self.peek().and_then(|c| c.to_digit(10)) {
                    value = value.saturating_mul(10).saturating_add(digit.into());
                    self.at += 1;
                }
                if value > MAX_LETTERS {
                    let (offset, last) = (self.chars[start].0, self.chars[self.at - 1].0);
                    return Err(PatternError {
                        offset,
                        length: last + 1 - offset,
                        kind: PatternErrorKind::HugeExponent,
                    });
                }
                Ok(Exponent::Number(if negative { -value } else { value }))
            }
            Some(name) if name.is_alphabetic() => {
                self.at += 1;
                Ok(Exponent::Counter { name, negative })
            }
            _ => Err(self.error(PatternErrorKind::MissingExponent)),
        }
    }
}

fn one_or(
    mut parts: Vec<PatternTree>,
    several: fn(Vec<PatternTree>) -> PatternTree,
) -> PatternTree {
    if parts.len() == 1
        && let Some(only) = parts.pop()
    {
        return only;
    }
    several(parts)
}
