//! Surfaces: meshes from files, profiles turned about an axis, walls on a curve.

use std::sync::Arc;

use super::mesh_faults;
use super::placement::space_map;
use fretwork_action::{Action, Data, ReadLog, StageResult};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{
    Affine3, Form, Mesh, MeshError, Model, Point, Point3, SurfaceMesh, polyline,
};
use fretwork_language::kinds::surfaces::{
    Extrude, Mesh as File, Profile, Revolve, Surface as Kind,
};
use fretwork_language::scalar::FilePath;
use fretwork_source::mesh;

/// Makes a surface of any kind.
pub fn surface(action: &Action, kind: &Kind, log: &ReadLog) -> StageResult {
    let (mut surface, mut warnings): (SurfaceMesh, _) = match kind {
        Kind::Mesh(file) => {
            let (mesh, warnings) = placed(action, file, log)?;
            (mesh.into(), warnings)
        }
        Kind::Revolve(kind) => (revolved(action, kind)?, Vec::new()),
        Kind::Extrude(kind) => (extruded(action, kind)?, Vec::new()),
    };
    warnings.extend(crossing(action, &surface));
    if let Err(MeshError::InsideOut { .. }) = surface.check_closed() {
        let warning =
            Diagnostic::warning("the surface is inside out; its triangles are turned over");
        warnings.push(warning.at(action.span(), "in this surface"));
        surface = surface.reversed().into();
    }
    Ok((Data::Surface(Arc::new(surface)), warnings))
}

/// A warning where a profile crosses itself: what is made of it passes through itself.
fn crossing(action: &Action, surface: &SurfaceMesh) -> Option<Diagnostic> {
    let at = match &surface.form {
        Form::Turned(form) => polyline::crossing(&form.profile, form.closed, |_| true),
        Form::Swept(form) => polyline::crossing(&form.points, form.closed, |_| true),
        Form::Free => None,
    }?;
    let message = format!("the profile meets itself at ({:.3}, {:.3})", at.x, at.y);
    let warning = Diagnostic::warning(message).at(action.span(), "in this surface");
    Some(warning.help("a body that is made of it passes through itself there"))
}

/// The bodies in a file that the node names, in the units of the spec, and warnings.
///
/// # Errors
/// When it, or a file that it names, cannot be read.
pub fn load(
    action: &Action,
    file: &FilePath,
    log: &ReadLog,
) -> Result<(Model, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (path, bytes) = action.file(&file.0)?;
    let mut sibling = |name: &str| Ok(action.files.found(name, &path, log)?.1);
    let unit_mm = action.definition.own_units.millimetres();
    let named = |d: Diagnostic| d.at(action.span(), "the file is named here");
    match mesh::read(&bytes, &path, unit_mm, &mut sibling) {
        Ok((model, warnings)) => {
            let told = warnings.into_iter().map(named).collect();
            Ok((in_units_of(action, model), told))
        }
        Err(error) => Err(vec![named(error)]),
    }
}

/// A model that was read in the unit of the node's file, in that of the spec.
fn in_units_of(action: &Action, model: Model) -> Model {
    let unit = action.definition.own_unit();
    if unit == 1.0 {
        return model;
    }
    model.scaled(unit)
}

/// The mesh of a file: turned, scaled, mirrored, brought to its longest side, moved.
fn placed(
    action: &Action,
    kind: &File,
    log: &ReadLog,
) -> Result<(Mesh, Vec<Diagnostic>), Vec<Diagnostic>> {
    let (model, mut warnings) = load(action, &kind.file, log)?;
    let read = model.merged();
    let mesh = read.welded();
    let turned = space_map([1.0; 3], None, kind.rotate.0, [0.0; 3]);
    let scaled = turned.then(&space_map(kind.scale.0, kind.mirror, [0.0; 3], [0.0; 3]));
    let mesh = mesh.transformed(&scaled);
    let longest = mesh.bounds().longest_side();
    let factor = match &kind.longest_side {
        None => 1.0,
        Some(side) if longest > 0.0 => side.0 / longest,
        Some(_) => {
            let diagnostic = Diagnostic::error(format!(
                "`{}` has no size that could be scaled",
                kind.file.0
            ));
            return Err(vec![diagnostic.at(action.span(), "in this surface")]);
        }
    };
    let fitted = Affine3::scale(Point3::new(factor, factor, factor));
    let moved = fitted.then(&Affine3::translation(kind.at.0.into()));
    let mesh = mesh.transformed(&moved);
    warnings.extend(mesh_faults::without_area(
        action,
        &read,
        &scaled.then(&moved),
    )?);
    if let Err(error) = mesh.validate() {
        let error = Diagnostic::error(error.to_string()).at(action.span(), "in this surface");
        return Err(vec![error]);
    }
    warnings.extend(mesh_faults::crossing(action, &mesh, "in this surface"));
    Ok((mesh, warnings))
}

fn revolved(action: &Action, kind: &Revolve) -> Result<SurfaceMesh, Vec<Diagnostic>> {
    let failed =
        |message: String| vec![Diagnostic::error(message).at(action.span(), "in this surface")];
    let (profile, closed): (Vec<Point>, bool) = match &kind.profile {
        Profile::Points(points) => (points.iter().map(|p| Point::from(p.0)).collect(), false),
        Profile::Curve(reference) => {
            let curve = action.input(reference);
            if curve.points().iter().any(|p| p.z != 0.0) {
                return Err(failed("the profile leaves the xy plane".into()));
            }
            let flat = curve.points().iter().map(|p| Point::new(p.x, p.y));
            (flat.collect(), curve.is_closed())
        }
    };
    SurfaceMesh::turned(&profile, closed, kind.segments.0).map_err(|e| failed(e.to_string()))
}

fn extruded(action: &Action, kind: &Extrude) -> Result<SurfaceMesh, Vec<Diagnostic>> {
    let failed =
        |message: &str| vec![Diagnostic::error(message).at(action.span(), "in this surface")];
    let curve = action.input(&kind.profile);
    let points = curve.points();
    let level = points.first().map_or(0.0, |p| p.z);
    if points.iter().any(|p| p.z != level) {
        return Err(failed("the profile does not lie level"));
    }
    let plan: Vec<Point> = points.iter().map(|p| Point::new(p.x, p.y)).collect();
    SurfaceMesh::swept(&plan, curve.is_closed(), [level, level + kind.height.0])
        .ok_or_else(|| failed("the profile has too few points"))
}
