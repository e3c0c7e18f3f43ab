//! GeoPackage: one layer of features of an SQLite file.
//!
//! ```text
//! sqlite   the file → lines of tables
//! schema   the columns of a table
//! wkb      a geometry
//! ```

mod schema;
pub mod sqlite;
mod wkb;

use std::sync::Arc;

use super::crs::Crs;
use super::{GeoError, Layer, Record};
use fretwork_geometry::Attribute;
use schema::{Column, Kind};
use sqlite::{Database, Line, Value};

/// The features of the layer named `layer`, or of the only one.
///
/// # Errors
/// When the bytes are no GeoPackage, there is no such layer, or several and none is named.
pub fn read(bytes: &[u8], layer: Option<&str>) -> Result<Layer, GeoError> {
    let database = Database::open(bytes).map_err(GeoError::Damaged)?;
    let own = entry(&database, layer)?;
    let crs = own.system.map_or(Ok(None), |id| crs(&database, id))?;
    let (lines, columns) = table(&database, &own.name)?;
    let named = columns.into_iter().map(|c| (Arc::from(c.name), c.kind));
    let columns: Vec<(Arc<str>, Kind)> = named.collect();
    let mut features = Vec::with_capacity(lines.len());
    for (i, line) in lines.into_iter().enumerate() {
        features.push(record(i + 1, line, &columns, &own.geometry)?);
    }
    let names = columns.into_iter().map(|(name, _)| name);
    let plain = names.filter(|name| **name != *own.geometry);
    Ok(Layer {
        crs,
        columns: Some(plain.collect()),
        features,
    })
}

/// The system of the layer named `layer`, or of the only one; none where it says none or cannot be read.
pub fn system(bytes: &[u8], layer: Option<&str>) -> Option<Crs> {
    let database = Database::open(bytes).ok()?;
    let own = entry(&database, layer).ok()?;
    crs(&database, own.system?).ok()?
}

/// What the list of layers says of one.
struct Entry {
    name: String,
    /// The column with the geometries.
    geometry: String,
    /// The number of its coordinate system.
    system: Option<i64>,
}

/// The entry of the layer named `layer`, or of the only one.
fn entry(database: &Database<'_>, layer: Option<&str>) -> Result<Entry, GeoError> {
    let (lines, columns) = table(database, "gpkg_geometry_columns")?;
    let position = |name: &str| {
        columns
            .iter()
            .position(|c| c.name.eq_ignore_ascii_case(name))
    };
    let places = (
        position("table_name"),
        position("column_name"),
        position("srs_id"),
    );
    let (Some(name), Some(geometry), Some(system)) = places else {
        return Err(GeoError::Damaged(
            "its list of layers lacks a column".into(),
        ));
    };
    let text = |line: &Line, at: usize| Some(line.1.get(at)?.text()?.to_string());
    let entries = lines.iter().filter_map(|line| {
        Some(Entry {
            name: text(line, name)?,
            geometry: text(line, geometry)?,
            system: line.1.get(system).and_then(Value::integer),
        })
    });
    let mut entries: Vec<Entry> = entries.collect();
    let names = || entries.iter().map(|entry| entry.name.clone()).collect();
    let place = match layer {
        Some(name) => entries.iter().position(|entry| entry.name == name),
        None if entries.len() > 1 => return Err(GeoError::Layers(names())),
        None if entries.is_empty() => {
            return Err(GeoError::Damaged("it holds no layer of features".into()));
        }
        None => Some(0),
    };
    match place {
        Some(place) => Ok(entries.swap_remove(place)),
        None => Err(GeoError::NoLayer {
            name: layer.unwrap_or_default().to_string(),
            layers: names(),
        }),
    }
}

/// The lines of a table and its columns.
fn table(database: &Database<'_>, name: &str) -> Result<(Vec<Line>, Vec<Column>), GeoError> {
    let found = database.table(name).map_err(GeoError::Damaged)?;
    let (root, sql) = match found {
        Some(found) => found,
        None if database.has_view(name).map_err(GeoError::Damaged)? => {
            return Err(GeoError::View(name.to_string()));
        }
        None => {
            let message = format!("it is no GeoPackage: it has no table `{name}`");
            return Err(GeoError::Damaged(message));
        }
    };
    let columns: Vec<Column> = schema::columns(&sql)
        .into_iter()
        .filter(|column| column.is_stored)
        .collect();
    let mut lines = database.lines(root).map_err(GeoError::Damaged)?;
    let key = columns.iter().position(|column| column.is_key);
    for (number, values) in &mut lines {
        // A column that is the number of its line is left empty in the record.
        if let Some(value) = key.and_then(|key| values.get_mut(key))
            && *value == Value::Null
        {
            *value = Value::Integer(*number);
        }
        let added = columns.iter().skip(values.len());
        values.extend(added.map(|column| column.default.clone()));
    }
    Ok((lines, columns))
}

/// The system of a GeoPackage's number; none for the two that stand for not knowing.
fn crs(database: &Database<'_>, id: i64) -> Result<Option<Crs>, GeoError> {
    if id == -1 || id == 0 {
        return Ok(None);
    }
    let (lines, columns) = table(database, "gpkg_spatial_ref_sys")?;
    let position = |name: &str| {
        columns
            .iter()
            .position(|c| c.name.eq_ignore_ascii_case(name))
    };
    let of = |line: &Line, name: &str| position(name).and_then(|i| line.1.get(i).cloned());
    let own = lines
        .iter()
        .find(|line| of(line, "srs_id") == Some(Value::Integer(id)));
    let own = own.ok_or_else(|| {
        GeoError::Damaged(format!(
            "its coordinate system {id} is not in its list of them"
        ))
    })?;
    let organization = of(own, "organization");
    let is_epsg = organization
        .as_ref()
        .and_then(Value::text)
        .is_some_and(|name| name.eq_ignore_ascii_case("EPSG"));
    let code = of(own, "organization_coordsys_id").and_then(|v| v.integer());
    let known = code
        .and_then(|code| u32::try_from(code).ok())
        .map(Crs::of_epsg);
    if let (true, Some(Ok(crs))) = (is_epsg, known) {
        return Ok(Some(crs));
    }
    match of(own, "definition").as_ref().and_then(Value::text) {
        Some(text) => Ok(Some(Crs::parse(text)?)),
        None => Err(GeoError::Damaged(format!(
            "its coordinate system {id} has no definition"
        ))),
    }
}

fn record(
    number: usize,
    line: Line,
    columns: &[(Arc<str>, Kind)],
    geometry: &str,
) -> Result<Record, GeoError> {
    let mut record = Record {
        number,
        ..Record::default()
    };
    for ((name, kind), value) in columns.iter().zip(line.1) {
        let value = match value {
            Value::Blob(blob) if **name == *geometry => {
                wkb::add(&mut record, &blob)
                    .map_err(|message| GeoError::Feature { number, message })?;
                continue;
            }
            Value::Null | Value::Blob(_) => continue,
            Value::Integer(value) => match kind {
                Kind::Truth => Attribute::Truth(value != 0),
                Kind::Float => Attribute::Number(value as f64),
                Kind::Any => Attribute::Whole(value),
            },
            Value::Real(value) if value.is_finite() => Attribute::Number(value),
            Value::Real(_) => continue,
            Value::Text(text) => Attribute::Text(text.into()),
        };
        record.attributes.push((name.clone(), value));
    }
    Ok(record)
}
