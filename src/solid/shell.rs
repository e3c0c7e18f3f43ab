//! Surfaces made into bodies: thickened, or with their flat openings closed.

use std::collections::BTreeMap;

use super::SolidError;
use fretwork_geometry::halving::largest;
use fretwork_geometry::mesh::{doubled_normal, open_sides, triangulate};
use fretwork_geometry::{Mesh, Point, Point3, Polygon, Side};

/// Corners of an opening within this part of its size of a plane lie in it.
const FLAT: f64 = 1e-6;
/// Corners move inward by no more than this many times the thickness.
const LONGEST: f64 = 4.0;

/// The body between two copies of `surface`, `thickness` apart: on the inner side of it, on the outer side, or half of it on each. Walls
/// stand at open rims. Corners move along the mean of the normals around them, so far that flat sides are as thick as asked for.
///
/// # Errors
/// A thickness that is not above zero, triangles that do not form an oriented surface, bends that are sharper than
/// the thickness.
pub fn shell(surface: &Mesh, thickness: f64, side: Side) -> Result<Mesh, SolidError> {
    if !(thickness > 0.0 && thickness.is_finite()) {
        return Err(SolidError::Size(thickness));
    }
    surface.validate()?;
    let steps = inward(surface);
    let [low, high] = between(thickness, side).map(|out| moved(surface, &steps, out));
    if let Err(SolidError::Bend { at, .. }) = check_copies(surface, &[&low, &high]) {
        let most = largest(thickness, |thickness| {
            let copies = between(thickness, side).map(|out| moved(surface, &steps, out));
            check_copies(surface, &[&copies[0], &copies[1]]).is_ok()
        });
        return Err(SolidError::Bend { at, most });
    }
    let count = surface.positions.len() as u32;
    let mut mesh = Mesh {
        positions: high,
        triangles: surface.triangles.clone(),
    };
    mesh.positions.extend(low);
    for [a, b] in open_sides(&surface.triangles) {
        mesh.triangles.push([b, a, a + count]);
        mesh.triangles.push([b, a + count, b + count]);
    }
    for triangle in &surface.triangles {
        let [a, b, c] = triangle.map(|corner| corner + count);
        mesh.triangles.push([a, c, b]);
    }
    mesh.check_closed()?;
    Ok(mesh)
}

/// An error where a triangle of the surface is turned over in one of its copies.
fn check_copies(surface: &Mesh, copies: &[&Vec<Point3>]) -> Result<(), SolidError> {
    for triangle in &surface.triangles {
        for copy in copies {
            check_turned(surface.corners(*triangle), copy, *triangle)?;
        }
    }
    Ok(())
}

/// Between which distances out of a surface a body of this thickness lies.
pub(crate) fn between(thickness: f64, side: Side) -> [f64; 2] {
    match side {
        Side::Inside => [-thickness, 0.0],
        Side::Center => [-0.5 * thickness, 0.5 * thickness],
        Side::Outside => [0.0, thickness],
    }
}

/// The corners of `surface`, each `out` of it along its step, which points inward.
fn moved(surface: &Mesh, steps: &[Point3], out: f64) -> Vec<Point3> {
    if out == 0.0 {
        return surface.positions.clone();
    }
    let corners = surface.positions.iter().zip(steps);
    corners.map(|(p, step)| *p + *step * -out).collect()
}

/// An error where a side of a triangle runs the other way once its corners have moved: it has been turned over there. A triangle
/// as a whole may be turned over twice, so that its normal is not enough.
pub(crate) fn check_turned(
    before: [Point3; 3],
    moved: &[Point3],
    triangle: [u32; 3],
) -> Result<(), SolidError> {
    let after = triangle.map(|corner| moved[corner as usize]);
    let turned = |i: usize| {
        let j = (i + 1) % 3;
        (before[j] - before[i]).dot(after[j] - after[i]) < 0.0
    };
    if doubled_normal(before).dot(doubled_normal(after)) < 0.0 || (0..3).any(turned) {
        return Err(SolidError::Bend {
            at: before[0],
            most: None,
        });
    }
    Ok(())
}

