//! GeoJSON (RFC 7946), and the `crs` member that went before it.

use std::fmt;
use std::sync::Arc;

use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value as Json};

use super::crs::Crs;
use super::misfit::{check_letters, misfit};
use super::{GeoError, Layer, Record};
use fretwork_geometry::{Attribute, Point};

/// Any object that may stand at the top.
#[derive(Deserialize)]
struct Document {
    #[serde(rename = "type")]
    kind: String,
    crs: Option<Json>,
    features: Option<Vec<Feature>>,
    geometry: Option<Geometry>,
    properties: Option<Map<String, Json>>,
    coordinates: Option<Coordinates>,
    geometries: Option<Vec<Geometry>>,
}

#[derive(Deserialize)]
struct Feature {
    geometry: Option<Geometry>,
    properties: Option<Map<String, Json>>,
}

#[derive(Deserialize)]
struct Geometry {
    #[serde(rename = "type")]
    kind: String,
    coordinates: Option<Coordinates>,
    geometries: Option<Vec<Geometry>>,
}

/// Positions, or lists of them, as deep as they are nested.
enum Coordinates {
    Number(f64),
    Position(Point),
    List(Vec<Coordinates>),
}

impl<'de> Deserialize<'de> for Coordinates {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Coordinates, D::Error> {
        deserializer.deserialize_any(Coordinated)
    }
}

struct Coordinated;

