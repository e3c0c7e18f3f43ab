//! Boxes, balls, cylinders.

use std::f64::consts::PI;

use super::SolidError;
use fretwork_geometry::mesh::{check_size, revolve};
use fretwork_geometry::{Mesh, Point, Point3};

/// The box from the origin to `size`.
///
/// # Errors
/// Sizes that are not above zero.
pub fn cuboid(size: Point3) -> Result<Mesh, SolidError> {
    [size.x, size.y, size.z]
        .into_iter()
        .try_for_each(positive)?;
    Ok(Mesh::cuboid(Point3::default(), size))
}

/// The ball about the origin, with `segments` pieces to a full turn. Its corners are on the sphere.
///
/// # Errors
/// A radius that is not above zero, too few or too many segments.
pub fn ball(radius: f64, segments: u32) -> Result<Mesh, SolidError> {
    positive(radius)?;
    let rings = (segments / 2).max(2);
    check_size(u64::from(rings) + 1, segments)?;
    let point = |i: u32| match i {
        0 => Point::new(0.0, -radius),
        i if i == rings => Point::new(0.0, radius),
        i => {
            let p = Point::unit(PI * (f64::from(i) / f64::from(rings) - 0.5));
            Point::new(p.x * radius, p.y * radius)
        }
    };
    Ok(revolve(
        &(0..=rings).map(point).collect::<Vec<_>>(),
        false,
        segments,
    )?)
}

/// The cylinder on the xy plane about the z axis, with `segments` sides.
///
/// # Errors
/// Sizes that are not above zero, too few or too many segments.
pub fn cylinder(radius: f64, height: f64, segments: u32) -> Result<Mesh, SolidError> {
    [radius, height].into_iter().try_for_each(positive)?;
    let profile = [[0.0, 0.0], [radius, 0.0], [radius, height], [0.0, height]].map(Point::from);
    Ok(revolve(&profile, false, segments)?)
}

fn positive(size: f64) -> Result<(), SolidError> {
    if size > 0.0 && size.is_finite() {
        Ok(())
    } else {
        Err(SolidError::Size(size))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::mesh::RevolveError;

    #[test]
    fn a_ball_of_too_many_pieces_is_refused_before_its_profile_is_made() {
        let refused = ball(1.0, 1_000_000_000);
        assert!(matches!(
            refused,
            Err(SolidError::Revolve(RevolveError::TooMany(_)))
        ));
    }

    #[test]
    fn primitives_are_closed_and_have_their_volumes() {
        let close = |mesh: &Mesh, volume: f64, part: f64| {
            assert_eq!(
                mesh.check_closed().map(|t| (t.components, t.genus)),
                Ok((1, Some(0)))
            );
            assert!(
                (mesh.volume() / volume - 1.0).abs() < part,
                "{} {volume}",
                mesh.volume()
            );
        };
        close(&cuboid(Point3::new(2.0, 3.0, 4.0)).unwrap(), 24.0, 1e-12);
        close(&ball(3.0, 200).unwrap(), 36.0 * PI, 1e-3);
        close(&ball(3.0, 3).unwrap(), 23.4, 0.1);
        close(&cylinder(2.0, 5.0, 200).unwrap(), 20.0 * PI, 1e-3);
    }

    #[test]
    fn sizes_are_checked() {
        assert_eq!(
            cuboid(Point3::new(1.0, 0.0, 1.0)),
            Err(SolidError::Size(0.0))
        );
        assert_eq!(ball(-1.0, 9), Err(SolidError::Size(-1.0)));
        assert!(ball(1.0, 2).is_err() && cylinder(1.0, f64::INFINITY, 9).is_err());
    }
}
