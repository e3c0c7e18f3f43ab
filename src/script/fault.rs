//! An error of the interpreter, taken apart: what it says, where, and through which calls.

use super::guard::Limits;

/// What went wrong. Places are bytes of the guarded text of the file named with them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fault {
    pub message: String,
    /// File, first byte, one past the last.
    pub start: Option<(String, usize, usize)>,
    /// Calls that led there, the outermost first: what was called, and where.
    pub frames: Vec<(String, String, usize, usize)>,
}

impl Fault {
    /// Takes `error` apart.
    pub fn of(error: &starlark::Error) -> Fault {
        let place = |span: &starlark::codemap::FileSpan| {
            (span.filename().to_owned(), span.span.begin().get() as usize, span.span.end().get() as usize)
        };
        let frames = error.call_stack().frames.iter().filter_map(|frame| {
            let (file, start, end) = place(frame.location.as_ref()?);
            Some((frame.name.clone(), file, start, end))
        });
        let message = worded(&error.without_diagnostic().to_string());
        Fault { message, start: error.span().map(place), frames: frames.collect() }
    }
}

/// The interpreter's message in the words of this program.
fn worded(message: &str) -> String {
    let first = message.lines().next().unwrap_or_default();
    if first.starts_with("Heap memory limit of") {
        let bytes = first.split_whitespace().find_map(|word| word.parse::<usize>().ok());
        return format!("this needs more than {} MiB of memory", bytes.unwrap_or(Limits::MAPPER.heap) >> 20);
    }
    if first.starts_with("Execution duration limit of") {
        let ticks = first.split_whitespace().find_map(|word| word.parse::<u64>().ok());
        return format!("this takes more than {} steps", ticks.unwrap_or(Limits::MAPPER.steps));
    }
    if first.starts_with("Starlark call stack overflow") {
        return "calls are nested too deeply; a function must not call itself".into();
    }
    let text = first.trim_end_matches('.');
    let mut letters = text.chars();
    let begins_with_word =
        text.split_whitespace().next().is_some_and(|word| word.chars().skip(1).all(char::is_lowercase));
    match letters.next() {
        Some(letter) if begins_with_word => letter.to_lowercase().chain(letters).collect(),
        _ => text.to_owned(),
    }
}
