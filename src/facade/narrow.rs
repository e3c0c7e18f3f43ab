//! A good alignment of a candidate in few steps, where the search for the best one was cut short: the
//! narrow search of `search`, and that of `constrained`, with bounds that keep them going forward.

use std::collections::BTreeSet;

use super::balance::Balance;
use super::budget::Budget;
use super::comparison::SIZE_STEPS;
use super::constrained::align_sizable;
use super::network::Network;
use super::search::{Alignment, Width, align};
use super::selection::Selection;
use super::sizing::{Equation, size};

/// The steps that may be taken for one candidate: it may not take what all the others need.
const CANDIDATE_STEPS: u64 = 300_000;

impl Selection<'_, '_> {
    /// A good alignment. More is found where the bound is tight: what is far above the guess is looked at last.
    pub fn align_narrow(&mut self, network: &Network, bound: i64) -> Vec<Alignment> {
        let guess = network.guess(bound, self.budget);
        let likely = guess + guess / 2;
        if likely > bound + bound / 2 {
            return Vec::new();
        }
        for bound in BTreeSet::from([likely.min(bound), bound]) {
            let found = match self.width {
                Width::Sizable(width) => self
                    .align_sizable(network, bound, width)
                    .into_iter()
                    .collect(),
                width => {
                    let mut share = self.budget.part(CANDIDATE_STEPS);
                    let found = align(network, bound, width, &mut share);
                    self.budget.charge(&share);
                    found
                }
            };
            if !found.is_empty() {
                return found;
            }
        }
        Vec::new()
    }

    /// An alignment that sizes can be found for.
    fn align_sizable(&mut self, network: &Network, bound: i64, width: usize) -> Option<Alignment> {
        let preferences = self.axis.preferences();
        let (canvas, known) = (self.axis.canvas, &mut self.known_sizes);
        let mut can_size = |balance: &Balance, budget: &mut Budget| {
            let demands = balance.equations.iter();
            let all: BTreeSet<Equation> = demands
                .map(|terms| Equation {
                    terms: terms.clone(),
                    is_canvas: false,
                })
                .collect();
            if let Some(sizes) = known.get(&all) {
                return sizes.is_some();
            }
            if !budget.spend(SIZE_STEPS) {
                return false;
            }
            let list: Vec<Equation> = all.iter().cloned().collect();
            known
                .entry(all)
                .or_insert_with(|| size(&preferences, &list, canvas))
                .is_some()
        };
        let mut share = self.budget.part(2 * CANDIDATE_STEPS);
        let found = align_sizable(
            network,
            bound,
            width,
            self.axis.symbols.len(),
            &mut share,
            &mut can_size,
        );
        self.budget.charge(&share);
        found
    }
}
