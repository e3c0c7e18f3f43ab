//! Snap rounding: segments in, pieces out that meet at nodes only. A node is an end of a segment
//! or a crossing, rounded to the grid; a segment is led through every node within a resolution of
//! it, and nodes within a resolution of one another are merged (Hobby 1999; Guibas and Marimont
//! 1998, with a disc of one resolution in the place of the hot pixel). Where that moves anything
//! farther than a harmless bend the pieces are noded again until they come to rest, as in iterated
//! snap rounding (Halperin and Packer 2002): in the end every node is farther than a resolution
//! from every piece that it does not end, so the result is its own snap rounding.
//! Curves and labels are not known here beyond the number of the curve a piece is of.

use rayon::prelude::*;

use super::PlanarMapError;
use super::bins::{Bins, Cells};
use super::crossings::{CellWork, Found, MOST};
use super::exact::Segment;
use super::lattice::Site;
use super::routes::Routes;

/// Segments with the curves they are of, ascending: 2 × curve, + 1 where the curve runs from b to a.
#[derive(Default)]
pub(super) struct Strands {
    pub segments: Vec<Segment>,
    pub curves: Vec<u32>,
}

impl Strands {
    /// Adds the segment between two sites that differ.
    pub fn push(&mut self, from: Site, to: Site, curve: u32) {
        let (segment, reversed) = Segment::between(from, to);
        self.segments.push(segment);
        self.curves.push(2 * curve + u32::from(reversed));
    }
}

/// Pieces between nodes, in the order and direction of the curves.
#[derive(Default)]
pub(super) struct Network {
    /// The nodes.
    pub sites: Vec<Site>,
    /// From and to, never the same node.
    pub pieces: Vec<[u32; 2]>,
    /// The curve of every piece, ascending.
    pub curves: Vec<u32>,
}

/// Passes after which noding gives up; real inputs take one or two.
const PASSES: usize = 64;

/// The noded network of strands that may cross, touch and overlap.
pub(super) fn node(mut strands: Strands, resolution: f64) -> Result<Network, PlanarMapError> {
    for _ in 0..PASSES {
        if strands.segments.is_empty() {
            return Ok(Network::default());
        }
        let (network, settled) = pass(strands)?;
        if settled {
            return Ok(network);
        }
        strands = Strands::default();
        for (piece, &curve) in network.pieces.iter().zip(&network.curves) {
            let [from, to] = piece.map(|v| network.sites[v as usize]);
            strands.push(from, to, curve);
        }
    }
    Err(PlanarMapError::Unresolved { resolution })
}

/// One round of finding nodes and leading the segments through them; whether it is the last.
fn pass(strands: Strands) -> Result<(Network, bool), PlanarMapError> {
    let found = find(&strands.segments);
    let count = found.iter().map(|f| f.incidences.len()).sum();
    if count > MOST {
        return Err(PlanarMapError::TooLarge { what: "meetings of curves", count });
    }
    let unsettled = Found::unsettled(&found);
    let mut sites = Vec::with_capacity(found.iter().map(|f| f.sites.len()).sum());
    found.iter().for_each(|f| sites.extend_from_slice(&f.sites));
    let (routes, merged) = Routes::gather(&strands.segments, &sites, found);
    drop(strands.segments);
    let (pieces, curves) = routes.pieces(&strands.curves);
    Ok((Network { sites, pieces, curves }, !merged && !unsettled))
}

/// Nodes and incidences of all cells, in the order of these, some rows at a time.
fn find(segments: &[Segment]) -> Vec<Found> {
    /// A thread takes rows with this many entries of the bins at once.
    const GRAIN: u32 = 1 << 14;
    let cells = Cells::suited(segments);
    let bins = Bins::fill(cells, segments.len(), |i| segments[i]);
    let mut tasks = Vec::new();
    let mut first = 0;
    for row in 1..=cells.rows {
        let entries = bins.starts[row * cells.columns] - bins.starts[first * cells.columns];
        if entries > GRAIN || row == cells.rows {
            tasks.push(first * cells.columns..row * cells.columns);
            first = row;
        }
    }
    let explore = |rows: std::ops::Range<usize>| {
        let mut work = CellWork::new(segments);
        rows.for_each(|cell| work.explore(&bins.cells, cell, bins.members(cell)));
        work.found
    };
    if tasks.len() > 1 {
        tasks.into_par_iter().map(explore).collect()
    } else {
        tasks.into_iter().map(explore).collect()
    }
}
