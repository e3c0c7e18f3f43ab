//! What all files of solids ask of a model before it is written.

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine3, Model};

/// The farthest coordinate, in the file's unit.
const LARGEST: f64 = 1e9;

/// Whether `model`, its lengths multiplied by `unit`, can be written: it has triangles, and every
/// coordinate is a number in the range of the formats (10^9 in the file's unit).
///
/// # Errors
/// What cannot be written.
pub fn check(model: &Model, unit: f64) -> Result<(), Diagnostic> {
    if !(unit.is_finite() && unit > 0.0) {
        return Err(Diagnostic::error(format!("a unit cannot be {unit}")));
    }
    for body in &model.bodies {
        body.mesh
            .validate()
            .map_err(|e| Diagnostic::error(e.to_string()))?;
        if body
            .uv
            .as_ref()
            .is_some_and(|uv| uv.len() != body.mesh.triangles.len())
        {
            return Err(Diagnostic::error(
                "a picture's coordinates do not fit the triangles",
            ));
        }
    }
    if model.parts.is_empty() {
        return Err(Diagnostic::error("there is nothing to write"));
    }
    if u32::try_from(model.triangle_count()).is_err() {
        return Err(Diagnostic::error(format!(
            "{} triangles are too many for a file",
            model.triangle_count()
        )));
    }
    let is_placed = |place: &Affine3| place.is_finite() && place.determinant() != 0.0;
    if let Some(part) = model.parts.iter().find(|part| !is_placed(&part.place)) {
        return Err(Diagnostic::error(format!(
            "`{}` is flat or infinite where it stands",
            part.name
        )));
    }
    let bounds = model.bounds();
    match [bounds.min, bounds.max].into_iter().find(|p| {
        let far = |v: f64| v.is_nan() || v.abs() * unit > LARGEST;
        far(p.x) || far(p.y) || far(p.z)
    }) {
        Some(p) => Err(Diagnostic::error(format!(
            "({}, {}, {}) is too far out to be written",
            p.x, p.y, p.z
        ))),
        None => Ok(()),
    }
}

#[cfg(test)]
#[expect(missing_docs, reason = "of tests")]
pub mod tests {
    use super::*;
    use fretwork_geometry::{Mesh, Point3};

    /// A cube from 0 to `side`.
    pub fn cube(side: f64) -> Mesh {
        Mesh::cuboid(Point3::default(), Point3::new(1.0, 1.0, 1.0) * side)
    }

    #[test]
    fn what_cannot_be_written_is_found() {
        let good = Model::of("cube", cube(1.0));
        assert!(check(&good, 1.0).is_ok());
        assert!(good.merged().check_closed().is_ok());
        assert!(
            check(&good, 0.0).is_err()
                && check(&good, 1e10).is_err()
                && check(&Model::default(), 1.0).is_err()
        );
        assert!(check(&Model::of("none", Mesh::default()), 1.0).is_err());
        let mut flat = good.clone();
        flat.parts[0].place = Affine3::scale(Point3::new(1.0, 0.0, 1.0));
        assert!(check(&flat, 1.0).is_err());
        let mut broken = cube(1.0);
        broken.positions[0].x = f64::NAN;
        assert!(check(&Model::of("broken", broken), 1.0).is_err());
    }
}
