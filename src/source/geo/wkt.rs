//! Coordinate systems in WKT, as `.prj` files, GeoPackages and some GeoTIFFs have them: by the EPSG
//! code at the end if there is one, else by their parameters, with the datum of that name.

use super::crs::{Crs, CrsError, shortened, unusable};
use super::datums::shift_of_name;

/// Brackets inside of one another, at most.
const DEEPEST: usize = 32;

/// The system that a text in WKT 1 or 2 describes.
///
/// # Errors
/// Where it is none that can be used.
pub fn parse(text: &str) -> Result<Crs, CrsError> {
    let outline = Outline::of(text).ok_or_else(|| unusable(text, "its brackets do not match"))?;
    let code = outline.authority.and_then(|part| code_of(&part));
    if let Some(Ok(crs)) = code.map(Crs::of_epsg) {
        return Ok(crs);
    }
    let start = text.trim_start().to_ascii_uppercase();
    if start.starts_with("LOCAL_CS") || start.starts_with("ENGCRS") {
        return Err(unusable(text, "it is no place on Earth"));
    }
    let name = text
        .split('"')
        .nth(1)
        .map_or_else(|| shortened(text), shortened);
    // Where the parameters are those of another projection, GDAL adds what PROJ is to make of it.
    if let Some(proj) = outline.extension {
        return Crs::of_proj(&proj, code, name);
    }
    let proj = proj4wkt::wkt_to_projstring(&with_older_names(text));
    let proj = proj.map_err(|error| unusable(text, &error.to_string()))?;
    let proj = swiss(&proj).unwrap_or(proj);
    match outline.datum {
        Some(datum) if !outline.has_shift => shifted(&proj, &datum, code, name),
        _ => Crs::of_proj(&proj, code, name),
    }
}

/// The text with the parameters of oblique projections by the names that they had before version 10 of EPSG's register.
fn with_older_names(text: &str) -> String {
    let names = [
        ("Azimuth at projection centre", "Azimuth of initial line"),
        (
            "Scale factor at projection centre",
            "Scale factor on initial line",
        ),
    ];
    let renamed = |text: String, (new, old): (&str, &str)| text.replace(new, old);
    names.into_iter().fold(text.to_string(), renamed)
}

/// The system with the shift of the datum that is named. Spheres have none: they stand for an ellipsoid.
fn shifted(proj: &str, datum: &str, code: Option<u32>, name: String) -> Result<Crs, CrsError> {
    let parts = || proj.split_whitespace();
    let is_sphere = parts().any(|part| part.starts_with("+R="));
    let Some(shift) = shift_of_name(datum).filter(|_| !is_sphere) else {
        let crs = Crs::of_proj(proj, code, name)?;
        let is_like_wgs84 = parts().any(|part| part.starts_with("+towgs84="));
        return Ok(match is_sphere || is_like_wgs84 {
            true => crs,
            false => crs.with_unknown_datum(datum),
        });
    };
    // A datum that PROJ knows by name has its own ellipsoid.
    let is_named = shift.starts_with("+datum=");
    let is_kept = |part: &&str| {
        let is_ellipsoid = part.starts_with("+a=") || part.starts_with("+rf=");
        !(part.starts_with("+towgs84=") || is_named && is_ellipsoid)
    };
    let kept: Vec<&str> = parts().filter(is_kept).chain([shift]).collect();
    Crs::of_proj(&kept.join(" "), code, name)
}

/// An oblique Mercator whose line runs due east, which PROJ computes as the Swiss one; nothing of any other.
fn swiss(proj: &str) -> Option<String> {
    let value = |name: &str| {
        let found = proj.split_whitespace().find_map(|p| p.strip_prefix(name));
        found.and_then(|value| value.parse::<f64>().ok())
    };
    let is_right = |name: &str| value(name).is_none_or(|angle| (angle - 90.0).abs() < 1e-9);
    let is_swiss = proj.contains("+proj=omerc") && value("+alpha=").is_some();
    if !(is_swiss && is_right("+alpha=") && is_right("+gamma=")) {
        return None;
    }
    let turned = proj.split_whitespace().filter_map(|part| match part {
        "+proj=omerc" => Some("+proj=somerc".to_string()),
        part if part.starts_with("+alpha=") || part.starts_with("+gamma=") => None,
        part if part.starts_with("+lonc=") => Some(part.replace("+lonc=", "+lon_0=")),
        part => Some(part.to_string()),
    });
    Some(turned.collect::<Vec<_>>().join(" "))
}

/// What can be told of WKT by its brackets and quotes.
#[derive(Default)]
struct Outline {
    /// The inside of the last `AUTHORITY` or `ID` that belongs to the whole.
    authority: Option<String>,
    /// The name of the datum.
    datum: Option<String>,
    /// Whether the datum's shift to WGS 84 is given.
    has_shift: bool,
    /// A PROJ string that says the whole.
    extension: Option<String>,
}

impl Outline {
    fn of(text: &str) -> Option<Outline> {
        let mut outline = Outline::default();
        // The words before the brackets that are open, and the text since each.
        let mut open: Vec<(String, usize)> = Vec::new();
        let mut quoted = false;
        let mut word = String::new();
        for (at, c) in text.char_indices() {
            match c {
                '"' => quoted = !quoted,
                _ if quoted => {}
                '[' | '(' => {
                    if open.len() == DEEPEST {
                        return None;
                    }
                    open.push((std::mem::take(&mut word), at + 1));
                }
                ']' | ')' => {
                    let (word, start) = open.pop()?;
                    outline.add(&word, &text[start..at], open.len());
                }
                c if c.is_alphanumeric() || c == '_' => word.extend(c.to_uppercase()),
                _ => word.clear(),
            }
            if c == ']' || c == ')' {
                word.clear();
            }
        }
        (open.is_empty() && !quoted).then_some(outline)
    }

    /// Notes what stands between the brackets after `word`, in `depth` others.
    fn add(&mut self, word: &str, inside: &str, depth: usize) {
        let quoted = |n: usize| inside.split('"').nth(2 * n + 1).map(str::to_string);
        match word {
            "AUTHORITY" | "ID" if depth == 1 => self.authority = Some(inside.to_string()),
            "DATUM" | "GEODETICDATUM" | "TRF" | "ENSEMBLE" if self.datum.is_none() => {
                self.datum = quoted(0);
            }
            "TOWGS84" => self.has_shift = true,
            "EXTENSION" if quoted(0).is_some_and(|name| name.eq_ignore_ascii_case("PROJ4")) => {
                self.extension = quoted(1);
            }
            _ => {}
        }
    }
}

/// The code in `"EPSG","32616"]`.
fn code_of(part: &str) -> Option<u32> {
    let (authority, code) = part.trim_end_matches([']', ')']).split_once(',')?;
    let plain = |text: &str| text.trim().trim_matches('"').to_ascii_uppercase();
    (plain(authority) == "EPSG").then(|| plain(code).parse().ok())?
}
