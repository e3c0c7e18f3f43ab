//! Coordinate systems of maps: read from an EPSG code, a PROJ string or WKT, and transformed into one
//! another. What a system of a map may be, and which one a map has, is decided elsewhere.

use std::fmt;

use proj4rs::Proj;
use proj4rs::transform::transform;

use super::datums::definition_of_code;
use super::{codes, wkt};
use fretwork_geometry::Point;

/// Why a coordinate system cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CrsError {
    /// No such code is known.
    #[error("the coordinate system `{0}` is not known")]
    Unknown(String),
    /// The text is no coordinate system.
    #[error("`{text}` is no coordinate system that can be used: {reason}")]
    Unusable {
        /// The text, shortened.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Degrees.
    #[error("`{0}` is geographic: its unit is the degree, which has no length of its own")]
    Geographic(String),
    /// Projected, but in feet or kilometres.
    #[error("the unit of `{text}` is {metres} m, and a map is in metres")]
    Unit {
        /// The system.
        text: String,
        /// Its unit in metres.
        metres: f64,
    },
}

/// A coordinate system in two dimensions. Geographic ones have degrees, longitude first.
#[derive(Clone)]
pub struct Crs {
    proj: Proj,
    epsg: Option<u32>,
    name: String,
    /// The PROJ string.
    text: String,
    needs_grid: bool,
    /// The name of its datum, where nothing is known of it.
    unknown_datum: Option<String>,
}

impl fmt::Debug for Crs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Crs({})", self.name)
    }
}

/// Parts of a degree below which two systems that map them to the same places are one.
const SAME: f64 = 1e-6;

/// The longest text that is read as a coordinate system.
const LONGEST: usize = 1 << 16;

impl Crs {
    /// The system that a text names: `EPSG:n`, a URN or URL of one, `OGC:CRS84`, a PROJ string or WKT.
    ///
    /// # Errors
    /// [`CrsError`]
    pub fn parse(text: &str) -> Result<Crs, CrsError> {
        let text = text.trim();
        if text.len() > LONGEST {
            return Err(unusable(text, "it is too long"));
        }
        if text.starts_with('+') {
            let crs = Crs::of_proj(text, None, shortened(text))?;
            return Ok(match lone_ellipsoid(text) {
                Some(ellipsoid) => crs.with_unknown_datum(ellipsoid),
                None => crs,
            });
        }
        if text.contains('[') || text.contains('(') {
            return wkt::parse(text);
        }
        if text.to_ascii_uppercase().ends_with("CRS84") {
            return Crs::wgs84();
        }
        match code_in(text) {
            Some(code) => Crs::of_epsg(code),
            None => Err(unusable(text, "write `EPSG:n`, a PROJ string or WKT")),
        }
    }

    /// Longitude and latitude on WGS 84.
    ///
    /// # Errors
    /// None in practice: the definition is a constant.
    pub fn wgs84() -> Result<Crs, CrsError> {
        Crs::of_proj(
            "+proj=longlat +datum=WGS84 +no_defs",
            Some(4326),
            "EPSG:4326".into(),
        )
    }

    /// The system of an EPSG code.
    ///
    /// # Errors
    /// Where it is not known.
    pub fn of_epsg(code: u32) -> Result<Crs, CrsError> {
        let name = format!("EPSG:{code}");
        let definition = u16::try_from(code)
            .ok()
            .and_then(definition_of_code)
            .ok_or_else(|| CrsError::Unknown(name.clone()))?;
        Crs::of_proj(&definition, Some(code), name)
    }

    /// The system of a PROJ string.
    pub(super) fn of_proj(text: &str, epsg: Option<u32>, name: String) -> Result<Crs, CrsError> {
        let is_grid = |part: &&str| part.starts_with("+nadgrids=") && !part.contains("@null");
        let grids = text.split_whitespace().any(|part| is_grid(&part));
        let needs_grid = grids || text.contains("+datum=NAD27");
        let kept: Vec<&str> = text
            .split_whitespace()
            .filter(|part| !is_grid(part))
            .collect();
        // Without its grid, NAD27 is its ellipsoid.
        let kept = kept.join(" ").replace("+datum=NAD27", "+ellps=clrk66");
        let kept = kept.replace("+datum=OSGB36", GREAT_BRITAIN);
        let proj = Proj::from_proj_string(&kept);
        let proj = proj.map_err(|error| unusable(text, &error.to_string()))?;
        if proj.is_geocent() {
            return Err(unusable(text, "it has three dimensions"));
        }
        let crs = Crs {
            proj,
            epsg,
            name,
            text: text.to_string(),
            needs_grid,
            unknown_datum: None,
        };
        Ok(crs)
    }

    /// The same, of which is known that the shift of its datum is not.
    pub(super) fn with_unknown_datum(self, name: &str) -> Crs {
        Crs {
            unknown_datum: Some(shortened(name)),
            ..self
        }
    }

    /// How it was named.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// A text from which [`Crs::parse`] makes the same system.
    pub fn text(&self) -> String {
        match self.epsg {
            Some(code) if Crs::of_epsg(code).is_ok() => format!("EPSG:{code}"),
            _ => self.text.clone(),
        }
    }

    /// Its EPSG code, where it was named by one.
    pub fn epsg(&self) -> Option<u32> {
        self.epsg
    }

    /// Its EPSG code, also where it was described by parameters that are those of a code.
    pub fn code(&self) -> Option<u32> {
        let is_known = self.unknown_datum.is_none();
        let found = || codes::code_of(self, &self.text).filter(|_| is_known);
        self.epsg.or_else(found)
    }

