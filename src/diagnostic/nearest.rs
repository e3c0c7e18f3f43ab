//! The name that was probably meant.

/// Names longer than this are near to none: comparing two takes the product of their lengths.
const LONGEST: usize = 200;

/// The name of `known` that is nearest to `unknown`, if one is near enough to be worth proposing:
/// one edit for every three characters, at least one, and not all characters. Ties go to the first
/// in order.
pub fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = unknown.chars().take(LONGEST + 1).count();
    if length > LONGEST {
        return None;
    }
    let limit = (length / 3).max(1);
    let unknown = unknown.to_lowercase();
    let distance = |name: &'a str| {
        let longest = length.max(name.chars().take(LONGEST + limit + 1).count());
        // Each character more or less is an edit.
        if longest > length + limit {
            return None;
        }
        let distance = strsim::damerau_levenshtein(&unknown, &name.to_lowercase());
        (distance <= limit && distance < longest).then_some((distance, name))
    };
    let near = known.into_iter().filter_map(distance);
    near.min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// The file of `known` whose name was probably meant by `unknown`: its own name is near and its ending the same, or its own
/// name is the same and the ending a slip of the pen. That two endings are alike does not make files alike.
pub fn nearest_file<'a>(
    unknown: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let parts = |name: &str| {
        let (own, ending) = name.rsplit_once('.').unwrap_or((name, ""));
        (own.to_lowercase(), ending.to_lowercase())
    };
    let (own, ending) = parts(unknown);
    let is_like = |name: &&str| {
        let (other, its_ending) = parts(name);
        match other == own {
            true => ending == its_ending || is_slip(&ending, &its_ending),
            false => ending == its_ending && nearest(&own, [&*other]).is_some(),
        }
    };
    nearest(unknown, known.into_iter().filter(is_like))
}

/// Whether an ending is near another because letters are missing or stand in the wrong order. `shp` and `shx` are two formats.
fn is_slip(ending: &str, other: &str) -> bool {
    let sorted = |text: &str| {
        let mut letters: Vec<char> = text.chars().collect();
        letters.sort_unstable();
        letters
    };
    let (a, b) = (sorted(ending), sorted(other));
    nearest(ending, [other]).is_some() && (a.len() != b.len() || a == b)
}

#[cfg(test)]
mod tests {
    use super::{nearest, nearest_file};

    /// Bug: `b.gpkg` was proposed for `a.gpkg`, since most of their letters, those of the ending, are the same.
    #[test]
    fn files_are_alike_by_their_own_names() {
        let beside = ["land.gpkg", "faces.shx", "faces.dbf", "dem.tif", "b.gpkg"];
        for (unknown, near) in [
            ("a.gpkg", None),
            ("sand2.gpkg", None),
            ("road.gpkg", None),
            ("faces.shp", None),
            ("lands.gpkg", Some("land.gpkg")),
            ("Land.gpkg", Some("land.gpkg")),
            ("dem.tiff", Some("dem.tif")),
            ("dem.tfi", Some("dem.tif")),
        ] {
            assert_eq!(nearest_file(unknown, beside), near, "{unknown}");
        }
    }

    #[test]
    fn proposes_only_what_is_near() {
        assert_eq!(
            nearest("cirle", ["rectangle", "circle", "svg"]),
            Some("circle")
        );
        assert_eq!(nearest("hexagon", ["rectangle", "circle", "svg"]), None);
        assert_eq!(nearest("Radius", ["radius"]), Some("radius"));
        assert_eq!(nearest("z", ["x", "y"]), None);
        assert_eq!(nearest("size", ["sign"]), None);
        assert_eq!(nearest("wrist", ["print"]), None);
        assert_eq!(nearest("mn", ["mm", "in"]), Some("mm"));
    }
}
