//! GeoKeys: the coordinate system of a raster, by code or by parameters, and whether its samples stand
//! for pixels or for points.

use std::collections::BTreeMap;

use tiff::tags::Tag;

use super::file::{GeoTiffError, Reader};
use crate::geo::crs::{Crs, CrsError};

const DIRECTORY: u16 = 34735;
const DOUBLES: u16 = 34736;
const TEXTS: u16 = 34737;
/// The code for what is defined by parameters.
const USER_DEFINED: u16 = 32767;

/// A key's value.
enum Value {
    Short(u16),
    Double(f64),
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
                DOUBLES => doubles.get(at).copied().map(Value::Double),
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

    fn short(&self, key: u16) -> Option<u16> {
        match self.values.get(&key)? {
            Value::Short(value) => Some(*value),
            _ => None,
        }
    }

    fn double(&self, keys: &[u16]) -> Option<f64> {
        keys.iter().find_map(|key| match self.values.get(key)? {
            Value::Double(value) => Some(*value),
            Value::Short(value) => Some(f64::from(*value)),
            Value::Text(_) => None,
        })
    }

    /// The coordinate system, if the file names one.
    pub fn crs(&self) -> Result<Option<Crs>, CrsError> {
        let crs = match (self.short(3072), self.short(2048)) {
            (Some(USER_DEFINED), _) => self.by_parameters()?,
            (Some(code), _) => Some(Crs::of_epsg(u32::from(code))?),
            (None, Some(USER_DEFINED)) if self.short(1024) == Some(2) => {
                let ellipsoid = self.ellipsoid();
                let text = format!("+proj=longlat {ellipsoid} +no_defs");
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

    fn ellipsoid(&self) -> String {
        match (self.short(2048), self.short(2050), self.short(2056)) {
            (Some(4326 | 4258 | 4269), ..) | (_, Some(6326 | 6258 | 6269), _) => {
                return "+datum=WGS84".into();
            }
            (_, _, Some(7030)) => return "+ellps=WGS84".into(),
            (_, _, Some(7019)) => return "+ellps=GRS80".into(),
            (_, _, Some(7004)) => return "+ellps=bessel".into(),
            (_, _, Some(7022)) => return "+ellps=intl".into(),
            _ => {}
        }
        match (self.double(&[2057]), self.double(&[2059])) {
            (Some(major), Some(inverse)) if inverse > 0.0 => format!("+a={major} +rf={inverse}"),
            (Some(major), _) => format!("+a={major} +b={major}"),
            _ => "+datum=WGS84".into(),
        }
    }

    /// A projection that is defined by parameters, or by WKT among the citations.
    fn by_parameters(&self) -> Result<Option<Crs>, CrsError> {
        for key in [3073, 1026] {
            if let Some(Value::Text(text)) = self.values.get(&key)
                && let Some((_, wkt)) = text.split_once("ESRI PE String = ")
            {
                return Crs::parse(wkt).map(Some);
            }
        }
        let method = match self.short(3075) {
            Some(1) => "tmerc",
            Some(7) => "merc",
            Some(8 | 9) => "lcc",
            Some(10) => "laea",
            Some(11) => "aea",
            Some(15 | 14) => "stere",
            Some(28) => "cea",
            Some(other) => return Err(CrsError::Unknown(format!("projection method {other}"))),
            None => return Err(CrsError::Unknown("defined by the user".into())),
        };
        let mut text = format!("+proj={method} {}", self.ellipsoid());
        let parameters: [(&str, &[u16]); 7] = [
            ("lat_1", &[3078]),
            ("lat_2", &[3079]),
            ("lon_0", &[3080, 3084, 3088, 3095]),
            ("lat_0", &[3081, 3085, 3089]),
            ("x_0", &[3082, 3086, 3090]),
            ("y_0", &[3083, 3087, 3091]),
            ("k_0", &[3092, 3093]),
        ];
        for (name, keys) in parameters {
            let Some(value) = self.double(keys) else {
                continue;
            };
            // A polar aspect has its true scale where others have their origin.
            match name {
                "lat_0" if self.short(3075) == Some(15) => {
                    let pole = if value < 0.0 { -90 } else { 90 };
                    text.push_str(&format!(" +lat_0={pole} +lat_ts={value}"));
                }
                "lat_1" if matches!(method, "merc" | "cea") => {
                    text.push_str(&format!(" +lat_ts={value}"));
                }
                _ => text.push_str(&format!(" +{name}={value}")),
            }
        }
        let unit = match self.short(3076) {
            None | Some(9001) => " +units=m",
            Some(9002) => " +units=ft",
            Some(9003) => " +units=us-ft",
            Some(other) => return Err(CrsError::Unknown(format!("unit {other}"))),
        };
        text.push_str(unit);
        Crs::of_proj(&text, None, text.clone()).map(Some)
    }
}
