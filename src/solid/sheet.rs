//! The filled shape of a cutout as an open mesh, without a thickness.

use super::SolidError;
use super::inlay::compact;
use super::strip::{Sheet, tidied};
use fretwork_geometry::mesh::triangulate;
use fretwork_geometry::{Carrier, Cutout, Mesh, Point3, Polygon, Ribbon};

/// What the polygons of `cutout` fill of what they lie on: an open mesh that faces outward. The drawing plane is mirrored into
/// world space and faces up; a loop has no seam. Where the sheet passes through itself it is not cut. O(n log n).
///
/// # Errors
/// Polygons that cross or overlap, and no polygon.
pub fn sheet(cutout: &Cutout) -> Result<Mesh, SolidError> {
    let mesh = match &cutout.carrier {
        Carrier::Surface(imprint) => compact(Mesh {
            positions: imprint.positions(),
            triangles: imprint.part(true),
        }),
        Carrier::Plane => flat(&cutout.polygons)?,
        Carrier::Strip(ribbon) | Carrier::Ring { ribbon, .. } => bent(cutout, ribbon)?,
    };
    if mesh.triangles.is_empty() {
        return Err(SolidError::Nothing);
    }
    Ok(mesh)
}

fn flat(polygons: &[Polygon]) -> Result<Mesh, SolidError> {
    let mut mesh = Mesh::default();
    for polygon in polygons {
        let first = mesh.positions.len() as u32;
        // The mirror turns triangles over.
        let base = triangulate(polygon)?.into_iter();
        mesh.triangles
            .extend(base.map(|[a, b, c]| [a, c, b].map(|corner| first + corner)));
        let corners = polygon.rings().flatten();
        mesh.positions
            .extend(corners.map(|p| Point3::new(p.x, 0.0 - p.y, 0.0)));
    }
    Ok(mesh)
}

/// The strip along a curve, ruled between its joints.
fn bent(cutout: &Cutout, ribbon: &Ribbon) -> Result<Mesh, SolidError> {
    let mut mesh = Mesh::default();
    for polygon in &tidied(cutout) {
        let sheet = Sheet::new(polygon, cutout, ribbon)?;
        let first = mesh.positions.len() as u32;
        let places = sheet.corners.iter();
        mesh.positions
            .extend(places.map(|&(u, v)| ribbon.place(u, v, 0.0)));
        let triangles = sheet.triangles.iter();
        mesh.triangles
            .extend(triangles.map(|t| t.map(|corner| first + corner)));
    }
    Ok(match ribbon.outward() > 0.0 {
        true => mesh,
        false => mesh.reversed(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thicken;
    use fretwork_geometry::{Point, Side};

    /// A plate with a hole, twice.
    fn plates() -> Cutout {
        let square = |x: f64, y: f64, side: f64| {
            let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
            corners.map(|[u, v]| Point::new(x + u, y + v)).to_vec()
        };
        let plate = |x: f64| Polygon {
            outer: square(x, 0.0, 10.0),
            holes: vec![square(x + 2.0, 3.0, 4.0).into_iter().rev().collect()],
        };
        Cutout::planar(vec![plate(0.0), plate(20.0)]).expect("they lie apart")
    }

    /// Half of a thin body's area is that of its sheet, and the sheet lies in its middle.
    #[test]
    fn a_sheet_is_the_middle_of_a_thin_body() {
        let cutout = plates();
        let open = sheet(&cutout).unwrap();
        let (thin, _) = thicken(&cutout, 1e-6, Side::Center).unwrap();
        assert!((thin.area() / 2.0 - open.area()).abs() < 1e-3);
        assert_eq!(open.topology().components, 2);
        let (a, b) = (thin.bounds(), open.bounds());
        assert!((a.min - b.min).length() < 1e-5 && (a.max - b.max).length() < 1e-5);
        let up = |t: &[u32; 3]| fretwork_geometry::mesh::doubled_normal(open.corners(*t)).z > 0.0;
        assert!(open.triangles.iter().all(up));
    }

    #[test]
    fn nothing_has_no_sheet() {
        let nothing = Cutout::planar(Vec::new()).unwrap();
        assert_eq!(sheet(&nothing), Err(SolidError::Nothing));
    }
}
