//! What is wanted as a surface: one itself, or the filled shape of a cutout or a region.

use std::sync::Arc;

use fretwork_action::{Action, Data, Input as _, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Cutout, SurfaceMesh};
use fretwork_language::{Ref, wants};
use fretwork_primitive::mesh_faults;

/// The surface that the reference names. What is drawn in the plane faces up, and looks from above as it is drawn.
///
/// # Errors
/// A shape that cannot be divided into triangles, or is empty.
pub fn surface_of(
    action: &Action,
    reference: &Ref<wants::Sheet>,
) -> Result<Arc<SurfaceMesh>, Vec<Diagnostic>> {
    let failed = |error: String| {
        let message = format!("`{}` is no surface: {error}", reference.name);
        vec![Diagnostic::error(message).at(action.span(), "wanted as one here")]
    };
    let cutout = match action.value(reference) {
        Value::Data(Data::Surface(surface)) => return Ok(surface.clone()),
        Value::Data(Data::Region(region)) => {
            let planar = Cutout::planar(region.area.clone());
            Arc::new(planar.map_err(|e| failed(e.to_string()))?)
        }
        value => wants::Cutout::of(value).expect("the graph checks the types of references"),
    };
    let mesh = fretwork_solid::sheet(&cutout).map_err(|e| failed(e.to_string()))?;
    Ok(Arc::new(mesh.into()))
}

/// A warning where the sheet that stands in for a surface passes through itself. Surfaces tell that where they are made.
pub fn crossing_of(
    action: &Action,
    reference: &Ref<wants::Sheet>,
    sheet: &SurfaceMesh,
) -> Option<Diagnostic> {
    match action.value(reference) {
        Value::Data(Data::Surface(_)) => None,
        _ => mesh_faults::crossing(action, sheet, "in this shell"),
    }
}
