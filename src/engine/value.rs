//! Values with a digest, in memory or still in the store.

use std::sync::{Arc, OnceLock};

use fretwork_action::Value;
use fretwork_store::Digest;

/// The digest of a value, and the value as soon as somebody has needed it. Equal when the digests
/// are.
#[derive(Clone, Debug)]
pub struct Handle {
    /// The digest of the canonical bytes; for a function, of everything it is made from.
    pub digest: Digest,
    slot: Arc<OnceLock<Value>>,
}

impl PartialEq for Handle {
    fn eq(&self, other: &Handle) -> bool {
        self.digest == other.digest
    }
}

impl Handle {
    /// A value that may be in the store.
    pub fn absent(digest: Digest) -> Handle {
        Handle {
            digest,
            slot: Arc::default(),
        }
    }

    /// A value at hand.
    pub fn present(digest: Digest, value: Value) -> Handle {
        Handle {
            digest,
            slot: Arc::new(OnceLock::from(value)),
        }
    }

    /// The value, if it is at hand.
    pub fn get(&self) -> Option<&Value> {
        self.slot.get()
    }

    /// Keeps `value` at hand.
    pub fn fill(&self, value: Value) -> &Value {
        self.slot.get_or_init(|| value)
    }
}
