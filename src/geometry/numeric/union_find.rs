//! Disjoint sets of the numbers 0 to n - 1.

/// Disjoint sets of the numbers 0 to n - 1 that grow together (Galler and Fischer 1964).
///
/// The least number of a set is its root. Sets are linked by number and not by size, so that roots do not
/// depend on the order in which pairs are united: whatever is numbered by roots is the same in every run.
/// The price is a bound of O(log n) amortized for each operation instead of the inverse of Ackermann's
/// function (Tarjan and van Leeuwen 1984, on linking without ranks and on halving of paths).
///
/// ```
/// use fretwork_geometry::numeric::UnionFind;
/// let mut sets = UnionFind::new(4);
/// assert!(sets.unite(3, 1));
/// assert!(!sets.unite(1, 3));
/// assert_eq!((sets.find(3), sets.find(2), sets.count()), (1, 2, 3));
/// ```
#[derive(Clone, Debug, Default)]
pub struct UnionFind {
    /// A number of the same set that is not larger; a root has itself.
    parents: Vec<u32>,
}

impl UnionFind {
    /// Every number from 0 to `len` - 1 in a set of its own.
    pub fn new(len: usize) -> UnionFind {
        UnionFind {
            parents: (0..len as u32).collect(),
        }
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.parents.len()
    }

    /// Whether there are no numbers.
    pub fn is_empty(&self) -> bool {
        self.parents.is_empty()
    }

    /// Adds the next number, in a set of its own, and gives it.
    pub fn push(&mut self) -> u32 {
        let number = self.parents.len() as u32;
        self.parents.push(number);
        number
    }

    /// The least number in the set of `i`, which must be below [`UnionFind::len`]. Halves the path that it walks.
    #[inline]
    pub fn find(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let grandparent = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = grandparent;
            i = grandparent;
        }
        i
    }

    /// Puts the sets of `a` and `b` together, and tells whether they were apart.
    #[inline]
    pub fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// The least number of every set, ascending.
    pub fn roots(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.parents.len() as u32).filter(|&i| self.parents[i as usize] == i)
    }

    /// How many sets there are. O(n).
    pub fn count(&self) -> usize {
        self.roots().count()
    }

    /// For every number, which set it is in: sets are numbered from 0, by their least numbers. O(n log n).
    pub fn labels(&mut self) -> Vec<u32> {
        let mut labels = vec![0; self.len()];
        let mut next = 0;
        for i in 0..self.len() as u32 {
            let root = self.find(i);
            // A root comes before the rest of its set.
            labels[i as usize] = if root == i {
                next += 1;
                next - 1
            } else {
                labels[root as usize]
            };
        }
        labels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Seed;

    #[test]
    fn agrees_with_relabelling_everything() {
        for case in 0..20 {
            let seed = Seed::root(case);
            let mut sets = UnionFind::new(40);
            let mut slow: Vec<u32> = (0..40).collect();
            for k in 0..30 {
                let pick = |i: u64| (seed.unit(2 * k + i) * 40.0) as u32;
                let (a, b) = (pick(0), pick(1));
                let (x, y) = (slow[a as usize], slow[b as usize]);
                slow.iter_mut()
                    .filter(|label| **label == x.max(y))
                    .for_each(|label| *label = x.min(y));
                assert_eq!(sets.unite(a, b), x != y);
            }
            let roots: Vec<u32> = (0..40).map(|i| sets.find(i)).collect();
            assert_eq!(roots, slow);
            let mut distinct = slow.clone();
            distinct.sort_unstable();
            distinct.dedup();
            assert_eq!(sets.roots().collect::<Vec<_>>(), distinct);
            let rank = |label: &u32| distinct.binary_search(label).unwrap() as u32;
            assert_eq!(sets.labels(), slow.iter().map(rank).collect::<Vec<_>>());
        }
    }

    #[test]
    fn numbers_are_added() {
        let mut sets = UnionFind::default();
        assert!(sets.is_empty());
        assert_eq!((sets.push(), sets.push()), (0, 1));
        assert!(sets.unite(1, 0));
        assert_eq!((sets.len(), sets.count()), (2, 1));
    }
}
