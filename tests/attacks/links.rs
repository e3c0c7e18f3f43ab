//! Whatever links a project brings along, nothing outside of its output folder changes.

#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use super::super::project::{Project, RECORD, Random};

/// Everything below `folder` but what lies in `without`: files by their bytes, links by their
/// targets.
fn everything(folder: &Path, without: &[PathBuf]) -> BTreeMap<PathBuf, Vec<u8>> {
    let (mut found, mut open) = (BTreeMap::new(), vec![folder.to_path_buf()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let meta = fs::symlink_metadata(&path).unwrap();
            if meta.is_symlink() {
                let target = fs::read_link(&path).unwrap();
                found.insert(path, target.to_string_lossy().into_owned().into_bytes());
            } else if without.contains(&path) {
                // It may change, as long as it is no link.
            } else if meta.is_dir() {
                found.insert(path.clone(), Vec::new());
                open.push(path);
            } else {
                found.insert(path.clone(), fs::read(path).unwrap());
            }
        }
    }
    found
}

const NAMES: [&str; 6] = ["a", "b", "a.svg", "b.json", "p", "c.dxf"];

fn name(random: &mut Random) -> String {
    let parts = 1 + random.below(3);
    let parts: Vec<&str> = (0..parts)
        .map(|_| NAMES[random.below(6) as usize])
        .collect();
    parts.join("/")
}

/// A tree of folders, files and links below `folder`, which lead back into the project, to `outside`
/// and nowhere.
fn grow(folder: &Path, outside: &Path, random: &mut Random) {
    for _ in 0..random.below(7) {
        let path = folder.join(name(random));
        if fs::create_dir_all(path.parent().unwrap()).is_err() {
            continue;
        }
        // What is there already stays: the names are few.
        let _ = match random.below(4) {
            0 => fs::create_dir_all(&path),
            1 if !path.exists() && !path.is_symlink() => fs::write(&path, "mine"),
            1 => Ok(()),
            _ => {
                let outside = outside.display().to_string();
                let targets = [
                    "..",
                    ".",
                    "../..",
                    "../specs",
                    "nowhere",
                    &outside,
                    "../../specs",
                    "/dev/null",
                ];
                symlink(targets[random.below(8) as usize], &path)
            }
        };
    }
}

fn spec(random: &mut Random) -> String {
    let mut spec =
        "fretwork: 1\nregions: { page: { rectangle: { width: 5, height: 5 } } }\nartifacts:\n"
            .to_string();
    let mut names: Vec<String> = (0..1 + random.below(3))
        .map(|_| name(random))
        .map(|name| {
            if name.contains('.') {
                name
            } else {
                name + ".svg"
            }
        })
        .collect();
    names.sort();
    names.dedup();
    for name in names {
        spec += &format!("  \"{name}\": {{ from: page }}\n");
    }
    spec
}

/// A record that claims all files of the tests as written.
fn forged(random: &mut Random) -> String {
    let mut text =
        "\"fretwork record 1: what builds have written here; only this is pruned\"\n".to_string();
    let digest = blake3::hash(b"mine").to_hex();
    for _ in 0..random.below(12) {
        let up = ["", "../", "/", "p/../../"][random.below(4) as usize];
        text += &format!(
            "[\"{up}{}\",\"specs/p.yaml\",[\"{digest}\"]]\n",
            name(random)
        );
    }
    text
}

#[test]
fn links_lead_nothing_out_of_the_output_folder() {
    let mut random = Random(11);
    for round in 0..60 {
        let outside = tempfile::tempdir().unwrap();
        for path in ["a.svg", "p/a.svg", "a/b.json", "p/a/c.dxf", "b"] {
            let path = outside.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "mine").unwrap();
        }
        let project = Project::empty();
        project.write("specs/p.yaml", spec(&mut random));
        project.write("specs/a.svg", "mine");
        if random.below(8) == 0 {
            symlink(outside.path(), project.path("out")).unwrap();
        } else {
            fs::create_dir(project.path("out")).unwrap();
            grow(&project.path("out"), outside.path(), &mut random);
            let _ = fs::create_dir(project.path("out/p"));
            if project.path("out/p").is_dir() && !project.path("out/p").is_symlink() {
                grow(&project.path("out/p"), outside.path(), &mut random);
            }
            if random.below(2) == 0 {
                project.write(&format!("out/{RECORD}"), forged(&mut random));
            }
        }
        let trace = format!("out/{}", name(&mut random));
        let root = fs::canonicalize(project.path("")).unwrap();
        let without = ["out", ".fretwork", "fretwork.lock"].map(|name| root.join(name));
        let before = (everything(&root, &without), everything(outside.path(), &[]));
        let commands = [
            &["build", "--prune"][..],
            &["build", "--overwrite", "--prune", "--out", "out"],
            &["build", "--timings", &trace],
            &["build", "specs/p.yaml", "--out", "out/p", "--prune"],
            &["build", "--locked"],
        ];
        for arguments in commands {
            project.write("specs/p.yaml", before.0[&root.join("specs/p.yaml")].clone());
            let run = project.run(arguments);
            assert!(
                matches!(run.code, Some(0..=2)),
                "round {round}: {arguments:?}: {}",
                run.stderr
            );
            let after = (everything(&root, &without), everything(outside.path(), &[]));
            assert_eq!(
                after, before,
                "round {round}: {arguments:?}: {}",
                run.stderr
            );
        }
    }
}
