//! Pieces: voxels that hang together, through corners or only through faces.

use fretwork_geometry::numeric::UnionFind;

use super::surface_graph::{SurfaceGraph, Touch};

/// The piece of a voxel that was left out.
pub const NO_PIECE: u32 = u32::MAX;

/// The pieces of a set of voxels.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// The piece of each voxel, [`NO_PIECE`] of those that were left out. Pieces are numbered by
    /// their least voxels.
    pub of: Vec<u32>,
    /// How many voxels each piece has.
    pub sizes: Vec<u32>,
    /// The least voxel of each piece.
    pub least: Vec<u32>,
}

impl Pieces {
    /// The pieces of the voxels that `keep` tells, joined where they touch so closely.
    ///
    /// ```
    /// use fretwork_geometry::Point3;
    /// use fretwork_geometry::voxel::{Lattice, VoxelSurface, Voxels};
    /// use fretwork_shell::connect::{Pieces, SurfaceGraph, Touch};
    /// let lattice = Lattice { origin: Point3::ORIGIN, pitch: 1.0 };
    /// let voxels = Voxels::new(lattice, vec![[0, 0, 0], [1, 1, 0], [2, 1, 0]]);
    /// let surface = VoxelSurface { voxels, normals: vec![[0.0, 0.0, 1.0]; 3] };
    /// let graph = SurfaceGraph::new(&surface);
    /// assert_eq!(Pieces::of(&graph, Touch::Corner, |_| true).sizes, [3]);
    /// assert_eq!(Pieces::of(&graph, Touch::Face, |_| true).sizes, [1, 2]);
    /// ```
    pub fn of(graph: &SurfaceGraph, touch: Touch, keep: impl Fn(u32) -> bool) -> Pieces {
        let n = graph.len() as u32;
        let mut sets = UnionFind::new(n as usize);
        for v in (0..n).filter(|v| keep(*v)) {
            for w in graph.touching(v, touch).take_while(|w| *w < v) {
                if keep(w) {
                    sets.unite(v, w);
                }
            }
        }
        let mut pieces = Pieces {
            of: vec![NO_PIECE; n as usize],
            sizes: Vec::new(),
            least: Vec::new(),
        };
        for v in (0..n).filter(|v| keep(*v)) {
            let root = sets.find(v);
            if root == v {
                pieces.of[v as usize] = pieces.sizes.len() as u32;
                pieces.sizes.push(0);
                pieces.least.push(v);
            }
            let piece = pieces.of[root as usize];
            pieces.of[v as usize] = piece;
            pieces.sizes[piece as usize] += 1;
        }
        pieces
    }

    /// How many pieces there are.
    pub fn len(&self) -> usize {
        self.sizes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.sizes.is_empty()
    }
}

/// Which solid voxels belong to pieces too small to be worth a bridge: below `least` voxels. The
/// largest piece of a part of the surface is none of them, nor is a piece with a voxel of `kept`.
///
/// `surface` holds the pieces of the whole surface.
pub fn specks(
    graph: &SurfaceGraph,
    surface: &Pieces,
    solid: &[bool],
    kept: &[bool],
    least: usize,
) -> Vec<bool> {
    let pieces = Pieces::of(graph, Touch::Corner, |v| solid[v as usize]);
    let mut largest = vec![NO_PIECE; surface.len()];
    for (piece, &v) in pieces.least.iter().enumerate() {
        let best = &mut largest[surface.of[v as usize] as usize];
        if *best == NO_PIECE || pieces.sizes[*best as usize] < pieces.sizes[piece] {
            *best = piece as u32;
        }
    }
    let mut is_speck: Vec<bool> = pieces
        .sizes
        .iter()
        .map(|size| (*size as usize) < least)
        .collect();
    largest
        .iter()
        .filter(|piece| **piece != NO_PIECE)
        .for_each(|piece| {
            is_speck[*piece as usize] = false;
        });
    for (v, &piece) in pieces.of.iter().enumerate() {
        if piece != NO_PIECE && kept[v] {
            is_speck[piece as usize] = false;
        }
    }
    let of_speck = |piece: &u32| *piece != NO_PIECE && is_speck[*piece as usize];
    pieces.of.iter().map(of_speck).collect()
}
