//! A body of lattice points without points where it would touch itself by an edge or a corner alone.
//!
//! A set of lattice points is well-composed (Latecki, Eckhardt, Rosenfeld: Well-Composed Sets, 1995;
//! in space Latecki 1997) when in no square of four points two opposite ones are inside and the others
//! outside, and in no cube two opposite ones alone are inside or alone outside. The border of such a
//! set is a 2-manifold, and each cube has at most one piece of it. A set is made well-composed by
//! taking the nearest of the points outside in, which never parts what was together.

use fretwork_geometry::numeric::UnionFind;

use super::samples::Samples;

/// Which points of a lattice are inside.
pub struct Body {
    /// How many points there are along each axis.
    pub size: [usize; 3],
    bits: Vec<u64>,
    /// How many points were taken in to make it well-composed.
    pub filled: usize,
}

impl Body {
    /// The points inside, and the fewest more by which the set becomes well-composed.
    pub fn of(samples: &Samples) -> Body {
        let mut body = Body {
            size: samples.size,
            bits: vec![0; samples.points().div_ceil(64)],
            filled: 0,
        };
        let mut open: Vec<usize> = samples.inside().collect();
        open.iter().for_each(|index| body.set(*index));
        while !open.is_empty() {
            let mut next = Vec::new();
            for index in open {
                body.mend_around(index, samples, &mut next);
            }
            open = next;
        }
        body
    }

    /// Whether the point with this number is inside.
    #[inline]
    pub fn holds(&self, index: usize) -> bool {
        self.bits[index / 64] >> (index % 64) & 1 == 1
    }

    #[inline]
    fn set(&mut self, index: usize) {
        self.bits[index / 64] |= 1 << (index % 64);
    }

    /// The steps from a point to the next along each axis, by number.
    #[inline]
    pub fn steps(&self) -> [usize; 3] {
        [self.size[1] * self.size[2], self.size[2], 1]
    }

    /// The numbers of the points inside, ascending.
    pub fn inside(&self) -> impl Iterator<Item = usize> + '_ {
        self.bits.iter().enumerate().flat_map(|(word, bits)| {
            (0..64)
                .filter(move |bit| bits >> bit & 1 == 1)
                .map(move |bit| 64 * word + bit)
        })
    }

    /// Looks at all squares and cubes at a point inside.
    fn mend_around(&mut self, index: usize, samples: &Samples, taken: &mut Vec<usize>) {
        let steps = self.steps();
        for corner in 0..8usize {
            let mut low = index;
            for (axis, step) in steps.iter().enumerate() {
                low -= if corner >> axis & 1 == 1 { *step } else { 0 };
            }
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let square = [
                    low,
                    low + steps[a],
                    low + steps[b],
                    low + steps[a] + steps[b],
                ];
                self.mend_square(square, samples, taken);
            }
            self.mend_cube(low, samples, taken);
        }
    }

    fn mend_square(&mut self, [p, q, r, s]: [usize; 4], samples: &Samples, taken: &mut Vec<usize>) {
        let inside = [p, q, r, s].map(|n| self.holds(n));
        match inside {
            [true, false, false, true] => self.take_nearest(&[q, r], samples, taken),
            [false, true, true, false] => self.take_nearest(&[p, s], samples, taken),
            _ => {}
        }
    }

    fn mend_cube(&mut self, low: usize, samples: &Samples, taken: &mut Vec<usize>) {
        let steps = self.steps();
        let corners: [usize; 8] = std::array::from_fn(|c| {
            (0..3).fold(low, |n, axis| {
                n + if c >> axis & 1 == 1 { steps[axis] } else { 0 }
            })
        });
        let inside: u8 = (0..8).map(|c| u8::from(self.holds(corners[c])) << c).sum();
        for c in 0..4 {
            let pair = 1u8 << c | 1 << (7 - c);
            if inside == pair || inside == !pair {
                let outside: Vec<usize> = (0..8)
                    .filter(|c| inside >> c & 1 == 0)
                    .map(|c| corners[c])
                    .collect();
                self.take_nearest(&outside, samples, taken);
            }
        }
    }

    /// Takes in the point whose value is least; of equal ones that of the least number.
    fn take_nearest(&mut self, points: &[usize], samples: &Samples, taken: &mut Vec<usize>) {
        let nearest = points.iter().copied().min_by(|a, b| {
            samples
                .value(*a)
                .total_cmp(&samples.value(*b))
                .then(a.cmp(b))
        });
        if let Some(point) = nearest {
            self.set(point);
            self.filled += 1;
            taken.push(point);
        }
    }

    /// The pieces that are joined through neighbours along an axis, each by its points, the largest
    /// first.
    pub fn pieces(&self) -> Vec<Vec<usize>> {
        let inside: Vec<usize> = self.inside().collect();
        let mut sets = UnionFind::new(inside.len());
        for step in self.steps() {
            let mut ahead = 0;
            for (number, index) in inside.iter().enumerate() {
                while ahead < inside.len() && inside[ahead] < index + step {
                    ahead += 1;
                }
                if inside.get(ahead) == Some(&(index + step)) {
                    sets.unite(number as u32, ahead as u32);
                }
            }
        }
        let labels = sets.labels();
        let mut pieces = vec![Vec::new(); labels.iter().max().map_or(0, |n| *n as usize + 1)];
        for (index, label) in inside.into_iter().zip(labels) {
            pieces[label as usize].push(index);
        }
        pieces.sort_by_key(|piece: &Vec<usize>| (std::cmp::Reverse(piece.len()), piece[0]));
        pieces
    }

    /// Takes points out.
    pub fn remove(&mut self, points: &[usize]) {
        for index in points {
            self.bits[index / 64] &= !(1 << (index % 64));
        }
    }
}