/// For each corner the step inward for a thickness of one.
pub(crate) fn inward(surface: &Mesh) -> Vec<Point3> {
    let normals: Vec<Option<Point3>> = surface
        .triangles
        .iter()
        .map(|t| doubled_normal(surface.corners(*t)).unit())
        .collect();
    let mut sums = vec![Point3::ORIGIN; surface.positions.len()];
    for (triangle, normal) in surface.triangles.iter().zip(&normals) {
        let corners = surface.corners(*triangle);
        for i in 0..3 {
            let (next, back) = (
                corners[(i + 1) % 3] - corners[i],
                corners[(i + 2) % 3] - corners[i],
            );
            // By the angle at the corner, so that it does not matter how a side is divided into triangles.
            let angle = libm::atan2(next.cross(back).length(), next.dot(back));
            sums[triangle[i] as usize] =
                sums[triangle[i] as usize] + normal.unwrap_or_default() * angle;
        }
    }
    let means: Vec<Point3> = sums
        .into_iter()
        .map(|sum| sum.unit().unwrap_or_default())
        .collect();
    // How much the mean leans from the side that it leans from the most.
    let mut least = vec![1.0f64; means.len()];
    for (triangle, normal) in surface.triangles.iter().zip(&normals) {
        for &corner in triangle {
            let lean = normal.map_or(1.0, |normal| normal.dot(means[corner as usize]));
            least[corner as usize] = least[corner as usize].min(lean);
        }
    }
    means
        .iter()
        .zip(least)
        .map(|(mean, lean)| *mean * -(1.0 / lean.max(1.0 / LONGEST)))
        .collect()
}

/// The surface with its flat openings closed. One that is closed already is given back as it is.
///
/// # Errors
/// Openings that are not flat, and all that makes the result no closed mesh.
pub fn capped(surface: &Mesh) -> Result<Mesh, SolidError> {
    surface.validate()?;
    let mut mesh = surface.clone();
    for rim in rims(surface)? {
        let corners: Vec<Point3> = rim
            .iter()
            .map(|corner| surface.positions[*corner as usize])
            .collect();
        mesh.triangles.extend(
            cap(&corners)?
                .into_iter()
                .map(|t| t.map(|i| rim[i as usize])),
        );
    }
    mesh.check_closed()?;
    Ok(mesh)
}

/// The loops of open sides, each run so that what closes it lies on its left.
fn rims(surface: &Mesh) -> Result<Vec<Vec<u32>>, SolidError> {
    let mut next: BTreeMap<u32, u32> = BTreeMap::new();
    for [a, b] in open_sides(&surface.triangles) {
        if next.insert(b, a).is_some() {
            return Err(SolidError::Rim {
                at: surface.positions[b as usize],
            });
        }
    }
    let mut rims = Vec::new();
    while let Some((first, mut corner)) = next.pop_first() {
        let mut rim = vec![first];
        while corner != first {
            rim.push(corner);
            let at = surface.positions[corner as usize];
            corner = next.remove(&corner).ok_or(SolidError::Rim { at })?;
        }
        rims.push(rim);
    }
    Ok(rims)
}

/// The triangles of a flat rim.
fn cap(corners: &[Point3]) -> Result<Vec<[u32; 3]>, SolidError> {
    let middle =
        corners.iter().fold(Point3::ORIGIN, |sum, p| sum + *p) * (1.0 / corners.len() as f64);
    let around = corners.iter().zip(corners.iter().cycle().skip(1));
    let normal = around
        .fold(Point3::ORIGIN, |sum, (a, b)| {
            sum + (*a - middle).cross(*b - middle)
        })
        .unit();
    let size = corners
        .iter()
        .map(|p| p.distance(middle))
        .fold(0.0, f64::max);
    let off = |normal: Point3| {
        corners
            .iter()
            .find(|p| (**p - middle).dot(normal).abs() > FLAT * size)
    };
    let Some(normal) = normal.filter(|normal| off(*normal).is_none()) else {
        let at = normal.and_then(off).copied().unwrap_or(middle);
        return Err(SolidError::NotFlat { at });
    };
    let axis = if normal.x.abs() < 0.6 {
        Point3::new(1.0, 0.0, 0.0)
    } else {
        Point3::new(0.0, 1.0, 0.0)
    };
    let x = (axis - normal * axis.dot(normal)).unit().unwrap_or(axis);
    let y = normal.cross(x);
    let outer = corners
        .iter()
        .map(|p| Point::new((*p - middle).dot(x), (*p - middle).dot(y)))
        .collect();
    Ok(triangulate(&Polygon {
        outer,
        holes: Vec::new(),
    })?)
}

