//! The fewest voxels that make loose pieces one, whatever the pattern says: the last resort, and what
//! turns pieces that touch in an edge or a corner into one body (S6).

use fretwork_geometry::numeric::UnionFind;

use super::forest::{Forest, NOBODY};
use super::pieces::{NO_PIECE, Pieces};
use super::surface_graph::{SurfaceGraph, Touch};

/// Paths that join all pieces of the solid voxels of each part of the surface, through corners: a
/// shortest spanning tree of the pieces by the gaps between them. Each path begins and ends with a
/// solid voxel. There are none where each part holds one piece at most.
pub fn join_through_corners(graph: &SurfaceGraph, solid: &[bool]) -> Vec<Vec<u32>> {
    join(graph, solid, Touch::Corner)
}

/// As [`join_through_corners`], through the faces of voxels. A path then holds the fewest empty voxels
/// that join its ends; pieces between which no way through faces leads along the surface stay apart.
pub fn join_through_faces(graph: &SurfaceGraph, solid: &[bool]) -> Vec<Vec<u32>> {
    join(graph, solid, Touch::Face)
}

fn join(graph: &SurfaceGraph, solid: &[bool], touch: Touch) -> Vec<Vec<u32>> {
    let pieces = Pieces::of(graph, touch, |v| solid[v as usize]);
    join_groups(graph, &pieces.of, touch)
}

/// As [`join_through_corners`] or [`join_through_faces`], of groups of voxels: `groups` has the number of each
/// voxel's, [`NO_PIECE`] of one that is in none. A group need not hang together.
///
/// The shortest paths come first that join what was apart (Kruskal 1956). That trees of neighbouring groups
/// are enough to look at is the theorem on spanning trees of Voronoi cells (Mehlhorn 1988).
pub fn join_groups(graph: &SurfaceGraph, groups: &[u32], touch: Touch) -> Vec<Vec<u32>> {
    let mut forest = Forest::new(graph.len());
    let mut count = 0;
    for (v, &group) in (0u32..).zip(groups) {
        if group != NO_PIECE {
            forest.plant(v, group);
            count = count.max(group as usize + 1);
        }
    }
    forest.grow(graph, touch, u32::MAX, |w| groups[w as usize] == NO_PIECE);
    let mut gaps = Vec::new();
    for v in 0..graph.len() as u32 {
        for w in graph.touching(v, touch).take_while(|w| *w < v) {
            let owners = [v, w].map(|v| forest.owners[v as usize]);
            if owners[0] != owners[1] && !owners.contains(&NOBODY) {
                let ways =
                    forest.distances[v as usize].saturating_add(forest.distances[w as usize]);
                gaps.push((ways.saturating_add(graph.step(v, w)), v, w));
            }
        }
    }
    gaps.sort_unstable();
    let mut sets = UnionFind::new(count);
    let mut paths = Vec::new();
    for (_, v, w) in gaps {
        if sets.unite(forest.owners[v as usize], forest.owners[w as usize]) {
            let mut path: Vec<u32> = forest.way(v).collect();
            path.reverse();
            path.extend(forest.way(w));
            paths.push(path);
        }
    }
    paths
}
