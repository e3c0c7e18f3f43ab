//! Git, asked as a program: commits, what is in their trees, the bytes of files. Nothing is checked out, fetched or
//! written.

use std::collections::BTreeMap;
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Output, Stdio};
use std::sync::{Mutex, PoisonError};

use super::super::terminal::Failure;
use fretwork_engine::{FILE_LIMIT, ReadError};

/// The repository that a project lies in.
#[derive(Clone, Debug)]
pub struct Repository {
    root: PathBuf,
    is_shallow: bool,
}

/// What stands at a path of a tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What it is.
    pub kind: Kind,
    /// The name of its object.
    pub id: String,
}

/// The sorts of entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A file.
    File,
    /// A symbolic link; its object holds the path that it leads to.
    Link,
    /// A commit of another repository.
    Submodule,
}

impl Repository {
    /// The repository of the project at `root`.
    ///
    /// # Errors
    /// When there is no git, or no repository.
    pub fn of(root: &Path) -> Result<Repository, Failure> {
        let repository = Repository {
            root: root.to_path_buf(),
            is_shallow: false,
        };
        let told = repository.ask(&["rev-parse", "--is-shallow-repository"])?;
        if !told.status.success() {
            let why = first_line(&told.stderr);
            let root = root.display();
            return Err(Failure::usage(format!(
                "`{root}` lies in no git repository: {why}"
            )));
        }
        Ok(Repository {
            is_shallow: told.stdout.starts_with(b"true"),
            ..repository
        })
    }

    /// The name of the commit that `rev` means.
    ///
    /// # Errors
    /// When it means none.
    pub fn commit(&self, rev: &str) -> Result<String, Failure> {
        let wanted = format!("{rev}^{{commit}}");
        let arguments = ["rev-parse", "--verify", "--quiet", "--end-of-options"];
        let told = self.ask(&[&arguments[..], &[&wanted]].concat())?;
        let name = first_line(&told.stdout);
        let is_name = name.len() >= 40 && name.bytes().all(|b| b.is_ascii_hexdigit());
        if told.status.success() && is_name {
            return Ok(name);
        }
        let advice = if self.is_shallow {
            "; the clone is shallow: fetch more of its history, as with `git fetch --unshallow`"
        } else {
            ""
        };
        Err(Failure::usage(format!(
            "there is no revision `{rev}` in this repository{advice}"
        )))
    }

    /// What is in the tree of a commit below the project's root, by paths from there. Names that are not UTF-8 are left out.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn tree(&self, commit: &str) -> Result<BTreeMap<String, Entry>, Failure> {
        let told = self.ask(&["ls-tree", "-r", "-z", commit])?;
        if !told.status.success() {
            let why = first_line(&told.stderr);
            return Err(Failure::usage(format!("git cannot read `{commit}`: {why}")));
        }
        let lines = told.stdout.split(|b| *b == 0);
        Ok(lines.filter_map(entry).collect())
    }

    /// The objects of the repository.
    pub fn objects(&self) -> Objects {
        Objects {
            root: self.root.clone(),
            batch: Mutex::new(None),
        }
    }

    fn ask(&self, arguments: &[&str]) -> Result<Output, Failure> {
        let told = command(&self.root).args(arguments).output();
        told.map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => {
                Failure::usage("`git` is needed for this, and is not installed or not in the PATH")
            }
            _ => Failure::usage(format!("git cannot be run: {error}")),
        })
    }
}

/// A command of git that asks nobody, fetches nothing and writes nothing.
fn command(root: &Path) -> Command {
    let mut command = Command::new("git");
    command
        .arg("-C")
        .arg(root)
        .arg("--no-replace-objects")
        .env("GIT_OPTIONAL_LOCKS", "0")
        .env("GIT_NO_LAZY_FETCH", "1")
        .env("GIT_TERMINAL_PROMPT", "0")
        .stdin(Stdio::null());
    command
}

