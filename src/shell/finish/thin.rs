//! The parts of a pattern that no disc of a radius fits into, on the surface.
//!
//! The middle of a feature is where no neighbour's largest disc holds the whole of its own largest
//! disc: the centres of maximal discs, the geodesic skeleton. A thin part that leads from one place of the pattern to
//! another, or stands alone, is kept; one that only ends, as the corner of any shape does, is a leaf of the skeleton.

use fretwork_geometry::budget;
use fretwork_geometry::numeric::UnionFind;

use crate::connect::{Forest, NO_PIECE, NOBODY, Pieces, SurfaceGraph, Touch, UNIT};

/// A leaf of the skeleton reaches no farther from the rest than this many radii of the features asked for.
const LEAF: f64 = 2.0;
/// Steps of the budget for each voxel when thin parts are looked for.
const STEPS: u64 = 150;

/// How far a leaf of the skeleton may reach where features of this width are asked for, in pitches.
pub fn leaf(width: f64) -> f64 {
    width.max(2.0) / 2.0 * (1.0 + LEAF)
}

/// A distance in pitches as one of the graph.
pub fn units(pitches: f64) -> u32 {
    (pitches.max(0.0) * f64::from(UNIT)).min(f64::from(u32::MAX / 2)) as u32
}

/// The parts of a pattern that no disc of some radius fits into.
pub struct Thin {
    /// The empty voxel nearest to each, and its distance: the greatest number where there is none.
    pub empty: Forest,
    pieces: Pieces,
    /// Whether a piece is no leaf.
    is_kept: Vec<bool>,
}

impl Thin {
    /// The thin parts of the solid voxels, by the radius of the disc and how far a leaf may reach, in pitches. `rim` are the
    /// voxels in which the surface ends.
    pub fn of(
        graph: &SurfaceGraph,
        (solid, rim): (&[bool], &[bool]),
        radius: f64,
        leaf: f64,
    ) -> Thin {
        budget::spend("voxels of features", STEPS * graph.len() as u64);
        let n = graph.len() as u32;
        let mut empty = Forest::new(graph.len());
        (0..n)
            .filter(|v| !solid[*v as usize])
            .for_each(|v| empty.plant(v, v));
        // The surface ends in the middle of a voxel of the rim, more or less: as if there were an empty one half a
        // pitch away.
        (0..n)
            .filter(|v| solid[*v as usize] && rim[*v as usize])
            .for_each(|v| empty.plant_at(v, v, UNIT / 2));
        empty.grow(graph, Touch::Corner, u32::MAX, |_| true);
        // What is wider than a voxel holds the neighbours of its middle.
        let near = units(radius.max(1.0));
        let [singles, pairs] = cores(graph, &empty, radius);
        // The middle of a pair is half a step from both.
        let reached = [(singles, near), (pairs, near.saturating_sub(UNIT / 2))];
        let [of_singles, of_pairs] = reached.map(|(core, reach)| (distances(graph, core), reach));
        let is_wide = |v: usize| of_singles.0[v] <= of_singles.1 || of_pairs.0[v] <= of_pairs.1;
        let pieces = Pieces::of(graph, Touch::Corner, |v| {
            solid[v as usize] && !is_wide(v as usize)
        });
        let core: Vec<u32> = of_singles
            .0
            .iter()
            .zip(&of_pairs.0)
            .map(|(a, b)| *a.min(b))
            .collect();
        let mut thin = Thin {
            is_kept: vec![false; pieces.len()],
            empty,
            pieces,
        };
        thin.find_leaves(graph, solid, &core, units(leaf));
        thin
    }

