//! Which empty edges become solid for the sake of connection and of stress (Dumas 2015, 5.2). How edges
//! are scored comes from outside; the worst case by lengths is in `geodesic`.

use fretwork_geometry::Point3;
use fretwork_geometry::numeric::UnionFind;

use crate::connect::{AbstractEdge, AbstractGraph, SurfaceGraph};

/// Edges that the stress may add between two solutions. With more, edges are added to stresses that the
/// first of them have already taken away; with fewer, solutions take longer than they save edges.
const BATCH: usize = 8;
/// The least score of such an edge, as a part of the best one's.
const NEARLY_BEST: f64 = 0.5;
/// Solutions in a row after which the stress must have fallen by a hundredth, and the most in all. A
/// limit that cannot be had, say at a support, would otherwise fill the surface.
const PATIENCE: usize = 6;
const SOLUTIONS: usize = 60;

/// The state of every edge while some are added.
pub(super) struct Selection<'a> {
    edges: &'a [AbstractEdge],
    /// The middle of each edge's path, in pitches.
    middles: Vec<Point3>,
    pieces: usize,
    /// Which edges are solid by now.
    pub solid: Vec<bool>,
    /// The edges added, in order.
    pub added: Vec<usize>,
}

/// What the stress has come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stress {
    /// The greatest score of a solid edge, Pa.
    pub greatest: f64,
    /// Whether it is within the limit.
    pub holds: bool,
}

impl<'a> Selection<'a> {
    pub fn new(graph: &SurfaceGraph, abstracted: &'a AbstractGraph) -> Selection<'a> {
        let middle = |edge: &AbstractEdge| {
            let [x, y, z] = graph.cell(edge.path[edge.path.len() / 2]).map(f64::from);
            Point3::new(x, y, z)
        };
        Selection {
            edges: &abstracted.edges,
            middles: abstracted.edges.iter().map(middle).collect(),
            pieces: abstracted.samples.len(),
            solid: abstracted.edges.iter().map(|edge| edge.is_solid).collect(),
            added: Vec::new(),
        }
    }

    /// The samples that hang together by solid edges.
    fn sets(&self) -> UnionFind {
        let mut sets = UnionFind::new(self.pieces);
        for (edge, solid) in self.edges.iter().zip(&self.solid) {
            if *solid {
                sets.unite(edge.ends[0], edge.ends[1]);
            }
        }
        sets
    }

    /// Makes an edge solid.
    pub fn add(&mut self, edge: usize) {
        self.solid[edge] = true;
        self.added.push(edge);
    }

    /// Whether an edge is farther from all of `others` than twice their lengths: what is nearer may well be
    /// relieved by them (the paper's rule of cancellation).
    fn is_clear(&self, edge: usize, others: &[usize]) -> bool {
        let is_clear = |other: &usize| {
            let distance = self.middles[edge].distance(self.middles[*other]);
            distance > 2.0 * self.edges[*other].length
        };
        others.iter().all(is_clear)
    }

    /// The empty edges that `wanted` tells, highest score first, then by number.
    fn ranked(&self, scores: &[f64], wanted: impl Fn(usize) -> bool) -> Vec<usize> {
        let empty = (0..self.edges.len()).filter(|e| !self.solid[*e] && wanted(*e));
        let mut ranked: Vec<usize> = empty.collect();
        ranked.sort_by(|&a, &b| scores[b].total_cmp(&scores[a]).then(a.cmp(&b)));
        ranked
    }

    /// Joins all pieces of each part of the surface: the highest score first, several between two solutions as
    /// long as they are clear of one another.
    ///
    /// # Errors
    /// Those of `score`.
    pub fn connect<E>(
        &mut self,
        mut score: impl FnMut(&[bool]) -> Result<Vec<f64>, E>,
    ) -> Result<(), E> {
        loop {
            let mut sets = self.sets();
            let roots: Vec<u32> = (0..self.pieces as u32).map(|p| sets.find(p)).collect();
            let is_apart = |e: usize| {
                let [a, b] = self.edges[e].ends.map(|end| roots[end as usize]);
                a != b
            };
            if !(0..self.edges.len()).any(&is_apart) {
                return Ok(());
            }
            let scores = score(&self.solid)?;
            let mut batch = Vec::new();
            for edge in self.ranked(&scores, is_apart) {
                let [a, b] = self.edges[edge].ends;
                if self.is_clear(edge, &batch) && sets.unite(a, b) {
                    batch.push(edge);
                }
            }
            batch.into_iter().for_each(|edge| self.add(edge));
        }
    }

    /// Joins all pieces by the shortest edges (Kruskal 1956).
    pub fn connect_shortest(&mut self) {
        let mut sets = self.sets();
        let scores: Vec<f64> = self.edges.iter().map(|edge| -edge.length).collect();
        for edge in self.ranked(&scores, |_| true) {
            if sets.unite(self.edges[edge].ends[0], self.edges[edge].ends[1]) {
                self.add(edge);
            }
        }
    }

    /// Adds the most strained empty edges until the greatest score of all solid ones is `limit` at most, or
    /// until more edges do not help any more; those that have not helped are taken back.
    ///
    /// # Errors
    /// Those of `score`.
    pub fn reinforce<E>(
        &mut self,
        limit: f64,
        mut score: impl FnMut(&[bool]) -> Result<Vec<f64>, E>,
    ) -> Result<Stress, E> {
        let (mut best, mut until, mut waited) = (f64::INFINITY, self.added.len(), 0);
        for _ in 0..SOLUTIONS {
            let scores = score(&self.solid)?;
            let greatest = self.greatest(&scores);
            if greatest <= limit {
                return Ok(Stress {
                    greatest,
                    holds: true,
                });
            }
            waited += 1;
            if greatest < 0.99 * best {
                (best, until, waited) = (greatest, self.added.len(), 0);
            }
            let batch = self.batch(&scores);
            if batch.is_empty() || waited >= PATIENCE {
                break;
            }
            batch.into_iter().for_each(|edge| self.add(edge));
        }
        for edge in self.added.drain(until..) {
            self.solid[edge] = false;
        }
        Ok(Stress {
            greatest: best,
            holds: false,
        })
    }

    /// The greatest score of a solid edge.
    pub fn greatest(&self, scores: &[f64]) -> f64 {
        let solid = scores.iter().zip(&self.solid).filter(|(_, solid)| **solid);
        solid.map(|(score, _)| *score).fold(0.0, f64::max)
    }

    /// The edges to add after one solution.
    fn batch(&self, scores: &[f64]) -> Vec<usize> {
        let ranked = self.ranked(scores, |_| true);
        let least = ranked
            .first()
            .map_or(0.0, |best| scores[*best] * NEARLY_BEST);
        let mut batch = Vec::new();
        for edge in ranked.into_iter().take_while(|edge| scores[*edge] >= least) {
            if batch.len() < BATCH && self.is_clear(edge, &batch) {
                batch.push(edge);
            }
        }
        batch
    }
}
