//! The name that was probably meant.

/// The name of `known` that is nearest to `unknown`, if one is near enough to be worth proposing:
/// one edit for every three characters, at least one, and not all characters. Ties go to the first
/// in order.
pub fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let limit = (unknown.chars().count() / 3).max(1);
    known
        .into_iter()
        .map(|name| {
            (
                strsim::damerau_levenshtein(&unknown.to_lowercase(), &name.to_lowercase()),
                name,
            )
        })
        .filter(|(distance, name)| {
            *distance <= limit && *distance < unknown.chars().count().max(name.chars().count())
        })
        .min_by_key(|(distance, _)| *distance)
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
