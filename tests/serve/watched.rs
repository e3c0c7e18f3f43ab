//! A project that is watched and served: W1, W5, what is shown while a build fails, and what becomes of a project that goes.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead as _, BufReader};
use std::net::TcpListener;
use std::process::{Child, ChildStdout, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::super::project::{Project, finish};
use super::{Reply, ask};

/// A page of a project, ended when it is dropped.
pub struct Watched {
    pub project: Project,
    pub child: Child,
    pub port: u16,
    _stdout: BufReader<ChildStdout>,
}

impl Watched {
    pub fn new(project: Project) -> Watched {
        Watched::with(project, &[])
    }

    pub fn with(project: Project, arguments: &[&str]) -> Watched {
        let all = [&["watch", "--serve", "--port", "0"], arguments].concat();
        let mut child = project
            .command(&all)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut stdout = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        stdout.read_line(&mut line).unwrap();
        let address = line.strip_prefix("serving http://127.0.0.1:").unwrap();
        let port = address.trim_end().trim_end_matches('/').parse().unwrap();
        let watched = Watched {
            project,
            child,
            port,
            _stdout: stdout,
        };
        watched.until(|state| state["build"] != 0);
        watched
    }

    pub fn state(&self) -> Value {
        serde_json::from_str(&ask(self.port, "GET /state.json", &[], "").body).unwrap()
    }

    /// Waits for a state.
    #[track_caller]
    pub fn until(&self, is_reached: impl Fn(&Value) -> bool) -> Value {
        let started = Instant::now();
        loop {
            let state = self.state();
            if is_reached(&state) {
                return state;
            }
            assert!(started.elapsed() < Duration::from_secs(30), "{state:#}");
            sleep(Duration::from_millis(15));
        }
    }

    pub fn set(&self, body: &str) -> Reply {
        let origin = format!("Origin: http://127.0.0.1:{}", self.port);
        ask(
            self.port,
            "POST /set",
            &[&origin, "Content-Type: application/json"],
            body,
        )
    }

    /// The digests of the artifacts.
    pub fn digests(&self) -> BTreeMap<String, String> {
        digests(&self.state())
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub fn digests(state: &Value) -> BTreeMap<String, String> {
    let artifacts = state["artifacts"].as_array().unwrap().iter();
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    artifacts
        .map(|artifact| (text(&artifact["path"]), text(&artifact["blake3"])))
        .collect()
}

#[test]
fn the_state_tells_what_was_built() {
    let watched = Watched::new(Project::small());
    let state = watched.until(|state| state["artifacts"][0]["measures"].is_object());
    assert_eq!((&state["build"], &state["ok"]), (&1.into(), &true.into()));
    assert!(state["seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(state["specs"][0]["path"], "specs/spec.yaml");
    let spacing = &state["specs"][0]["params"][1];
    assert_eq!(
        (&spacing["name"], &spacing["value"]),
        (&"spacing".into(), &8.into())
    );
    let files = watched.project.files("out");
    assert_eq!(digests(&state).len(), files.len());
    for artifact in state["artifacts"].as_array().unwrap() {
        let (path, blake3) = (
            artifact["path"].as_str().unwrap(),
            artifact["blake3"].as_str(),
        );
        let bytes = &files[path];
        assert_eq!(
            blake3,
            Some(&*blake3::hash(bytes).to_hex().to_string()),
            "{path}"
        );
        assert_eq!(artifact["bytes"], bytes.len());
        assert_eq!(path.rsplit('.').next(), artifact["format"].as_str());
        let line = format!("GET /files/{path}?v={}", blake3.unwrap());
        let reply = ask(watched.port, &line, &[], "");
        assert_eq!(
            (reply.status, reply.body.as_bytes()),
            (200, &bytes[..]),
            "{path}"
        );
        let other = ask(watched.port, &format!("GET /files/{path}?v=00"), &[], "");
        assert_eq!(other.status, 404, "{path}");
    }
    assert_eq!(state["diagnostics"], serde_json::json!([]));
    assert_eq!(state["nodes"].as_array().unwrap().len(), 11);
    let edge = serde_json::json!({ "spec": "specs/spec.yaml", "from": "regions.page", "to": "regions.plate" });
    assert!(state["edges"].as_array().unwrap().contains(&edge));
    // What lies on the disk and is no artifact is not served.
    watched.project.write("out/spec/mine.svg", "<svg/>");
    for path in [
        "spec/mine.svg",
        ".fretwork-record",
        "../specs/spec.yaml",
        "specs/spec.yaml",
    ] {
        let status = ask(watched.port, &format!("GET /files/{path}"), &[], "").status;
        assert!([400, 404].contains(&status), "{path}");
    }
}

#[test]
fn edits_are_followed_and_the_last_good_files_stay_while_a_build_fails() {
    let watched = Watched::new(Project::small());
    let project = &watched.project;
    let first = watched.digests();
    // What is written in place may be read half written, which is a build of its own.
    let drawn_anew = |before: &str| {
        let state = watched
            .until(|state| state["ok"] == true && digests(state)["spec/plate.svg"] != before);
        digests(&state)["spec/plate.svg"].clone()
    };
    project.edit("specs/spec.yaml", "radius: 10", "radius: 12");
    let mut drawn = drawn_anew(&first["spec/plate.svg"]);
    // Many editors write a new file and move it over the old one; some put a new folder in its place.
    for radius in 13..16 {
        let text = fs::read_to_string(project.path("specs/spec.yaml")).unwrap();
        let text = text.replace(
            &format!("radius: {}", radius - 1),
            &format!("radius: {radius}"),
        );
        project.write("specs/.new", text);
        fs::rename(project.path("specs/.new"), project.path("specs/spec.yaml")).unwrap();
        drawn = drawn_anew(&drawn);
    }
    let good = watched.digests();
    project.edit("specs/spec.yaml", "radius: 15", "radius: wrong");
    let is_wrong = |state: &Value| {
        let excerpt = state["diagnostics"][0]["excerpt"].as_str();
        excerpt.is_some_and(|excerpt| excerpt.contains("radius: wrong"))
    };
    let state = watched.until(|state| state["ok"] == false && is_wrong(state));
    assert_eq!(digests(&state), good);
    let stale = state["artifacts"].as_array().unwrap().iter();
    assert!(
        stale.into_iter().all(|artifact| artifact["stale"] == true),
        "{state}"
    );
    let wrong = &state["diagnostics"][0];
    assert_eq!(wrong["file"], "specs/spec.yaml");
    assert!(wrong["code"].is_string() && wrong["line"].is_u64());
    let page = ask(watched.port, "GET /", &[], "").body;
    assert!(page.contains("data-diagnostic=") && page.contains("data-artifact=\"spec/plate.svg\""));
    project.edit("specs/spec.yaml", "radius: wrong", "radius: 10");
    let state = watched.until(|state| state["ok"] == true);
    assert_eq!(digests(&state), first);
}

#[test]
fn a_project_that_vanishes_and_comes_back_is_shown_again() {
    let mut watched = Watched::new(Project::small());
    let good = watched.digests();
    fs::rename(watched.project.path("specs"), watched.project.path("gone")).unwrap();
    let state = watched.until(|state| state["ok"] == false);
    assert_eq!(digests(&state), good);
    fs::rename(watched.project.path("gone"), watched.project.path("specs")).unwrap();
    let state = watched.until(|state| state["ok"] == true);
    assert_eq!(digests(&state), good);
    // The whole project goes, with all that it holds; while it does, a file may still be written there.
    let root = watched.project.path("");
    while fs::remove_dir_all(&root).is_err() && root.exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let state = watched.until(|state| state["ok"] == false);
    assert_eq!(digests(&state), good);
    assert_eq!(ask(watched.port, "GET /", &[], "").status, 200);
    assert!(watched.child.try_wait().unwrap().is_none(), "it has ended");
    assert!(!watched.project.path("").exists(), "it was made again");
}

#[test]
fn a_port_that_is_taken_is_told() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let project = Project::small();
    let run = project.run(&["watch", "--serve", "--port", &port]);
    assert_eq!((run.code, &*run.stdout), (Some(2), ""));
    assert!(run.stderr.contains(&port), "{}", run.stderr);
    assert!(!project.path("out").exists());
}

#[test]
fn options_of_the_page_need_the_page() {
    let project = Project::small();
    for arguments in [
        &["watch", "--port", "0"][..],
        &["watch", "--open"],
        &["watch", "--allow-host", "a"],
        &["watch", "--serve", "--port", "65536"],
        &["watch", "--serve", "--allow-host", ""],
        &["watch", "--serve", "--allow-host", "http://a"],
        &["watch", "--serve", "--allow-host", "a:b"],
        &["build", "--serve"],
    ] {
        let run = finish(project.command(arguments));
        assert_eq!(run.code, Some(2), "{arguments:?}: {}", run.stderr);
    }
}

#[test]
#[cfg(unix)]
fn an_interrupt_ends_it_at_once() {
    use std::os::unix::process::ExitStatusExt as _;
    let mut watched = Watched::new(Project::small());
    let id = watched.child.id().to_string();
    let started = Instant::now();
    let (signal, number) = if ignores_interrupts() {
        ("-TERM", 15)
    } else {
        ("-INT", 2)
    };
    let killed = std::process::Command::new("kill")
        .args([signal, &id])
        .status();
    assert!(killed.unwrap().success());
    let status = watched.child.wait().unwrap();
    assert!(started.elapsed() < Duration::from_secs(2));
    assert_eq!(status.signal(), Some(number));
}

/// Whether interrupts are ignored, as shells have it for what runs in the background; children take it over.
#[cfg(unix)]
fn ignores_interrupts() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask & 2 != 0)
}
