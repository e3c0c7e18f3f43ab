//! The graph that the solver searches (Zhou 2014, sections 3.4 and 3.6.2). A state is the last
//! piece of an unfinished pattern with that part of its topology descriptor on which the future
//! depends. Costs and lengths are on the steps between states; counters are no part of a state.

use std::collections::HashMap;

use super::task::{Demand, Problem, TooManyStates};
use crate::exemplar::descriptor::Descriptor;
use crate::exemplar::piece::Piece;
use crate::exemplar::seam::{Seam, Seams};

/// One more piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The state after it.
    pub to: u32,
    /// The seam between the last piece and this one.
    pub seam: Seam,
    /// The width of the piece and the gap before it.
    pub length: f64,
    /// Components that are closed by it.
    pub components: u32,
    /// Holes that are closed by it.
    pub holes: u32,
}

/// The end of a pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// The seam with the first piece; the end of an open pattern has one that costs nothing.
    pub seam: Seam,
    /// Components that are closed by it.
    pub components: u32,
    /// Holes that are closed by it.
    pub holes: u32,
}

/// The states that can be reached from the first piece and from which an end can be reached.
#[derive(Clone, Debug, Default)]
pub struct States {
    /// The last piece of each.
    pub pieces: Vec<u16>,
    first: Vec<u32>,
    steps: Vec<Step>,
    /// How the pattern may end there.
    pub ends: Vec<Option<End>>,
    /// Components and holes of the first piece alone. The first state is number 0.
    pub start: (u32, u32),
}

/// The most states of a graph. A state takes about 200 bytes a step: a graph of this size whose
/// states have twenty steps fills 240 MB. More would let a machine swap where an error helps more;
/// fewer would refuse exemplars with many portals.
const MOST_STATES: usize = 60_000;

impl States {
    /// The graph of open patterns: they begin with the first piece and end with the last one.
    ///
    /// # Errors
    /// More states than are kept in memory.
    pub fn open(problem: &Problem) -> Result<States, TooManyStates> {
        let Problem { pieces, task, .. } = *problem;
        let last = pieces.len() - 1;
        let rule = Rule {
            first: 0,
            demand: task.demand,
            allowed: vec![true; pieces.len()],
        };
        let start = pieces[0].descriptor.without_left();
        let end = |piece: usize, d: &Descriptor| {
            let free = Seam {
                cost: 0.0,
                rise: 0.0,
                gap: 0.0,
            };
            (piece == last && d.right.is_empty()).then_some(End {
                seam: free,
                components: 0,
                holes: 0,
            })
        };
        explore(problem, &rule, start, end)
    }

    /// The graph of loops that begin with `first` and use only pieces that are `allowed`.
    ///
    /// # Errors
    /// More states than are kept in memory.
    pub fn closed(
        problem: &Problem,
        first: usize,
        allowed: Vec<bool>,
    ) -> Result<States, TooManyStates> {
        let Problem {
            pieces,
            seams,
            task,
        } = *problem;
        let demand = task.demand;
        let rule = Rule {
            first,
            demand,
            allowed,
        };
        let end = |piece: usize, d: &Descriptor| {
            let seam = seams.get(piece, first)?;
            if !demand.reads_topology() {
                return Some(End {
                    seam,
                    components: 0,
                    holes: 0,
                });
            }
            let closed = d.close()?;
            let wanted = (closed.around > 0 || !demand.around)
                && (demand.components != Some(1) || closed.components == 1);
            wanted.then_some(End {
                seam,
                components: closed.components,
                holes: closed.holes,
            })
        };
        explore(problem, &rule, pieces[first].descriptor.clone(), end)
    }

    /// How many states there are; none where no pattern can be finished.
    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Whether no pattern can be finished.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The steps from `state`.
    pub fn steps(&self, state: u32) -> &[Step] {
        &self.steps[self.first[state as usize] as usize..self.first[state as usize + 1] as usize]
    }

    /// Where the steps of `state` begin among all steps.
    pub fn step_base(&self, state: u32) -> usize {
        self.first[state as usize] as usize
    }

    /// All steps.
    pub fn all_steps(&self) -> &[Step] {
        &self.steps
    }
}

/// Which patterns are explored.
struct Rule {
    first: usize,
    demand: Demand,
    allowed: Vec<bool>,
}

impl Rule {
    /// Whether a pattern may have what a step has closed. Where one component is asked for, nothing
    /// may be closed before the whole.
    fn may_close(&self, merged: &Descriptor) -> bool {
        match self.demand.components {
            Some(1) => {
                merged.components == 0 || (merged.components == 1 && merged.open_components() == 0)
            }
            Some(most) => merged.components <= most,
            None => true,
        }
    }

    /// Whether a pattern must end because its only component is closed.
    fn must_end(&self, d: &Descriptor) -> bool {
        self.demand.components == Some(1) && d.components == 1
    }
}