    /// Keeps the pieces that reach far, touch nothing, or touch the rest in two places.
    fn find_leaves(&mut self, graph: &SurfaceGraph, solid: &[bool], core: &[u32], far: u32) {
        let n = graph.len() as u32;
        let mut contacts: Vec<(u32, u32)> = Vec::new();
        for v in 0..n {
            let piece = self.pieces.of[v as usize];
            if piece == NO_PIECE {
                continue;
            }
            self.is_kept[piece as usize] |= core[v as usize] > far;
            let rest = graph
                .neighbours(v)
                .iter()
                .filter(|w| solid[**w as usize] && self.pieces.of[**w as usize] == NO_PIECE);
            contacts.extend(rest.map(|w| (piece, *w)));
        }
        contacts.sort_unstable();
        contacts.dedup();
        let mut from = 0;
        for piece in 0..self.pieces.len() as u32 {
            let to = from + contacts[from..].partition_point(|contact| contact.0 == piece);
            let touched: Vec<u32> = contacts[from..to].iter().map(|contact| contact.1).collect();
            self.is_kept[piece as usize] |= clusters(graph, &touched) != 1;
            from = to;
        }
    }

    /// Whether `v` is thin and in no leaf.
    pub fn is_kept(&self, v: u32) -> bool {
        let piece = self.pieces.of[v as usize];
        piece != NO_PIECE && self.is_kept[piece as usize]
    }

    /// Whether `v` is thin and in a leaf.
    pub fn is_leaf(&self, v: u32) -> bool {
        self.pieces.of[v as usize] != NO_PIECE && !self.is_kept(v)
    }

    /// Whether the largest disc about `v` lies in no neighbour's.
    pub fn is_middle(&self, graph: &SurfaceGraph, v: u32) -> bool {
        let depth = |v: u32| self.empty.distances[v as usize];
        let neighbours = graph.neighbours(v).iter();
        neighbours
            .copied()
            .all(|w| depth(w) < depth(v).saturating_add(graph.step(v, w)))
    }
}

/// The voxels about whose middles a disc of the radius fits, and those that have such a place half way to
/// a neighbour: a strip of an even number of voxels has its middle there.
fn cores(graph: &SurfaceGraph, empty: &Forest, radius: f64) -> [Vec<u32>; 2] {
    // The border of an empty voxel is half a pitch nearer than its middle.
    let wide = radius + 0.5;
    let depth = |v: u32| empty.distances[v as usize];
    let limit = units(wide);
    let solid = |v: &u32| depth(*v) > 0;
    let singles = (0..graph.len() as u32)
        .filter(|v| depth(*v) >= limit)
        .collect();
    let has_place = |v: &u32| {
        let neighbours = graph.touching(*v, Touch::Face);
        solid(v)
            && neighbours
                .filter(solid)
                .any(|w| fits_between(graph, empty, (*v, w), wide))
    };
    let pairs = (0..graph.len() as u32).filter(has_place).collect();
    [singles, pairs]
}

/// Whether a disc of the radius `wide` about the place half way between two voxels holds none of the empty ones that are
/// nearest to them.
pub fn fits_between(graph: &SurfaceGraph, empty: &Forest, (v, w): (u32, u32), wide: f64) -> bool {
    let middle = |v: u32| graph.cell(v).map(f64::from);
    let (a, b) = (middle(v), middle(w));
    [v, w]
        .into_iter()
        .all(|from| match empty.owners[from as usize] {
            NOBODY => true,
            nearest => {
                let e = middle(nearest);
                let is_rim = empty.distances[nearest as usize] > 0;
                let wide = if is_rim { wide - 0.5 } else { wide };
                let square = |k: usize| ((a[k] + b[k]) / 2.0 - e[k]).powi(2);
                (0..3).map(square).sum::<f64>().sqrt() >= wide
            }
        })
}

/// The distance of every voxel to the nearest of some.
fn distances(graph: &SurfaceGraph, from: Vec<u32>) -> Vec<u32> {
    let mut forest = Forest::new(graph.len());
    from.into_iter().for_each(|v| forest.plant(v, 0));
    forest.grow(graph, Touch::Corner, u32::MAX, |_| true);
    forest.distances
}

/// Into how many groups of voxels that touch the ascending `voxels` fall.
fn clusters(graph: &SurfaceGraph, voxels: &[u32]) -> usize {
    let mut sets = UnionFind::new(voxels.len());
    for (number, v) in voxels.iter().enumerate() {
        for w in graph.neighbours(*v) {
            if let Ok(other) = voxels.binary_search(w) {
                sets.unite(number as u32, other as u32);
            }
        }
    }
    sets.count()
}
