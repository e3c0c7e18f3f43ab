//! Areas of the drawing plane made thick.

use super::SolidError;
use fretwork_geometry::mesh::{open_sides, triangulate};
use fretwork_geometry::{Mesh, Point3, Polygon};

/// The polygons between the heights `low` and `high`, mirrored into world space: seen from above they look as they
/// are drawn. Each polygon is a body of its own, with as many handles as it has holes; where polygons or
/// rings touch in a corner, walls stand in one place and are not joined. O(n log n).
///
/// # Errors
/// Rings that cross or overlap; heights that are not in order; no polygon.
pub fn extrude(polygons: &[Polygon], low: f64, high: f64) -> Result<Mesh, SolidError> {
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(SolidError::Size(high - low));
    }
    let mut mesh = Mesh::default();
    for polygon in polygons {
        push_prism(&mut mesh, polygon, low, high)?;
    }
    if mesh.triangles.is_empty() {
        Err(SolidError::Nothing)
    } else {
        Ok(mesh)
    }
}

fn push_prism(mesh: &mut Mesh, polygon: &Polygon, low: f64, high: f64) -> Result<(), SolidError> {
    let base = triangulate(polygon)?;
    let first = mesh.positions.len() as u32;
    let count = polygon.rings().map(Vec::len).sum::<usize>() as u32;
    for height in [low, high] {
        let corners = polygon.rings().flatten();
        mesh.positions
            .extend(corners.map(|p| Point3::new(p.x, 0.0 - p.y, height)));
    }
    let top = first + count;
    for [a, b] in open_sides(&base) {
        mesh.triangles.push([first + b, first + a, top + a]);
        mesh.triangles.push([first + b, top + a, top + b]);
    }
    for [a, b, c] in base {
        // The mirror turns triangles over: those of the base look down as they are.
        mesh.triangles.push([first + a, first + b, first + c]);
        mesh.triangles.push([top + a, top + c, top + b]);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{Point, Ring};

    fn ring(points: &[[f64; 2]]) -> Ring {
        points.iter().map(|&p| Point::from(p)).collect()
    }

    #[test]
    fn an_area_with_holes_has_as_many_handles() {
        let hole = |x: f64| ring(&[[x, 1.0], [x, 2.0], [x + 0.5, 2.0], [x + 0.5, 1.0]]);
        let plate = Polygon {
            outer: ring(&[[0., 0.], [9., 0.], [9., 3.], [0., 3.]]),
            holes: (1..8).map(|x| hole(f64::from(x))).collect(),
        };
        let corner = Polygon {
            outer: ring(&[[9., 3.], [12., 3.], [9., 5.]]),
            holes: vec![],
        };
        let mesh = extrude(&[plate.clone(), corner.clone()], -1.0, 2.0).unwrap();
        let topology = mesh.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (2, Some(7)));
        assert!((mesh.volume() - 3.0 * (plate.area() + corner.area())).abs() < 1e-9);
        let bounds = mesh.bounds();
        assert_eq!(
            (bounds.min, bounds.max),
            (Point3::new(0.0, -5.0, -1.0), Point3::new(12.0, 0.0, 2.0))
        );
    }

    #[test]
    fn rings_that_touch_stay_apart() {
        let outer = ring(&[[0., 0.], [4., 0.], [4., 2.], [4., 4.], [0., 4.]]);
        let holes = vec![
            ring(&[[1., 2.], [2., 3.], [3., 2.], [2., 1.]]),
            ring(&[[3., 2.], [3.5, 3.], [4., 2.], [3.5, 1.]]),
        ];
        let mesh = extrude(&[Polygon { outer, holes }], 0.0, 1.0).unwrap();
        assert_eq!(
            mesh.check_closed().map(|t| (t.components, t.genus)),
            Ok((1, Some(0)))
        );
    }

    #[test]
    fn what_has_no_volume_is_refused() {
        let square = Polygon {
            outer: ring(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]]),
            holes: vec![],
        };
        assert_eq!(
            extrude(std::slice::from_ref(&square), 1.0, 1.0),
            Err(SolidError::Size(0.0))
        );
        assert!(extrude(&[square], f64::NAN, 1.0).is_err());
        assert_eq!(extrude(&[], 0.0, 1.0), Err(SolidError::Nothing));
        let bow = Polygon {
            outer: ring(&[[0., 0.], [2., 2.], [2., 0.], [0., 2.]]),
            holes: vec![],
        };
        assert!(matches!(
            extrude(&[bow], 0.0, 1.0),
            Err(SolidError::Triangulation(_))
        ));
    }
}
