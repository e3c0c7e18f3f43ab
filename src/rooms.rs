//! The rooms, what each may use, and their versions. The table of rooms is their manifests: what a
//! room may use is what its `Cargo.toml` depends on. The build script and the test of the layers
//! read it here; the compiler itself gets only the versions.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The room of the stages. Each of its files is a stage with a version of its own.
const STAGE: &str = "stage";
/// What stands between every node and its stage: the files that put an action together and hand it on.
const ALWAYS: [(&str, &str); 2] = [
    ("engine", "src/engine/gather.rs"),
    (STAGE, "src/stage/lib.rs"),
];

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

/// The rooms `names` and all that they use, through others too.
pub fn closure<'a>(
    rooms: &'a BTreeMap<String, Room>,
    names: impl IntoIterator<Item = &'a str>,
) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&str> = names.into_iter().collect();
    while let Some(name) = open.pop() {
        if found.insert(name) {
            open.extend(rooms[name].uses.iter().map(String::as_str));
        }
    }
    found
}

/// The versions of all rooms, and those of the stages as `stage/NAME`: digests of the files of which
/// each is made, of what stands between every node and its stage, and of the versions of the libraries
/// in `lock`.
pub fn versions(rooms: &BTreeMap<String, Room>, lock: &[u8]) -> Vec<(String, String)> {
    let of_room = |name: &String| {
        let used = closure(rooms, [name.as_str(), "action"]);
        (name.clone(), digest(rooms, &used, &BTreeSet::new(), lock))
    };
    let of_stage = |name: &str| {
        let (files, named) = stage(rooms, name);
        let named = named.iter().map(String::as_str).chain(["action"]);
        (
            format!("{STAGE}/{name}"),
            digest(rooms, &closure(rooms, named), &files, lock),
        )
    };
    let stages = rooms[STAGE]
        .files
        .keys()
        .filter_map(|path| path.file_stem()?.to_str());
    rooms
        .keys()
        .map(of_room)
        .chain(stages.map(of_stage))
        .collect()
}

/// The files of a stage: its own and those of the room that it names; and the other rooms that they
/// name.
fn stage(rooms: &BTreeMap<String, Room>, name: &str) -> (BTreeSet<PathBuf>, BTreeSet<String>) {
    let (mut files, mut named) = (BTreeSet::new(), BTreeSet::new());
    let mut open = vec![name.to_owned()];
    while let Some(name) = open.pop() {
        let path = Path::new("src")
            .join(STAGE)
            .join(&name)
            .with_extension("rs");
        let held = rooms[STAGE]
            .files
            .iter()
            .find(|(file, _)| file.ends_with(&path));
        let Some((_, bytes)) = held else { continue };
        if !files.insert(path) {
            continue;
        }
        let text = String::from_utf8_lossy(bytes);
        named.extend(words_after(&text, "fretwork_"));
        open.extend(words_after(&text, "super::").chain(words_after(&text, "crate::")));
    }
    (files, named)
}

/// The words of `text` that follow `marker`.
fn words_after<'a>(text: &'a str, marker: &'a str) -> impl Iterator<Item = String> + 'a {
    text.match_indices(marker).map(move |(at, _)| {
        let rest = text[at + marker.len()..].chars();
        rest.take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect()
    })
}

/// A digest of whole rooms, of some `files` of the stages, and of what stands before every stage.
fn digest(
    rooms: &BTreeMap<String, Room>,
    whole: &BTreeSet<&str>,
    files: &BTreeSet<PathBuf>,
    lock: &[u8],
) -> String {
    let mut hasher = DefaultHasher::new();
    lock.hash(&mut hasher);
    for room in whole {
        rooms[*room].files.hash(&mut hasher);
    }
    let always = ALWAYS.iter().map(|(room, path)| (*room, Path::new(path)));
    let own = files.iter().map(|path| (STAGE, path.as_path()));
    for (room, path) in always.chain(own) {
        let held = rooms[room]
            .files
            .iter()
            .filter(|(file, _)| file.ends_with(path));
        held.for_each(|(_, bytes)| bytes.hash(&mut hasher));
    }
    format!("{:016x}", hasher.finish())
}
