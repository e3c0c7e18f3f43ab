//! What two states of an artifact are compared by: its measures, and its geometry as it is finished, without what makes up
//! for a beam and without an order for machines.

use serde_json::{Map, Value as Json};

use super::artifact::{is_spatial, shown_field, unit_mm};
use super::expect::measures;
use super::model::Form;
use super::page::{file_unit, page, parts};
use super::shown::shown_model;
use fretwork_action::Action;
use fretwork_artifact::report;
use fretwork_diagnostic::Diagnostic;
use fretwork_difference::{Drawing, Shape};
use fretwork_fabricate::format::FileUnit;
use fretwork_geometry::{Affine3, Point3};
use fretwork_language::Node;
use fretwork_language::kinds::artifacts::{Artifact, Format};

/// What is compared of an artifact.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// Its measures by name, in the units of the spec.
    pub measures: Map<String, Json>,
    /// Its geometry in the units of its file; none of measures and of fields.
    pub shape: Option<Shape>,
}

/// What is compared of the artifact of an action; nothing where it cannot be made.
pub fn compared(action: &Action) -> Compared {
    let (Node::Artifact(kind), Some(format)) = (&action.definition.node, action.format) else {
        return Compared::default();
    };
    let measured = action.within_budget(|| measures(action, kind, format));
    let measured = report(
        Json::Object(measured.unwrap_or_default()),
        action.definition.units,
    );
    let shape = action.within_budget(|| shape(action, kind, format));
    Compared {
        measures: match measured {
            Json::Object(measures) => measures,
            _ => Map::new(),
        },
        shape: shape.ok().flatten(),
    }
}

fn shape(
    action: &Action,
    kind: &Artifact,
    format: Format,
) -> Result<Option<Shape>, Vec<Diagnostic>> {
    match format {
        Format::Json => Ok(None),
        Format::Stl | Format::ThreeMf => body(action, kind, Form::Solid),
        Format::Glb => body(action, kind, Form::Scene),
        Format::Png if shown_field(action, kind)?.is_some() => Ok(None),
        Format::Png if is_spatial(action, kind) => body(action, kind, Form::Scene),
        Format::Png => drawing(action, kind, format),
        Format::Svg | Format::Dxf | Format::GeoJson => drawing(action, kind, Format::Svg),
    }
}

fn body(action: &Action, kind: &Artifact, form: Form) -> Result<Option<Shape>, Vec<Diagnostic>> {
    let (model, _) = shown_model(action, kind, form)?;
    let side = unit_mm(action, kind);
    let scaled = model.transformed(&Affine3::scale(Point3::new(side, side, side)));
    Ok(Some(Shape::Body(scaled)))
}

fn drawing(
    action: &Action,
    kind: &Artifact,
    format: Format,
) -> Result<Option<Shape>, Vec<Diagnostic>> {
    let page = page(action, kind, format);
    let sheet = fretwork_artifact::finished(&parts(action, kind), &page)
        .map_err(|fault| vec![fault.placed(action)])?;
    let unit = match file_unit(action, kind) {
        FileUnit::Millimetre => "mm",
        FileUnit::Centimetre => "cm",
        FileUnit::Inch => "in",
        FileUnit::Metre => "m",
    };
    Ok(Some(Shape::Drawing(Drawing::of(&sheet, unit))))
}