impl<'de> Visitor<'de> for Coordinated {
    type Value = Coordinates;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number or a list of coordinates")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Coordinates, E> {
        Ok(Coordinates::Number(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Coordinates, E> {
        Ok(Coordinates::Number(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Coordinates, E> {
        Ok(Coordinates::Number(value as f64))
    }

    /// Numbers come as maps of one text where some part of the program has asked for all of their digits.
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Coordinates, A::Error> {
        let number = Number::deserialize(MapAccessDeserializer::new(map))?;
        let value = number.as_f64().filter(|value| value.is_finite());
        let value = value.ok_or_else(|| A::Error::custom("a coordinate is out of range"))?;
        Ok(Coordinates::Number(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Coordinates, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            let Coordinates::Number(x) = item else {
                list.push(item);
                continue;
            };
            let Some(Coordinates::Number(y)) = items.next_element()? else {
                return Err(A::Error::custom("a position has two numbers"));
            };
            while items.next_element::<IgnoredAny>()?.is_some() {}
            return Ok(Coordinates::Position(Point::new(x, y)));
        }
        Ok(Coordinates::List(list))
    }
}

/// The features of a GeoJSON text. Without a `crs` member coordinates are longitude and latitude on WGS 84.
///
/// # Errors
/// With the line and the column where it is no JSON, with the number of the feature where it is no GeoJSON.
pub fn read(bytes: &[u8]) -> Result<Layer, GeoError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.trim_ascii().is_empty() {
        return Err(GeoError::Damaged("it is empty".into()));
    }
    check_letters(bytes)?;
    check_depth(bytes)?;
    let document: Document =
        serde_json::from_slice(bytes).map_err(|error| misfit(bytes, &error))?;
    let crs = match &document.crs {
        None | Some(Json::Null) => Crs::wgs84()?,
        Some(member) => named(member)?,
    };
    let features = match &*document.kind {
        "FeatureCollection" => document.features.unwrap_or_default(),
        "Feature" => vec![Feature {
            geometry: document.geometry,
            properties: document.properties,
        }],
        _ => vec![Feature {
            geometry: Some(Geometry {
                kind: document.kind,
                coordinates: document.coordinates,
                geometries: document.geometries,
            }),
            properties: None,
        }],
    };
    let mut names: Vec<Arc<str>> = Vec::new();
    let records = features
        .into_iter()
        .enumerate()
        .map(|(i, feature)| record(i + 1, feature, &mut names))
        .collect::<Result<_, _>>()?;
    Ok(Layer {
        crs: Some(crs),
        columns: Some(names),
        features: records,
    })
}

/// The deepest nesting of lists and objects that is read.
const DEEPEST: usize = 128;

/// That lists and objects are not nested too deep, in members that nobody reads neither.
fn check_depth(bytes: &[u8]) -> Result<(), GeoError> {
    let (mut depth, mut line) = (0usize, 1);
    let (mut in_text, mut is_escaped) = (false, false);
    for byte in bytes {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' => is_escaped = in_text,
            b'"' => in_text = !in_text,
            b'\n' => line += 1,
            b'[' | b'{' if !in_text => depth += 1,
            b']' | b'}' if !in_text => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let message = format!("it is nested more than {DEEPEST} deep in line {line}");
            return Err(GeoError::Damaged(message));
        }
    }
    Ok(())
}

/// The system of a GeoJSON text, without its features; none where it cannot be read.
pub fn system(bytes: &[u8]) -> Option<Crs> {
    #[derive(Deserialize)]
    struct Head {
        crs: Option<Json>,
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let head: Head = serde_json::from_slice(bytes).ok()?;
    match head.crs {
        None | Some(Json::Null) => Crs::wgs84().ok(),
        Some(member) => named(&member).ok(),
    }
}

/// The system that a `crs` member names.
fn named(member: &Json) -> Result<Crs, GeoError> {
    let name = member["properties"]["name"].as_str();
    let name = name.ok_or_else(|| {
        GeoError::Damaged("its `crs` is not of the type `name`, which is the only one read".into())
    })?;
    Ok(Crs::parse(name)?)
}

fn record(number: usize, feature: Feature, names: &mut Vec<Arc<str>>) -> Result<Record, GeoError> {
    let mut record = Record {
        number,
        ..Record::default()
    };
    for (name, value) in feature.properties.unwrap_or_default() {
        let known = names.binary_search_by(|known| (**known).cmp(&name));
        let name = match known {
            Ok(i) => names[i].clone(),
            Err(i) => {
                let name: Arc<str> = name.into();
                names.insert(i, name.clone());
                name
            }
        };
        let value = match value {
            Json::Null => continue,
            Json::Bool(value) => Attribute::Truth(value),
            Json::Number(value) => match (value.as_i64(), value.as_f64()) {
                (Some(value), _) => Attribute::Whole(value),
                (None, Some(value)) => Attribute::Number(value),
                (None, None) => continue,
            },
            Json::String(text) => Attribute::Text(text.into()),
            nested => Attribute::Nested {
                names: names_in(&nested),
                json: nested.to_string().into(),
            },
        };
        record.attributes.push((name, value));
    }
    if let Some(geometry) = feature.geometry {
        add(&mut record, geometry).map_err(|message| GeoError::Feature { number, message })?;
    }
    Ok(record)
}

/// The texts of a list of plain values; none of anything else.
fn names_in(value: &Json) -> Vec<Arc<str>> {
    let items = value.as_array().into_iter().flatten();
    let name = |item: &Json| match item {
        Json::String(text) => Some(Arc::from(&**text)),
        Json::Bool(_) | Json::Number(_) => Some(Arc::from(item.to_string())),
        _ => None,
    };
    items.map(name).collect::<Option<_>>().unwrap_or_default()
}

/// Adds a geometry to a record.
fn add(record: &mut Record, geometry: Geometry) -> Result<(), String> {
    let depth = match &*geometry.kind {
        "GeometryCollection" => {
            let mut all = geometry.geometries.unwrap_or_default().into_iter();
            return all.try_for_each(|geometry| add(record, geometry));
        }
        "Point" => 0,
        "MultiPoint" | "LineString" => 1,
        "MultiLineString" | "Polygon" => 2,
        "MultiPolygon" => 3,
        other => return Err(format!("`{other}` is no type of a geometry")),
    };
    let wrong = || format!("its coordinates are not those of a {}", geometry.kind);
    let mut lists = Vec::new();
    let coordinates = geometry.coordinates.ok_or_else(wrong)?;
    gather(coordinates, depth, &mut lists).ok_or_else(wrong)?;
    match &*geometry.kind {
        "Point" | "MultiPoint" => record.points.extend(lists.into_iter().flatten()),
        "LineString" | "MultiLineString" => record.lines.extend(lists),
        _ => lists.into_iter().for_each(|list| record.push_ring(list)),
    }
    Ok(())
}

/// The lists of positions in coordinates that are nested `depth` deep. None where they are not.
fn gather(coordinates: Coordinates, depth: usize, lists: &mut Vec<Vec<Point>>) -> Option<()> {
    match (coordinates, depth) {
        (Coordinates::Position(p), 0) => lists.push(vec![p]),
        (Coordinates::List(list), 0) if list.is_empty() => {}
        (Coordinates::List(list), 1) => {
            let positions = list.into_iter().map(|item| match item {
                Coordinates::Position(p) => Some(p),
                _ => None,
            });
            lists.push(positions.collect::<Option<_>>()?);
        }
        (Coordinates::List(list), 2..) => {
            for item in list {
                gather(item, depth - 1, lists)?;
            }
        }
        _ => return None,
    }
    Some(())
}
