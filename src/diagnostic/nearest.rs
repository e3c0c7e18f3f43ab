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

#[cfg(test)]
mod tests {
    use super::nearest;

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