    /// Whether its coordinates are degrees.
    pub fn is_geographic(&self) -> bool {
        self.proj.is_latlong()
    }

    /// Whether exact positions in it need a grid of shifts that is not at hand, which makes them wrong by some metres.
    pub fn needs_grid(&self) -> bool {
        self.needs_grid
    }

    /// Why places that come from it or go into it may be wrong, if there is a reason.
    pub fn doubt(&self) -> Option<String> {
        if self.needs_grid {
            let message = format!(
                "`{}` needs a grid of shifts, which is not at hand",
                self.name
            );
            return Some(message);
        }
        let datum = self.unknown_datum.as_ref()?;
        let message = format!("how the datum `{datum}` lies to WGS 84 is not known");
        Some(message)
    }

    /// Whether a map may be drawn in it: projected, with metres.
    ///
    /// # Errors
    /// Why not.
    pub fn check_plane(&self) -> Result<(), CrsError> {
        if self.is_geographic() {
            return Err(CrsError::Geographic(self.name.clone()));
        }
        let metres = self.proj.to_meter();
        if (metres - 1.0).abs() > 1e-12 {
            return Err(CrsError::Unit {
                text: self.name.clone(),
                metres,
            });
        }
        Ok(())
    }

    /// Whether both put the same numbers to the same places. WGS 84, ETRS89 and NAD83 are one here.
    pub fn is_same(&self, other: &Crs) -> bool {
        if self.epsg.is_some() && self.epsg == other.epsg {
            return true;
        }
        let kind = |crs: &Crs| {
            (
                crs.is_geographic(),
                crs.needs_grid,
                crs.unknown_datum.clone(),
            )
        };
        if kind(self) != kind(other) {
            return false;
        }
        let to = Transform::new(self.clone(), other.clone());
        let middle = self.middle();
        let (reach, close) = match self.is_geographic() {
            true => (1.0, SAME * 1e-2),
            false => (1e5 / self.proj.to_meter(), 1e-4),
        };
        let around = [(0.0, 0.0), (1.0, 1.0), (-1.0, 0.5), (0.5, -1.0)];
        around.iter().all(|(x, y)| {
            let p = middle + Point::new(*x, *y) * reach;
            to.apply(p).is_some_and(|q| q.distance(p) < close)
        })
    }

    /// A place that it is made for.
    fn middle(&self) -> Point {
        if self.is_geographic() {
            return Point::new(10.0, 45.0);
        }
        let metres = self.proj.to_meter();
        Point::new(self.proj.false_easting(), self.proj.false_northing()) * (1.0 / metres)
    }
}

/// From one coordinate system into another.
#[derive(Clone, Debug)]
pub struct Transform {
    from: Crs,
    to: Crs,
}

impl Transform {
    /// From `from` into `to`.
    pub fn new(from: Crs, to: Crs) -> Transform {
        Transform { from, to }
    }

    /// The way back.
    pub fn inverse(&self) -> Transform {
        Transform::new(self.to.clone(), self.from.clone())
    }

    /// Where `p` lies; longitudes come in -180 to 180. None where the other system has no place for it.
    pub fn apply(&self, p: Point) -> Option<Point> {
        let mut at = (p.x, p.y, 0.0);
        if self.from.is_geographic() {
            if p.y.abs() > 90.0 + 1e-9 {
                return None;
            }
            at = (p.x.to_radians(), p.y.to_radians(), 0.0);
        }
        transform(&self.from.proj, &self.to.proj, &mut at).ok()?;
        let mut q = Point::new(at.0, at.1);
        if self.to.is_geographic() {
            q = Point::new(wrapped(at.0.to_degrees()), at.1.to_degrees());
        }
        q.is_finite().then_some(q)
    }
}

/// A longitude in -180 to 180.
fn wrapped(longitude: f64) -> f64 {
    if (-180.0..=180.0).contains(&longitude) {
        longitude
    } else {
        longitude - ((longitude + 180.0) / 360.0).floor() * 360.0
    }
}

/// The ellipsoid and the shift of the datum of Great Britain that PROJ takes where the grid is not at hand.
const GREAT_BRITAIN: &str = "+ellps=airy +towgs84=446.448,-125.157,542.06,0.15,0.247,0.842,-20.489";

/// The ellipsoid of a PROJ string that says no datum and no shift, if it is not like that of WGS 84.
fn lone_ellipsoid(text: &str) -> Option<&str> {
    let mut parts = text.split_whitespace();
    let says_datum = ["+datum=", "+towgs84=", "+nadgrids="];
    if parts
        .clone()
        .any(|part| says_datum.iter().any(|start| part.starts_with(start)))
    {
        return None;
    }
    let ellipsoid = parts.find_map(|part| part.strip_prefix("+ellps="))?;
    (!["WGS84", "GRS80"].contains(&ellipsoid)).then_some(ellipsoid)
}

/// The number at the end of a text that speaks of EPSG.
fn code_in(text: &str) -> Option<u32> {
    let upper = text.to_ascii_uppercase();
    let (_, rest) = upper.split_once("EPSG")?;
    let code = rest.rsplit([':', '/', '#']).next()?;
    code.parse().ok()
}

pub(super) fn unusable(text: &str, reason: &str) -> CrsError {
    CrsError::Unusable {
        text: shortened(text),
        reason: reason.to_string(),
    }
}

pub(super) fn shortened(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
