//! An alignment that has sizes, for candidates whose best alignments have none: two fixed symbols share
//! a column, say, or a symbol would have to vanish. It is a beam search, which finds a good layout
//! where the exact search found none at any tolerance. Unlike the beam of `search`, it carries the
//! equations of the sizes along each path, and drops a path as soon as they have no solution.

use std::collections::BTreeMap;

use crate::align::network::Network;
use crate::align::place::State;
use crate::align::search::{Alignment, NODE_STEPS};
use crate::budget::Budget;
use crate::size::size_equations::SizeEquations;

/// What the search may do.
pub struct SizableBeam<'a> {
    /// The greatest error.
    pub bound: i64,
    /// The number of nodes that are followed in each part of the canvas.
    pub width: usize,
    /// The symbols whose sizes follow from the others.
    pub idle: Vec<bool>,
    /// Whether equations have a solution.
    pub can_size: &'a mut dyn FnMut(&SizeEquations, &mut Budget) -> bool,
}

/// An alignment whose equations have a solution. Of the nodes in one part of the canvas, those are
/// followed first that promise the least error.
pub fn align_sizable(
    network: &Network,
    beam: &mut SizableBeam,
    budget: &mut Budget,
) -> Option<Alignment> {
    let network = &network.with_lower_bound(beam.bound, budget);
    let start = Partial {
        state: network.start(),
        demands: SizeEquations::default(),
        rank: (0, 0, 0),
        parent: None,
    };
    let mut search = Search {
        network,
        partials: vec![start],
        open: BTreeMap::from([(0, vec![0])]),
        ends: Vec::new(),
    };
    while let Some((part, ids)) = search.open.pop_first() {
        let mut share = network.share(part * network.part(), budget);
        search.advance(ids, beam, &mut share);
        budget.charge(&share);
        if !budget.spend(1) {
            break;
        }
    }
    search
        .ends
        .iter()
        .min()
        .map(|(.., end)| search.alignment(*end))
}

/// A path from the start of the canvas to some place.
struct Partial {
    state: State,
    demands: SizeEquations,
    /// The estimated error, the lower bound of the error, and minus the number of columns.
    rank: (i64, i64, i64),
    parent: Option<usize>,
}

impl Partial {
    /// Whether it makes `other` useless, as far as it matters here.
    fn is_as_good(&self, other: &Partial) -> bool {
        let (a, b) = (&self.state, &other.state);
        a.places == b.places
            && a.passed == b.passed
            && a.lengths == b.lengths
            && a.span <= b.span
            && self.demands.implied_by(&other.demands)
    }
}

/// The search along the canvas, part by part.
struct Search<'a> {
    network: &'a Network,
    partials: Vec<Partial>,
    /// The paths that are not followed yet, by the part of the canvas that they reached.
    open: BTreeMap<i64, Vec<usize>>,
    /// The error, minus the columns, and the number of each path that reached the end.
    ends: Vec<(i64, i64, usize)>,
}

impl Search<'_> {
    /// Follows the best of the paths in one part of the canvas.
    fn advance(&mut self, mut ids: Vec<usize>, beam: &mut SizableBeam, budget: &mut Budget) {
        ids.sort_by_key(|id| (self.partials[*id].rank, *id));
        let mut followed: Vec<usize> = Vec::new();
        for id in ids {
            if followed.len() >= beam.width || budget.exhausted {
                return;
            }
            let partial = &self.partials[id];
            let others = || followed.iter().map(|other| &self.partials[*other]);
            let alike = others()
                .filter(|other| other.state.places == partial.state.places)
                .count();
            let is_beaten =
                alike >= (beam.width / 4).max(1) || others().any(|other| other.is_as_good(partial));
            if is_beaten || !(beam.can_size)(&partial.demands, budget) {
                continue;
            }
            if self.network.is_end(&partial.state.places) {
                if self.network.settle(&partial.state.lengths).is_some() {
                    let (error, columns) = (partial.state.error, partial.rank.2);
                    self.ends.push((error, columns, id));
                }
                continue;
            }
            followed.push(id);
            for next in self.successors(id, beam, budget) {
                let part = next.state.span / self.network.part();
                self.open.entry(part).or_default().push(self.partials.len());
                self.partials.push(next);
            }
        }
    }

    /// The paths with one column more.
    fn successors(&self, id: usize, beam: &SizableBeam, budget: &mut Budget) -> Vec<Partial> {
        let (network, partial) = (self.network, &self.partials[id]);
        let mut found = Vec::new();
        let mut steps = budget.part(NODE_STEPS);
        network.expand(
            &partial.state,
            beam.bound,
            &mut steps,
            &mut |next, error| {
                let mut demands = partial.demands.clone();
                let column = [&partial.state.places[..], &next.places[..]];
                demands.add_column(network, column, &beam.idle);
                let ahead = network.lower_bound.as_ref();
                let estimate = next.error + ahead.map_or(0, |ahead| ahead.sum(&next.places));
                found.push(Partial {
                    state: next.clone(),
                    demands,
                    rank: (estimate.max(error), error, partial.rank.2 - 1),
                    parent: Some(id),
                });
            },
        );
        budget.charge(&steps);
        budget.spend(1);
        found
    }

    fn alignment(&self, end: usize) -> Alignment {
        let last = &self.partials[end].state;
        let mut path = vec![last.places.clone()];
        let mut id = end;
        while let Some(parent) = self.partials[id].parent {
            path.push(self.partials[parent].state.places.clone());
            id = parent;
        }
        path.reverse();
        Alignment {
            error: last.error,
            lengths: last.lengths.clone(),
            path,
        }
    }
}
