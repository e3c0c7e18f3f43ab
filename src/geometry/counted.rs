//! Counts in sentences: one thing, or several.

/// A count with the words for one and for several: `1 edge`, `3 edges`. What follows may be among the words: `edge has`, `edges have`.
pub fn counted(count: usize, one: &str, several: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        more => format!("{more} {several}"),
    }
}

#[cfg(test)]
mod tests {
    use super::counted;

    #[test]
    fn one_is_one_and_none_is_several() {
        let shown = [0, 1, 2].map(|n| counted(n, "edge has", "edges have"));
        assert_eq!(shown, ["0 edges have", "1 edge has", "2 edges have"]);
    }
}
