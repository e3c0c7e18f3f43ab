//! What happens to artifacts and to the cache when the process is killed, the disk is full, files
//! are damaged, or two builds run at once.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Instant;

use super::project::{Project, Random, Run, finish};

type Files = BTreeMap<String, Vec<u8>>;

/// The artifacts of a project, built apart from it.
fn reference(project: &Project, arguments: &[&str]) -> Files {
    let all: Vec<&str> = ["build", "--no-cache", "--out", "reference"]
        .iter()
        .chain(arguments)
        .copied()
        .collect();
    project.succeed(&all);
    let files = project.files("reference");
    fs::remove_dir_all(project.path("reference")).unwrap();
    files
}

/// Artifacts without what a killed build left half written, which has a name that no artifact has.
fn artifacts(project: &Project) -> Files {
    let mut files = project.files("out");
    files.retain(|path, _| !path.rsplit('/').next().unwrap().starts_with(".fretwork-"));
    files
}

/// Kills builds at random moments. Each time the spec has changed, so that there is something to
/// write, and most times the cache holds what the build before managed to put there.
fn kill_builds(times: u64, mut random: Random) {
    let project = Project::small();
    project.edit("specs/spec.yaml", "cell_size: 9", "cell_size: 4");
    let specs = [2, 3].map(|n| {
        fs::read_to_string(project.path("specs/spec.yaml"))
            .unwrap()
            .replace("radius: 10", &format!("radius: 1{n}"))
            .replace("angle: 30", &format!("angle: {n}"))
    });
    let references: Vec<Files> = specs
        .iter()
        .map(|spec| {
            project.write("specs/spec.yaml", spec);
            reference(&project, &[])
        })
        .collect();
    let started = Instant::now();
    project.succeed(&["build"]);
    let whole = started.elapsed();
    for round in 0..times as usize {
        project.write("specs/spec.yaml", &specs[round % 2]);
        if round % 3 == 0 {
            fs::remove_dir_all(project.path(".fretwork")).unwrap();
        }
        let mut child = project
            .command(&["build"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        thread::sleep(whole.mul_f64(random.below(1200) as f64 / 1000.0));
        child.kill().unwrap();
        child.wait().unwrap();
        for (path, bytes) in artifacts(&project) {
            assert!(
                references.iter().any(|r| r.get(&path) == Some(&bytes)),
                "round {round}: {path} is torn"
            );
        }
        if round % 5 == 0 {
            assert!(
                project
                    .succeed(&["cache", "verify"])
                    .starts_with("0 damaged"),
                "round {round}"
            );
        }
        if round % 2 == 0 {
            project.succeed(&["build"]);
            assert_eq!(artifacts(&project), references[round % 2], "round {round}");
        }
    }
}

#[test]
fn killed_builds_leave_whole_artifacts() {
    kill_builds(15, Random(1));
}

#[test]
#[ignore = "a hundred kills, for a while by hand"]
fn a_hundred_killed_builds_leave_whole_artifacts() {
    kill_builds(100, Random(2));
}

/// The files of the cache, by kind of damage.
fn damage_every_file(stride: usize) {
    let project = Project::small();
    project.succeed(&["build"]);
    let expected = project.files("out");
    let cache = project.files(".fretwork");
    assert!(cache.len() > 15);
    let damages: [(&str, fn(&[u8]) -> Vec<u8>); 4] = [
        ("flipped", |bytes| {
            let mut bytes = bytes.to_vec();
            let middle = bytes.len() / 2;
            bytes
                .iter_mut()
                .skip(middle)
                .take(1)
                .for_each(|b| *b ^= 0x20);
            bytes
        }),
        ("cut", |bytes| bytes[..bytes.len() / 2].to_vec()),
        ("emptied", |_| Vec::new()),
        ("overwritten", |bytes| vec![b'{'; bytes.len() + 3]),
    ];
    for (i, path) in cache.keys().enumerate().filter(|(i, _)| i % stride == 0) {
        let (name, damage) = damages[i / stride % damages.len()];
        for (path, bytes) in &cache {
            project.write(&format!(".fretwork/{path}"), bytes);
        }
        project.write(&format!(".fretwork/{path}"), damage(&cache[path]));
        fs::remove_dir_all(project.path("out")).unwrap();
        let run = project.run(&["build"]);
        assert_eq!(run.code, Some(0), "{path} {name}: {}", run.stderr);
        assert!(
            !run.stderr.contains("warning"),
            "{path} {name}: {}",
            run.stderr
        );
        assert_eq!(project.files("out"), expected, "{path} {name}");
        project.succeed(&["build"]);
        assert_eq!(
            project.build(&[]).nodes("evaluated"),
            [""; 0],
            "{path} {name}: the damage lasts"
        );
    }
}

#[test]
fn a_damaged_cache_file_changes_no_artifact() {
    damage_every_file(1);
}

#[test]
fn a_cache_of_rubbish_changes_no_artifact() {
    let project = Project::small();
    let expected = reference(&project, &[]);
    project.succeed(&["build"]);
    for (i, path) in project.files(".fretwork").into_keys().enumerate() {
        project.write(&format!(".fretwork/{path}"), [i as u8; 7]);
    }
    fs::remove_dir_all(project.path("out")).unwrap();
    project.succeed(&["build"]);
    assert_eq!(project.files("out"), expected);
    // Folders where files are meant, and files where folders are.
    for path in project.files(".fretwork").into_keys().step_by(2) {
        fs::remove_file(project.path(&format!(".fretwork/{path}"))).unwrap();
        fs::create_dir(project.path(&format!(".fretwork/{path}"))).unwrap();
    }
    fs::remove_dir_all(project.path("out")).unwrap();
    assert_eq!(project.run(&["build"]).code, Some(0));
    assert_eq!(project.files("out"), expected);
    fs::remove_dir_all(project.path(".fretwork/v3/blobs")).unwrap();
    project.write(".fretwork/v3/blobs", "a file");
    project.edit("specs/spec.yaml", "radius: 10", "radius: 9");
    let run = project.run(&["build"]);
    assert_eq!(
        (
            run.code,
            run.stderr.matches("the cache cannot be written").count()
        ),
        (Some(0), 1),
        "{}",
        run.stderr
    );
}

#[test]
fn two_builds_at_once_give_what_each_alone_gives() {
    let project = Project::small();
    let sets = [&[][..], &["--set", "spacing=5"], &["--set", "size=50"]];
    let references: Vec<Files> = sets.iter().map(|set| reference(&project, set)).collect();
    let start = |arguments: &[&str]| {
        project
            .command(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    };
    for round in 0..8 {
        if round % 2 == 0 {
            let _ = fs::remove_dir_all(project.path(".fretwork"));
        }
        let mut children = Vec::new();
        for (i, set) in sets.iter().enumerate() {
            let out = format!("out-{i}");
            children.push(start(&[&["build", "--out", &out], *set].concat()));
            children.push(start(&["build", "--jobs", "2"]));
        }
        for child in children {
            let run = super::project::wait(child);
            assert_eq!(run.code, Some(0), "{}", run.stderr);
            assert!(!run.stderr.contains("warning"), "{}", run.stderr);
        }
        for (i, expected) in references.iter().enumerate() {
            assert_eq!(
                &project.files(&format!("out-{i}")),
                expected,
                "round {round}"
            );
        }
        assert_eq!(project.files("out"), references[0], "round {round}");
        assert!(
            project
                .succeed(&["cache", "verify"])
                .starts_with("0 damaged"),
            "round {round}"
        );
        fs::remove_dir_all(project.path("out")).unwrap();
    }
}

/// Runs a build that cannot write its artifacts; what was there must stay.
#[track_caller]
fn refuse(project: &Project, command: Command) -> Run {
    let before = artifacts(project);
    let run = finish(command);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert_eq!(
        run.stderr.matches("cannot write").count(),
        1,
        "{}",
        run.stderr
    );
    assert_eq!(artifacts(project), before);
    run
}

#[test]
fn an_output_folder_that_is_a_file_is_one_clear_error() {
    let project = Project::small();
    project.write("out", "a file");
    let run = refuse(&project, project.command(&["build"]));
    assert!(
        run.stderr.contains("out/spec") && run.stderr.contains("and 4 other artifacts"),
        "{}",
        run.stderr
    );
    assert_eq!(fs::read(project.path("out")).unwrap(), b"a file");
    refuse(
        &project,
        project.command(&["build", "--out", "fretwork.toml/below"]),
    );
}

#[test]
fn a_folder_in_the_place_of_an_artifact_is_one_clear_error() {
    let project = Project::small();
    project.write("out/spec/zig.svg/keep.txt", "x");
    let run = project.run(&["build"]);
    assert_eq!(
        (run.code, run.stderr.matches("cannot write").count()),
        (Some(1), 1),
        "{}",
        run.stderr
    );
    let mut expected = reference(&project, &[]);
    expected.remove("spec/zig.svg");
    expected.insert("spec/zig.svg/keep.txt".to_string(), b"x".to_vec());
    assert_eq!(project.files("out"), expected);
}

#[test]
fn a_cache_that_cannot_be_written_is_one_warning() {
    let project = Project::small();
    let expected = reference(&project, &[]);
    for folder in ["fretwork.toml", "fretwork.toml/below"] {
        let run = project.run(&["build", "--cache-dir", folder]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert_eq!(
            run.stderr.matches("the cache cannot be written").count(),
            1,
            "{}",
            run.stderr
        );
        assert!(run.stderr.contains("1 warning\n"), "{}", run.stderr);
        assert_eq!(project.files("out"), expected);
        assert_eq!(
            project
                .run(&["build", "--cache-dir", folder, "--deny", "warnings"])
                .code,
            Some(1)
        );
    }
    assert_eq!(fs::read(project.path("fretwork.toml")).unwrap(), b"");
}

/// A file system of 128 KiB mounted at a folder while it lives; none where that is not allowed.
struct Small<'a>(&'a Path);

impl Small<'_> {
    fn mount(folder: &Path) -> Option<Small<'_>> {
        fs::create_dir_all(folder).unwrap();
        let mut mount = Command::new("mount");
        mount
            .args(["-t", "tmpfs", "-o", "size=128k", "tmpfs"])
            .arg(folder)
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        mount
            .status()
            .is_ok_and(|status| status.success())
            .then_some(Small(folder))
    }
}

impl Drop for Small<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

#[test]
fn a_full_disk_is_one_clear_error() {
    let project = Project::small();
    let out = project.path("out");
    let Some(_disk) = Small::mount(&out) else {
        return;
    };
    project.succeed(&["build"]);
    project.write("out/ballast", vec![0; 90_000]);
    project.edit("specs/spec.yaml", "cell_size: 9", "cell_size: 1");
    let run = refuse(&project, project.command(&["build"]));
    assert!(run.stderr.contains("No space left"), "{}", run.stderr);
}

#[test]
#[cfg(unix)]
fn files_over_a_limit_of_the_system_are_one_clear_error() {
    let project = Project::small();
    project.succeed(&["build"]);
    project.edit("specs/spec.yaml", "cell_size: 9", "cell_size: 1");
    project.edit("specs/spec.yaml", "radius: 10", "radius: 9");
    let expected = artifacts(&project);
    let mut command = Command::new("sh");
    command
        .current_dir(project.path(""))
        .args(["-c", "trap '' XFSZ; ulimit -f 1; exec \"$0\" build"]);
    command.arg(env!("CARGO_BIN_EXE_fretwork"));
    let run = finish(command);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert_eq!(
        run.stderr.matches("cannot write").count(),
        1,
        "{}",
        run.stderr
    );
    assert_eq!(
        run.stderr.matches("the cache cannot be written").count(),
        1,
        "{}",
        run.stderr
    );
    for (path, bytes) in &expected {
        let now = fs::read(project.path(&format!("out/{path}"))).unwrap();
        assert!(now == *bytes || now.len() < 1024, "{path} is torn");
    }
    project.succeed(&["build"]);
    assert_eq!(artifacts(&project), reference(&project, &[]));
}

#[test]
fn two_builds_with_other_values_in_one_folder_leave_whole_artifacts() {
    let project = Project::small();
    let sets = ["size=50", "size=70"];
    let references: Vec<Files> = sets
        .iter()
        .map(|set| reference(&project, &["--set", set]))
        .collect();
    for round in 0..6 {
        let children = sets.map(|set| {
            project
                .command(&["build", "--set", set])
                .stdout(Stdio::piped())
                .stderr(Stdio::piped())
                .spawn()
                .unwrap()
        });
        for child in children {
            let run = super::project::wait(child);
            assert_eq!(run.code, Some(0), "{}", run.stderr);
        }
        for (path, bytes) in project.files("out") {
            assert!(
                references.iter().any(|r| r[&path] == bytes),
                "round {round}: {path}"
            );
        }
        fs::remove_dir_all(project.path(".fretwork")).unwrap();
    }
}

#[test]
fn long_chains_are_built_without_deep_recursion() {
    let n = 3000;
    let lets: String = (0..n)
        .map(|i| format!("  v{i:05}: \"${{v{:05} + 1}}\"\n", i + 1))
        .collect();
    let regions: String = (1..n)
        .map(|i| format!("  r{i}: {{ union: [r{}] }}\n", i - 1))
        .collect();
    let spec = format!(
        "fretwork: 1\nlet:\n{lets}  v{n:05}: 1\nregions:\n  r0: {{ rectangle: {{ width: \"${{v00000}}\", height: 3 }} }}\n{regions}artifacts:\n  a.json: {{ from: r{} }}\n",
        n - 1
    );
    let project = Project::of(&spec);
    for jobs in ["1", "3"] {
        project.succeed(&["build", "--no-cache", "--jobs", jobs]);
        assert!(String::from_utf8_lossy(&project.files("out")["spec/a.json"]).contains("9003"));
    }
}

#[test]
fn many_files_including_one_another_in_a_row_are_refused() {
    let project = Project::empty();
    for i in 0..200 {
        project.write(
            &format!("specs/{i}.yaml"),
            format!("fretwork: 1\ninclude: [{}.yaml]\n", i + 1),
        );
    }
    project.write("specs/200.yaml", "fretwork: 1\n");
    let run = project.run(&["check", "specs/0.yaml"]);
    assert_eq!(run.code, Some(1));
    assert!(
        run.stderr.contains("includes are nested more than"),
        "{}",
        run.stderr
    );
    assert_eq!(project.run(&["check", "specs/150.yaml"]).code, Some(0));
}
