//! Which media a rule is for (Media Queries, level 4): a drawing is seen on a light screen.

use super::block::split_outside;

/// Whether rules behind a list of queries count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Applies {
    /// On any screen.
    Yes,
    /// On no screen.
    No,
    /// On some screens: it depends on what is not known here.
    Unknown,
}

/// What the list says; an empty one applies.
pub fn applies(list: &str) -> Applies {
    if list.trim().is_empty() {
        return Applies::Yes;
    }
    let answers: Vec<Applies> = split_outside(list, ',').map(query).collect();
    let has = |answer| answers.contains(&answer);
    if has(Applies::Yes) {
        Applies::Yes
    } else if has(Applies::Unknown) {
        Applies::Unknown
    } else {
        Applies::No
    }
}

fn query(text: &str) -> Applies {
    let text = text.trim().to_ascii_lowercase();
    if let Some(rest) = text.strip_prefix("not ") {
        return match query(rest) {
            Applies::Yes => Applies::No,
            Applies::No => Applies::Yes,
            Applies::Unknown => Applies::Unknown,
        };
    }
    let text = text.strip_prefix("only ").unwrap_or(&text);
    let answers: Vec<Applies> = text.split(" and ").map(condition).collect();
    if answers.contains(&Applies::No) {
        Applies::No
    } else if answers.contains(&Applies::Unknown) {
        Applies::Unknown
    } else {
        Applies::Yes
    }
}

fn condition(text: &str) -> Applies {
    let text: String = text.split_whitespace().collect();
    match &*text {
        "all" | "screen" | "(prefers-color-scheme:light)" => Applies::Yes,
        "print"
        | "speech"
        | "aural"
        | "braille"
        | "embossed"
        | "handheld"
        | "projection"
        | "tty"
        | "tv"
        | "(prefers-color-scheme:dark)" => Applies::No,
        _ => Applies::Unknown,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_screen_is_what_queries_are_about() {
        for yes in [
            "",
            "screen",
            "all",
            "only SCREEN",
            "not print",
            "print, screen",
        ] {
            assert_eq!(applies(yes), Applies::Yes, "{yes}");
        }
        for no in [
            "print",
            "not screen",
            "print and (color)",
            "(prefers-color-scheme: dark)",
        ] {
            assert_eq!(applies(no), Applies::No, "{no}");
        }
        for unknown in [
            "(min-width: 3px)",
            "screen and (color)",
            "print, (hover)",
            "x",
            "not",
        ] {
            assert_eq!(applies(unknown), Applies::Unknown, "{unknown}");
        }
    }
}
