//! Snap rounding: segments in, routes out that meet at nodes only. A node is an end of a segment
//! or a crossing, rounded to the grid; a segment is led through every node within half a resolution
//! of it, and nodes that follow one another along a segment within a resolution are merged (Hobby 1999; Guibas and
//! Marimont 1998, with a disc in the place of the hot pixel). Where that moves anything
//! farther than a harmless bend the pieces around it are noded again until they come to rest, as in iterated
//! snap rounding (Halperin and Packer 2002): in the end no node is near a piece that it does not
//! end, so the result is its own snap rounding. Labels are not known here.

use rayon::prelude::*;

use super::PlanarMapError;
use super::bins::{Bins, Cells};
use super::crossings::{CellWork, Found, MOST};
use super::excerpt::Excerpt;
use super::lattice::Site;
use super::routes::Routes;
use super::strands::Strands;

/// Nodes and the routes of the strands through them.
#[derive(Default)]
pub(super) struct Network {
    /// The nodes in reading order; some may be on no route.
    pub sites: Vec<Site>,
    pub routes: Routes,
}

/// Passes after which noding gives up; real inputs take one or two.
const PASSES: usize = 64;

/// The noded network of strands that may cross, touch and overlap.
pub(super) fn node(mut strands: Strands, resolution: f64) -> Result<Network, PlanarMapError> {
    if strands.segments.is_empty() {
        return Ok(Network::default());
    }
    let cells = Cells::suited(&strands.segments);
    strands.sort(&cells);
    let (mut network, mut suspects) = pass(strands, cells)?;
    for _ in 0..PASSES {
        if suspects.is_empty() {
            return Ok(network);
        }
        let (around, strands) = Excerpt::around(&suspects, &network, &cells);
        let cells = Cells::suited(&strands.segments);
        let (part, moved) = pass(strands, cells)?;
        (network, suspects) = around.replace(network, part, &moved);
    }
    Err(PlanarMapError::Unresolved { resolution })
}

/// Finds nodes and leads the segments through them. Also returned are the nodes around which it has
/// to be done again, because something moved there.
fn pass(strands: Strands, cells: Cells) -> Result<(Network, Vec<u32>), PlanarMapError> {
    let mut found = find(&strands, cells);
    let count = found.iter().map(|f| f.incidences.len()).sum();
    if count > MOST {
        return Err(PlanarMapError::TooLarge {
            what: "meetings of curves",
            count,
        });
    }
    let bent = found.iter().any(|f| f.bent);
    let mut sites = Vec::with_capacity(found.iter().map(|f| f.sites.len()).sum());
    let mut suspects = Vec::new();
    for part in &mut found {
        // The parts are whole rows of cells, one after the other, so the nodes are in reading order.
        part.base = sites.len() as u32;
        sites.append(&mut std::mem::take(&mut part.sites));
        let close = if bent { part.close.as_slice() } else { &[] };
        suspects.extend(part.moved.iter().chain(close).map(|v| part.base + v));
    }
    let (routes, merged) = Routes::gather(strands, &sites, found);
    suspects.extend(merged);
    Ok((Network { sites, routes }, suspects))
}

/// Nodes and incidences of all cells, in the order of these, some rows at a time.
fn find(strands: &Strands, cells: Cells) -> Vec<Found> {
    /// A thread takes rows with this many entries of the bins at once.
    const GRAIN: usize = 1 << 13;
    let segments = &strands.segments;
    let bins = Bins::fill(cells, segments.len(), |i| segments[i]);
    let mut tasks = Vec::new();
    let mut first = 0;
    for row in 1..=cells.rows {
        if bins.size(first..row) > GRAIN || row == cells.rows {
            tasks.push(first * cells.columns..row * cells.columns);
            first = row;
        }
    }
    let explore = |task: std::ops::Range<usize>| {
        let mut work = CellWork::new(segments);
        task.for_each(|cell| work.explore(&bins.cells, cell, bins.members(cell)));
        work.finish()
    };
    if tasks.len() > 1 {
        tasks.into_par_iter().map(explore).collect()
    } else {
        tasks.into_iter().map(explore).collect()
    }
}
