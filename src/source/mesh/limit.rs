//! What a file may ask for, and how it reaches the files beside it.

use std::sync::Arc;

/// More triangles than this are refused.
pub const MOST_TRIANGLES: usize = 50_000_000;

/// Reads a file that a file names, by its path relative to that one; a message when it cannot be read.
pub type Sibling<'a> = &'a mut dyn FnMut(&str) -> Result<Arc<[u8]>, String>;
