//! Many, long and hostile names in messages.

use std::fmt::Write as _;
use std::time::Instant;

use super::super::project::Project;

/// A spec with as many regions, each of which names what is not there.
fn flood(count: usize) -> String {
    let mut spec = "fretwork: 1\nregions:\n".to_string();
    for i in 0..count {
        writeln!(spec, "  q{i}: {{ union: [zz{i}x] }}").unwrap();
    }
    spec + "artifacts: { o.svg: { from: q1 } }\n"
}

#[test]
fn many_errors_are_counted() {
    let project = Project::of(&flood(1000));
    let run = project.run(&["check"]);
    assert_eq!(run.code, Some(1));
    assert!(run.stderr.len() < 100_000, "{}", run.stderr.len());
    assert!(
        run.stderr.contains("more are not shown\n"),
        "{}",
        &run.stderr[run.stderr.len() - 200..]
    );
    for command in ["check", "build"] {
        let run = project.run(&[command, "--format", "json"]);
        let report: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(report["errors"].as_array().unwrap().len(), 100);
        assert!(report["omitted"].as_u64().unwrap() >= 900, "{report}");
    }
}

#[test]
#[ignore = "a measure of time, by hand on a machine that does nothing else"]
fn the_time_for_errors_grows_with_their_number() {
    let time = |count| {
        let project = Project::of(&flood(count));
        let started = Instant::now();
        project.run(&["check"]);
        started.elapsed().as_secs_f64()
    };
    let (some, many) = (time(1000), time(8000));
    assert!(many < 16.0 * some, "{some} s, {many} s");
}

#[test]
fn long_names_are_shortened() {
    let long = "b".repeat(1_000_000);
    for spec in [
        format!(
            "fretwork: 1\nregions:\n  page: {{ union: [\"{long}\"] }}\nartifacts: {{ o.svg: {{ from: page }} }}\n"
        ),
        format!(
            "fretwork: 1\nexemplars:\n  e: {{ vector: {{ file: \"{long}\" }} }}\nartifacts: {{ o.svg: {{ from: e }} }}\n"
        ),
        format!("fretwork: 1\n{long}: {{}}\n"),
        format!("fretwork: 1\nregions: {{ page: {{ {long}: {{}} }} }}\n"),
    ] {
        let project = Project::of(&spec);
        for arguments in [&["check"][..], &["check", "--format", "json"]] {
            let run = project.run(arguments);
            assert_eq!(run.code, Some(1));
            let length = run.stderr.len() + run.stdout.len();
            assert!(length < 20_000, "{length} bytes");
        }
    }
}

#[test]
fn names_command_neither_terminal_nor_log() {
    let project = Project::of(
        "fretwork: 1\nregions: { page: { union: [\"x\\n::error::forged\\e[2J\\u202Eo\"] } }\nartifacts: { o.svg: { from: page } }\n",
    );
    #[cfg(unix)]
    project.write(
        "specs/b\n::error file=x::forged\u{1b}[2J.yaml",
        "fretwork: 1\nregions: { page: 3 }\n",
    );
    for arguments in [
        &["check"][..],
        &["build"],
        &["build", "specs/none\n::error::forged.yaml"],
    ] {
        let run = project.run(arguments);
        let text = run.stdout + &run.stderr;
        assert!(text.contains("forged"), "{text}");
        for line in text.lines() {
            assert!(!line.trim_start().starts_with("::error"), "{text}");
        }
        assert!(!text.contains(['\u{1b}', '\u{202e}']), "{text:?}");
    }
}
