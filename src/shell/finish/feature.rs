//! Features that are thinner than can be made, made wide enough on the surface (Dumas 2015, 6.2.1).
//!
//! The middle of a feature is where no neighbour's largest disc holds the whole of its own largest
//! disc: the centres of maximal discs, the geodesic skeleton. What no disc of the asked radius fits
//! into is thin. A thin part that leads from one place of the pattern to another, or stands alone, is
//! widened about its skeleton; one that only ends, as the corner of any shape does, is left: it is a
//! leaf of the skeleton, and widening it would put a knob on every corner.

use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Mesh, Point3, budget};

use crate::connect::{Forest, NO_PIECE, NOBODY, Pieces, SurfaceGraph, Touch, UNIT};

/// A leaf of the skeleton reaches no farther from the rest than this many radii of the features asked for.
const LEAF: f64 = 2.0;
/// Rounds of widening, at most.
const ROUNDS: usize = 6;
/// A width is a quotient of lengths: so much more than a whole number of voxels is none.
const ROUNDING: f64 = 1e-6;
/// The steps in which the least width is measured, in pitches.
const STEP: f64 = 0.25;
/// How far apart the places of a border are that are looked up, in pitches.
const SAMPLE: f64 = 0.2;
/// Steps of the budget for each voxel when thin parts are looked for.
const STEPS: u64 = 150;

/// The solid voxels with those that features of less than the `width`, in pitches, lack. What is filled can
/// leave a narrow place beside it, so that there are rounds, as many as it takes but for a limit.
///
/// `rim` are the voxels in which the surface ends: a feature ends there too, and is widened away from it.
pub fn widened(graph: &SurfaceGraph, (solid, rim): (&[bool], &[bool]), width: f64) -> Vec<bool> {
    let mut solid = solid.to_vec();
    for _ in 0..ROUNDS {
        let thin = Thin::of(graph, (&solid, rim), width / 2.0, leaf(width));
        let is_middle = |v: &u32| thin.is_kept(*v) && thin.is_middle(graph, *v);
        let middle: Vec<u32> = (0..graph.len() as u32).filter(is_middle).collect();
        if middle.is_empty() {
            break;
        }
        let count = (width - ROUNDING).ceil();
        let [single, paired] = thin.by_parity(graph, middle, count % 2.0 == 1.0);
        // A voxel with so many on each side is at least as wide as asked; of a pair each has one side.
        let beside = [((count - 1.0) / 2.0).ceil(), (count / 2.0).ceil() - 1.0];
        for (middle, beside) in [single, paired].into_iter().zip(beside) {
            let mut reach = Forest::new(graph.len());
            middle.into_iter().for_each(|v| reach.plant(v, 0));
            reach.grow(graph, Touch::Corner, units(beside), |_| true);
            for (solid, distance) in solid.iter_mut().zip(&reach.distances) {
                *solid |= *distance != u32::MAX;
            }
        }
    }
    solid
}

/// The voxels in which an open surface ends.
pub fn rim(mesh: &Mesh, surface: &VoxelSurface) -> Vec<bool> {
    let lattice = &surface.voxels.lattice;
    let mut rim = vec![false; surface.voxels.len()];
    for [a, b] in border_edges(mesh) {
        let steps = (a.distance(b) / (SAMPLE * lattice.pitch)).ceil().max(1.0);
        for step in 0..=steps as u64 {
            let at = lattice.place(a.lerp(b, step as f64 / steps));
            if at.iter().all(|c| (0.0..f64::from(u16::MAX)).contains(c))
                && let Some(v) = surface.voxels.find(at.map(|c| c as u16))
            {
                rim[v] = true;
            }
        }
    }
    rim
}

/// The edges of one triangle only, in order. O(n log n).
fn border_edges(mesh: &Mesh) -> Vec<[Point3; 2]> {
    let sides = |t: &[u32; 3]| {
        let t = *t;
        (0..3).map(move |k| [t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3])])
    };
    let mut edges: Vec<[u32; 2]> = mesh.triangles.iter().flat_map(sides).collect();
    edges.sort_unstable();
    let single = edges.chunk_by(|a, b| a == b).filter(|run| run.len() == 1);
    single
        .map(|run| run[0].map(|corner| mesh.positions[corner as usize]))
        .collect()
}