fn first_line(text: &[u8]) -> String {
    let line = text.split(|b| *b == b'\n').next().unwrap_or_default();
    String::from_utf8_lossy(line).trim().to_string()
}

/// A line of a tree: `MODE TYPE OBJECT\tPATH`.
fn entry(line: &[u8]) -> Option<(String, Entry)> {
    let (head, path) = std::str::from_utf8(line).ok()?.split_once('\t')?;
    let [mode, kind, id] = *head.split(' ').collect::<Vec<_>>() else {
        return None;
    };
    let kind = match (kind, mode) {
        ("commit", _) => Kind::Submodule,
        (_, "120000") => Kind::Link,
        _ => Kind::File,
    };
    let id = id.to_string();
    Some((path.to_string(), Entry { kind, id }))
}

/// The objects of a repository, read through one process that is started when it is first needed.
pub struct Objects {
    root: PathBuf,
    batch: Mutex<Option<Batch>>,
}

impl Objects {
    /// The bytes of an object.
    ///
    /// # Errors
    /// When it is missing or too large, or git fails.
    pub fn read(&self, id: &str) -> Result<Vec<u8>, ReadError> {
        let mut batch = self.batch.lock().unwrap_or_else(PoisonError::into_inner);
        let running = match batch.take() {
            Some(running) => running,
            None => Batch::start(&self.root).map_err(failed)?,
        };
        let running = batch.insert(running);
        match running.read(id) {
            Ok(Some(bytes)) => Ok(bytes),
            Ok(None) => Err(ReadError::Io("git does not have it here".to_string())),
            Err(error) => {
                // What is still to be read of an answer is of no use to the next question.
                *batch = None;
                Err(error)
            }
        }
    }
}

fn failed(error: io::Error) -> ReadError {
    ReadError::Io(format!("git cannot be asked for it: {error}"))
}

/// A running `git cat-file --batch`.
struct Batch {
    process: Child,
    questions: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Batch {
    fn start(root: &Path) -> io::Result<Batch> {
        let mut process = command(root)
            .args(["cat-file", "--batch"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let lost = || io::Error::other("it has no pipes");
        Ok(Batch {
            questions: process.stdin.take().ok_or_else(lost)?,
            answers: BufReader::new(process.stdout.take().ok_or_else(lost)?),
            process,
        })
    }

    /// The bytes of an object; none where it is missing.
    fn read(&mut self, id: &str) -> Result<Option<Vec<u8>>, ReadError> {
        let asked = writeln!(self.questions, "{id}").and_then(|()| self.questions.flush());
        asked.map_err(failed)?;
        let mut head = String::new();
        self.answers.read_line(&mut head).map_err(failed)?;
        let parts: Vec<&str> = head.split_whitespace().collect();
        let size: u64 = match parts[..] {
            [_, "missing"] => return Ok(None),
            [_, "blob", size] => size.parse().ok(),
            _ => None,
        }
        .ok_or_else(|| failed(io::Error::other("its answer is no file")))?;
        if size > FILE_LIMIT {
            return Err(ReadError::TooLarge);
        }
        // The bytes and a line break.
        let mut bytes = vec![0; size as usize + 1];
        self.answers.read_exact(&mut bytes).map_err(failed)?;
        bytes.pop();
        Ok(Some(bytes))
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        // It may be in the middle of an answer.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_trees_are_entries() {
        let id = "0".repeat(40);
        let of = |line: String| entry(line.as_bytes()).map(|(path, entry)| (path, entry.kind));
        let file = of(format!("100644 blob {id}\ta b\nc"));
        assert_eq!(file, Some(("a b\nc".into(), Kind::File)));
        let link = of(format!("120000 blob {id}\tl"));
        assert_eq!(link, Some(("l".into(), Kind::Link)));
        let module = of(format!("160000 commit {id}\tm"));
        assert_eq!(module, Some(("m".into(), Kind::Submodule)));
        assert_eq!(of(String::new()), None);
    }
}
