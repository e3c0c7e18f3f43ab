//! Actions are plain data: written down, read in another process and run there, each gives the same
//! bytes, without the project, the disk or the database.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use fretwork::action::{Action, ReadLog};
use fretwork::engine::{Compiler, MemoryWorld, Settings};
use fretwork::language::Section;
use fretwork::store::Digest;

/// Names the folder of actions in the process that runs them.
const FOLDER: &str = "FRETWORK_TEST_ACTIONS";

/// Specs that together have a node of every kind that can be evaluated, and are quick.
const SPECS: [&str; 2] = ["specs/kinds/kinds.yaml", "specs/kinds/land.yaml"];

/// Sections whose nodes are parts of others: the values of symbols, patterns and layers are in facades, fields travel
/// inside of what applies them.
const INSIDE: [Section; 5] = [
    Section::Symbols,
    Section::Patterns,
    Section::Layers,
    Section::Fields,
    Section::ForceProfiles,
];

#[test]
fn actions_run_in_a_fresh_process() {
    let compiler = Compiler::new(Arc::new(files()), None, false);
    let folder = tempfile::tempdir().unwrap();
    let (mut expected, mut kinds) = (BTreeMap::new(), BTreeSet::new());
    for spec in SPECS {
        let settings = Settings::default();
        let problems = compiler.check(spec, &settings);
        assert!(
            problems.iter().all(|d| !d.is_error()),
            "{spec}: {problems:?}"
        );
        for action in compiler.actions(spec, &settings) {
            let name = format!("{}.action", expected.len());
            fs::write(folder.path().join(&name), &action.bytes).unwrap();
            let node = &Action::from_bytes(&action.bytes).unwrap().definition.node;
            kinds.insert((node.section().name(), node.kind_name()));
            expected.insert(name, (action.name, action.output));
        }
    }
    let all = Section::ALL
        .iter()
        .filter(|section| !INSIDE.contains(section));
    let all = all.flat_map(|section| section.kinds().iter().map(|kind| (section.name(), *kind)));
    let missing: Vec<_> = all.filter(|kind| !kinds.contains(kind)).collect();
    assert_eq!(missing, []);
    let output = Command::new(std::env::current_exe().unwrap())
        .args([
            "--ignored",
            "--exact",
            "actions::run_all_of_a_folder",
            "--nocapture",
        ])
        .env(FOLDER, folder.path())
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    for (file, (name, digest)) in expected {
        let made = fs::read_to_string(folder.path().join(&file).with_extension("digest"));
        assert_eq!(made.unwrap(), digest.to_string(), "{name}");
    }
}

#[test]
#[ignore = "the other process of the test above"]
fn run_all_of_a_folder() {
    let Some(folder) = std::env::var_os(FOLDER) else {
        return;
    };
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_none_or(|extension| extension != "action")
        {
            continue;
        }
        let action = Action::from_bytes(&fs::read(&path).unwrap()).unwrap();
        let (value, _) = fretwork::stage::run(&action, &ReadLog::default()).unwrap();
        let mut bytes = Vec::new();
        value.write(&mut bytes).unwrap();
        let digest = Digest::of(&bytes);
        fs::write(path.with_extension("digest"), digest.to_string()).unwrap();
    }
}

/// The specs of this test, and the files of the shipped ones, in memory.
fn files() -> MemoryWorld {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut world = MemoryWorld::default();
    for (folder, as_folder) in [
        ("specs/assets", "specs/assets"),
        ("specs/shells/assets", "specs/shells/assets"),
        ("tests/kinds", "specs/kinds"),
    ] {
        for entry in fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy();
            let bytes = fs::read(&path).unwrap();
            world.files.insert(format!("{as_folder}/{name}"), bytes);
        }
    }
    world
}