/// The least width of a feature of the pattern, in pitches; `most` where none is narrower. Ends that are short
/// beside the `width` that was asked for are passed over, as they are not widened.
///
/// What is thin for one width is so for all larger ones, so that the width is found by halving: O(n log n) for each
/// of log(`most`) looks at the pattern.
pub fn least_width(
    graph: &SurfaceGraph,
    (solid, rim): (&[bool], &[bool]),
    (width, most): (f64, f64),
) -> f64 {
    let leaf = leaf(width);
    let asked = Thin::of(graph, (solid, rim), width / 2.0, leaf);
    let is_thin = |width: f64| {
        let thin = Thin::of(graph, (solid, rim), (width + STEP) / 2.0, leaf);
        (0..graph.len() as u32).any(|v| thin.is_kept(v) && !asked.is_leaf(v))
    };
    let width_of = |steps: u64| 1.0 + STEP * steps as f64;
    let (mut least, mut end) = (0, ((most - 1.0) / STEP).ceil().max(0.0) as u64);
    while least < end {
        let middle = least + (end - least) / 2;
        if is_thin(width_of(middle)) {
            end = middle;
        } else {
            least = middle + 1;
        }
    }
    width_of(least).min(most)
}

/// How far a leaf of the skeleton may reach where features of this width are asked for, in pitches.
fn leaf(width: f64) -> f64 {
    width.max(2.0) / 2.0 * (1.0 + LEAF)
}

fn units(pitches: f64) -> u32 {
    (pitches.max(0.0) * f64::from(UNIT)).min(f64::from(u32::MAX / 2)) as u32
}

/// The parts of a pattern that no disc of some radius fits into.
struct Thin {
    /// The empty voxel nearest to each, and its distance: the greatest number where there is none.
    empty: Forest,
    pieces: Pieces,
    /// Whether a piece is no leaf.
    is_kept: Vec<bool>,
}

impl Thin {
    fn of(graph: &SurfaceGraph, (solid, rim): (&[bool], &[bool]), radius: f64, leaf: f64) -> Thin {
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

    fn is_kept(&self, v: u32) -> bool {
        let piece = self.pieces.of[v as usize];
        piece != NO_PIECE && self.is_kept[piece as usize]
    }

    /// Whether `v` is thin and in a leaf.
    fn is_leaf(&self, v: u32) -> bool {
        self.pieces.of[v as usize] != NO_PIECE && !self.is_kept(v)
    }

    /// Middles in strips of an odd number of voxels, and pairs of them in strips of an even number: between two of a
    /// pair there is room for a disc that is half a pitch larger than those about either. Where strips are to
    /// become of an odd number, the first of a pair counts as a middle by itself and the other one as none.
    fn by_parity(&self, graph: &SurfaceGraph, middle: Vec<u32>, is_odd: bool) -> [Vec<u32>; 2] {
        let depth = |v: u32| self.empty.distances[v as usize];
        let [mut single, mut paired] = [Vec::new(), Vec::new()];
        for v in middle {
            let wide = f64::from(depth(v)) / f64::from(UNIT) + 0.5 - ROUNDING;
            // Where the surface ends, it does so in the middle of a voxel.
            let is_rim = match self.empty.owners[v as usize] {
                NOBODY => false,
                nearest => depth(nearest) > 0,
            };
            let beside = graph.touching(v, Touch::Face);
            let beside = beside.filter(|w| !is_rim && depth(*w) > 0);
            let partner = beside
                .filter(|w| fits_between(graph, &self.empty, (v, *w), wide))
                .max();
            match partner {
                None => single.push(v),
                Some(_) if !is_odd => paired.push(v),
                Some(w) if v < w => single.push(v),
                Some(_) => {}
            }
        }
        [single, paired]
    }

    /// Whether the largest disc about `v` lies in no neighbour's.
    fn is_middle(&self, graph: &SurfaceGraph, v: u32) -> bool {
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
fn fits_between(graph: &SurfaceGraph, empty: &Forest, (v, w): (u32, u32), wide: f64) -> bool {
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
