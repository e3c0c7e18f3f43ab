//! The rooms, what each may use, and their versions. The table of rooms is their manifests: what a
//! room may use is what its `Cargo.toml` depends on. The build script and the test of the layers
//! read it here; the compiler itself gets only the versions.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The room whose code stands between every node and its stage.
const ENGINE: &str = "engine";

/// A package below `src/`.
#[derive(Debug)]
pub struct Room {
    /// The rooms that its manifest names as dependencies, those of its tests left out.
    pub uses: BTreeSet<String>,
    /// Its files by path, those that only tests read left out.
    pub files: BTreeMap<PathBuf, Vec<u8>>,
}

/// The rooms below `src`, by name.
///
/// # Errors
/// When a file cannot be read.
pub fn read(src: &Path) -> io::Result<BTreeMap<String, Room>> {
    let mut rooms = BTreeMap::new();
    for entry in fs::read_dir(src)? {
        let folder = entry?.path();
        if !folder.is_dir() {
            continue;
        }
        let manifest = fs::read_to_string(folder.join("Cargo.toml"))?;
        let mut files = BTreeMap::new();
        collect(&folder, &mut files)?;
        let name = folder
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        rooms.insert(
            name,
            Room {
                uses: uses(&manifest),
                files,
            },
        );
    }
    Ok(rooms)
}

/// The rooms under `[dependencies]` of a manifest.
fn uses(manifest: &str) -> BTreeSet<String> {
    let dependencies = manifest
        .lines()
        .skip_while(|line| *line != "[dependencies]")
        .skip(1);
    dependencies
        .take_while(|line| !line.starts_with('['))
        .filter_map(|line| line.strip_prefix("fretwork-"))
        .filter_map(|line| line.split(['.', ' ']).next())
        .map(str::to_owned)
        .collect()
}

/// The files below `folder` from which the room is compiled.
fn collect(folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let stem = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if stem == "tests" || stem.ends_with("_tests") {
            continue;
        }
        if path.is_dir() {
            collect(&path, files)?;
        } else {
            let bytes = fs::read(&path)?;
            files.insert(path, without_tests(bytes));
        }
    }
    Ok(())
}

/// The text before the module of tests, which is the last thing in a file.
fn without_tests(mut bytes: Vec<u8>) -> Vec<u8> {
    const TESTS: &[u8] = b"\n#[cfg(test)]\nmod tests {";
    if let Some(at) = bytes
        .windows(TESTS.len())
        .position(|window| window == TESTS)
    {
        bytes.truncate(at);
    }
    bytes
}

/// The room `name` and all that it uses, through others too.
pub fn closure<'a>(rooms: &'a BTreeMap<String, Room>, name: &'a str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![name];
    while let Some(name) = open.pop() {
        if found.insert(name) {
            open.extend(rooms[name].uses.iter().map(String::as_str));
        }
    }
    found
}

/// The version of each room: a digest of its own files, of those of all rooms that it uses, of the
/// engine's, and of the versions of the libraries in `lock`.
pub fn versions(rooms: &BTreeMap<String, Room>, lock: &[u8]) -> Vec<(String, String)> {
    let version = |name: &String| {
        let mut used = closure(rooms, name);
        used.insert(ENGINE);
        let mut hasher = DefaultHasher::new();
        lock.hash(&mut hasher);
        for room in used {
            rooms[room].files.hash(&mut hasher);
        }
        (name.clone(), format!("{:016x}", hasher.finish()))
    };
    rooms.keys().map(version).collect()
}
