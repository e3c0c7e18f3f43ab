//! Each room under `src/` uses only the rooms that it may, and only `build/` knows salsa.

use std::fs;
use std::path::Path;

/// Room and the rooms it may use, in the order of the data flow.
const ROOMS: &[(&str, &[&str])] = &[
    ("diagnostic", &[]),
    ("geometry", &[]),
    ("store", &[]),
    ("script", &["geometry", "diagnostic"]),
    ("spec", &["diagnostic"]),
    ("graph", &["spec", "diagnostic"]),
    ("source", &["geometry", "diagnostic"]),
    ("arrangement", &["geometry", "script", "spec", "diagnostic"]),
    ("band", &["geometry", "spec", "diagnostic"]),
    ("facade", &["geometry", "spec", "diagnostic"]),
    ("shell", &["geometry", "spec", "diagnostic"]),
    ("solid", &["geometry", "spec", "diagnostic"]),
    ("fabricate", &["geometry", "diagnostic"]),
    (
        "build",
        &[
            "arrangement",
            "band",
            "diagnostic",
            "fabricate",
            "facade",
            "geometry",
            "graph",
            "script",
            "shell",
            "solid",
            "source",
            "spec",
            "store",
        ],
    ),
    ("cli", &["build", "diagnostic", "graph", "spec", "store"]),
];

#[test]
fn rooms_use_only_what_they_may() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut errors = Vec::new();
    for (room, allowed) in ROOMS {
        for (path, text) in sources(&src.join(room)) {
            for used in rooms_named(&text) {
                let is_room = ROOMS.iter().any(|(r, _)| *r == used);
                if is_room && used != *room && !allowed.contains(&used.as_str()) {
                    errors.push(format!("{path}: {room} must not use {used}"));
                }
            }
        }
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}

#[test]
fn every_folder_of_the_source_is_a_known_room() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in fs::read_dir(src).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(
            !path.is_dir() || ROOMS.iter().any(|(room, _)| *room == name),
            "{name} is no room"
        );
    }
}

#[test]
fn salsa_the_disk_and_the_terminal_are_named_only_in_their_places() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut errors = Vec::new();
    for (path, text) in sources(&src) {
        if path.ends_with("/tests.rs") || path.contains("/tests/") {
            continue;
        }
        let code = text.split("#[cfg(test)]").next().unwrap_or(&text);
        for (word, places) in [
            ("salsa::", &["src/build/"][..]),
            ("std::fs", &["src/cli/", "src/store/local.rs"]),
            ("println!", &["src/cli/"]),
            ("SystemTime", &["src/store/local.rs"]),
        ] {
            if code.contains(word) && !places.iter().any(|place| path.contains(place)) {
                errors.push(format!("{path} names {word}"));
            }
        }
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}

#[test]
fn rooms_are_found_in_grouped_imports() {
    let text = "use crate::{geometry::{Point, Ring}, spec::{self, Tree}};\nfn f() { crate::store::Digest::of(b) }";
    assert_eq!(rooms_named(text), ["geometry", "spec", "store"]);
}

/// The first steps of all paths that begin at `crate::`, those in groups too.
fn rooms_named(text: &str) -> Vec<String> {
    let word = |s: &str| {
        s.trim_start()
            .chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect::<String>()
    };
    let mut rooms = Vec::new();
    for (at, marker) in text.match_indices("crate::") {
        let rest = &text[at + marker.len()..];
        if !rest.starts_with('{') {
            rooms.push(word(rest));
            continue;
        }
        let mut depth = 0;
        for (i, c) in rest.char_indices() {
            depth += match c {
                '{' => 1,
                '}' => -1,
                _ => 0,
            };
            if depth == 0 {
                break;
            }
            if depth == 1 && matches!(c, '{' | ',') {
                rooms.push(word(&rest[i + 1..]));
            }
        }
    }
    rooms.retain(|room| !room.is_empty());
    rooms
}

fn sources(folder: &Path) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let Ok(entries) = fs::read_dir(folder) else {
        return found;
    };
    for entry in entries {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push((
                path.display().to_string(),
                fs::read_to_string(&path).unwrap(),
            ));
        }
    }
    found.sort();
    found
}
