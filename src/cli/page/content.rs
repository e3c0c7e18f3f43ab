//! What a page is made of.

use super::super::exhibit::Exhibit;
use super::super::page_diff::Changes;

/// What the page shows.
pub struct Page<'a> {
    /// What there is to see.
    pub exhibit: &'a Exhibit,
    /// What differs from a revision, where that was asked for.
    pub changes: Option<Changes>,
    /// What a served page says beside it; none for a file.
    pub live: Option<Live>,
    /// Whether times are left out.
    pub is_stable: bool,
}

/// A build that is followed.
pub struct Live {
    /// Its number, 0 before the first.
    pub build: u64,
    /// Whether nothing is wrong.
    pub is_ok: bool,
    /// How long it took.
    pub seconds: f64,
    /// The specs of which values are tried out, and the command lines that do the same.
    pub trials: Vec<(String, String)>,
}
