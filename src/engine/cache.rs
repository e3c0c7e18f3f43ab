//! The store together with the versions of what fills it.

use fretwork_store::LocalStore;

/// The version of each room by its name: a digest of the sources from which it is compiled.
#[derive(Clone, Copy, Debug, Default)]
pub struct Versions(pub &'static [(&'static str, &'static str)]);

impl Versions {
    /// The version of `room`; empty where none is known, as in tests.
    pub fn of(self, room: &str) -> &'static str {
        self.0
            .iter()
            .find(|(name, _)| *name == room)
            .map_or("", |(_, version)| version)
    }
}

/// Where results are remembered, and which stages make them.
#[derive(Debug)]
pub struct Cache {
    /// The store.
    pub store: LocalStore,
    /// The versions of the rooms.
    pub versions: Versions,
}
