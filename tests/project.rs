//! A project in a temporary folder, and the binary run in it.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

/// No run of a test takes as long as this; one that does hangs.
const DEADLINE: Duration = Duration::from_secs(60);

/// A small spec with a node of every kind that the tests of the whole need: values that follow
/// from others, a drawing, a random partition, five artifacts in three formats.
pub const SPEC: &str = r#"fretwork: 1
seed: 3
params:
  size: 60
  spacing: { default: 8, type: length, min: 2, max: 20, doc: "between lines" }
let: { half: "${size / 2}" }
regions:
  page: { rectangle: { width: "${size}", height: "${size}" } }
  hole: { circle: { radius: 10, at: ["${half}", "${half}"] } }
  plate: { difference: [page, hole] }
exemplars:
  zig: { vector: { file: assets/zig.svg } }
partitions:
  rows: { stripes: { angle: 30, spacing: "${spacing}" } }
  cells: { uniform: { cell_size: 9 } }
artifacts:
  plate.svg: { from: plate }
  rows.svg: { from: rows, region: plate, stroke: 0.4 }
  cells.dxf: { from: cells, region: page }
  zig.svg: { from: zig }
  cells.json: { from: cells, region: page }
"#;

/// The record of what builds have written, which stands in each output folder.
pub const RECORD: &str = ".fretwork-record";

/// The drawing that [`SPEC`] names.
pub const ZIG: &str = r#"<svg xmlns="http://www.w3.org/2000/svg" width="10mm" height="4mm" viewBox="0 0 10 4">
  <path d="M0 2 L3 0 L7 4 L10 2" fill="none" stroke="black"/>
</svg>
"#;

/// A project with a root marker. Removed when dropped.
pub struct Project {
    folder: tempfile::TempDir,
}

/// What a run of the binary gave.
#[derive(Debug)]
pub struct Run {
    /// The exit code; none when a signal ended it.
    pub code: Option<i32>,
    /// Its standard output.
    pub stdout: String,
    /// Its standard error.
    pub stderr: String,
    /// The lines of its standard error that say what it was doing: how many depends on how busy the machine is.
    pub progress: Vec<String>,
}

impl Project {
    /// A project without any other file.
    pub fn empty() -> Project {
        let project = Project {
            folder: tempfile::tempdir().unwrap(),
        };
        project.write("fretwork.toml", "");
        project
    }

    /// A project with [`SPEC`] as `specs/spec.yaml`.
    pub fn small() -> Project {
        let project = Project::empty();
        project.write("specs/spec.yaml", SPEC);
        project.write("specs/assets/zig.svg", ZIG);
        project
    }

    /// A project with `text` as `specs/spec.yaml`.
    pub fn of(text: &str) -> Project {
        let project = Project::empty();
        project.write("specs/spec.yaml", text);
        project
    }

    /// The absolute path of a file of the project.
    pub fn path(&self, path: &str) -> PathBuf {
        self.folder.path().join(path)
    }

    /// Writes a file and the folders that it needs.
    pub fn write(&self, path: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    /// Replaces `from`, which must occur, by `to` in a file.
    pub fn edit(&self, path: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(path)).unwrap();
        assert!(text.contains(from), "`{from}` is not in {path}");
        self.write(path, text.replacen(from, to, 1));
    }

    /// All files below a folder by their paths in it, without the record of builds and links that lead
    /// nowhere; nothing where there is none.
    pub fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = BTreeMap::new();
        collect(&self.path(folder), String::new(), &mut files);
        files
    }

    /// The binary, to be run in the project's folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwork"));
        command
            .args(arguments)
            .current_dir(self.folder.path())
            .stdin(Stdio::null());
        command
            .env_remove("FRETWORK_CHECK")
            .env_remove("FRETWORK_CACHE_SIZE")
            .env_remove("SOURCE_DATE_EPOCH");
        command
    }

    /// Runs the binary.
    pub fn run(&self, arguments: &[&str]) -> Run {
        finish(self.command(arguments))
    }

    /// Runs the binary, which must succeed, and gives its standard output.
    #[track_caller]
    pub fn succeed(&self, arguments: &[&str]) -> String {
        let run = self.run(arguments);
        assert_eq!(
            run.code,
            Some(0),
            "{arguments:?}: {}{}",
            run.stdout,
            run.stderr
        );
        run.stdout
    }

    /// Builds with `--format json` and the given arguments, and gives what was printed.
    #[track_caller]
    pub fn build(&self, arguments: &[&str]) -> Report {
        let all: Vec<&str> = ["build", "--format", "json"]
            .iter()
            .chain(arguments)
            .copied()
            .collect();
        Report(serde_json::from_str(&self.succeed(&all)).unwrap())
    }
}

/// A sequence of numbers that looks random.
pub struct Random(pub u64);

impl Random {
    /// A number below `end`.
    pub fn below(&mut self, end: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }
}

/// Runs a command to its end.
pub fn finish(mut command: Command) -> Run {
    let child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    wait(child)
}

/// Waits for a process whose outputs are pipes, but not for ever.
pub fn wait(mut child: Child) -> Run {
    let reader = |pipe: Option<Box<dyn Read + Send>>| {
        thread::spawn(move || {
            let mut bytes = Vec::new();
            pipe.into_iter().for_each(|mut p| {
                p.read_to_end(&mut bytes).unwrap();
            });
            String::from_utf8_lossy(&bytes).into_owned()
        })
    };
    let stdout = reader(child.stdout.take().map(|p| Box::new(p) as _));
    let stderr = reader(child.stderr.take().map(|p| Box::new(p) as _));
    let status = end(&mut child).unwrap_or_else(|| {
        child.kill().unwrap();
        child.wait().unwrap();
        panic!("the process hangs");
    });
    let said = stderr.join().unwrap();
    let (progress, stderr): (Vec<&str>, Vec<&str>) = said
        .split_inclusive('\n')
        .partition(|line| line.starts_with("… "));
    Run {
        code: status.code(),
        stdout: stdout.join().unwrap(),
        stderr: stderr.concat(),
        progress: progress.into_iter().map(str::to_owned).collect(),
    }
}

fn end(child: &mut Child) -> Option<ExitStatus> {
    let started = Instant::now();
    while started.elapsed() < DEADLINE {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status);
        }
        thread::sleep(Duration::from_millis(1));
    }
    None
}

/// The output of `build --format json`.
pub struct Report(pub Value);

impl Report {
    /// The nodes with this status, as `section.name`.
    pub fn nodes(&self, status: &str) -> Vec<String> {
        let nodes = self.0["nodes"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|n| n["status"] == status);
        nodes
            .map(|n| {
                format!(
                    "{}.{}",
                    n["section"].as_str().unwrap(),
                    n["name"].as_str().unwrap()
                )
            })
            .collect()
    }

    /// The paths of the artifacts with this status.
    pub fn artifacts(&self, status: &str) -> Vec<String> {
        let artifacts = self.0["artifacts"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|a| a["status"] == status);
        artifacts
            .map(|a| a["path"].as_str().unwrap().to_string())
            .collect()
    }
}

/// Copies a folder with all that is in it.
pub fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

fn collect(folder: &Path, prefix: String, files: &mut BTreeMap<String, Vec<u8>>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            collect(&entry.path(), name + "/", files);
        } else if !name.ends_with(RECORD) && entry.path().exists() {
            files.insert(name, fs::read(entry.path()).unwrap());
        }
    }
}
