//! Shapefiles, their tables, GeoJSON, GeoPackages.

use crate::geo::{GeoError, dbf, geojson, geopackage, shapefile};
use fretwork_geometry::{Attribute, Point};

/// A table with a text, a number and a truth value.
fn table(language: u8, lines: &[(&[u8], &str, u8)]) -> Vec<u8> {
    let mut bytes = vec![3, 120, 1, 1];
    bytes.extend((lines.len() as u32).to_le_bytes());
    bytes.extend((32u16 + 3 * 32 + 1).to_le_bytes());
    bytes.extend((1u16 + 8 + 6 + 1).to_le_bytes());
    bytes.resize(32, 0);
    bytes[29] = language;
    for (name, kind, width) in [("name", b'C', 8), ("size", b'N', 6), ("wet", b'L', 1)] {
        let mut field = name.as_bytes().to_vec();
        field.resize(11, 0);
        field.push(kind);
        field.extend([0; 4]);
        field.push(width);
        field.resize(32, 0);
        bytes.extend(field);
    }
    bytes.push(0x0d);
    for (name, size, wet) in lines {
        bytes.push(b' ');
        bytes.extend(*name);
        bytes.resize(bytes.len() + 8 - name.len(), b' ');
        bytes.extend(format!("{size:>6}").bytes());
        bytes.push(*wet);
    }
    bytes
}

fn text(text: &str) -> Attribute {
    Attribute::Text(text.into())
}

#[test]
fn tables_have_numbers_texts_and_nothing() {
    let bytes = table(0, &[(b"a b", "-1.5", b'T'), (b"", "******", b'?')]);
    let read = dbf::read(&bytes, None).unwrap();
    let columns: Vec<String> = read.columns().iter().map(|c| c.to_string()).collect();
    assert_eq!(columns, ["name", "size", "wet"]);
    let values: Vec<_> = read.lines[0]
        .iter()
        .map(|(_, value)| value.clone())
        .collect();
    let expected = [text("a b"), Attribute::Number(-1.5), Attribute::Truth(true)];
    assert_eq!(values, expected);
    assert_eq!(read.lines[1], []);
    for cut in 0..bytes.len() {
        assert!(dbf::read(&bytes[..cut], None).is_err(), "{cut}");
    }
}

#[test]
fn texts_are_in_the_code_page_that_is_named_or_in_the_language_of_the_table() {
    let name = |language: u8, bytes: &[u8], page: Option<&str>| {
        let read = dbf::read(&table(language, &[(bytes, "", b' ')]), page).unwrap();
        read.lines[0][0].1.clone()
    };
    assert_eq!(name(0, "Crête".as_bytes(), None), text("Crête"));
    assert_eq!(name(0, b"Cr\xeate", None), text("Crête"));
    assert_eq!(name(0x57, "Crête".as_bytes(), Some("UTF-8")), text("Crête"));
    assert_eq!(name(0x03, b"\x80", None), text("€"));
    assert_eq!(name(0x01, b"Cr\x88te", None), text("Crête"));
    assert_eq!(name(0x02, b"\x9bre", None), text("øre"));
    assert_eq!(name(0, b"\xcc\xee", Some("1251\r\n")), text("Мо"));
    assert_eq!(name(0, b"\xa4", Some("ISO 8859-15")), text("€"));
    assert!(dbf::read(&table(0, &[]), Some("no page")).is_err());
}

/// A shapefile of one polygon record.
fn shape(parts: &[&[[f64; 2]]]) -> Vec<u8> {
    let mut content = 5u32.to_le_bytes().to_vec();
    content.resize(36, 0);
    content.extend((parts.len() as u32).to_le_bytes());
    let count: usize = parts.iter().map(|part| part.len()).sum();
    content.extend((count as u32).to_le_bytes());
    let mut start = 0u32;
    for part in parts {
        content.extend(start.to_le_bytes());
        start += part.len() as u32;
    }
    content.extend(parts.concat().concat().iter().flat_map(|v| v.to_le_bytes()));
    let mut bytes = 9994u32.to_be_bytes().to_vec();
    bytes.resize(100, 0);
    bytes.extend(1u32.to_be_bytes());
    bytes.extend((content.len() as u32 / 2).to_be_bytes());
    bytes.extend(content);
    bytes
}

