//! Coordinate systems that a file describes by parameters (GeoTIFF 1.1, section 7.5 and annex C), as PROJ strings.

use super::keys::{Keys, USER_DEFINED};
use crate::geo::crs::CrsError;
use crate::geo::datums::{datum_of_code, shift_of_name};

/// Parameters of PROJ that are lengths.
const LENGTHS: [&str; 2] = ["x_0", "y_0"];
/// Parameters of PROJ that are no angles.
const PLAIN: [&str; 3] = ["x_0", "y_0", "k_0"];

impl Keys {
    /// The projection, its datum and its unit.
    pub(super) fn projection(&self) -> Result<String, CrsError> {
        let (unit, metres) = self.linear_unit()?;
        let datum = self.datum();
        let zone = match self.short(3074) {
            Some(zone @ 16001..=16060) => Some(format!("+zone={}", zone - 16000)),
            Some(zone @ 16101..=16160) => Some(format!("+zone={} +south", zone - 16100)),
            None | Some(USER_DEFINED) => None,
            Some(other) => return Err(CrsError::Unknown(format!("projection {other}"))),
        };
        if let Some(zone) = zone {
            return Ok(format!("+proj=utm {zone} {datum} {unit}"));
        }
        let method = self.method()?;
        let mut text = format!("+proj={method} {datum} {unit}");
        let parameters: [(&str, &[u16]); 9] = [
            ("lat_1", &[3078]),
            ("lat_2", &[3079]),
            ("lon_0", &[3080, 3084, 3088, 3095]),
            ("lat_0", &[3081, 3085, 3089]),
            ("x_0", &[3082, 3086, 3090]),
            ("y_0", &[3083, 3087, 3091]),
            ("k_0", &[3092, 3093]),
            ("alpha", &[3094]),
            ("gamma", &[3096]),
        ];
        for (name, keys) in parameters {
            let Some(value) = self.number(keys) else {
                continue;
            };
            let value = match name {
                // PROJ has them in metres, the file in its own unit.
                name if LENGTHS.contains(&name) => value * metres,
                name if PLAIN.contains(&name) => value,
                _ => value * self.degrees(),
            };
            text.push_str(&self.parameter(method, name, value));
        }
        Ok(text)
    }

