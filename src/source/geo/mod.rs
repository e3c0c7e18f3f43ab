//! Geodata: files whose coordinates are those of places on Earth.
//!
//! ```text
//! crs, wkt      texts → coordinate systems, and from one into another
//! datums        shifts of datums by name
//! codes         the EPSG code of a system that does not say it
//! geotiff       rasters
//! shapefile, dbf, geojson, geopackage   → layers of features
//! code_pages    how the texts of tables are written
//! system        which coordinate system a file says
//! misfit        what is wrong with a GeoJSON
//! simple        rings that cross themselves or share sides
//! ```

mod code_pages;
mod codes;
pub mod crs;
mod datums;
pub mod dbf;
pub mod geojson;
pub mod geopackage;
pub mod geotiff;
mod misfit;
pub mod shapefile;
pub mod simple;
pub mod system;
#[cfg(test)]
mod tests;
mod wkt;

use std::sync::Arc;

use crs::{Crs, CrsError, Transform};
use fretwork_geometry::{Attribute, Point};

/// The features of a file, or of one of its layers.
#[derive(Clone, Debug, Default)]
pub struct Layer {
    /// The system of the coordinates, where the file says it.
    pub crs: Option<Crs>,
    /// The names of the table's columns; none where there is no table.
    pub columns: Option<Vec<Arc<str>>>,
    /// The features in order of the file.
    pub features: Vec<Record>,
}

/// One feature: shapes, and a line of the table.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Its number in the file, from 1.
    pub number: usize,
    /// Points that stand alone.
    pub points: Vec<Point>,
    /// Polylines.
    pub lines: Vec<Vec<Point>>,
    /// Rings, which enclose by even and odd; the first point is not repeated at the end.
    pub rings: Vec<Vec<Point>>,
    /// How many of the rings did not end in their file where they begin.
    pub unclosed: usize,
    /// The values of those columns that have one.
    pub attributes: Vec<(Arc<str>, Attribute)>,
}

/// Why a file is no layer of features.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeoError {
    /// The bytes are not what they should be.
    #[error("{0}")]
    Damaged(String),
    /// One feature is wrong.
    #[error("feature {number}: {message}")]
    Feature {
        /// Its number, from 1.
        number: usize,
        /// What is wrong with it.
        message: String,
    },
    /// Several layers, and none is asked for.
    #[error("it holds several layers: {}", .0.join(", "))]
    Layers(Vec<String>),
    /// No layer of the name.
    #[error("it has no layer `{name}`; it has {}", .layers.join(", "))]
    NoLayer {
        /// What was asked for.
        name: String,
        /// What there is.
        layers: Vec<String>,
    },
    /// A layer that is no table.
    #[error(
        "its layer `{0}` is a view, a stored query without features of its own, and views are not read"
    )]
    View(String),
    /// The coordinate system cannot be used.
    #[error(transparent)]
    Crs(#[from] CrsError),
}

impl Layer {
    /// Checks the coordinates, and brings them where `transform` says.
    ///
    /// # Errors
    /// When a coordinate is no number, a latitude lies beyond the poles, or there is no place for a vertex; names the feature.
    pub fn placed(mut self, transform: Option<&Transform>) -> Result<Layer, GeoError> {
        let is_geographic = self.crs.as_ref().is_some_and(Crs::is_geographic);
        // What is no place on Earth is told before what has none on the map.
        for record in &self.features {
            let lists = [&record.lines, &record.rings].into_iter().flatten();
            for p in lists.flatten().chain(&record.points) {
                check(*p, is_geographic).map_err(|message| GeoError::Feature {
                    number: record.number,
                    message,
                })?;
            }
        }
        for record in &mut self.features {
            let number = record.number;
            let lists = [&mut record.lines, &mut record.rings].into_iter().flatten();
            for p in lists.flatten().chain(&mut record.points) {
                *p = place(*p, is_geographic, transform)
                    .map_err(|message| GeoError::Feature { number, message })?;
            }
        }
        Ok(self)
    }
}

fn check(p: Point, is_geographic: bool) -> Result<(), String> {
    if !p.is_finite() {
        return Err("a coordinate is not a finite number".into());
    }
    if is_geographic && p.y.abs() > 90.0 {
        // Nobody goes round the earth to the north.
        let metres = if p.y.abs() > 360.0 {
            ": if the coordinates are metres, the file must say its coordinate system, in GeoJSON by a `crs` member"
        } else {
            ""
        };
        return Err(format!("the latitude {} lies beyond a pole{metres}", p.y));
    }
    Ok(())
}

fn place(p: Point, is_geographic: bool, transform: Option<&Transform>) -> Result<Point, String> {
    let Some(transform) = transform else {
        return Ok(p);
    };
    let at = |p: Point| {
        transform
            .apply(p)
            .filter(|q| q.x.abs().max(q.y.abs()) < FARTHEST)
    };
    let mut lies = match is_geographic && p.x.abs() > 180.0 {
        true => beyond_date_line(p, at),
        false => at(p),
    };
    // Where the date line is no border of the plane, its two names are one: digit for digit, so that what was cut there joins.
    if is_geographic && p.x == -180.0 {
        let other = at(Point::new(180.0, p.y));
        let is_one = lies.zip(other).is_some_and(|(a, b)| a.distance(b) < 1e-3);
        lies = if is_one { other } else { lies };
    }
    lies.ok_or_else(|| {
        format!(
            "the map's coordinate system has no place for ({}, {})",
            p.x, p.y
        )
    })
}

/// Where a longitude beyond ±180 lies. Where the date line is a border of the plane, it goes on beyond that border by the
/// width of the plane there, so that a shape across the line stays in one piece.
fn beyond_date_line(p: Point, at: impl Fn(Point) -> Option<Point>) -> Option<Point> {
    let turns = ((p.x + 180.0) / 360.0).floor();
    let lies = at(Point::new(p.x - 360.0 * turns, p.y))?;
    let [west, east] = [-180.0, 180.0].map(|x| at(Point::new(x, p.y)));
    let width = east? - west?;
    let is_border = width.length() > 1e-3;
    Some(if is_border {
        lies + width * turns
    } else {
        lies
    })
}

/// No place of a map is so far from its origin, in metres; what is, is a pole of a projection that has none.
const FARTHEST: f64 = 1e9;

impl Record {
    /// Adds a ring without the repetition of its first point, and without points that repeat the one before.
    fn push_ring(&mut self, mut ring: Vec<Point>) {
        self.unclosed += usize::from(ring.first() != ring.last());
        ring.dedup();
        if ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        self.rings.push(ring);
    }
}