#[cfg(test)]
mod tests {
    use super::super::{ball, cuboid};
    use super::*;
    use fretwork_geometry::mesh::revolve;

    #[test]
    fn a_box_becomes_a_hollow_box() {
        let mesh = shell(
            &cuboid(Point3::new(4.0, 5.0, 6.0)).unwrap(),
            1.0,
            Side::Inside,
        )
        .unwrap();
        assert_eq!(
            mesh.check_closed().map(|t| (t.components, t.genus)),
            Ok((2, Some(0)))
        );
        assert!(
            (mesh.volume() - (120.0 - 24.0)).abs() < 1e-9,
            "{}",
            mesh.volume()
        );
    }

    #[test]
    fn an_open_surface_has_walls_at_its_rims() {
        let tube = revolve(&[Point::new(20.0, 0.0), Point::new(20.0, 30.0)], false, 360).unwrap();
        let mesh = shell(&tube, 2.0, Side::Inside).unwrap();
        assert_eq!(
            mesh.check_closed().map(|t| (t.components, t.genus)),
            Ok((1, Some(1)))
        );
        let expected = std::f64::consts::PI * (400.0 - 324.0) * 30.0;
        assert!((mesh.volume() / expected - 1.0).abs() < 1e-3);
    }

    #[test]
    fn the_thickness_of_a_shell_goes_to_the_side_that_is_asked_for() {
        let tube = revolve(&[Point::new(20.0, 0.0), Point::new(20.0, 30.0)], false, 360).unwrap();
        for (side, expected) in [
            (Side::Inside, [18.0, 20.0]),
            (Side::Center, [19.0, 21.0]),
            (Side::Outside, [20.0, 22.0]),
        ] {
            let mesh = shell(&tube, 2.0, side).unwrap();
            let radii = mesh.positions.iter().map(|p| libm::hypot(p.x, p.y));
            let (low, high) = radii.fold((f64::MAX, 0.0f64), |(low, high), r| {
                (low.min(r), high.max(r))
            });
            let off = (low - expected[0]).abs().max((high - expected[1]).abs());
            assert!(off < 1e-3, "{side:?}: {low} to {high}");
            assert!(mesh.volume() > 0.0);
        }
        // Room inside does not matter where nothing grows inward.
        let ball = ball(3.0, 24).unwrap();
        assert!(shell(&ball, 4.0, Side::Outside).is_ok());
        assert!(shell(&ball, 4.0, Side::Center).is_ok());
    }

    #[test]
    fn flat_openings_are_closed_and_others_are_told() {
        let tube = revolve(&[Point::new(20.0, 0.0), Point::new(15.0, 30.0)], false, 36).unwrap();
        assert_eq!(
            capped(&tube).unwrap().check_closed().map(|t| t.genus),
            Ok(Some(0))
        );
        let ball = ball(3.0, 24).unwrap();
        assert_eq!(capped(&ball), Ok(ball.clone()));
        let mut bent = tube.clone();
        bent.positions[0].z -= 1.0;
        assert!(matches!(capped(&bent), Err(SolidError::NotFlat { .. })));
    }

    #[test]
    fn sharp_bends_cannot_be_thick() {
        assert!(matches!(
            shell(&ball(3.0, 24).unwrap(), 4.0, Side::Inside),
            Err(SolidError::Bend { .. })
        ));
        assert!(shell(&ball(3.0, 24).unwrap(), 0.0, Side::Inside).is_err());
    }
}
