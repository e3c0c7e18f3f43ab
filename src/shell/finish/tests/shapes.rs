//! Surfaces for tests.

use fretwork_geometry::mesh::revolve;
use fretwork_geometry::{Mesh, Point};

/// A profile turned about the z axis.
pub(super) fn turned(profile: &[[f64; 2]], segments: u32) -> Mesh {
    let profile: Vec<Point> = profile.iter().map(|p| Point::from(*p)).collect();
    revolve(&profile, false, segments).unwrap().welded()
}