const SQUARE: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0], [0.0, 0.0]];
const HOLE: [[f64; 2]; 4] = [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0], [1.0, 1.0]];

#[test]
fn polygons_of_a_shapefile_are_rings() {
    let bytes = shape(&[&SQUARE, &HOLE]);
    let layer = shapefile::read(&bytes, None).unwrap();
    assert_eq!(layer.features.len(), 1);
    assert_eq!(layer.features[0].rings[0].len(), 4);
    assert_eq!(layer.features[0].rings[1][1], Point::new(2.0, 1.0));
    assert_eq!(layer.columns, None);
    for cut in 108..bytes.len() {
        assert!(shapefile::read(&bytes[..cut], None).is_err(), "{cut}");
    }
}

#[test]
fn a_record_that_claims_more_than_the_file_has_is_an_error() {
    let mut bytes = shape(&[&SQUARE]);
    bytes[100 + 8 + 40..][..4].copy_from_slice(&(1u32 << 31).to_le_bytes());
    let error = shapefile::read(&bytes, None).unwrap_err();
    assert!(
        matches!(error, GeoError::Feature { number: 1, .. }),
        "{error}"
    );
    let mut bytes = shape(&[&SQUARE]);
    bytes[100 + 8 + 36..][..4].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(shapefile::read(&bytes, None).is_err());
    let lines = dbf::read(&table(0, &[]), None).unwrap();
    let error = shapefile::read(&shape(&[&SQUARE]), Some(lines)).unwrap_err();
    assert_eq!(error.to_string(), "its table has 0 lines for 1 feature");
}

