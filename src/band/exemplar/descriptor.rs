//! Topology descriptors (Zhou 2014, section 3.4): which portals of a pattern belong together, and
//! how many components and holes it encloses. Where the portals lie is not known here.

use fretwork_geometry::numeric::WeightedUnionFind;

/// What a pattern, or a piece of one, looks like from its two sides.
///
/// Equal patterns have equal descriptors: components are numbered in the order in which they
/// are met along the left side from below upward, and then along the right side.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Descriptor {
    /// The component of each portal on the left side.
    pub left: Vec<u16>,
    /// The component of each portal on the right side.
    pub right: Vec<u16>,
    /// Components without a portal.
    pub components: u32,
    /// Holes.
    pub holes: u32,
}

/// The counts of a pattern that was closed to a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loop {
    /// Components.
    pub components: u32,
    /// Holes, without the one round which the loop runs.
    pub holes: u32,
    /// Components that run round the loop.
    pub around: u32,
}

impl Descriptor {
    /// The descriptor of a pattern whose portals belong to the components `left` and `right`,
    /// numbered in any way.
    pub fn new(left: &[u16], right: &[u16], components: u32, holes: u32) -> Descriptor {
        let mut numbers = vec![
            None;
            left.iter()
                .chain(right)
                .map(|&c| c as usize + 1)
                .max()
                .unwrap_or(0)
        ];
        let mut met = 0;
        let mut number = |c: &u16| {
            *numbers[*c as usize].get_or_insert_with(|| {
                met += 1;
                met - 1
            })
        };
        let left = left.iter().map(&mut number).collect();
        let right = right.iter().map(&mut number).collect();
        Descriptor {
            left,
            right,
            components,
            holes,
        }
    }

    /// How many components reach a side.
    pub fn open_components(&self) -> usize {
        self.left
            .iter()
            .chain(&self.right)
            .max()
            .map_or(0, |&c| c as usize + 1)
    }

    /// The descriptor of this pattern with `next` joined to its right side, portal to portal; none
    /// when the numbers of portals differ.
    ///
    /// Two portals of one component that are joined to two portals of one component enclose a
    /// hole; a component that keeps no portal is closed. Joining is associative.
    pub fn merge(&self, next: &Descriptor) -> Option<Descriptor> {
        if self.right.len() != next.left.len() {
            return None;
        }
        let base = self.open_components() as u16;
        let mut sets = WeightedUnionFind::new(base + next.open_components() as u16);
        let mut holes = self.holes + next.holes;
        for (&a, &b) in self.right.iter().zip(&next.left) {
            if sets.unite(a, base + b, 0).is_some() {
                holes += 1;
            }
        }
        let left: Vec<u16> = self.left.iter().map(|&c| sets.find(c).0).collect();
        let right: Vec<u16> = next.right.iter().map(|&c| sets.find(base + c).0).collect();
        let closed = sets
            .roots()
            .filter(|root| !left.contains(root) && !right.contains(root))
            .count();
        let components = self.components + next.components + closed as u32;
        Some(Descriptor::new(&left, &right, components, holes))
    }

    /// The counts when the right side is joined to the left side of the same pattern (figure 6);
    /// none when the numbers of portals differ.
    ///
    /// A component runs round the loop when there is a way in it, from a portal back to the same
    /// portal, that passes the joint more often forward than backward or the reverse.
    pub fn close(&self) -> Option<Loop> {
        if self.right.len() != self.left.len() {
            return None;
        }
        let mut sets = WeightedUnionFind::new(self.open_components() as u16);
        // A joint is one turn ahead of where it is joined to.
        let mut round = vec![false; self.open_components()];
        let mut cycles = 0;
        for (&a, &b) in self.right.iter().zip(&self.left) {
            if let Some(turns) = sets.unite(a, b, 1) {
                cycles += 1;
                round[a as usize] |= turns != 0;
            }
        }
        let mut around = vec![false; round.len()];
        for c in 0..round.len() {
            around[sets.find(c as u16).0 as usize] |= round[c];
        }
        let around = around.iter().filter(|&&r| r).count() as u32;
        Some(Loop {
            components: self.components + sets.roots().count() as u32,
            holes: self.holes + cycles - around,
            around,
        })
    }

