//! Sites that may become nodes, and how near they must be to one another or to a segment to matter.

use crate::planar_map::noding::exact::before;
use crate::planar_map::noding::snap_grid::{RESOLUTION, Site};

/// A node this near to a segment, in grid units, lies on it, and one this near to another is merged with it.
pub(in crate::planar_map) const REACH: f64 = 0.5 * RESOLUTION - 2.0;

/// Sites of one cell this near become one node. Less than [`REACH`] by more than the rounding of a
/// crossing, so that a segment through a site is also near to the node that replaces the site.
pub(in crate::planar_map) const MERGE: f64 = REACH - 1.0;

/// A site of the cell: an end of a segment (2 × segment, + 1 for b) or a crossing.
#[derive(Clone, Copy)]
pub(in crate::planar_map) struct Candidate {
    pub site: Site,
    pub end: u32,
}

impl Candidate {
    /// [`Candidate::end`] of a crossing.
    pub const CROSSING: u32 = u32::MAX;

    /// Reading order, ends before crossings.
    pub fn order(&self, other: &Candidate) -> std::cmp::Ordering {
        before(self.site, other.site).then(self.end.cmp(&other.end))
    }
}
