//! Datums by name and by code: how places of each are shifted to WGS 84. Which datum a text names is told elsewhere.

/// The names of datums in EPSG's register and in the texts of GDAL and ESRI, in the letters that [`folded`] leaves, and
/// the code of a geographic system that has the datum. Those with the same name in several places of the register are left
/// out.
const NAMES: &str = include_str!("datums.txt");

/// Systems whose rotations the list of definitions has in the sense of a coordinate frame, though PROJ strings have them in that
/// of a position vector: Fatu Iva 72 and the Stereo70 of Romania.
const TURNED: [u16; 2] = [3303, 3844];

/// The shift of the Netherlands in the list of definitions, and the later one that PROJ takes.
const AMERSFOORT: [&str; 2] = [
    "+towgs84=565.2369,50.0087,465.658,-0.406857,0.350733,-1.87035,4.0812",
    "+towgs84=565.4171,50.3319,465.5524,-0.398957388243134,0.343987817378283,-1.87740163998045,4.0725",
];

/// The PROJ string of the system with this code.
pub(super) fn definition_of_code(code: u16) -> Option<String> {
    let text = crs_definitions::from_code(code)?.proj4;
    if !TURNED.contains(&code) {
        return Some(text.replace(AMERSFOORT[0], AMERSFOORT[1]));
    }
    let parts = text.split_whitespace().map(|part| {
        let Some(shift) = part.strip_prefix("+towgs84=") else {
            return part.to_owned();
        };
        let opposite = |number: &str| match number.strip_prefix('-') {
            Some(size) => size.to_owned(),
            None => format!("-{number}"),
        };
        let numbers = shift.split(',').enumerate();
        let numbers = numbers.map(|(n, number)| match n {
            3..6 => opposite(number),
            _ => number.to_owned(),
        });
        format!("+towgs84={}", numbers.collect::<Vec<_>>().join(","))
    });
    Some(parts.collect::<Vec<_>>().join(" "))
}

/// What PROJ calls the shift of the datum of this name: `+towgs84=…`, `+datum=…` or `+nadgrids=…`; none where it is not known.
pub(super) fn shift_of_name(name: &str) -> Option<&'static str> {
    let name = folded(name);
    let known = NAMES.lines().filter_map(|line| line.split_once(' '));
    let code = known.clone().find(|(known, _)| *known == name)?.1;
    shift_of_code(code.parse().ok()?)
}

/// The ellipsoid and the shift of the geographic system with this code, as parts of a PROJ string; none where it is not known.
pub(super) fn datum_of_code(code: u16) -> Option<String> {
    let text = crs_definitions::from_code(code)?.proj4;
    let is_datum = |part: &&str| !part.starts_with("+proj=") && *part != "+no_defs";
    let parts: Vec<&str> = text.split_whitespace().filter(is_datum).collect();
    text.contains("+proj=longlat").then(|| parts.join(" "))
}

/// The shift of the datum of the geographic system with this code.
fn shift_of_code(code: u16) -> Option<&'static str> {
    let text = crs_definitions::from_code(code)?.proj4;
    let is_shift = |part: &&str| {
        let known = ["+towgs84=", "+datum=", "+nadgrids="];
        known.iter().any(|known| part.starts_with(known))
    };
    text.split_whitespace().find(is_shift)
}

/// A name without the `D_` that ESRI puts before it, in small letters and digits alone.
fn folded(name: &str) -> String {
    let name = name.to_ascii_lowercase();
    let name = name.strip_prefix("d_").unwrap_or(&name);
    let is_kept = |c: &char| c.is_ascii_alphanumeric() || *c == '+';
    name.chars().filter(is_kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_a_shift_and_stands_once() {
        let mut before = "";
        for line in NAMES.lines() {
            let (name, _) = line.split_once(' ').unwrap();
            assert_eq!(folded(name), name);
            assert!(shift_of_name(name).is_some(), "{line}");
            assert!(before < name, "{line}");
            before = name;
        }
    }
}
