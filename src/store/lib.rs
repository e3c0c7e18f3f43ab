//! What has been computed before, kept under the name of what it was computed from.
//!
//! Two tables: the *actions*, from the digest of everything a computation depends on to what came
//! out, and the *blobs*, bytes under their own digest. Nothing here knows what the bytes mean.
//!
//! A [`Folder`] is how this room and the command line reach files without passing a link.

// The store keeps its entries on the disk.
#![allow(clippy::disallowed_methods)]

mod digest;
mod folder;
mod keep;
mod local;

pub use digest::{Digest, Hasher, Naming};
pub use folder::{Entry, Folder, Held, Kind, Lasting, Unexpected};
pub use keep::{StoreSize, Verification};
pub use local::LocalStore;

use serde::{Deserialize, Serialize};

/// What came out of an action.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ActionResult {
    /// The files that were looked for while it ran, and the digest of their bytes then; none of those that
    /// were not there. The result holds only as long as all of this does.
    pub reads: Vec<(String, Option<Digest>)>,
    /// The blob with the value.
    pub output: Digest,
    /// What the caller wants to remember beside the value.
    pub note: Vec<u8>,
}
