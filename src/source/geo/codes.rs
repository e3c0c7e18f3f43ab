//! The EPSG code of a coordinate system that was described without one, as `.prj` files do it.

use super::crs::Crs;

/// The codes of projected systems.
const CODES: std::ops::Range<u16> = 2000..32768;

/// Codes of systems that are others with heights beside them, and one that was given up for 3857.
const NOT_MEANT: [std::ops::Range<u16>; 8] = [
    3785..3786,
    5498..5501,
    5554..5557,
    5597..5599,
    5698..5700,
    5942..5977,
    6144..6191,
    7400..7424,
];

/// The code whose system puts the same numbers to the same places as `crs`, which the PROJ string `text` describes. Of
/// several, the zones of UTM in their own blocks come first, then the lowest.
///
/// Linear in the number of codes, some tens of milliseconds.
pub(super) fn code_of(crs: &Crs, text: &str) -> Option<u32> {
    if crs.is_geographic() {
        return None;
    }
    let datum = datum(text);
    let is_same = |code: &u16| {
        let Some(known) = crs_definitions::from_code(*code) else {
            return false;
        };
        self::datum(known.proj4) == datum
            && !known.proj4.contains("+proj=longlat")
            && Crs::of_epsg(u32::from(*code)).is_ok_and(|known| known.is_same(crs))
    };
    let is_meant = |code: &u16| NOT_MEANT.iter().all(|range| !range.contains(code));
    let found: Vec<u16> = CODES.filter(is_meant).filter(is_same).collect();
    let is_utm = |code: &&u16| {
        let blocks = [25828..25839, 26901..26924, 32601..32661, 32701..32761];
        blocks.iter().any(|block| block.contains(*code))
    };
    let best = found.iter().find(is_utm).or(found.first());
    best.map(|code| u32::from(*code))
}

/// The datum that a PROJ string names among those that are one to [`Crs::is_same`]; nothing for all others.
fn datum(text: &str) -> Option<&str> {
    let named = text.split_whitespace();
    let mut named = named.filter(|part| ["+datum=WGS84", "+datum=NAD83"].contains(part));
    named.next()
}
