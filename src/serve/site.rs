//! What is served: the one door between the server and who has something to show.

use std::sync::Arc;

use super::events::Listener;

/// Bytes and what they are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The media type, with its character set where it is text.
    pub media: &'static str,
    /// The bytes.
    pub bytes: Arc<[u8]>,
}

/// What becomes of values that a reader sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// They will be shown.
    Taken,
    /// They cannot be.
    Refused,
    /// The request is none.
    Malformed,
}

/// The answer to values: a verdict and JSON that says more.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// What there is to say, as JSON.
    pub json: String,
}

/// What a server serves. It is asked on the server's thread and must answer at once.
pub trait Site: Send + Sync {
    /// The page, as HTML.
    fn page(&self) -> Arc<[u8]>;
    /// A script or a style of the page.
    fn asset(&self, name: &str) -> Option<Piece>;
    /// All that the page shows, as JSON.
    fn state(&self) -> Arc<[u8]>;
    /// The bytes of an artifact of the current build by its path; with `digest` only if they have it; `view` names the
    /// format of another form of it.
    fn file(&self, path: &str, digest: Option<&str>, view: Option<&str>) -> Option<Piece>;
    /// Takes the values of a body, which is at most 64 KiB of anything.
    fn set(&self, body: &[u8]) -> Answer;
    /// Somebody who hears of builds.
    fn listen(&self) -> Listener;
}
