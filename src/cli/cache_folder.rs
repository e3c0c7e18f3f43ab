//! Which folder the cache is in, whether it can be believed, and how large it may become.
//!
//! What a cache holds proves that it is whole, not who has made it. A folder that came with the project, as a link or as files under
//! version control, was made by whoever wrote the project, and is not used.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::place::Place;
use super::terminal::Failure;
use fretwork_diagnostic::{Code, Diagnostic};
use fretwork_store::{Kind, Unexpected};

/// The folder beside the root marker.
const NAME: &str = ".fretwork";

/// The index of a repository that is longer is not searched.
const LONGEST_INDEX: u64 = 1 << 28;

/// The folder of the cache of the project at `root`: the one that was given, or its own.
///
/// # Errors
/// A warning that says why it is not used.
pub fn find(root: &Path, given: Option<&Path>) -> Result<PathBuf, Diagnostic> {
    let warning = |why: String| {
        let warning =
            Diagnostic::warning(format!("the cache is not used: {why}")).about(Code::Output);
        warning.help("name another folder with `--cache-dir`")
    };
    let place = match given {
        None => Place::inside(root, NAME),
        Some(given) => Place::of(root, given).map_err(|e| warning(e.to_string()))?,
    };
    let folder = place.path();
    match place.open() {
        Err(error) if Unexpected::of(&error).is_some_and(|e| e.kind == Kind::Link) => {
            Err(warning(error.to_string()))
        }
        // Other errors are told when something is to be written.
        Err(_) => Ok(folder),
        Ok(_) if is_tracked(&folder) => {
            let why = format!("`{}` is under version control", folder.display());
            Err(warning(why))
        }
        Ok(_) => Ok(folder),
    }
}

/// The size that the cache keeps by itself, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit(u64);

impl Limit {
    /// The size that `FRETWORK_CACHE_SIZE` names; 2 GB where it is not set.
    ///
    /// # Errors
    /// When it is set to what is no size.
    pub fn given() -> Result<Limit, Failure> {
        let Some(text) = std::env::var_os("FRETWORK_CACHE_SIZE").filter(|text| !text.is_empty())
        else {
            return Ok(Limit(2_000_000_000));
        };
        text.to_str().and_then(Limit::parsed).ok_or_else(|| {
            let text = text.to_string_lossy();
            Failure::usage(format!(
                "`FRETWORK_CACHE_SIZE={text}` is no size such as 500MB or 2GB"
            ))
        })
    }

    /// The size in bytes.
    pub fn bytes(self) -> u64 {
        self.0
    }

    /// Reads bytes, or a number with a unit.
    fn parsed(text: &str) -> Option<Limit> {
        let text = text.trim().to_ascii_uppercase();
        let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == ' ');
        let factor = match text[digits.len()..].trim() {
            "" | "B" => 1.0,
            "K" | "KB" => 1e3,
            "M" | "MB" => 1e6,
            "G" | "GB" => 1e9,
            "T" | "TB" => 1e12,
            _ => return None,
        };
        let bytes = digits.parse::<f64>().ok()? * factor;
        (bytes.is_finite() && bytes >= 0.0).then_some(Limit(bytes as u64))
    }
}

/// Whether the repository that `folder` lies in tracks a file of it.
fn is_tracked(folder: &Path) -> bool {
    let tracked = || -> Option<bool> {
        let folder = fs::canonicalize(folder).ok()?;
        let top = folder
            .ancestors()
            .skip(1)
            .find(|above| above.join(".git").exists())?;
        let below = folder.strip_prefix(top).ok()?.to_str()?.replace('\\', "/") + "/";
        let index = index(&top.join(".git")).ok()?;
        Some(names(&index).any(|name| name.starts_with(below.as_bytes())))
    };
    tracked().unwrap_or(false)
}