/// A breadth-first search from the start. A state's descriptor has counters of 0, with one
/// exception: where one component is asked for, a 1 marks the patterns that are whole.
struct Explorer<'a> {
    pieces: &'a [Piece],
    seams: &'a Seams,
    rule: &'a Rule,
    /// The numbers of the states.
    known: HashMap<(u16, Descriptor), u32>,
    /// The states by their numbers.
    list: Vec<(u16, Descriptor)>,
}

fn explore(
    problem: &Problem,
    rule: &Rule,
    start: Descriptor,
    end: impl Fn(usize, &Descriptor) -> Option<End>,
) -> Result<States, TooManyStates> {
    let counts = (start.components, start.holes);
    if rule.demand.reads_topology() && !rule.may_close(&start) {
        return Ok(States::default());
    }
    let mut search = Explorer {
        pieces: problem.pieces,
        seams: problem.seams,
        rule,
        known: HashMap::new(),
        list: Vec::new(),
    };
    search.number(rule.first, start)?;
    let mut links: Vec<Vec<Step>> = Vec::new();
    while links.len() < search.list.len() {
        links.push(search.steps(links.len())?);
    }
    let list = search.list;
    let ends = list
        .iter()
        .map(|(piece, d)| end(*piece as usize, d))
        .collect();
    Ok(keep_finishable(&list, links, ends, counts))
}

impl Explorer<'_> {
    /// The number of the state after `piece`; a new one where the state is new.
    fn number(&mut self, piece: usize, descriptor: Descriptor) -> Result<u32, TooManyStates> {
        let key = (piece as u16, self.reduced(piece, descriptor));
        let list = &mut self.list;
        let number = *self.known.entry(key).or_insert_with_key(|key| {
            list.push(key.clone());
            list.len() as u32 - 1
        });
        if self.list.len() > MOST_STATES {
            Err(TooManyStates(MOST_STATES))
        } else {
            Ok(number)
        }
    }

    /// That part of a descriptor on which the future depends.
    fn reduced(&self, piece: usize, mut d: Descriptor) -> Descriptor {
        if !self.rule.demand.reads_topology() {
            // Only the number of portals matters, and the piece tells it.
            let open = if self.pieces[piece].right.is_empty() {
                vec![]
            } else {
                vec![0]
            };
            return Descriptor {
                right: open,
                ..Descriptor::default()
            };
        }
        let whole = self.rule.demand.components == Some(1) && d.components == 1;
        (d.components, d.holes) = (u32::from(whole), 0);
        d
    }

    /// The steps from the state of this number.
    fn steps(&mut self, number: usize) -> Result<Vec<Step>, TooManyStates> {
        let (piece, descriptor) = self.list[number].clone();
        let mut steps = Vec::new();
        if self.rule.must_end(&descriptor) {
            return Ok(steps);
        }
        for next in (0..self.pieces.len()).filter(|&j| self.rule.allowed[j]) {
            let Some(seam) = self.seams.get(piece as usize, next) else {
                continue;
            };
            let merged = if self.rule.demand.reads_topology() {
                descriptor.merge(&self.pieces[next].descriptor)
            } else {
                Some(Descriptor::default())
            };
            let Some(merged) = merged.filter(|d| self.rule.may_close(d)) else {
                continue;
            };
            let (components, holes) = (merged.components, merged.holes);
            let length = self.pieces[next].width + seam.gap;
            steps.push(Step {
                to: self.number(next, merged)?,
                seam,
                length,
                components,
                holes,
            });
        }
        Ok(steps)
    }
}

/// Drops the states from which no end can be reached, and the steps to them.
fn keep_finishable(
    list: &[(u16, Descriptor)],
    links: Vec<Vec<Step>>,
    ends: Vec<Option<End>>,
    start: (u32, u32),
) -> States {
    let mut before: Vec<Vec<u32>> = vec![Vec::new(); list.len()];
    for (from, steps) in links.iter().enumerate() {
        steps
            .iter()
            .for_each(|s| before[s.to as usize].push(from as u32));
    }
    let mut alive: Vec<bool> = ends.iter().map(Option::is_some).collect();
    let mut queue: Vec<u32> = (0..list.len() as u32)
        .filter(|&s| alive[s as usize])
        .collect();
    while let Some(state) = queue.pop() {
        for &from in &before[state as usize] {
            if !std::mem::replace(&mut alive[from as usize], true) {
                queue.push(from);
            }
        }
    }
    let mut states = States {
        start,
        ..States::default()
    };
    if !alive[0] {
        return states;
    }
    let mut numbers = vec![u32::MAX; list.len()];
    for (new, old) in (0..list.len()).filter(|&s| alive[s]).enumerate() {
        numbers[old] = new as u32;
    }
    states.first.push(0);
    for (old, steps) in links.into_iter().enumerate().filter(|&(s, _)| alive[s]) {
        let kept = steps.into_iter().filter(|s| alive[s.to as usize]);
        states.steps.extend(kept.map(|s| Step {
            to: numbers[s.to as usize],
            ..s
        }));
        states.first.push(states.steps.len() as u32);
        states.pieces.push(list[old].0);
        states.ends.push(ends[old]);
    }
    states
}