    /// The same pattern without its left side. Components that reach only the left side are
    /// neither open nor counted then.
    pub fn without_left(&self) -> Descriptor {
        Descriptor::new(&[], &self.right, self.components, self.holes)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn descriptor(left: &[u16], right: &[u16]) -> Descriptor {
        Descriptor::new(left, right, 0, 0)
    }

    #[test]
    fn joining_closes_components_and_holes() {
        let fork = descriptor(&[0], &[0, 0, 1]);
        let join = descriptor(&[0, 0, 1], &[0]);
        let closed = fork.merge(&join).unwrap();
        assert_eq!(closed, Descriptor::new(&[0], &[0], 1, 1));
        assert!(fork.merge(&fork).is_none());
    }

    #[test]
    fn equal_numbers_of_components_can_end_differently() {
        // Figure 5: the same last piece after two patterns of two components each.
        let end = descriptor(&[0, 1, 1], &[]);
        let below = descriptor(&[], &[0, 0, 1]).merge(&end).unwrap();
        let above = descriptor(&[], &[0, 1, 1]).merge(&end).unwrap();
        assert_eq!((below.components, below.holes), (1, 0));
        assert_eq!((above.components, above.holes), (2, 1));
    }

    #[test]
    fn a_loop_of_one_component_need_not_close() {
        // Figure 6: above, a component passes through; below, the two ends only meet at the joint.
        let through = descriptor(&[0, 0], &[0, 0]);
        assert_eq!(
            through.close(),
            Some(Loop {
                components: 1,
                holes: 1,
                around: 1
            })
        );
        let ends = descriptor(&[0, 1], &[0, 2]);
        assert_eq!(
            ends.close(),
            Some(Loop {
                components: 2,
                holes: 0,
                around: 1
            })
        );
        let apart = descriptor(&[0], &[1]);
        assert_eq!(
            apart.close(),
            Some(Loop {
                components: 1,
                holes: 0,
                around: 0
            })
        );
    }

    #[test]
    fn a_spiral_that_is_joined_twice_runs_round_once() {
        // Portal 0 leads to portal 1 and portal 1 to nothing: a spiral of two turns with two ends.
        let spiral = descriptor(&[0, 1], &[2, 0]);
        assert_eq!(
            spiral.close(),
            Some(Loop {
                components: 1,
                holes: 0,
                around: 0
            })
        );
        let hook = descriptor(&[0, 1], &[1, 1]);
        assert_eq!(
            hook.close(),
            Some(Loop {
                components: 1,
                holes: 0,
                around: 1
            })
        );
    }

    /// A pattern of random pieces, as lists of components over 2 to 5 portals a seam.
    fn piece(left: usize, right: usize) -> impl Strategy<Value = Descriptor> {
        (
            prop::collection::vec(0u16..4, left + right),
            0u32..2,
            0u32..2,
        )
            .prop_map(move |(c, components, holes)| {
                Descriptor::new(&c[..left], &c[left..], components, holes)
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            failure_persistence: None,
            ..ProptestConfig::with_cases(500)
        })]

        #[test]
        fn joining_is_associative(
            (a, b, c) in (0usize..5, 0usize..5, 0usize..5, 0usize..5)
                .prop_flat_map(|(w, x, y, z)| (piece(w, x), piece(x, y), piece(y, z)))
        ) {
            let left = a.merge(&b).unwrap().merge(&c);
            let right = a.merge(&b.merge(&c).unwrap());
            prop_assert_eq!(&left, &right);
            // The characteristic components - holes is that of the parts less one a portal.
            let euler = |d: &Descriptor| {
                d.open_components() as i64 + i64::from(d.components) - i64::from(d.holes)
            };
            let seams = (a.right.len() + b.right.len()) as i64;
            prop_assert_eq!(euler(&left.unwrap()), euler(&a) + euler(&b) + euler(&c) - seams);
        }
    }
}