    /// The projection of PROJ that the method is.
    fn method(&self) -> Result<&'static str, CrsError> {
        let angle = |key: u16| self.number(&[key]).map(|angle| angle * self.degrees());
        let is_right = |angle: Option<f64>| angle.is_none_or(|a| (a - 90.0).abs() < 1e-9);
        Ok(match self.short(3075) {
            Some(1) => "tmerc",
            // The Swiss projection is an oblique one along a line due east.
            Some(3 | 9815) if is_right(angle(3094)) && is_right(angle(3096)) => "somerc",
            Some(3 | 9815) => "omerc",
            Some(7) => "merc",
            Some(8 | 9) => "lcc",
            Some(10) => "laea",
            Some(11) => "aea",
            Some(12) => "aeqd",
            Some(13) => "eqdc",
            Some(15 | 14) => "stere",
            Some(16) => "sterea",
            Some(17) => "eqc",
            Some(18) => "cass",
            Some(22) => "poly",
            Some(24) => "sinu",
            Some(28) => "cea",
            Some(other) => return Err(CrsError::Unknown(format!("projection method {other}"))),
            None => return Err(CrsError::Unknown("defined by the user".into())),
        })
    }

    /// A parameter of `method`, with what it means for others.
    fn parameter(&self, method: &str, name: &str, value: f64) -> String {
        match (method, name) {
            // A polar aspect has its true scale where others have their origin.
            ("stere", "lat_0") if self.short(3075) == Some(15) => {
                let pole = if value < 0.0 { -90 } else { 90 };
                format!(" +lat_0={pole} +lat_ts={value}")
            }
            ("merc" | "cea" | "eqc", "lat_1") => format!(" +lat_ts={value}"),
            ("somerc", "alpha" | "gamma") => String::new(),
            ("omerc", "lon_0") => format!(" +lonc={value}"),
            // With one parallel, the true scale is at the origin.
            ("lcc", "lat_0") if self.number(&[3078]).is_none() => {
                format!(" +lat_1={value} +lat_0={value}")
            }
            _ => format!(" +{name}={value}"),
        }
    }

    /// The linear unit, and how many metres it has.
    fn linear_unit(&self) -> Result<(String, f64), CrsError> {
        let metres = match (self.short(3076), self.number(&[3077])) {
            (None | Some(9001), _) => 1.0,
            (Some(9002), _) => 0.3048,
            (Some(9003), _) => 1200.0 / 3937.0,
            (Some(9036), _) => 1000.0,
            (Some(_), Some(size)) if size > 0.0 => size,
            (Some(other), _) => return Err(CrsError::Unknown(format!("unit {other}"))),
        };
        Ok((format!("+to_meter={metres}"), metres))
    }

    /// How many degrees the unit of angles has.
    fn degrees(&self) -> f64 {
        match (self.short(2054), self.number(&[2055])) {
            (Some(9101), _) => 1f64.to_degrees(),
            (Some(9105 | 9106), _) => 0.9,
            (Some(USER_DEFINED), Some(radians)) if radians > 0.0 => radians.to_degrees(),
            _ => 1.0,
        }
    }

    /// The datum: by a code, or by its ellipsoid and its shift or its name, with the meridian that it counts from.
    pub(super) fn datum(&self) -> String {
        // The code of a datum is that of its geographic system and 2000.
        let of_datum = self.short(2050).and_then(|code| code.checked_sub(2000));
        let codes = [self.short(2048), of_datum].into_iter().flatten();
        let own = self.numbers(2062);
        let known = codes.filter(|code| *code != USER_DEFINED && own.is_empty());
        if let Some(known) = known.filter_map(datum_of_code).next() {
            return known;
        }
        let meridian = match (self.short(2051), self.number(&[2061])) {
            (Some(8903), _) => " +pm=paris".to_string(),
            (_, Some(east)) if east != 0.0 => format!(" +pm={}", east * self.degrees()),
            _ => String::new(),
        };
        let ellipsoid = self.ellipsoid();
        if !own.is_empty() {
            let numbers: Vec<String> = own.iter().map(f64::to_string).collect();
            return format!("{ellipsoid} +towgs84={}{meridian}", numbers.join(","));
        }
        match self.named_shift() {
            Some(named) if named.starts_with("+datum=") => format!("{named}{meridian}"),
            Some(shift) => format!("{ellipsoid} {shift}{meridian}"),
            None => format!("{ellipsoid}{meridian}"),
        }
    }

    /// The shift of the datum whose name stands in the citation.
    fn named_shift(&self) -> Option<&'static str> {
        let (_, rest) = self.text(2049)?.split_once("Datum = ")?;
        shift_of_name(rest.split('|').next()?)
    }

    fn ellipsoid(&self) -> String {
        let named = match self.short(2056) {
            Some(7030) => "+ellps=WGS84",
            Some(7019) => "+ellps=GRS80",
            Some(7001) => "+ellps=airy",
            Some(7004) => "+ellps=bessel",
            Some(7008) => "+ellps=clrk66",
            Some(7022) => "+ellps=intl",
            Some(7024) => "+ellps=krass",
            _ => "",
        };
        if !named.is_empty() {
            return named.into();
        }
        match (
            self.number(&[2057]),
            self.number(&[2059]),
            self.number(&[2058]),
        ) {
            (Some(major), Some(inverse), _) if inverse > 0.0 => {
                format!("+a={major} +rf={inverse}")
            }
            (Some(major), _, Some(minor)) => format!("+a={major} +b={minor}"),
            (Some(major), ..) => format!("+a={major} +b={major}"),
            _ => "+datum=WGS84".into(),
        }
    }
}
