//! Choices of one word per line of a group that agree in their counters and that rule R5 leaves. Which
//! words there are is found in `candidate`.

use super::budget::Budget;
use super::candidate::{Axis, Window, Word};
use super::word::Environment;

/// A choice of words, one per line of a group.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Number of each line's word among those of its pattern.
    pub words: Vec<usize>,
    /// The counters that they share.
    pub counters: Environment,
    /// A lower bound of the error.
    pub bound: i64,
}

impl Axis<'_> {
    /// The choices of words for a group that rule R5 leaves, by their bounds of the error.
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
        let mut found = Vec::new();
        let start = Partial {
            opaque: 0,
            longest: 0,
            room: i64::MAX,
        };
        let mut choice = Choice {
            words: Vec::new(),
            counters: Environment::new(),
            bound: 0,
        };
        choose(&lines, start, window, &mut choice, budget, &mut found);
        found.sort_by_key(|choice| choice.bound);
        found
    }
}

/// The two environments together, unless they disagree.
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

/// What the words chosen so far leave for the next line.
#[derive(Clone, Copy)]
struct Partial {
    /// The opaque letters of the words above.
    opaque: i64,
    /// The longest word.
    longest: i64,
    /// The least that a word and the empty entries in it can take.
    room: i64,
}

fn choose(
    lines: &[&[Word]],
    above: Partial,
    window: Window,
    choice: &mut Choice,
    budget: &mut Budget,
    found: &mut Vec<Choice>,
) {
    let Some((words, rest)) = lines.split_first() else {
        return found.push(choice.clone());
    };
    for (number, word) in words.iter().enumerate() {
        if !budget.spend(1) {
            return;
        }
        let wild: i64 = word.wildcards.values().sum();
        if word.sized + wild > window.longest
            || wild == 0 && word.sized < window.shortest - above.opaque
        {
            continue;
        }
        let most = if wild == 0 {
            word.sized + above.opaque
        } else {
            i64::MAX
        };
        let next = Partial {
            opaque: above.opaque + word.opaque,
            longest: above.longest.max(word.sized + wild),
            room: above.room.min(most),
        };
        let bound = (next.longest - next.room).max(0);
        let Some(counters) =
            join(&choice.counters, &word.counters).filter(|_| bound <= window.error)
        else {
            continue;
        };
        let before = (
            std::mem::replace(&mut choice.counters, counters),
            std::mem::replace(&mut choice.bound, bound),
        );
        choice.words.push(number);
        choose(rest, next, window, choice, budget, found);
        choice.words.pop();
        (choice.counters, choice.bound) = before;
    }
}
