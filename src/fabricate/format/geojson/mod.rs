//! GeoJSON: points, lines and polygons with properties, each feature on a line of the file, in an order that depends on their
//! coordinates alone. No date, no name of a program: the same features give the same bytes.

mod valid;

use serde_json::{Map, Value};

use crate::origin::Origin;
use crate::sheet::Item;
use crate::sheet::fixed_point::{self, Cell};
use fretwork_geometry::polygon::AreaError;
use fretwork_geometry::{Point, Polygon, Ring};

/// What lies somewhere.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A point.
    Point(Point),
    /// A line or an area.
    Item(Item),
}

/// A point, a line or an area, and what is known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// Its shape, y up.
    pub shape: Shape,
    /// Its properties.
    pub properties: Map<String, Value>,
}

/// How a file writes coordinates.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinates {
    /// How many digits stand behind the point.
    pub digits: usize,
    /// The name of their system, if the file is to say it.
    pub crs: Option<String>,
}

impl Coordinates {
    /// The whole numbers of last digits of a polyline, those that follow one another distinct.
    fn cells(&self, points: &[Point]) -> Vec<Cell> {
        let one = 10u64.pow(self.digits as u32) as f64;
        let whole = |v: f64| (v * one).round() as i64;
        let cell = |p: &Point| (whole(p.x), whole(p.y));
        let mut cells: Vec<Cell> = points.iter().map(cell).collect();
        cells.dedup();
        cells
    }
}

/// The file. Features are sorted unless they are `in_order` already. A line or an area that is a point when it is rounded
/// is left out. An area that touches itself is written as valid ones, with a hole or as several.
///
/// # Errors
/// When what such an area is cannot be computed.
pub fn write(
    features: &[Feature],
    coordinates: &Coordinates,
    in_order: bool,
    origin: Option<&Origin>,
) -> Result<Vec<u8>, AreaError> {
    let mut written: Vec<(Vec<Cell>, String)> = Vec::new();
    for feature in features {
        for (key, geometry) in geometries(&feature.shape, coordinates)? {
            let properties = Value::Object(feature.properties.clone());
            let text = format!(
                "{{\"type\":\"Feature\",\"properties\":{properties},\"geometry\":{geometry}}}"
            );
            written.push((key, text));
        }
    }
    if !in_order {
        written.sort();
    }
    let mut out = String::from("{\"type\":\"FeatureCollection\",");
    if let Some(origin) = origin {
        out += &format!("\"origin\":{},", origin.json());
    }
    if let Some(name) = &coordinates.crs {
        let name = Value::from(name.as_str());
        out += &format!("\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":{name}}}}},");
    }
    out += "\"features\":[";
    for (number, (_, text)) in written.iter().enumerate() {
        out += if number == 0 { "\n" } else { ",\n" };
        out += text;
    }
    out += "\n]}\n";
    Ok(out.into_bytes())
}

/// The shape as JSON, of one or several geometries, each with the coordinates by which it is sorted.
fn geometries(
    shape: &Shape,
    coordinates: &Coordinates,
) -> Result<Vec<(Vec<Cell>, String)>, AreaError> {
    match shape {
        Shape::Point(at) => {
            let cells = coordinates.cells(&[*at]);
            let place = position(cells[0], coordinates.digits);
            let text = format!("{{\"type\":\"Point\",\"coordinates\":{place}}}");
            Ok(vec![(cells, text)])
        }
        Shape::Item(Item::Line(points)) => {
            let cells = coordinates.cells(points);
            if cells.len() < 2 {
                return Ok(Vec::new());
            }
            let positions = positions(&cells, coordinates.digits);
            let text = format!("{{\"type\":\"LineString\",\"coordinates\":{positions}}}");
            Ok(vec![(cells, text)])
        }
        Shape::Item(Item::Area(polygon)) => {
            let areas = valid::valid(open_rings(polygon, coordinates))?;
            Ok(areas
                .into_iter()
                .filter_map(|rings| area(rings, coordinates.digits))
                .collect())
        }
    }
}

/// The rings of a polygon that are left when they are rounded, the outer one first; nothing if it is not left.
fn open_rings(polygon: &Polygon, coordinates: &Coordinates) -> Vec<Vec<Cell>> {
    let open = |ring: &Ring| valid::open(coordinates.cells(ring));
    let Some(outer) = open(&polygon.outer) else {
        return Vec::new();
    };
    let holes = polygon.holes.iter().filter_map(open);
    std::iter::once(outer).chain(holes).collect()
}

