//! The coordinate system that a file says, without reading what lies in it.

use std::sync::Arc;

use super::crs::Crs;
use super::geotiff::{self, Source};
use super::{geojson, geopackage};

/// The content of the file with another ending beside one.
pub type Beside<'a> = &'a mut dyn FnMut(&str) -> Option<Arc<[u8]>>;

/// The system of the file at `path` with these bytes, which is no raster; none where it says none or cannot be read.
pub fn of_file(path: &str, bytes: &[u8], layer: Option<&str>, beside: Beside<'_>) -> Option<Crs> {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    match &*ending.to_ascii_lowercase() {
        "geojson" | "json" => geojson::system(bytes),
        "gpkg" => geopackage::system(bytes, layer),
        _ => described(beside),
    }
}

/// The system of a GeoTIFF; none where it says none or cannot be read.
pub fn of_raster(source: impl Source + 'static, beside: Beside<'_>) -> Option<Crs> {
    let raster = geotiff::open(source, 1).ok()?;
    raster.crs.or_else(|| described(beside))
}

/// That of the `.prj` beside a file.
fn described(beside: Beside<'_>) -> Option<Crs> {
    Crs::parse(&String::from_utf8_lossy(&beside("prj")?)).ok()
}
