//! Gives the compiler a digest of its own source, so that results remembered by another version
//! are never taken for its own.

use std::collections::BTreeMap;
use std::fs;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::io;
use std::path::{Path, PathBuf};

fn main() -> io::Result<()> {
    let mut files = BTreeMap::new();
    collect(Path::new("src"), &mut files)?;
    files.insert(PathBuf::from("Cargo.lock"), fs::read("Cargo.lock")?);
    let mut hasher = DefaultHasher::new();
    files.hash(&mut hasher);
    println!(
        "cargo::rustc-env=FRETWORK_SOURCE_DIGEST={:016x}",
        hasher.finish()
    );
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.lock");
    Ok(())
}

fn collect(folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else {
            let bytes = fs::read(&path)?;
            files.insert(path, bytes);
        }
    }
    Ok(())
}
