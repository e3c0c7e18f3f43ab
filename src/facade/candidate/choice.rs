//! The choices of one word for each line of a group that agree in their counters and that rule R5
//! allows. The words are found in `words`.

use super::axis_task::{AxisTask, Window};
use super::words::Word;
use crate::budget::Budget;
use crate::pattern::word::Environment;

/// A choice of words, one for each line of a group.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The number of each line's word among the words of its pattern.
    pub words: Vec<usize>,
    /// The counters of the words together.
    pub counters: Environment,
    /// A lower bound of the alignment error, in steps.
    pub bound: i64,
}

impl AxisTask<'_> {
    /// The choices of words for a group that rule R5 allows, in the order of their bounds. `words`
    /// holds the words of each pattern.
    pub fn choices(
        &self,
        group: usize,
        words: &[Vec<Word>],
        window: Window,
        budget: &mut Budget,
    ) -> Vec<Choice> {
        let lines: Vec<&[Word]> = self
            .lines
            .iter()
            .filter(|l| l.group == group)
            .map(|l| &words[l.pattern][..])
            .collect();
        let mut chooser = Chooser {
            window,
            choice: Choice {
                words: Vec::new(),
                counters: Environment::new(),
                bound: 0,
            },
            budget,
            found: Vec::new(),
        };
        let above = Above {
            opaque: 0,
            longest: 0,
            room: i64::MAX,
        };
        chooser.choose(&lines, above);
        let mut found = chooser.found;
        found.sort_by_key(|choice| choice.bound);
        found
    }
}

/// The two environments together; `None` if they disagree.
pub fn join(a: &Environment, b: &Environment) -> Option<Environment> {
    let agree = b
        .iter()
        .all(|(counter, k)| a.get(counter).is_none_or(|other| other == k));
    agree.then(|| {
        a.iter()
            .chain(b)
            .map(|(counter, k)| (*counter, *k))
            .collect()
    })
}

/// What the words chosen so far leave for the lines below them, in steps.
#[derive(Clone, Copy)]
struct Above {
    /// The length of the opaque letters.
    opaque: i64,
    /// The length of the longest word.
    longest: i64,
    /// The least over all words of the length that a word can take with empty entries in it. Empty
    /// entries lie below opaque letters, so they are at most as long as those.
    room: i64,
}

struct Chooser<'a> {
    window: Window,
    /// The words chosen so far.
    choice: Choice,
    budget: &'a mut Budget,
    found: Vec<Choice>,
}

impl Chooser<'_> {
    /// Chooses a word for the first of `lines` in every way, and then for the others.
    fn choose(&mut self, lines: &[&[Word]], above: Above) {
        let Some((words, rest)) = lines.split_first() else {
            return self.found.push(self.choice.clone());
        };
        for (number, word) in words.iter().enumerate() {
            if !self.budget.spend(1) {
                return;
            }
            let Some(next) = self.with_word(above, word) else {
                continue;
            };
            // The longest word and the word with the least room lie in the same columns.
            let bound = (next.longest - next.room).max(0);
            let Some(counters) =
                join(&self.choice.counters, &word.counters).filter(|_| bound <= self.window.error)
            else {
                continue;
            };
            let before = (
                std::mem::replace(&mut self.choice.counters, counters),
                std::mem::replace(&mut self.choice.bound, bound),
            );
            self.choice.words.push(number);
            self.choose(rest, next);
            self.choice.words.pop();
            (self.choice.counters, self.choice.bound) = before;
        }
    }

    /// What is left below one more word; `None` if its length is out of the bounds of rule R5.
    fn with_word(&self, above: Above, word: &Word) -> Option<Above> {
        let wild: i64 = word.wildcards.values().sum();
        let is_too_short = wild == 0 && word.sized < self.window.shortest - above.opaque;
        if word.sized + wild > self.window.longest || is_too_short {
            return None;
        }
        let most = if wild == 0 {
            word.sized + above.opaque
        } else {
            i64::MAX
        };
        Some(Above {
            opaque: above.opaque + word.opaque,
            longest: above.longest.max(word.sized + wild),
            room: above.room.min(most),
        })
    }
}
