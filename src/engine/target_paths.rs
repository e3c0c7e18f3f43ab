//! Whether the files of several artifacts can stand beside one another, on every system: some take
//! two paths for one that differ only in case or in how an accent is written, and some take a few
//! names for devices.

use std::collections::BTreeMap;

use unicode_normalization::UnicodeNormalization as _;

use super::target::Target;
use fretwork_diagnostic::{Code, Diagnostic};

/// Names that Windows takes for devices, whatever stands after a point.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "conin$", "conout$"];

/// The errors for artifacts that would have the same file, or whose file would be another's folder.
pub fn collisions(targets: &[Target]) -> Vec<Diagnostic> {
    let mut first: BTreeMap<String, &Target> = BTreeMap::new();
    let mut diagnostics = Vec::new();
    for target in targets {
        match first.get(&folded(&target.path)) {
            Some(other) if other.path == target.path => diagnostics.push(same_path(target, other)),
            Some(other) => diagnostics.push(alike(target, other)),
            None => {
                first.insert(folded(&target.path), target);
            }
        }
    }
    for target in targets {
        let folders = target
            .path
            .match_indices('/')
            .map(|(at, _)| &target.path[..at]);
        for other in folders.filter_map(|folder| first.get(&folded(folder))) {
            let message = format!(
                "`{}` is the path of an artifact, and a folder of another",
                other.path
            );
            let diagnostic = Diagnostic::error(message)
                .about(Code::Output)
                .at(other.span.clone(), "a file");
            diagnostics.push(diagnostic.at(target.span.clone(), "in a folder of that name"));
        }
    }
    diagnostics
}

/// A warning for a path that Windows does not take.
pub fn reserved(target: &Target) -> Option<Diagnostic> {
    let wrong = target.path.split('/').find(|part| !is_portable(part))?;
    let message = format!("Windows has no file `{}`", target.path);
    let warning = Diagnostic::warning(message).at(target.span.clone(), "");
    Some(warning.help(format!("`{wrong}` is reserved there; take another name")))
}

fn is_portable(part: &str) -> bool {
    let stem = part
        .split('.')
        .next()
        .unwrap_or(part)
        .trim_end()
        .to_lowercase();
    let number = stem
        .strip_prefix("com")
        .or_else(|| stem.strip_prefix("lpt"));
    let is_device = DEVICES.contains(&&*stem)
        || number.is_some_and(|n| {
            n.chars().count() == 1 && n.chars().all(|c| matches!(c, '0'..='9' | '¹' | '²' | '³'))
        });
    !is_device && !part.ends_with([' ', '.']) && !part.contains(['<', '>', '"', '|', '?', '*'])
}

/// What paths have in common that some system takes for one.
fn folded(path: &str) -> String {
    if path.is_ascii() {
        return path.to_ascii_lowercase();
    }
    // Upper case first: the letters for which only that is one to many, such as ß.
    let cased = path
        .nfd()
        .flat_map(char::to_uppercase)
        .flat_map(char::to_lowercase);
    cased.nfc().collect()
}

fn same_path(target: &Target, other: &Target) -> Diagnostic {
    let diagnostic = Diagnostic::error(format!("two artifacts have the path `{}`", target.path))
        .about(Code::Output);
    let diagnostic = diagnostic.at(target.span.clone(), "here");
    if other.span == target.span {
        diagnostic.help("name every parameter of `each` in the path, as in `\"cuff-${wrist}.3mf\"`")
    } else {
        diagnostic.at(other.span.clone(), "and here")
    }
}

fn alike(target: &Target, other: &Target) -> Diagnostic {
    let message = format!(
        "`{}` and `{}` are one file on macOS and on Windows",
        other.path, target.path
    );
    let diagnostic = Diagnostic::error(message)
        .about(Code::Output)
        .at(target.span.clone(), "here");
    let help = "there, case and the way in which an accent is written do not count";
    diagnostic.at(other.span.clone(), "and here").help(help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_that_some_system_takes_for_one_are_folded_alike() {
        for (one, two) in [
            ("a/B.svg", "A/b.svg"),
            ("stra\u{df}e", "STRASSE"),
            ("e\u{301}", "\u{c9}"),
        ] {
            assert_eq!(folded(one), folded(two));
        }
        assert_ne!(folded("a/b.svg"), folded("a-b.svg"));
    }

    #[test]
    fn names_of_devices_are_known() {
        for name in [
            "CON.svg",
            "aux",
            "com1.tar.gz",
            "LPT9.dxf",
            "a.",
            "a ",
            "what?.svg",
            "nul .svg",
        ] {
            assert!(!is_portable(name), "{name}");
        }
        for name in [
            "console.svg",
            "com.svg",
            "com10.svg",
            "auxiliary",
            "a b.svg",
            "\u{e9}.svg",
        ] {
            assert!(is_portable(name), "{name}");
        }
    }
}
