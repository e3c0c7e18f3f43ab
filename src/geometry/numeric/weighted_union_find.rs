//! Disjoint sets whose members have a distance from one another.

/// Disjoint sets whose members know how far they are ahead of their root: union-find with potentials.
///
/// It answers the question whether a system of equations `x[b] - x[a] = d` has a solution while equations are
/// added one at a time: an equation between members of one set is implied by the others, or contradicts them
/// by the number that [`WeightedUnionFind::unite`] gives. The least number of a set is its root, so roots do not
/// depend on the order of the equations.
///
/// It has no path compression, for it serves the few members of a portal; O(n) for each operation at worst.
///
/// ```
/// use fretwork_geometry::numeric::WeightedUnionFind;
/// let mut sets = WeightedUnionFind::new(3);
/// assert_eq!(sets.unite(0, 1, 1), None);
/// assert_eq!(sets.unite(1, 2, 1), None);
/// // The way 0, 1, 2 and back to 0 ends one turn ahead of where it began.
/// assert_eq!(sets.unite(2, 0, -1), Some(1));
/// assert_eq!(sets.find(2), (0, 2));
/// ```
#[derive(Clone, Debug)]
pub struct WeightedUnionFind {
    /// The parent of every member, and how far the member is ahead of it.
    parents: Vec<(u16, i32)>,
}

impl WeightedUnionFind {
    /// Every number from 0 to `len` - 1 in a set of its own.
    pub fn new(len: u16) -> WeightedUnionFind {
        WeightedUnionFind {
            parents: (0..len).map(|i| (i, 0)).collect(),
        }
    }

    /// The root of `i`, which must be one of the numbers, and how far `i` is ahead of it.
    pub fn find(&self, mut i: u16) -> (u16, i32) {
        let mut ahead = 0;
        while self.parents[i as usize].0 != i {
            ahead += self.parents[i as usize].1;
            i = self.parents[i as usize].0;
        }
        (i, ahead)
    }

    /// Tells that `b` is `ahead` of `a`. Where both were in one set already, gives by how much the way from `a` to
    /// `b` and back through the set misses its beginning; 0 where the equation holds.
    pub fn unite(&mut self, a: u16, b: u16, ahead: i32) -> Option<i32> {
        let ((root_a, ahead_a), (root_b, ahead_b)) = (self.find(a), self.find(b));
        let miss = ahead_a + ahead - ahead_b;
        if root_a == root_b {
            return Some(miss);
        }
        if root_a < root_b {
            self.parents[root_b as usize] = (root_a, miss);
        } else {
            self.parents[root_a as usize] = (root_b, -miss);
        }
        None
    }

    /// The least number of every set, ascending.
    pub fn roots(&self) -> impl Iterator<Item = u16> + '_ {
        (0..self.parents.len() as u16).filter(|&i| self.parents[i as usize].0 == i)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    #[test]
    fn agrees_with_moving_whole_sets() {
        for case in 0..20 {
            let seed = Seed::root(case);
            let mut sets = WeightedUnionFind::new(12);
            // Set and position of every member; the root of a set stands at 0.
            let mut slow: Vec<(u16, i32)> = (0..12).map(|i| (i, 0)).collect();
            for k in 0..16u64 {
                let pick = |i: u64, n: f64| (seed.unit(3 * k + i) * n) as u16;
                let (a, b, ahead) = (pick(0, 12.0), pick(1, 12.0), i32::from(pick(2, 5.0)) - 2);
                let ((set_a, at_a), (set_b, at_b)) = (slow[a as usize], slow[b as usize]);
                let miss = at_a + ahead - at_b;
                assert_eq!(sets.unite(a, b, ahead), (set_a == set_b).then_some(miss));
                let moved = if set_a < set_b {
                    (set_b, miss)
                } else {
                    (set_a, -miss)
                };
                for member in slow.iter_mut().filter(|m| set_a != set_b && m.0 == moved.0) {
                    *member = (set_a.min(set_b), member.1 + moved.1);
                }
            }
            let found: Vec<(u16, i32)> = (0..12).map(|i| sets.find(i)).collect();
            assert_eq!(found, slow);
            assert!(sets.roots().all(|root| slow[root as usize] == (root, 0)));
        }
    }
}
