//! Coordinate systems in WKT, as `.prj` files, GeoPackages and some GeoTIFFs have them: by the EPSG
//! code at the end if there is one, else by their parameters.

use super::crs::{Crs, CrsError, shortened, unusable};

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
    let proj = proj4wkt::wkt_to_projstring(text);
    let proj = proj.map_err(|error| unusable(text, &error.to_string()))?;
    Crs::of_proj(&proj, code, name)
}

/// What can be told of WKT by its brackets and quotes.
struct Outline {
    /// The inside of the last `AUTHORITY` or `ID` that belongs to the whole.
    authority: Option<String>,
}

impl Outline {
    fn of(text: &str) -> Option<Outline> {
        let (mut depth, mut quoted) = (0, false);
        let mut authority = None;
        let mut word = String::new();
        let mut inside: Option<String> = None;
        for c in text.chars() {
            if let Some(inside) = inside.as_mut() {
                inside.push(c);
            }
            match c {
                '"' => quoted = !quoted,
                _ if quoted => {}
                '[' | '(' => {
                    depth += 1;
                    if depth > DEEPEST {
                        return None;
                    }
                    let is_code = word == "AUTHORITY" || word == "ID";
                    if depth == 2 && is_code {
                        inside = Some(String::new());
                    }
                    word.clear();
                }
                ']' | ')' => {
                    depth = usize::checked_sub(depth, 1)?;
                    if depth == 1 && inside.is_some() {
                        authority = inside.take();
                    }
                    word.clear();
                }
                c if c.is_alphanumeric() || c == '_' => word.extend(c.to_uppercase()),
                _ => word.clear(),
            }
        }
        (depth == 0 && !quoted).then_some(Outline { authority })
    }
}

/// The code in `"EPSG","32616"]`.
fn code_of(part: &str) -> Option<u32> {
    let (authority, code) = part.trim_end_matches([']', ')']).split_once(',')?;
    let plain = |text: &str| text.trim().trim_matches('"').to_ascii_uppercase();
    (plain(authority) == "EPSG").then(|| plain(code).parse().ok())?
}
