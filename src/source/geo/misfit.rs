//! Why a text is no GeoJSON, in words: what its letters are, which feature of it, and what stands where something else belongs.
//! Reading what is well formed is in `geojson`.

use serde_json::Value as Json;
use serde_json::error::{Category, Error};

use super::GeoError;

/// What is wrong with a text that could not be read as GeoJSON because of `error`.
pub(super) fn misfit(bytes: &[u8], error: &Error) -> GeoError {
    let place = format!("line {}, column {}", error.line(), error.column());
    match error.classify() {
        Category::Eof => GeoError::Damaged(format!(
            "it is no GeoJSON: it ends in the middle of a value at {place}, as files do that are cut"
        )),
        Category::Syntax | Category::Io => GeoError::Damaged(format!("it is no GeoJSON: {error}")),
        Category::Data => {
            let document = serde_json::from_slice(bytes).ok();
            let found = document.and_then(|document| in_document(&document));
            found.unwrap_or_else(|| GeoError::Damaged(format!("it is no GeoJSON: {error}")))
        }
    }
}

/// Refuses a text in letters of two or four bytes, as some programs of Windows save it.
pub(super) fn check_letters(bytes: &[u8]) -> Result<(), GeoError> {
    let is_wide = match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => true,
        // Without a mark at its start, the first letter is an ASCII one, and beside it is a zero.
        [a, b, ..] => (*a == 0) != (*b == 0),
        _ => false,
    };
    if is_wide {
        let message = "its text is in UTF-16 or UTF-32, and GeoJSON is written in UTF-8: save it again in UTF-8";
        return Err(GeoError::Damaged(message.into()));
    }
    Ok(())
}

fn in_document(document: &Json) -> Option<GeoError> {
    let wrong = |message: String| Some(GeoError::Damaged(format!("it is no GeoJSON: {message}")));
    let Some(members) = document.as_object() else {
        return wrong(format!("it is {} and no object", shown(document)));
    };
    match members.get("type") {
        None => return wrong("it has no `type`".into()),
        Some(Json::String(_)) => {}
        Some(other) => return wrong(format!("its `type` is {} and no text", shown(other))),
    }
    match members.get("features") {
        None | Some(Json::Null) => {
            let (number, message) = (1, in_feature(document).or_else(|| in_geometry(document))?);
            Some(GeoError::Feature { number, message })
        }
        Some(Json::Array(features)) => {
            let found = |(i, feature)| Some((i + 1, in_feature(feature)?));
            let (number, message) = features.iter().enumerate().find_map(found)?;
            Some(GeoError::Feature { number, message })
        }
        Some(other) => wrong(format!("its `features` are {} and no list", shown(other))),
    }
}

fn in_feature(feature: &Json) -> Option<String> {
    let Some(members) = feature.as_object() else {
        return Some(format!("it is {} and no object", shown(feature)));
    };
    match members.get("properties") {
        None | Some(Json::Null | Json::Object(_)) => {}
        Some(other) => {
            return Some(format!(
                "its `properties` are {} and no object",
                shown(other)
            ));
        }
    }
    match members.get("geometry") {
        None | Some(Json::Null) => None,
        Some(geometry) => in_geometry(geometry),
    }
}

fn in_geometry(geometry: &Json) -> Option<String> {
    let Some(members) = geometry.as_object() else {
        return Some(format!(
            "its `geometry` is {} and no object",
            shown(geometry)
        ));
    };
    match members.get("type") {
        None => return Some("its `geometry` has no `type`".into()),
        Some(Json::String(_)) => {}
        Some(other) => return Some(format!("its type is {} and no text", shown(other))),
    }
    match members.get("geometries") {
        None | Some(Json::Null) => {}
        Some(Json::Array(all)) => {
            if let Some(found) = all.iter().find_map(in_geometry) {
                return Some(found);
            }
        }
        Some(other) => return Some(format!("its `geometries` are {} and no list", shown(other))),
    }
    in_coordinates(members.get("coordinates")?)
}

fn in_coordinates(coordinates: &Json) -> Option<String> {
    match coordinates {
        Json::Null => None,
        Json::Array(items) => match &items[..] {
            [Json::Number(_)] => Some("a position of it has one number and no second".into()),
            [Json::Number(_), Json::Number(_), ..] => None,
            [Json::Number(_), other, ..] => Some(misplaced(other)),
            items => items.iter().find_map(in_coordinates),
        },
        Json::Number(_) => Some("its coordinates are a number and no list".into()),
        other => Some(misplaced(other)),
    }
}

fn misplaced(value: &Json) -> String {
    format!(
        "its coordinates hold {} where a number belongs",
        shown(value)
    )
}

/// The letters of a text that a message shows, at most.
const LONGEST: usize = 40;

/// A value as a message names it.
fn shown(value: &Json) -> String {
    match value {
        Json::Null => "null".into(),
        Json::Bool(value) => value.to_string(),
        Json::Number(number) => format!("the number {number}"),
        Json::String(text) if text.chars().count() > LONGEST => "a text".into(),
        Json::String(text) => format!("the text {text:?}"),
        Json::Array(_) => "a list".into(),
        Json::Object(_) => "an object".into(),
    }
}
