//! Why an expression has no value.

/// What is wrong with an expression, and where: bytes of its text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// One sentence without a full stop.
    pub message: String,
    /// The first byte it is about.
    pub start: usize,
    /// One past the last.
    pub end: usize,
    /// What to do about it.
    pub help: Option<String>,
}

impl ExpressionError {
    pub(crate) fn new(message: impl Into<String>, start: usize, end: usize) -> ExpressionError {
        ExpressionError {
            message: message.into(),
            start,
            end,
            help: None,
        }
    }
}
