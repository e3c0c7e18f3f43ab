//! GeoKeys: the coordinate system of a raster, and whether its samples stand for pixels or for points.
//! Systems that are described by parameters are made in `parameters`.

use std::collections::BTreeMap;

use tiff::tags::Tag;

use super::file::{GeoTiffError, Reader};
use crate::geo::crs::{Crs, CrsError};

const DIRECTORY: u16 = 34735;
const DOUBLES: u16 = 34736;
const TEXTS: u16 = 34737;
/// The code for what is defined by parameters.
pub(super) const USER_DEFINED: u16 = 32767;

/// A key's value.
enum Value {
    Short(u16),
    Doubles(Vec<f64>),
    Text(String),
}

/// The keys of a file.
pub(super) struct Keys {
    values: BTreeMap<u16, Value>,
    /// Whether a sample stands for the place that is named, not for the middle of a pixel that begins there.
    pub is_point: bool,
}

/// A tag's numbers, none where it is missing.
pub(super) fn numbers(reader: &mut Reader, tag: u16) -> Result<Vec<f64>, GeoTiffError> {
    match reader.find_tag(Tag::Unknown(tag))? {
        Some(value) => Ok(value.into_f64_vec()?),
        None => Ok(Vec::new()),
    }
}

impl Keys {
    pub fn read(reader: &mut Reader) -> Result<Keys, GeoTiffError> {
        let directory = match reader.find_tag(Tag::Unknown(DIRECTORY))? {
            Some(value) => value.into_u16_vec()?,
            None => Vec::new(),
        };
        let doubles = numbers(reader, DOUBLES)?;
        let texts = match reader.find_tag(Tag::Unknown(TEXTS))? {
            Some(value) => value.into_string()?,
            None => String::new(),
        };
        let mut values = BTreeMap::new();
        for entry in directory.chunks_exact(4).skip(1) {
            let (place, count, at) = (entry[1], entry[2] as usize, entry[3] as usize);
            let value = match place {
                0 => Some(Value::Short(entry[3])),
                DOUBLES => {
                    let end = at.saturating_add(count.max(1)).min(doubles.len());
                    let found = doubles.get(at..end).filter(|found| !found.is_empty());
                    found.map(|found| Value::Doubles(found.to_vec()))
                }
                TEXTS => texts
                    .get(at..(at + count).min(texts.len()))
                    .map(|text| Value::Text(text.trim_end_matches(['|', '\0']).to_string())),
                _ => None,
            };
            value.and_then(|value| values.insert(entry[0], value));
        }
        let is_point = matches!(values.get(&1025), Some(Value::Short(2)));
        Ok(Keys { values, is_point })
    }

    /// The short number of a key.
    pub fn short(&self, key: u16) -> Option<u16> {
        match self.values.get(&key)? {
            Value::Short(value) => Some(*value),
            _ => None,
        }
    }

    /// The number of the first of some keys that is there.
    pub fn number(&self, keys: &[u16]) -> Option<f64> {
        keys.iter().find_map(|key| match self.values.get(key)? {
            Value::Doubles(values) => values.first().copied(),
            Value::Short(value) => Some(f64::from(*value)),
            Value::Text(_) => None,
        })
    }

    /// The numbers of a key.
    pub fn numbers(&self, key: u16) -> &[f64] {
        match self.values.get(&key) {
            Some(Value::Doubles(values)) => values,
            _ => &[],
        }
    }

    /// The text of a key.
    pub fn text(&self, key: u16) -> Option<&str> {
        match self.values.get(&key)? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The coordinate system, if the file names one.
    pub fn crs(&self) -> Result<Option<Crs>, CrsError> {
        let crs = match (self.short(3072), self.short(2048)) {
            (Some(USER_DEFINED), _) => self.by_parameters()?,
            (Some(code), _) => Some(Crs::of_epsg(u32::from(code))?),
            (None, Some(USER_DEFINED)) if self.short(1024) == Some(2) => {
                let text = format!("+proj=longlat {} +no_defs", self.datum());
                Some(Crs::of_proj(&text, None, text.clone())?)
            }
            (None, Some(code)) if self.short(1024) != Some(1) => {
                Some(Crs::of_epsg(u32::from(code))?)
            }
            _ if self.short(1024) == Some(1) => self.by_parameters()?,
            _ => None,
        };
        if let Some(crs) = &crs
            && (crs.is_geographic() && self.short(1024) == Some(1)
                || !crs.is_geographic() && self.short(1024) == Some(2))
        {
            return Err(super::super::crs::unusable(
                crs.name(),
                "the file contradicts itself on whether it is geographic",
            ));
        }
        Ok(crs)
    }

    /// A system that is described by WKT among the citations, or by parameters.
    fn by_parameters(&self) -> Result<Option<Crs>, CrsError> {
        for key in [3073, 1026] {
            let text = self.text(key);
            if let Some((_, wkt)) = text.and_then(|text| text.split_once("ESRI PE String = ")) {
                return Crs::parse(wkt).map(Some);
            }
        }
        let text = self.projection()?;
        Crs::of_proj(&text, None, text.clone()).map(Some)
    }
}