/// An area as JSON, of which the first ring is the outer one.
fn area(rings: Vec<Vec<Cell>>, digits: usize) -> Option<(Vec<Cell>, String)> {
    let mut rings = rings.into_iter();
    let outer = directed(rings.next()?, true)?;
    let mut holes: Vec<Vec<Cell>> = rings.filter_map(|ring| directed(ring, false)).collect();
    holes.sort();
    let rings = [vec![outer], holes].concat();
    let texts: Vec<String> = rings.iter().map(|ring| positions(ring, digits)).collect();
    let text = format!(
        "{{\"type\":\"Polygon\",\"coordinates\":[{}]}}",
        texts.join(",")
    );
    Some((rings.concat(), text))
}

/// The closed ring of cells, counter-clockwise if it is an outer one and clockwise otherwise (RFC 7946, section
/// 3.1.6), from its least corner on. None if it has no area.
fn directed(mut cells: Vec<Cell>, is_outer: bool) -> Option<Vec<Cell>> {
    let area = valid::doubled_area(&cells);
    if area == 0 {
        return None;
    }
    if (area > 0) != is_outer {
        cells.reverse();
    }
    let least = (0..cells.len()).min_by_key(|&i| cells[i])?;
    cells.rotate_left(least);
    cells.push(cells[0]);
    Some(cells)
}

fn positions(cells: &[Cell], digits: usize) -> String {
    let all: Vec<String> = cells.iter().map(|cell| position(*cell, digits)).collect();
    format!("[{}]", all.join(","))
}

fn position((x, y): Cell, digits: usize) -> String {
    let mut out = String::from("[");
    fixed_point::push_scaled(&mut out, x, digits);
    out.push(',');
    fixed_point::push_scaled(&mut out, y, digits);
    out.push(']');
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use expect_test::expect;
    use serde_json::json;

    fn points(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|&p| p.into()).collect()
    }

    #[test]
    fn a_small_file_has_these_bytes() {
        let properties = |label: &str| {
            let value = json!({ "labels": [label], "node": "a \"b\"" });
            value.as_object().cloned().expect("it is an object")
        };
        let line = |points_of: &[[f64; 2]], label| Feature {
            shape: Shape::Item(Item::Line(points(points_of))),
            properties: properties(label),
        };
        let area = Polygon {
            outer: points(&[[4., 4.], [4., 0.], [0., 0.], [0., 4.]]),
            holes: vec![points(&[[1., 1.], [2., 1.], [2., 2.]])],
        };
        let features = [
            line(&[[735000.12345, 1.0], [2.0, 4048500.5]], "late"),
            line(&[[1.0, 1.0], [1.00001, 1.0]], "dot"),
            line(&[[-1.0, 0.0], [3.0, 0.0]], "early"),
            Feature {
                shape: Shape::Item(Item::Area(area)),
                properties: properties("area"),
            },
            Feature {
                shape: Shape::Point(Point::new(0.5, 7.25)),
                properties: properties("place"),
            },
        ];
        let plane = Coordinates {
            digits: 4,
            crs: Some("urn:ogc:def:crs:EPSG::32616".to_string()),
        };
        let text = String::from_utf8(write(&features, &plane, false, None).expect("an area"))
            .expect("text");
        expect![[r#"
            {"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32616"}},"features":[
            {"type":"Feature","properties":{"labels":["early"],"node":"a \"b\""},"geometry":{"type":"LineString","coordinates":[[-1,0],[3,0]]}},
            {"type":"Feature","properties":{"labels":["area"],"node":"a \"b\""},"geometry":{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,4],[0,0]],[[1,1],[2,2],[2,1],[1,1]]]}},
            {"type":"Feature","properties":{"labels":["place"],"node":"a \"b\""},"geometry":{"type":"Point","coordinates":[0.5,7.25]}},
            {"type":"Feature","properties":{"labels":["late"],"node":"a \"b\""},"geometry":{"type":"LineString","coordinates":[[735000.1235,1],[2,4048500.5]]}}
            ]}
        "#]]
        .assert_eq(&text);
        assert!(serde_json::from_str::<Value>(&text).is_ok());
    }

    #[test]
    fn a_file_without_features_is_valid() {
        let plane = Coordinates {
            digits: 9,
            crs: None,
        };
        let text = write(&[], &plane, false, None).expect("nothing");
        let value: Value = serde_json::from_slice(&text).expect("it is JSON");
        assert_eq!(value["features"], json!([]));
    }
}
