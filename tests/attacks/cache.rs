//! A cache is believed only as far as it proves itself.

use std::fs;
#[cfg(unix)]
use std::os::unix::fs::symlink;
use std::path::PathBuf;
use std::process::Command;

use super::super::project::{Project, Random};

/// The files of the cache of a project.
fn entries(project: &Project) -> Vec<PathBuf> {
    let paths = project.files(".fretwork/v3").into_keys();
    paths
        .map(|path| project.path(&format!(".fretwork/v3/{path}")))
        .collect()
}

/// Does something to the entry `one`, sometimes with the help of `two`.
fn harm(kind: u64, one: &PathBuf, two: &PathBuf, random: &mut Random) {
    let bytes = fs::read(one).unwrap();
    match kind {
        0 => {
            let other = fs::read(two).unwrap();
            fs::write(two, &bytes).unwrap();
            fs::write(one, other).unwrap();
        }
        1 => drop(fs::copy(two, one).unwrap()),
        2 => {
            let mut bytes = bytes;
            if !bytes.is_empty() {
                let at = random.below(bytes.len() as u64) as usize;
                bytes[at] ^= 1 << random.below(8);
            }
            fs::write(one, bytes).unwrap();
        }
        3 => fs::write(one, &bytes[..random.below(bytes.len() as u64 + 1) as usize]).unwrap(),
        4 => fs::remove_file(one).unwrap(),
        5 => {
            fs::remove_file(one).unwrap();
            fs::create_dir(one).unwrap();
            fs::write(one.join("file"), "x").unwrap();
        }
        _ =>
        {
            #[cfg(unix)]
            if one != two {
                fs::remove_file(one).unwrap();
                symlink(two, one).unwrap();
            }
        }
    }
}

/// Whatever becomes of the entries of a cache, the artifacts stay right, and so does what is built
/// with it after that.
fn harm_entries(rounds: u64, mut random: Random) {
    let project = Project::small();
    project.succeed(&["build"]);
    let expected = project.files("out");
    for round in 0..rounds {
        let known = entries(&project);
        let mut done = Vec::new();
        for _ in 0..=random.below(3) {
            let [one, two] = [0; 2].map(|_| &known[random.below(known.len() as u64) as usize]);
            // What is no file any more was harmed before.
            if one.is_file() && two.is_file() && !one.is_symlink() {
                let kind = random.below(7);
                harm(kind, one, two, &mut random);
                done.push((kind, one.clone()));
            }
        }
        fs::remove_dir_all(project.path("out")).unwrap();
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(0), "round {round}: {done:?}: {}", run.stderr);
        assert!(project.files("out") == expected, "round {round}: {done:?}");
    }
    project.succeed(&["build", "--locked"]);
}

#[test]
fn harmed_entries_change_no_artifact() {
    harm_entries(200, Random(7));
}

#[test]
#[ignore = "5,000 rounds, for a while by hand"]
fn five_thousand_harmed_caches_change_no_artifact() {
    harm_entries(5000, Random(8));
}

#[test]
fn swapped_actions_are_found_and_computed_anew() {
    let project = Project::small();
    project.succeed(&["build"]);
    let expected = project.files("out");
    let folder = project.path(".fretwork/v3/actions");
    let mut actions: Vec<PathBuf> = fs::read_dir(&folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    actions.sort();
    let bytes: Vec<Vec<u8>> = actions.iter().map(|path| fs::read(path).unwrap()).collect();
    for (n, path) in actions.iter().enumerate() {
        fs::write(path, &bytes[(n + 1) % bytes.len()]).unwrap();
    }
    fs::remove_dir_all(project.path("out")).unwrap();
    let report = project.build(&[]);
    assert_eq!(report.nodes("cached"), [""; 0]);
    assert_eq!(project.files("out"), expected);
    for (n, path) in actions.iter().enumerate() {
        fs::write(path, &bytes[(n + 1) % bytes.len()]).unwrap();
    }
    assert!(
        project
            .succeed(&["cache", "verify"])
            .starts_with(&format!("{} damaged", actions.len()))
    );
}

#[test]
fn a_locked_build_does_not_ask_the_cache() {
    let project = Project::small();
    project.succeed(&["build"]);
    let report = project.build(&["--locked"]);
    assert_eq!(
        report.nodes("cached"),
        [""; 0],
        "nothing but the files says what is right"
    );
    project.succeed(&["build", "--lock"]);
    let report = project.build(&["--locked"]);
    assert_eq!(
        report.nodes("evaluated"),
        [""; 0],
        "the lock says what is right"
    );
}

#[test]
#[cfg(unix)]
fn a_cache_that_is_a_link_is_told_and_not_used() {
    let elsewhere = tempfile::tempdir().unwrap();
    let project = Project::small();
    symlink(elsewhere.path(), project.path(".fretwork")).unwrap();
    for arguments in [&["build"][..], &["build", "--cache-dir", ".fretwork"]] {
        let run = project.run(arguments);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(
            run.stderr.contains("the cache is not used") && run.stderr.contains("symbolic link"),
            "{}",
            run.stderr
        );
    }
    assert_eq!(project.run(&["cache", "gc", "--keep", "0"]).code, Some(2));
    assert_eq!(fs::read_dir(elsewhere.path()).unwrap().count(), 0);
}

#[test]
fn a_cache_under_version_control_is_told_and_not_used() {
    let project = Project::small();
    let git = |arguments: &[&str]| {
        let mut command = Command::new("git");
        command.args(arguments).current_dir(project.path(""));
        command.output().is_ok_and(|output| output.status.success())
    };
    if !git(&["init", "-q"]) {
        return;
    }
    project.succeed(&["build"]);
    assert!(git(&["add", "specs"]));
    assert!(!project.run(&["build"]).stderr.contains("not used"));
    assert!(git(&["add", "-f", ".fretwork"]));
    let run = project.run(&["build"]);
    assert!(
        run.stderr.contains("the cache is not used") && run.stderr.contains("version control"),
        "{}",
        run.stderr
    );
}

#[test]
fn the_cache_keeps_its_size_by_itself() {
    let project = Project::small();
    let build = |size: &str, radius: u32| {
        let text = fs::read_to_string(project.path("specs/spec.yaml")).unwrap();
        let from = text.find("radius: ").unwrap();
        let end = from + text[from..].find(',').unwrap();
        project.write(
            "specs/spec.yaml",
            format!("{}radius: {radius}{}", &text[..from], &text[end..]),
        );
        let mut command = project.command(&["build"]);
        command.env("FRETWORK_CACHE_SIZE", size);
        super::super::project::finish(command)
    };
    let size = || -> u64 {
        project
            .files(".fretwork/v3")
            .values()
            .map(|bytes| bytes.len() as u64)
            .sum()
    };
    for radius in 5..15 {
        assert_eq!(build("60KB", radius).code, Some(0));
        assert!(size() < 61_000, "{}", size());
    }
    assert!(size() > 20_000, "{}", size());
    assert_eq!(build("0", 5).code, Some(0));
    assert!(size() < 100);
    let run = build("many", 5);
    assert!(
        run.code == Some(2) && run.stderr.contains("FRETWORK_CACHE_SIZE=many"),
        "{}",
        run.stderr
    );
}