#[test]
fn geojson_of_every_type_is_read() {
    let read = |geometry: &str| {
        let text = format!(
            r#"{{"features":[{{"properties":{{"b":null,"a":1,"c":true,"d":"x"}},"geometry":{geometry}}},{{"geometry":null,"properties":null}}],"type":"FeatureCollection"}}"#
        );
        geojson::read(text.as_bytes()).unwrap()
    };
    let layer = read(r#"{"coordinates":[[[0,0,7],[1,0,7],[0,1,7],[0,0,7]]],"type":"Polygon"}"#);
    assert_eq!(layer.features[0].rings[0].len(), 3);
    assert_eq!(layer.features[0].attributes.len(), 3);
    assert_eq!(layer.features[1].rings.len(), 0);
    assert!(layer.crs.unwrap().is_geographic());
    let layer = read(
        r#"{"type":"GeometryCollection","geometries":[{"type":"Point","coordinates":[1,2]},{"type":"MultiLineString","coordinates":[[[0,0],[1,1]],[[2,2],[3,3]]]},{"type":"MultiPolygon","coordinates":[]}]}"#,
    );
    let record = &layer.features[0];
    assert_eq!(
        (record.points.len(), record.lines.len(), record.rings.len()),
        (1, 2, 0)
    );
    let alone =
        geojson::read(br#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[0,1]]]}"#).unwrap();
    assert_eq!(alone.features[0].rings.len(), 1);
    assert_eq!(
        (alone.features[0].unclosed, layer.features[0].unclosed),
        (1, 0)
    );
}

#[test]
fn wrong_geojson_is_an_error_with_its_place() {
    let said = |text: &str| geojson::read(text.as_bytes()).unwrap_err().to_string();
    assert!(said("{\n \"type\": ").contains("line 2"));
    assert!(said(&"[".repeat(100_000)).contains("nested more than 128 deep"));
    let deep = format!(
        "{{\"type\":\"Polygon\",\"coordinates\":{}",
        "[".repeat(100_000)
    );
    assert!(said(&deep).contains("nested more than 128 deep"));
    // A member that nobody reads is none the better for it.
    let foreign = format!(
        r#"{{"type":"FeatureCollection","x":{}{},"features":[]}}"#,
        "[".repeat(100_000),
        "]".repeat(100_000)
    );
    assert!(said(&foreign).contains("nested more than 128 deep"));
    let wrong = r#"{"type":"LineString","coordinates":[[[0,0]]]}"#;
    assert!(said(wrong).starts_with("feature 1: its coordinates"));
    assert!(said(r#"{"type":"Circle","coordinates":[0,0]}"#).contains("`Circle`"));
    let of_second = |feature: &str| {
        let first = r#"{"geometry":null,"properties":null}"#;
        said(&format!(
            r#"{{"type":"FeatureCollection","features":[{first},{feature}]}}"#
        ))
    };
    for (feature, message) in [
        (
            r#"{"properties":{},"geometry":{"type":"LineString","coordinates":[[0,0],[1,"x"]]}}"#,
            "feature 2: its coordinates hold the text \"x\" where a number belongs",
        ),
        (
            r#"{"geometry":{"type":"Point","coordinates":[1]}}"#,
            "feature 2: a position of it has one number and no second",
        ),
        (
            r#"{"geometry":{"type":"Point","coordinates":"1,2"}}"#,
            "feature 2: its coordinates hold the text \"1,2\" where a number belongs",
        ),
        (
            r#"{"properties":"x"}"#,
            "feature 2: its `properties` are the text \"x\" and no object",
        ),
        (
            r#"{"geometry":[1,2]}"#,
            "feature 2: its `geometry` is a list and no object",
        ),
        (
            r#"{"geometry":{}}"#,
            "feature 2: its `geometry` has no `type`",
        ),
        ("7", "feature 2: it is the number 7 and no object"),
    ] {
        assert_eq!(of_second(feature), message);
    }
    assert_eq!(said("[]"), "it is no GeoJSON: it is a list and no object");
    assert_eq!(said("{}"), "it is no GeoJSON: it has no `type`");
    assert_eq!(
        said(r#"{"type":"FeatureCollection","features":"x"}"#),
        "it is no GeoJSON: its `features` are the text \"x\" and no list"
    );
    assert!(said("{\"type\":\"Feat").contains("as files do that are cut"));
    let unknown = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::999999"}},"features":[]}"#;
    assert!(said(unknown).contains("EPSG:999999"));
    let beyond = geojson::read(br#"{"type":"Point","coordinates":[0,95]}"#).unwrap();
    let error = beyond.placed(None).unwrap_err().to_string();
    assert_eq!(error, "feature 1: the latitude 95 lies beyond a pole");
}

#[test]
fn what_is_no_geopackage_is_told() {
    let said = |bytes: &[u8]| geopackage::read(bytes, None).unwrap_err().to_string();
    assert!(said(b"").contains("no GeoPackage"));
    let mut bytes = b"SQLite format 3\0".to_vec();
    bytes.resize(4096, 0);
    assert!(said(&bytes).contains("no size"));
    bytes[16] = 16;
    assert!(said(&bytes).contains("another kind") || said(&bytes).contains("no table"));
    // An inner page that leads to itself.
    bytes[100] = 5;
    bytes[111] = 1;
    assert!(said(&bytes).contains("back into itself"));
}

#[test]
fn a_date_of_zeros_is_none() {
    let mut bytes = table(0, &[(b"00000000", "", b' '), (b"20260101", "", b' ')]);
    // The first column becomes one of dates.
    bytes[32 + 11] = b'D';
    let read = dbf::read(&bytes, None).unwrap();
    assert_eq!(read.lines[0], []);
    assert_eq!(read.lines[1][0].1, text("2026-01-01"));
}
