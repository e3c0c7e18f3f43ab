//! A good alignment of one candidate in few steps, for when the search for the best one was cut short:
//! the beam searches of `search` and `sizable`, with bounds that keep them going forward.

use std::collections::BTreeSet;

use super::contest::{Contest, SIZE_STEPS};
use super::sizable::{SizableBeam, align_sizable};
use crate::align::network::Network;
use crate::align::search::{Alignment, Effort, align};
use crate::budget::Budget;
use crate::size::least_squares::{Equation, size};
use crate::size::size_equations::SizeEquations;

/// The steps for one candidate. With more, the first candidates may use up what all the others need;
/// with fewer, a beam does not reach the end of a row of a hundred letters.
const CANDIDATE_STEPS: u64 = 300_000;

impl Contest<'_, '_> {
    /// A good alignment with an error of at most `bound`.
    ///
    /// A beam finds more where its bound is tight, because fewer nodes compete in it. So it is tried
    /// first with one and a half times the estimated error. A candidate whose estimate is far above
    /// the bound is not tried at all.
    pub fn align_in_few_steps(&mut self, network: &Network, bound: i64) -> Vec<Alignment> {
        let estimate = network.guess(bound, self.budget);
        let likely = estimate + estimate / 2;
        if likely > bound + bound / 2 {
            return Vec::new();
        }
        for bound in BTreeSet::from([likely.min(bound), bound]) {
            let found = match self.effort {
                Effort::SizableBeam(width) => self
                    .align_sizable(network, bound, width)
                    .into_iter()
                    .collect(),
                effort => {
                    let mut share = self.budget.part(CANDIDATE_STEPS);
                    let found = align(network, bound, effort, &mut share);
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

    /// An alignment that has sizes.
    fn align_sizable(&mut self, network: &Network, bound: i64, width: usize) -> Option<Alignment> {
        let preferences = self.task.preferences();
        let (canvas, known) = (self.task.canvas, &mut self.known_sizes);
        let mut can_size = |demands: &SizeEquations, budget: &mut Budget| {
            let demands = demands.equations.iter();
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
        let idle = vec![false; self.task.symbols.len()];
        let mut beam = SizableBeam {
            bound,
            width,
            idle,
            can_size: &mut can_size,
        };
        let found = align_sizable(network, &mut beam, &mut share);
        self.budget.charge(&share);
        found
    }
}
