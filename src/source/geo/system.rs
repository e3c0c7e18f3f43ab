//! The coordinate system that a file says, without reading what lies in it.

use std::sync::Arc;

use super::crs::Crs;
use super::{geojson, geopackage, geotiff};

/// The system of the file at `path` with these bytes; none where it says none or cannot be read. `beside` gives the
/// content of the file with another ending beside it.
pub fn of_file(
    path: &str,
    bytes: &Arc<[u8]>,
    layer: Option<&str>,
    beside: &mut dyn FnMut(&str) -> Option<Arc<[u8]>>,
) -> Option<Crs> {
    let ending = path.rsplit_once('.').map_or("", |(_, ending)| ending);
    let mut described = || Crs::parse(&String::from_utf8_lossy(&beside("prj")?)).ok();
    match &*ending.to_ascii_lowercase() {
        "tif" | "tiff" => geotiff::open(bytes, 1).ok()?.crs.or_else(described),
        "geojson" | "json" => geojson::system(bytes),
        "gpkg" => geopackage::system(bytes, layer),
        _ => described(),
    }
}
