//! GeoJSON: points, lines and polygons with properties, each feature on a line of the file, in an order that depends on their
//! coordinates alone. No date, no name of a program: the same features give the same bytes.

use serde_json::{Map, Value};

use crate::origin::Origin;
use crate::sheet::Item;
use crate::sheet::fixed_point::{self, Cell};
use fretwork_geometry::Point;

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
/// is left out.
pub fn write(
    features: &[Feature],
    coordinates: &Coordinates,
    in_order: bool,
    origin: Option<&Origin>,
) -> Vec<u8> {
    let written = features.iter().filter_map(|feature| {
        let (key, geometry) = geometry(&feature.shape, coordinates)?;
        let properties = Value::Object(feature.properties.clone());
        let text =
            format!("{{\"type\":\"Feature\",\"properties\":{properties},\"geometry\":{geometry}}}");
        Some((key, text))
    });
    let mut written: Vec<(Vec<Cell>, String)> = written.collect();
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
    out.into_bytes()
}

/// The shape as JSON, and the coordinates by which it is sorted.
fn geometry(shape: &Shape, coordinates: &Coordinates) -> Option<(Vec<Cell>, String)> {
    match shape {
        Shape::Point(at) => {
            let cells = coordinates.cells(&[*at]);
            let place = position(cells[0], coordinates.digits);
            Some((
                cells,
                format!("{{\"type\":\"Point\",\"coordinates\":{place}}}"),
            ))
        }
        Shape::Item(Item::Line(points)) => {
            let cells = coordinates.cells(points);
            (cells.len() > 1).then(|| {
                let text = format!(
                    "{{\"type\":\"LineString\",\"coordinates\":{}}}",
                    positions(&cells, coordinates.digits)
                );
                (cells, text)
            })
        }
        Shape::Item(Item::Area(polygon)) => {
            let outer = ring(coordinates.cells(&polygon.outer), true)?;
            let holes = polygon.holes.iter();
            let holes = holes.filter_map(|hole| ring(coordinates.cells(hole), false));
            let mut rings: Vec<Vec<Cell>> = holes.collect();
            rings.sort();
            rings.insert(0, outer);
            let text = |ring: &Vec<Cell>| positions(ring, coordinates.digits);
            let texts: Vec<String> = rings.iter().map(text).collect();
            let text = format!(
                "{{\"type\":\"Polygon\",\"coordinates\":[{}]}}",
                texts.join(",")
            );
            Some((rings.concat(), text))
        }
    }
}

/// The closed ring of cells, counter-clockwise if it is an outer one and clockwise otherwise (RFC 7946, section
/// 3.1.6), from its least corner on. None if nothing is left of it.
fn ring(mut cells: Vec<Cell>, is_outer: bool) -> Option<Vec<Cell>> {
    while cells.len() > 1 && cells.first() == cells.last() {
        cells.pop();
    }
    let twice: i128 = (0..cells.len())
        .map(|i| {
            let ((ax, ay), (bx, by)) = (cells[i], cells[(i + 1) % cells.len()]);
            i128::from(ax) * i128::from(by) - i128::from(ay) * i128::from(bx)
        })
        .sum();
    if cells.len() < 3 || twice == 0 {
        return None;
    }
    if (twice > 0) != is_outer {
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
    use fretwork_geometry::Polygon;
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
        let text = String::from_utf8(write(&features, &plane, false, None)).expect("text");
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
        let text = write(&[], &plane, false, None);
        let value: Value = serde_json::from_slice(&text).expect("it is JSON");
        assert_eq!(value["features"], json!([]));
    }
}
