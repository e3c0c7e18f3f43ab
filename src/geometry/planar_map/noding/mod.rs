//! Snap rounding: segments in, routes out that meet at nodes only.
//!
//! A node is an end of a segment or a crossing of two, rounded to the grid. In classical snap rounding (Hobby 1999; Guibas
//! and Marimont 1998) a node is a hot pixel: a square of the grid, and a segment that passes through the square is
//! bent to go through its middle. Here the pixel is a disc of half a resolution around the node, so that the result does not
//! depend on the directions of the axes, and the grid is 512 times finer than the resolution. Two rules make the
//! routes:
//!
//! - A segment runs through every node that is within half a resolution of it.
//! - Nodes that follow one another along a segment within a resolution are merged.
//!
//! A bend moves a segment, and the moved segment may come near another node. A bend below a sixteenth of the reach is
//! harmless, because nothing was near enough. Where something moves farther, the pieces around it are noded again until they
//! come to rest, as in iterated snap rounding (Halperin and Packer 2002). In the end no node is near a piece that it
//! does not end, so the result is its own snap rounding. Labels are not known here.

pub(in crate::planar_map) mod bins;
pub(in crate::planar_map) mod candidate;
mod clusters;
pub(in crate::planar_map) mod crossings;
pub(in crate::planar_map) mod exact;
mod excerpt;
pub(in crate::planar_map) mod network;
mod order;
pub(in crate::planar_map) mod routes;
pub(in crate::planar_map) mod segments;
pub(in crate::planar_map) mod snap_grid;

use rayon::prelude::*;

use crate::budget::{self, Meter};
use crate::planar_map::PlanarMapError;
use crate::planar_map::noding::bins::{Bins, Cells};
use crate::planar_map::noding::crossings::{CellWork, Found, MOST};
use crate::planar_map::noding::excerpt::Excerpt;
use crate::planar_map::noding::network::Network;
use crate::planar_map::noding::routes::Routes;
use crate::planar_map::noding::segments::Segments;

/// Passes after which noding gives up. Real inputs take one or two, and thickets made on purpose a dozen; with fewer passes
/// those would be refused, with more a network that never rests is only refused later.
const PASSES: usize = 64;

/// Bytes that a map takes while it is built for each place where a segment meets another one.
const MEETING: usize = 200;

/// The noded network of segments that may cross, touch and overlap.
pub(in crate::planar_map) fn node(
    mut segments: Segments,
    resolution: f64,
) -> Result<Network, PlanarMapError> {
    if segments.by_place.is_empty() {
        return Ok(Network::default());
    }
    let cells = Cells::suited(&segments.by_place);
    segments.sort(&cells);
    let (mut network, mut suspects) = pass(segments, cells)?;
    for _ in 0..PASSES {
        if suspects.is_empty() {
            return Ok(network);
        }
        let (around, segments) = Excerpt::around(&suspects, &network, &cells);
        let cells = Cells::suited(&segments.by_place);
        let (part, moved) = pass(segments, cells)?;
        (network, suspects) = around.replace(network, part, &moved);
    }
    Err(PlanarMapError::Unresolved { resolution })
}

/// Finds nodes and leads the segments through them. Also returned are the nodes around which it has
/// to be done again, because something moved there.
fn pass(segments: Segments, cells: Cells) -> Result<(Network, Vec<u32>), PlanarMapError> {
    let mut found = find(&segments, cells);
    let count = found.iter().map(|f| f.incidences.len()).sum();
    if count > MOST {
        return Err(PlanarMapError::TooLarge {
            what: "meetings of curves",
            count,
        });
    }
    budget::make("meetings of curves", count, MEETING);
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
    let (routes, merged) = Routes::gather(segments, &sites, found);
    suspects.extend(merged);
    Ok((Network { sites, routes }, suspects))
}

/// Nodes and incidences of all cells, in the order of these, some rows at a time.
fn find(segments: &Segments, cells: Cells) -> Vec<Found> {
    /// A thread takes rows with this many entries of the bins at once.
    const GRAIN: usize = 1 << 13;
    let segments = &segments.by_place;
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
        let meter = Meter::current();
        let explore = |task| meter.during(|| explore(task));
        tasks.into_par_iter().map(explore).collect()
    } else {
        tasks.into_iter().map(explore).collect()
    }
}
