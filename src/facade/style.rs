//! Which of a facade's styles a shape has. What a style is does not matter here.

use std::collections::BTreeMap;

/// The key, among those of `styles`, that fits a shape best: keys for its layer (`layer.` before the
/// rest) before general ones, and among these `XY` before `X*` before `*Y` before `*`.
pub fn style<'a, T>(styles: &'a BTreeMap<String, T>, layer: &str, x: char, y: char) -> Option<&'a T> {
    let layer = format!("{layer}.");
    let prefixes = [layer.as_str(), ""];
    let keys = prefixes.into_iter().flat_map(|prefix| {
        [format!("{prefix}{x}{y}"), format!("{prefix}{x}*"), format!("{prefix}*{y}"), format!("{prefix}*")]
    });
    keys.into_iter().find_map(|key| styles.get(&key))
}

/// Whether `key` has the form of a style's key, given the names of the layers: `XY`, `X*`, `*Y` or
/// `*`, alone or after the name of a layer and a full stop.
pub fn is_style_key(key: &str, layers: &[&str]) -> bool {
    let rest = match key.rsplit_once('.') {
        Some((layer, _)) if !layers.contains(&layer) => return false,
        Some((_, rest)) => rest,
        None => key,
    };
    let symbol = |c: char| c.is_alphabetic() || c == '*';
    match rest.chars().collect::<Vec<char>>()[..] {
        ['*'] => true,
        [x, y] => symbol(x) && symbol(y),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_specific_key_wins() {
        let mut styles: BTreeMap<String, &str> = BTreeMap::new();
        let mut of = |key: &'static str, layer: &str, x: char, y: char| {
            styles.insert(key.to_owned(), key);
            style(&styles, layer, x, y).copied()
        };
        assert_eq!(of("BQ", "base", 'A', 'P'), None);
        assert_eq!(of("*", "base", 'A', 'P'), Some("*"));
        assert_eq!(of("*P", "base", 'A', 'P'), Some("*P"));
        assert_eq!(of("A*", "base", 'A', 'P'), Some("A*"));
        assert_eq!(of("AP", "base", 'A', 'P'), Some("AP"));
        assert_eq!(of("base.*", "base", 'A', 'P'), Some("base.*"));
        assert_eq!(of("base.AP", "base", 'A', 'P'), Some("base.AP"));
        assert_eq!(of("base.A*", "pillars", 'A', 'P'), Some("AP"));
        assert_eq!(of("base.*P", "base", 'C', 'Q'), Some("base.*"));
    }

    #[test]
    fn keys_are_checked() {
        for key in ["AP", "A*", "*P", "*", "base.AP", "base.*", "**"] {
            assert!(is_style_key(key, &["base"]), "{key}");
        }
        for key in ["", "A", "APQ", "wall.AP", "base.", ".AP", "A1"] {
            assert!(!is_style_key(key, &["base"]), "{key}");
        }
    }
}
