//! What an artifact shows as a file of features on the ground, in the coordinates of the map or in longitudes
//! and latitudes.

use super::date_line::Earth;
use super::page::{Written, cut_of, here, origin, page, parts};
use fretwork_action::Action;
use fretwork_artifact::{ReadyGround, ready_ground};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::Item;
use fretwork_fabricate::format::geojson::{self, Coordinates, Feature, Shape};
use fretwork_geometry::Point;
use fretwork_language::kinds::artifacts::{Artifact, Format, OutputCrs};
use fretwork_primitive::plane;
use fretwork_source::geo::crs::{Crs, Transform};

/// The bytes of a GeoJSON file.
///
/// # Errors
/// What cannot be drawn on the ground, and longitudes of a map that has no place on the earth.
pub(super) fn ground(action: &Action, kind: &Artifact) -> Written {
    let (parts, mut page) = (parts(action, kind), page(action, kind, Format::GeoJson));
    let features = cut_of(
        action,
        (&parts, &mut page),
        ready_ground,
        ReadyGround::near,
        ReadyGround::features,
    );
    let (features, mut warnings) = features.map_err(|fault| vec![fault.placed(action)])?;
    let crs = plane::crs(action)?;
    let (features, coordinates) = if kind.crs == OutputCrs::Wgs84 {
        let degrees = Coordinates {
            digits: 9,
            crs: None,
        };
        (in_degrees(action, crs, features)?, degrees)
    } else {
        let code = crs.as_ref().and_then(Crs::code);
        if crs.is_some() && code.is_none() {
            warnings.push(nameless());
        }
        let metres = Coordinates {
            digits: 4,
            crs: code.map(|code| format!("urn:ogc:def:crs:EPSG::{code}")),
        };
        (features, metres)
    };
    let bytes = geojson::write(
        &features,
        &coordinates,
        kind.optimize,
        origin(action).as_ref(),
    );
    let bytes = bytes.map_err(|error| {
        let message = format!("an area cannot be computed: {error}");
        vec![Diagnostic::error(message).at(action.span(), "in this artifact")]
    })?;
    let warnings = warnings.into_iter().map(here(action)).collect();
    Ok((bytes, warnings))
}

fn nameless() -> Diagnostic {
    let message = "the file does not say its coordinate system: that of the map has no EPSG code, and programs take it for degrees";
    Diagnostic::warning(message).help(
        "leave out `crs: map`, or name the system where it has a code: `map: { crs: \"EPSG:…\" }`",
    )
}

/// The features in longitudes and latitudes of WGS 84, vertex by vertex, cut at ±180 degrees.
fn in_degrees(
    action: &Action,
    crs: Option<Crs>,
    features: Vec<Feature>,
) -> Result<Vec<Feature>, Vec<Diagnostic>> {
    let failed = |message: String| Diagnostic::error(message).at(action.span(), "in this artifact");
    let Some(crs) = crs else {
        let message = "longitudes and latitudes are known only of a map with a coordinate system";
        let help = "write `crs: map` here, or say where the map is: `map: { crs: \"EPSG:…\" }`";
        return Err(vec![failed(message.to_string()).help(help)]);
    };
    let wgs84 = Crs::wgs84().map_err(|error| vec![failed(error.to_string())])?;
    let earth = Earth {
        transform: Transform::new(crs, wgs84),
    };
    let lost = |p: Point| {
        let message = format!("({}, {}) has no longitude and latitude", p.x, p.y);
        vec![failed(message)]
    };
    let mut all = Vec::new();
    for feature in features {
        let shapes: Vec<Shape> = match &feature.shape {
            Shape::Point(at) => vec![Shape::Point(earth.place(*at).map_err(lost)?)],
            Shape::Item(Item::Line(points)) => {
                let lines = earth.lines(points).map_err(lost)?;
                lines.into_iter().map(Item::Line).map(Shape::Item).collect()
            }
            Shape::Item(Item::Area(area)) => {
                let areas = earth.areas(area).map_err(lost)?;
                areas.into_iter().map(Item::Area).map(Shape::Item).collect()
            }
        };
        let properties = feature.properties;
        all.extend(shapes.into_iter().map(|shape| Feature {
            shape,
            properties: properties.clone(),
        }));
    }
    Ok(all)
}