/// The bytes of the index of a repository whose `.git` is a folder, or a file that names one.
fn index(git: &Path) -> io::Result<Vec<u8>> {
    let folder = if git.is_dir() {
        git.to_path_buf()
    } else {
        let text = fs::read_to_string(git)?;
        let path = text
            .trim()
            .strip_prefix("gitdir:")
            .unwrap_or_default()
            .trim();
        git.parent().unwrap_or(git).join(path)
    };
    let path = folder.join("index");
    let meta = fs::metadata(&path)?;
    if !meta.is_file() || meta.len() > LONGEST_INDEX {
        return Err(io::ErrorKind::InvalidData.into());
    }
    fs::read(path)
}

/// The paths in an index of git, of version 2, 3 or 4 (gitformat-index(5)).
fn names(index: &[u8]) -> impl Iterator<Item = Vec<u8>> {
    let number = |at: usize| {
        let bytes = index.get(at..at + 4)?;
        Some(u32::from_be_bytes(bytes.try_into().ok()?))
    };
    let version = number(4)
        .filter(|_| index.starts_with(b"DIRC"))
        .unwrap_or(0);
    let count = number(8)
        .filter(|_| (2..=4).contains(&version))
        .unwrap_or(0);
    let (mut at, mut name) = (12, Vec::new());
    (0..count).map_while(move |_| {
        let flags = u16::from_be_bytes(index.get(at + 60..at + 62)?.try_into().ok()?);
        let mut start = at + if flags & 0x4000 == 0 { 62 } else { 64 };
        if version == 4 {
            let dropped = offset(index, &mut start)?;
            name.truncate(name.len().checked_sub(dropped)?);
        } else {
            name.clear();
        }
        let length = index.get(start..)?.iter().position(|&byte| byte == 0)?;
        name.extend_from_slice(&index[start..start + length]);
        let end = start + length;
        // Entries of the older versions are filled up with one to eight zeros.
        at = if version == 4 {
            end + 1
        } else {
            at + (end - at + 8) / 8 * 8
        };
        Some(name.clone())
    })
}

/// A number of a varying count of bytes, as packs have them; `at` is moved behind it.
fn offset(bytes: &[u8], at: &mut usize) -> Option<usize> {
    let mut next = || {
        let byte = *bytes.get(*at)?;
        *at += 1;
        Some(byte)
    };
    let mut byte = next()?;
    let mut value = usize::from(byte & 0x7f);
    while byte & 0x80 != 0 {
        byte = next()?;
        value = value.checked_add(1)?.checked_mul(128)? + usize::from(byte & 0x7f);
    }
    Some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        for (text, bytes) in [
            ("1000", 1000),
            ("2GB", 2_000_000_000),
            ("0.5 m", 500_000),
            ("1kb", 1000),
            ("0", 0),
        ] {
            assert_eq!(Limit::parsed(text), Some(Limit(bytes)), "{text}");
        }
        for text in ["GB", "-1", "1 parsec", "nan", "1e400"] {
            assert_eq!(Limit::parsed(text), None, "{text}");
        }
    }

    #[test]
    fn the_index_of_a_repository_is_read_in_all_its_versions() {
        let scratch = tempfile::tempdir().expect("a folder can be made");
        let git = |arguments: &[&str]| {
            let mut command = std::process::Command::new("git");
            command
                .args(["-c", "user.name=a", "-c", "user.email=a"])
                .args(arguments);
            command
                .current_dir(scratch.path())
                .output()
                .is_ok_and(|output| output.status.success())
        };
        if !git(&["init", "-q"]) {
            return;
        }
        for file in [
            "a.txt",
            "deep/er/b",
            ".fretwork/v3/actions/ab",
            ".fretworks/c",
            "z",
        ] {
            let path = scratch.path().join(file);
            fs::create_dir_all(path.parent().expect("it has one")).expect("it is new");
            fs::write(path, "x").expect("it is new");
        }
        let cache = scratch.path().join(NAME);
        for version in ["2", "4"] {
            assert!(git(&["add", "a.txt", "deep", ".fretworks", "z"]));
            assert!(git(&["update-index", "--index-version", version]));
            assert!(!is_tracked(&cache), "{version}");
            assert!(git(&["add", "-f", ".fretwork"]));
            assert!(is_tracked(&cache), "{version}");
            assert!(git(&["rm", "-rq", "--cached", ".fretwork"]));
        }
    }
}
