//! What noding gives.

use crate::planar_map::noding::routes::Routes;
use crate::planar_map::noding::snap_grid::Site;

/// Nodes and the routes of the segments through them.
#[derive(Default)]
pub(in crate::planar_map) struct Network {
    /// The nodes in reading order; some may be on no route.
    pub sites: Vec<Site>,
    pub routes: Routes,
}
