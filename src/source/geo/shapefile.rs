//! Shapefiles: the shapes of an `.shp` (ESRI Shapefile Technical Description, 1998), with the lines of
//! the `.dbf` beside it. An index is not needed: records follow one another. Heights and measures are left out.

use super::dbf::Table;
use super::{GeoError, Layer, Record};
use fretwork_geometry::{Point, counted};

/// The bytes before the first record.
const HEAD: usize = 100;
const CODE: u32 = 9994;
/// Where the length of the file stands, in words of two bytes.
const LENGTH: usize = 24;

/// The features of an `.shp`, with the lines of its table if there is one. The coordinate system is
/// that of another file.
///
/// # Errors
/// When the bytes are no shapefile, or a record is damaged; the table must not have fewer lines.
pub fn read(bytes: &[u8], table: Option<Table>) -> Result<Layer, GeoError> {
    let head = bytes.get(..HEAD).and_then(|head| big(head, 0));
    if head != Some(CODE) {
        return Err(GeoError::Damaged("it is no shapefile".into()));
    }
    let size = big(bytes, LENGTH).map_or(0, |words| 2 * u64::from(words));
    if size > bytes.len() as u64 {
        let message = format!(
            "it is truncated: it has {}, and {size} by its head",
            counted(bytes.len(), "byte", "bytes")
        );
        return Err(GeoError::Damaged(message));
    }
    let mut features = Vec::new();
    let mut at = HEAD;
    while at + 8 <= bytes.len() {
        let number = features.len() + 1;
        let failed = |message: &str| GeoError::Feature {
            number,
            message: message.to_string(),
        };
        let words = big(bytes, at + 4).unwrap_or(0) as usize;
        let end = words
            .checked_mul(2)
            .and_then(|size| size.checked_add(at + 8));
        let content = end.and_then(|end| bytes.get(at + 8..end));
        let content =
            content.ok_or_else(|| failed("its record lies beyond the end of the file"))?;
        let mut record = shapes(content).map_err(|message| failed(&message))?;
        record.number = number;
        features.push(record);
        at += 8 + content.len();
    }
    let columns = table.as_ref().map(Table::columns);
    if let Some(table) = table {
        if table.lines.len() < features.len() {
            let message = format!(
                "its table has {} for {}",
                counted(table.lines.len(), "line", "lines"),
                counted(features.len(), "feature", "features")
            );
            return Err(GeoError::Damaged(message));
        }
        for (record, line) in features.iter_mut().zip(table.lines) {
            record.attributes = line;
        }
    }
    Ok(Layer {
        crs: None,
        columns,
        features,
    })
}

/// The shapes of a record.
fn shapes(content: &[u8]) -> Result<Record, String> {
    let mut record = Record::default();
    let kind = little(content, 0).ok_or("its record is empty")?;
    let short = || "its record is too short for what it says".to_string();
    match kind {
        0 => {}
        1 | 11 | 21 => record.points.push(point(content, 4).ok_or_else(short)?),
        8 | 18 | 28 => {
            let count = little(content, 36).ok_or_else(short)? as usize;
            record.points = points(content, 40, 0, count).ok_or_else(short)?;
        }
        3 | 13 | 23 => record.lines = parts(content).ok_or_else(short)?,
        5 | 15 | 25 => {
            let parts = parts(content).ok_or_else(short)?;
            parts.into_iter().for_each(|part| record.push_ring(part));
        }
        31 => return Err("it is a multipatch, a surface in space, which is not read".into()),
        other => return Err(format!("its shapes are of the unknown type {other}")),
    }
    Ok(record)
}

/// The parts of a polyline or polygon.
fn parts(content: &[u8]) -> Option<Vec<Vec<Point>>> {
    let (parts, count) = (little(content, 36)? as usize, little(content, 40)? as usize);
    let first = parts.checked_mul(4)?.checked_add(44)?;
    // Nothing is set aside for what a file claims and cannot hold.
    content.get(first..first.checked_add(count.checked_mul(16)?)?)?;
    let start = |part: usize| match part == parts {
        true => Some(count),
        false => little(content, 44 + 4 * part).map(|n| n as usize),
    };
    let part = |part: usize| {
        let (from, to) = (start(part)?, start(part + 1)?);
        points(content, first, from, to)
    };
    (0..parts).map(part).collect()
}

/// The points numbered `from` to `to` of a list at a place.
fn points(content: &[u8], at: usize, from: usize, to: usize) -> Option<Vec<Point>> {
    let offset = |n: usize| n.checked_mul(16)?.checked_add(at);
    let bytes = content.get(offset(from)?..offset(to)?)?;
    (0..bytes.len() / 16)
        .map(|i| point(bytes, 16 * i))
        .collect()
}

fn point(bytes: &[u8], at: usize) -> Option<Point> {
    let number = |at: usize| Some(f64::from_le_bytes(bytes.get(at..at + 8)?.try_into().ok()?));
    Some(Point::new(number(at)?, number(at + 8)?))
}

fn little(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}

fn big(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
}
