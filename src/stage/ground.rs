//! What an artifact shows as a file of features on the ground, in the coordinates of the map or in longitudes
//! and latitudes.

use super::page::{Written, failed, here, origin, page, parts};
use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::format::geojson::{self, Coordinates, Feature};
use fretwork_fabricate::{Item, Window};
use fretwork_geometry::{Bounds, Point, Polygon};
use fretwork_language::kinds::artifacts::{Artifact, Format, OutputCrs};
use fretwork_primitive::plane;
use fretwork_source::geo::crs::{Crs, Transform};

/// Half of the way around the earth in degrees.
const HALF: f64 = 180.0;

/// The bytes of a GeoJSON file.
///
/// # Errors
/// What cannot be drawn on the ground, and longitudes of a map that has no place on the earth.
pub(super) fn ground(action: &Action, kind: &Artifact) -> Written {
    let page = page(action, kind, Format::GeoJson);
    let (features, warnings) =
        fretwork_artifact::features(&parts(action, kind), &page).map_err(failed(action))?;
    let crs = plane::crs(action)?;
    let (features, coordinates) = if kind.crs == OutputCrs::Wgs84 {
        let degrees = Coordinates {
            digits: 9,
            crs: None,
        };
        let features = in_degrees(action, crs, features)?;
        (
            features.into_iter().flat_map(within_half).collect(),
            degrees,
        )
    } else {
        let code = crs.and_then(|crs| crs.epsg());
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
    let warnings = warnings.into_iter().map(here(action)).collect();
    Ok((bytes, warnings))
}

/// The features in longitudes and latitudes of WGS 84, vertex by vertex. Longitudes run on beyond ±180 where a line
/// crosses it.
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
    let transform = Transform::new(crs, wgs84);
    let line = |points: &Vec<Point>, mut near: Option<f64>| {
        let place = |p: &Point| {
            let Some(mut place) = transform.apply(*p) else {
                let message = format!("({}, {}) has no longitude and latitude", p.x, p.y);
                return Err(vec![failed(message)]);
            };
            if let Some(last) = near {
                place.x += 2.0 * HALF * ((last - place.x) / (2.0 * HALF)).round();
            }
            near = Some(place.x);
            Ok(place)
        };
        points.iter().map(place).collect::<Result<Vec<_>, _>>()
    };
    let turned = |feature: Feature| {
        let shape = match &feature.shape {
            Item::Line(points) => Item::Line(line(points, None)?),
            Item::Area(area) => {
                let outer = line(&area.outer, None)?;
                let near = outer.first().map(|p| p.x);
                let holes = area.holes.iter().map(|hole| line(hole, near));
                let holes = holes.collect::<Result<_, _>>()?;
                Item::Area(Polygon { outer, holes })
            }
        };
        Ok(Feature { shape, ..feature })
    };
    features.into_iter().map(turned).collect()
}

/// A feature cut at ±180 degrees (RFC 7946, section 3.1.9), each part with longitudes between them.
fn within_half(feature: Feature) -> Vec<Feature> {
    let bounds = Bounds::of(feature.shape.points());
    let turns = |x: f64| (x + HALF) / (2.0 * HALF);
    // What ends at a side of a turn is none of the next one.
    let first = turns(bounds.min.x).floor() as i64;
    let last = turns(bounds.max.x).ceil() as i64 - 1;
    if last <= 0 && first == 0 {
        return vec![feature];
    }
    let part = |turn: i64| {
        let middle = 2.0 * HALF * turn as f64;
        let window = Window {
            bounds: Bounds {
                min: Point::new(middle - HALF, bounds.min.y - 1.0),
                max: Point::new(middle + HALF, bounds.max.y + 1.0),
            },
            closed: [true; 2],
            open: [false; 2],
            is_mirrored: false,
        };
        let back = move |p: Point| Point::new(p.x - middle, p.y);
        let items = window.parts(&feature.shape).into_iter();
        items.map(move |item| item.mapped(back)).collect::<Vec<_>>()
    };
    let parts = (first..=last.max(first)).flat_map(part);
    let with_shape = |shape| Feature {
        shape,
        ..feature.clone()
    };
    parts.map(with_shape).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(shape: Item) -> Vec<Item> {
        let feature = Feature {
            shape,
            properties: Default::default(),
        };
        within_half(feature).into_iter().map(|f| f.shape).collect()
    }

    fn points(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|&p| p.into()).collect()
    }

    #[test]
    fn what_crosses_the_date_line_is_cut_there() {
        let line = Item::Line(points(&[[178.0, 0.0], [182.0, 4.0]]));
        assert_eq!(
            cut(line),
            [
                Item::Line(points(&[[178.0, 0.0], [180.0, 2.0]])),
                Item::Line(points(&[[-180.0, 2.0], [-178.0, 4.0]])),
            ]
        );
        let square = Item::Area(Polygon {
            outer: points(&[[-181.0, 0.0], [-179.0, 0.0], [-179.0, 1.0], [-181.0, 1.0]]),
            holes: vec![],
        });
        let sides = cut(square).into_iter().map(|item| {
            let bounds = Bounds::of(item.points());
            (bounds.min.x, bounds.max.x)
        });
        assert_eq!(
            sides.collect::<Vec<_>>(),
            [(179.0, 180.0), (-180.0, -179.0)]
        );
    }

    #[test]
    fn what_touches_the_date_line_stays_whole() {
        for line in [
            points(&[[170.0, 0.0], [180.0, 4.0]]),
            points(&[[-180.0, 0.0], [-170.0, 4.0]]),
        ] {
            assert_eq!(cut(Item::Line(line.clone())), [Item::Line(line)]);
        }
    }
}
