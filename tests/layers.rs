//! The walls of the house. What a room may use stands in its manifest, which the compiler holds it
//! to; here are the rules that the compiler does not know.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

#[path = "../src/rooms.rs"]
mod rooms;

/// The rooms whose stages make values: they know neither one another nor the machine.
const SYNTHESIS: &[&str] = &["arrangement", "band", "facade", "shell", "solid", "wrap"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn methods_do_not_know_one_another() {
    let rooms = rooms::read(&root().join("src")).unwrap();
    for room in SYNTHESIS {
        let used = rooms::closure(&rooms, [*room]);
        let others: Vec<_> = SYNTHESIS
            .iter()
            .filter(|o| *o != room && used.contains(**o))
            .collect();
        assert!(others.is_empty(), "{room} uses {others:?}");
    }
}

#[test]
fn only_the_engine_depends_on_salsa() {
    for room in rooms::read(&root().join("src")).unwrap().keys() {
        let manifest =
            fs::read_to_string(root().join("src").join(room).join("Cargo.toml")).unwrap();
        assert!(
            room == "engine" || !manifest.contains("salsa"),
            "{room} names salsa"
        );
    }
}

#[test]
fn a_version_changes_with_the_rooms_that_a_stage_uses() {
    let before = rooms::read(&root().join("src")).unwrap();
    let versions = |rooms: &BTreeMap<String, rooms::Room>| -> BTreeMap<String, String> {
        rooms::versions(rooms, b"lock").into_iter().collect()
    };
    let changed_by = |edited: &str| -> BTreeSet<String> {
        let mut after = rooms::read(&root().join("src")).unwrap();
        let room = after.get_mut(edited).unwrap();
        room.files.insert("new.rs".into(), b"fn new() {}".to_vec());
        let (before, after) = (versions(&before), versions(&after));
        let changed = before
            .into_iter()
            .filter(|(room, version)| after[room] != *version);
        changed.map(|(room, _)| room).collect()
    };
    let stages = [
        "arrangement",
        "band",
        "facade",
        "shell",
        "solid",
        "artifact",
        "wrap",
    ]
    .map(|s| format!("stage/{s}"));
    let expected = [
        ("cli", &[][..]),
        ("engine", &[]),
        ("store", &[]),
        ("band", &["stage/band"]),
        (
            "arrangement",
            &["stage/arrangement", "stage/facade", "stage/wrap"],
        ),
        ("wrap", &["stage/wrap"]),
        ("fabricate", &["stage/artifact"]),
        ("shell", &["stage/shell"]),
        (
            "solid",
            &[
                "stage/artifact",
                "stage/facade",
                "stage/shell",
                "stage/solid",
            ],
        ),
    ];
    for (edited, of) in expected {
        let changed = changed_by(edited);
        for stage in stages.iter().map(String::as_str).chain(["primitive"]) {
            let is_expected = of.contains(&stage);
            assert!(
                changed.contains(stage) == is_expected,
                "{stage} after an edit of {edited}"
            );
        }
    }
    assert!(
        stages
            .iter()
            .all(|stage| changed_by("geometry").contains(stage))
    );
}

#[test]
fn the_disk_and_the_terminal_are_named_only_in_their_places() {
    let mut errors = Vec::new();
    for (path, text) in sources(&root().join("src")) {
        if path.ends_with("/tests.rs") || path.contains("/tests/") {
            continue;
        }
        let code = text.split("#[cfg(test)]").next().unwrap_or(&text);
        for (word, places) in [
            ("std::fs", &["src/cli/", "src/store/", "src/rooms.rs"][..]),
            ("println!", &["src/cli/"]),
            ("SystemTime", &["src/store/", "src/cli/disk_parts.rs"]),
        ] {
            if code.contains(word) && !places.iter().any(|place| path.contains(place)) {
                errors.push(format!("{path} names {word}"));
            }
        }
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}

#[test]
fn indices_and_disjoint_sets_live_in_the_kernel() {
    const NAMES: &[&str] = &[
        "UnionFind",
        "DisjointSets",
        "Buckets",
        "BucketGrid",
        "SegmentTree",
        "SideTree",
        "KdTree",
        "BoxTree",
        "RTree",
        "QuadTree",
    ];
    const HELD: &[&str] = &[
        "band",
        "cli",
        "engine",
        "fabricate",
        "facade",
        "graph",
        "script",
        "solid",
        "source",
    ];
    let mut errors = Vec::new();
    for (path, code) in HELD.iter().flat_map(|room| code_of(room)) {
        let words = code.split(|c: char| !c.is_alphanumeric() && c != '_');
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let defined = words
            .windows(2)
            .filter(|w| w[0] == "struct" && NAMES.contains(&w[1]));
        errors.extend(defined.map(|w| format!("{path} has a {} of its own", w[1])));
    }
    assert!(errors.is_empty(), "{}", errors.join("\n"));
}

#[test]
fn control_flow_never_reads_a_message() {
    const HELD: &[&str] = &[
        "arrangement",
        "cli",
        "engine",
        "fabricate",
        "facade",
        "geometry",
        "graph",
        "script",
        "solid",
        "source",
        "store",
    ];
    for (path, code) in HELD.iter().flat_map(|room| code_of(room)) {
        assert!(!code.contains("message.contains"), "{path} reads a message");
    }
}

/// The files of a room without their tests.
fn code_of(room: &str) -> Vec<(String, String)> {
    let mut files = sources(&root().join("src").join(room));
    files.retain(|(path, _)| {
        !path.ends_with("tests.rs") && !path.contains("/tests/") && !path.contains("_tests/")
    });
    for (_, text) in &mut files {
        *text = text.split("#[cfg(test)]").next().unwrap_or("").to_owned();
    }
    files
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
