//! `fretwork cache`: how much it holds, whether it is whole, and making it smaller.

use std::io;
use std::path::Path;

use super::arguments::{Cache, CacheAction};
use super::cache_folder;
use super::disk::DiskWorld;
use super::terminal::{self, Failure};
use fretwork_store::LocalStore;

/// Does one of them.
pub fn run(arguments: &Cache) -> Result<(), Failure> {
    let unreadable = |e: io::Error| Failure::usage(format!("cannot read the cache: {e}"));
    let world = DiskWorld::find(Path::new(".")).map_err(unreadable)?;
    let folder = cache_folder::find(world.root(), arguments.cache_dir.as_deref())
        .map_err(|why| Failure::usage(why.message))?;
    let store = LocalStore::new(&folder);
    match arguments.action {
        CacheAction::Size => {
            let size = store.size().map_err(unreadable)?;
            let megabytes = size.bytes as f64 / 1e6;
            terminal::print(&format!(
                "{}: {}, {}, {megabytes:.1} MB\n",
                folder.display(),
                terminal::counted(size.actions, "result"),
                terminal::counted(size.blobs, "value")
            ))
        }
        CacheAction::Verify => {
            let found = store.verify().map_err(unreadable)?;
            let kept = match found.unreadable {
                0 => String::new(),
                n => format!("; {n} that may not be read were left alone"),
            };
            let damaged = found.damaged;
            terminal::print(&format!(
                "{damaged} damaged files found and removed{kept}\n"
            ))
        }
        CacheAction::Gc { keep } => {
            let freed = store
                .collect(keep.saturating_mul(1_000_000))
                .map_err(unreadable)?;
            terminal::print(&format!("{:.1} MB removed\n", freed as f64 / 1e6))
        }
    }
}
