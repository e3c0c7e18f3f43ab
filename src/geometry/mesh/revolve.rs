//! Profiles turned about the z axis.

use std::f64::consts::TAU;

use super::Mesh;
use super::model::TRIANGLE;
use crate::budget;
use crate::{Point, Point3};

/// More triangles than this are refused.
const MOST: u64 = 20_000_000;

/// Why a profile cannot be turned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RevolveError {
    /// A coordinate that is no number.
    #[error("a size cannot be {0}")]
    NotFinite(f64),
    /// A full turn of fewer than three pieces.
    #[error("a full turn of {0} pieces has no volume: it needs at least 3")]
    Segments(u32),
    /// The profile has fewer than two distinct points.
    #[error("a profile needs at least two distinct points")]
    ShortProfile,
    /// The profile goes to the other side of the axis.
    #[error("the profile leaves the right side of the axis: its radius is {0}")]
    NegativeRadius(f64),
    /// The profile touches the axis between its ends.
    #[error("the profile touches the axis at height {0}, between its ends")]
    TouchesAxis(f64),
    /// More triangles than a mesh may have.
    #[error("{0} triangles are too many")]
    TooMany(u64),
}

/// The surface that `profile` (radius, height) leaves when it is turned about the z axis, in `segments` flat pieces to
/// a turn, facing outward. It is open at ends that are not on the axis, unless `closed` joins the last
/// point to the first. Points that repeat their predecessor count once.
///
/// # Errors
/// Fewer than two distinct points, radii below 0 or on the axis between the ends, fewer than three segments, or
/// too many triangles.
pub fn revolve(profile: &[Point], closed: bool, segments: u32) -> Result<Mesh, RevolveError> {
    let profile = revolved_profile(profile, closed, segments)?;
    let last = profile.len() - 1;
    let mut mesh = Mesh::default();
    // The number of a profile point's first corner; a point on the axis has one corner only.
    let mut starts = Vec::with_capacity(profile.len());
    for p in &profile {
        starts.push(mesh.positions.len() as u32);
        if p.x == 0.0 {
            mesh.positions.push(Point3::new(0.0, 0.0, p.y));
            continue;
        }
        for j in 0..segments {
            let at = Point::unit(TAU * f64::from(j) / f64::from(segments)) * p.x;
            mesh.positions.push(Point3::new(at.x, at.y, p.y));
        }
    }
    let corner = |i: usize, j: u32| {
        if profile[i].x == 0.0 {
            starts[i]
        } else {
            starts[i] + j % segments
        }
    };
    let steps = if closed { last + 1 } else { last };
    for i in 0..steps {
        let k = (i + 1) % profile.len();
        for j in 0..segments {
            let quad = [
                corner(i, j),
                corner(i, j + 1),
                corner(k, j + 1),
                corner(k, j),
            ];
            let halves = [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]];
            mesh.triangles.extend(
                halves
                    .into_iter()
                    .filter(|[a, b, c]| a != b && b != c && c != a),
            );
        }
    }
    Ok(mesh)
}

/// Whether a profile of `corners` points may be turned in `segments` pieces, to be asked before a long
/// profile is made.
///
/// # Errors
/// [`RevolveError::TooMany`].
pub fn check_size(corners: u64, segments: u32) -> Result<(), RevolveError> {
    match 2 * corners * u64::from(segments) {
        triangles if triangles > MOST => Err(RevolveError::TooMany(triangles)),
        triangles => {
            budget::make("triangles", triangles as usize, TRIANGLE);
            Ok(())
        }
    }
}

/// The profile without repeated points, checked, in the sense in which its surface faces outward.
///
/// # Errors
/// As [`revolve`].
pub fn revolved_profile(
    profile: &[Point],
    closed: bool,
    segments: u32,
) -> Result<Vec<Point>, RevolveError> {
    if segments < 3 {
        return Err(RevolveError::Segments(segments));
    }
    if let Some(p) = profile.iter().find(|p| !p.is_finite()) {
        return Err(RevolveError::NotFinite(if p.x.is_finite() {
            p.y
        } else {
            p.x
        }));
    }
    if let Some(p) = profile.iter().find(|p| p.x < 0.0) {
        return Err(RevolveError::NegativeRadius(p.x));
    }
    let mut points: Vec<Point> = profile
        .iter()
        .map(|p| Point::new(p.x + 0.0, p.y + 0.0))
        .collect();
    points.dedup();
    while closed && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 2 + usize::from(closed) {
        return Err(RevolveError::ShortProfile);
    }
    let inner = if closed {
        &points[..]
    } else {
        &points[1..points.len() - 1]
    };
    if let Some(p) = inner.iter().find(|p| p.x == 0.0) {
        return Err(RevolveError::TouchesAxis(p.y));
    }
    check_size(points.len() as u64, segments)?;
    // Three times the volume below the profile, by pi: that inside the surface, where it is closed by flat ends.
    let ends = points
        .iter()
        .zip(points.iter().cycle().skip(1))
        .take(points.len() - usize::from(!closed));
    let volume: f64 = ends
        .map(|(a, b)| (a.x * a.x + a.x * b.x + b.x * b.x) * (b.y - a.y))
        .sum();
    if volume < 0.0 {
        points.reverse();
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    #[test]
    fn profiles_from_axis_to_axis_are_closed() {
        let cone = profile(&[[0., 0.], [3., 0.], [0., 4.]]);
        for points in [cone.clone(), cone.into_iter().rev().collect()] {
            let mesh = revolve(&points, false, 360).unwrap();
            assert_eq!(mesh.check_closed().map(|t| t.genus), Ok(Some(0)));
            assert!((mesh.volume() / (TAU / 2.0 * 9.0 * 4.0 / 3.0) - 1.0).abs() < 1e-4);
        }
        let ring = profile(&[[5., 0.], [6., 0.], [6., 1.], [5., 1.], [5., 0.]]);
        assert_eq!(
            revolve(&ring, true, 24)
                .unwrap()
                .check_closed()
                .map(|t| t.genus),
            Ok(Some(1))
        );
    }

    #[test]
    fn other_profiles_are_open_and_face_outward() {
        let vase = revolve(&profile(&[[20., 0.], [35., 40.], [18., 90.]]), false, 96).unwrap();
        let topology = vase.topology();
        assert_eq!(
            (topology.components, topology.open_edges, topology.bad_edges),
            (1, 192, 0)
        );
        let middle = vase.corners(vase.triangles[0]);
        assert!(crate::mesh::doubled_normal(middle).x > 0.0);
    }

    #[test]
    fn bad_profiles_are_refused() {
        assert_eq!(
            revolve(&profile(&[[1., 0.], [1., 0.]]), false, 9),
            Err(RevolveError::ShortProfile)
        );
        assert_eq!(
            revolve(&profile(&[[1., 0.], [-1., 1.]]), false, 9),
            Err(RevolveError::NegativeRadius(-1.0))
        );
        assert_eq!(
            revolve(&profile(&[[1., 0.], [0., 1.], [1., 2.]]), false, 9),
            Err(RevolveError::TouchesAxis(1.0))
        );
        assert_eq!(
            revolve(&profile(&[[1., 0.], [1., 1.]]), false, 2),
            Err(RevolveError::Segments(2))
        );
        assert!(matches!(
            revolve(&profile(&[[1., 0.], [1., 1.]]), false, 1 << 30),
            Err(RevolveError::TooMany(_))
        ));
        assert!(revolve(&profile(&[[1., f64::NAN], [1., 1.]]), false, 9).is_err());
    }
}
