//! Gives the compiler the version of every room, so that a result which another version of a room
//! has made is never taken for its own.

// A build script reads the sources that it is about.
#![allow(clippy::disallowed_methods)]

#[path = "src/rooms.rs"]
mod rooms;

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let rooms = rooms::read(Path::new("src"))?;
    let versions = rooms::versions(&rooms, &fs::read("Cargo.lock")?);
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo names the folder"));
    fs::write(folder.join("versions.rs"), format!("&{versions:?}"))?;
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.lock");
    Ok(())
}
