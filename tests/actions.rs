//! Actions are plain data: written down, read in another process and run there, each gives the same
//! bytes, without the project, the disk or the database.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use fretwork::action::{Action, ReadLog};
use fretwork::engine::{Compiler, MemoryWorld, Settings};
use fretwork::store::Digest;

/// Names the folder of actions in the process that runs them.
const FOLDER: &str = "FRETWORK_TEST_ACTIONS";

/// Shipped specs that have a node of every kind that can be evaluated, and are quick.
const SPECS: [&str; 9] = [
    "specs/jigsaw.yaml",
    "specs/gradient-screen.yaml",
    "specs/textures/kumiko.yaml",
    "specs/bands/vase.yaml",
    "specs/bands/lace.yaml",
    "specs/bands/chair.yaml",
    "specs/facades/residential-house.yaml",
    "specs/solids/pen-stand.yaml",
    "specs/solids/relief-cup.yaml",
];

/// What a spec may be about. The values of symbols, patterns and layers are parts of facades, fields
/// travel inside of what applies them.
const SECTIONS: [&str; 10] = [
    "regions",
    "exemplars",
    "partitions",
    "arrangements",
    "curves",
    "bands",
    "panels",
    "facades",
    "solids",
    "artifacts",
];

#[test]
fn actions_run_in_a_fresh_process() {
    let compiler = Compiler::new(Arc::new(shipped()), None, false);
    let folder = tempfile::tempdir().unwrap();
    let (mut expected, mut sections) = (BTreeMap::new(), BTreeSet::new());
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
            sections.extend(action.name.split('.').next().map(str::to_owned));
            expected.insert(name, (action.name, action.output));
        }
    }
    for section in SECTIONS {
        assert!(sections.contains(section), "no spec has {section}");
    }
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
        let digest = Digest::of(&value.encode());
        fs::write(path.with_extension("digest"), digest.to_string()).unwrap();
    }
}

/// The shipped specs and their files in memory.
fn shipped() -> MemoryWorld {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut world = MemoryWorld::default();
    let mut open = vec![root.join("specs")];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path
                    .strip_prefix(root)
                    .unwrap()
                    .to_string_lossy()
                    .into_owned();
                world.files.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    world
}
