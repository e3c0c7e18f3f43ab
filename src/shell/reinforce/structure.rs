//! The structural loop (Dumas 2015, Algorithm 4): rounds of bridges and of synthesis until the pattern is one
//! piece and strong enough, and what makes it one piece whatever comes of them (S6).

use fretwork_geometry::voxel::Voxel;

use super::profile::ReinforceError;
use super::round::{Bridges, Round, Settings, round};
use crate::connect::{
    NO_PIECE, Pieces, SurfaceGraph, Touch, join_through_corners, join_through_faces, specks, widen,
};

/// A pattern after the loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Which voxels are solid. Those of each part of the surface hang together through faces, but for
    /// `unjoined`.
    pub solid: Vec<bool>,
    /// The voxels that bridges have asked for.
    pub forced: Vec<bool>,
    /// Rounds of synthesis that were needed.
    pub iterations: usize,
    /// The bridges of all rounds.
    pub bridges: Bridges,
    /// Whether the last round asked for none. Otherwise the limit of iterations has ended the loop.
    pub done: bool,
    /// Whether the limit of the profile holds in the last round's model.
    pub holds: bool,
    /// The greatest stress of the last round, Pa.
    pub max_stress: Option<f64>,
    /// Plain bridges that were needed at the end to make the pattern one piece.
    pub plain: usize,
    /// Voxels filled at the end where pieces met in an edge or a corner only.
    pub filled: usize,
    /// Solid voxels removed because they were specks.
    pub removed: usize,
    /// A voxel of every piece that no way through faces along the surface joins to the largest one.
    pub unjoined: Vec<Voxel>,
    /// A voxel of every part of the surface without anything solid.
    pub bare: Vec<Voxel>,
}

/// Runs the loop on a pattern. `kept` are voxels that must stay solid whatever happens; `resynthesize` takes all
/// voxels that must be solid by now and gives the pattern that has taken them up. Each round's findings are
/// shown to `watch`.
///
/// Everything forced is solid in the result, whatever the pattern says.
///
/// # Errors
/// Those of [`round`].
pub fn structure(
    graph: &SurfaceGraph,
    (solid, kept): (Vec<bool>, &[bool]),
    settings: &Settings,
    mut watch: impl FnMut(&Round),
    mut resynthesize: impl FnMut(&[bool]) -> Vec<bool>,
) -> Result<Structure, ReinforceError> {
    let mut forced = kept.to_vec();
    let mut solid = either(solid, &forced);
    let mut bridges = Bridges::default();
    let mut iterations = 0;
    let last = loop {
        let found = round(graph, &solid, &forced, settings)?;
        watch(&found);
        bridges.connection += found.bridges.connection;
        bridges.stress += found.bridges.stress;
        bridges.geodesic += found.bridges.geodesic;
        forced = either(forced, &found.forced);
        if found.done || iterations >= settings.max_iterations {
            break found;
        }
        iterations += 1;
        solid = either(resynthesize(&forced), &forced);
    };
    let mut structure = Structure {
        solid: either(solid, &forced),
        forced,
        iterations,
        bridges,
        done: last.done,
        holds: last.holds,
        max_stress: last.max_stress,
        plain: 0,
        filled: 0,
        removed: 0,
        unjoined: Vec::new(),
        bare: Vec::new(),
    };
    structure.unite(graph, settings);
    Ok(structure)
}

/// What is true in one of them.
fn either(mut a: Vec<bool>, b: &[bool]) -> Vec<bool> {
    a.iter_mut().zip(b).for_each(|(a, b)| *a |= b);
    a
}

impl Structure {
    /// Makes the pattern one piece for each part of the surface, as far as faces can join it.
    fn unite(&mut self, graph: &SurfaceGraph, settings: &Settings) {
        let surface = Pieces::of(graph, Touch::Corner, |_| true);
        let specks = specks(
            graph,
            &surface,
            &self.solid,
            &self.forced,
            settings.least_piece,
        );
        self.removed = specks.iter().filter(|speck| **speck).count();
        self.solid
            .iter_mut()
            .zip(&specks)
            .for_each(|(solid, speck)| *solid &= !speck);
        let paths = join_through_corners(graph, &self.solid);
        self.plain = paths.len();
        let radius = settings.feature_radius / graph.pitch();
        let plain = widen(graph, &self.solid, &paths, radius);
        self.solid = either(std::mem::take(&mut self.solid), &plain);
        for v in join_through_faces(graph, &self.solid).into_iter().flatten() {
            let solid = &mut self.solid[v as usize];
            self.filled += usize::from(!std::mem::replace(solid, true));
        }
        self.report(graph, &surface);
    }

    /// Finds what is still apart, and where nothing is.
    fn report(&mut self, graph: &SurfaceGraph, surface: &Pieces) {
        let pieces = Pieces::of(graph, Touch::Face, |v| self.solid[v as usize]);
        let part = |piece: usize| surface.of[pieces.least[piece] as usize] as usize;
        let mut largest = vec![NO_PIECE; surface.len()];
        for piece in 0..pieces.len() {
            let best = &mut largest[part(piece)];
            if *best == NO_PIECE || pieces.sizes[*best as usize] < pieces.sizes[piece] {
                *best = piece as u32;
            }
        }
        let loose = (0..pieces.len()).filter(|piece| largest[part(*piece)] != *piece as u32);
        self.unjoined = loose.map(|piece| graph.cell(pieces.least[piece])).collect();
        let bare = surface
            .least
            .iter()
            .zip(&largest)
            .filter(|(_, piece)| **piece == NO_PIECE);
        self.bare = bare.map(|(v, _)| graph.cell(*v)).collect();
    }
}
