//! The page in a browser: that it is drawn, follows edits and controls, keeps what a reader has set up, and that a report
//! needs nothing but itself. A target of its own, since it needs Chromium and the package `playwright-core` for Node;
//! where one is missing, it says so and is skipped. `.ci/run` installs both.

// A test that cannot go on has failed.
#![allow(clippy::unwrap_used)]
// Tests read and write files.
#![allow(clippy::disallowed_methods)]

#[allow(dead_code, reason = "another target uses the rest")]
#[path = "project.rs"]
mod project;

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use project::Project;

const SPEC: &str = r#"fretwork: 1
params:
  size: { default: 60, type: length, min: 20, max: 200, doc: "side of the plate" }
  turns: { default: 3, type: integer, min: 1, max: 9 }
  paper: { default: plain, type: text, choices: [plain, lined] }
  label: { default: "a", type: text }
regions:
  page: { rectangle: { width: "${size}", height: "${size}" } }
  hole: { circle: { radius: 10, at: [20, 20] } }
  plate: { difference: [page, hole] }
solids:
  block: { extrude: { region: plate, height: "${turns * 4}" } }
artifacts:
  plate.svg: { from: plate }
  "note-${paper}-${label}.json": { from: page }
  block.stl: { from: block }
  block.json: { from: block }
"#;

/// The programs that the test needs, or what is missing.
struct Browser {
    chromium: PathBuf,
    packages: PathBuf,
}

impl Browser {
    fn find() -> Result<Browser, &'static str> {
        let runs = |program: &str| {
            let mut command = Command::new(program);
            let run = command.arg("--version").stdout(Stdio::null()).status();
            run.is_ok_and(|status| status.success())
        };
        if !runs("node") {
            return Err("node");
        }
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let packages = root.join("target/browser/node_modules");
        if !packages.join("playwright-core").is_dir() {
            return Err("playwright-core below target/browser");
        }
        let folders = std::env::var_os("PATH").unwrap_or_default();
        let mut places = std::env::split_paths(&folders).flat_map(|folder| {
            ["chromium", "chromium-browser", "google-chrome"].map(|name| folder.join(name))
        });
        let chromium = places.find(|place| place.is_file()).ok_or("chromium")?;
        Ok(Browser { chromium, packages })
    }

    /// Runs a part of the script and shows what it says.
    fn run(&self, part: &str, arguments: &[&str]) {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/page.mjs");
        let output = Command::new("node")
            .arg(script)
            .args([
                part.as_ref(),
                self.packages.as_os_str(),
                self.chromium.as_os_str(),
            ])
            .args(arguments)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        println!("{said}");
        let wrong = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}\n{wrong}");
    }
}

/// The browser, or none and a message.
fn browser() -> Option<Browser> {
    let found = Browser::find();
    found
        .map_err(|missing| println!("skipped: there is no {missing}"))
        .ok()
}

#[test]
fn the_page_follows_edits_and_controls_and_keeps_the_view() {
    let Some(browser) = browser() else { return };
    let project = Project::of(SPEC);
    let mut child = project
        .command(&["watch", "--serve", "--port", "0"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut stdout = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    stdout.read_line(&mut line).unwrap();
    let address = line.trim().trim_start_matches("serving ").to_owned();
    let folder = project.path("").display().to_string();
    let result = std::panic::catch_unwind(|| browser.run("live", &[&address, &folder]));
    child.kill().unwrap();
    child.wait().unwrap();
    result.unwrap();
}

#[test]
fn a_report_needs_nothing_but_itself() {
    let Some(browser) = browser() else { return };
    let project = Project::of(SPEC);
    project.succeed(&["report"]);
    let path = project.path("out/report.html").display().to_string();
    browser.run("report", &[&path]);
}
