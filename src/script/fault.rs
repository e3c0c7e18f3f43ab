//! An error of the interpreter taken apart, and put together again as a diagnostic: what it says,
//! where, through which calls, and in which cells of which mappers.

use std::collections::BTreeMap;
use std::sync::Arc;

use starlark::codemap::FileSpan;

use crate::sandbox::budget::Limits;
use crate::sandbox::rewrite::Rewritten;
use fretwork_diagnostic::{Code, Diagnostic, Label, Span};

/// Texts that were run, by the name of their file: how to get back to what was written.
pub(crate) type Sources = BTreeMap<String, Rewritten>;

/// What was being done when an error passed by.
#[derive(Clone, Debug)]
pub struct Note {
    /// Such as `the face at (3, 4) is mapped by `blob``.
    pub text: String,
    /// Where that was written.
    pub site: Option<FileSpan>,
}

/// A place in the rewritten text of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The file.
    pub file: String,
    /// The first byte.
    pub start: usize,
    /// The byte after the last one.
    pub end: usize,
}

impl Place {
    fn of(span: &FileSpan) -> Place {
        let (start, end) = (
            span.span.begin().get() as usize,
            span.span.end().get() as usize,
        );
        Place {
            file: span.filename().to_owned(),
            start,
            end,
        }
    }

    /// The place in the text as it was written.
    fn span(&self, sources: &Sources) -> Option<Span> {
        let rewritten = sources.get(&self.file)?;
        let (start, end) = (rewritten.original(self.start), rewritten.original(self.end));
        Some(Span::Bytes {
            file: Arc::from(self.file.as_str()),
            start,
            end: end.max(start),
        })
    }
}

/// What went wrong.
#[derive(Clone, Debug)]
pub struct Fault {
    /// One sentence without a full stop.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Where it happened, if that is known.
    pub place: Option<Place>,
    /// Calls that led there, the outermost first: what was called, and where.
    pub frames: Vec<(String, Place)>,
    /// The innermost first.
    pub notes: Vec<Note>,
}

impl Fault {
    /// A fault without a place.
    pub fn new(message: impl Into<String>) -> Box<Fault> {
        let message = message.into();
        Box::new(Fault {
            message,
            help: None,
            place: None,
            frames: Vec::new(),
            notes: Vec::new(),
        })
    }

    /// Advice to go with it.
    pub fn help(&mut self, help: Option<String>) {
        self.help = help;
    }

    /// Takes `error` apart.
    pub fn of(error: &starlark::Error) -> Box<Fault> {
        let frames = error.call_stack().frames.iter();
        let frames = frames
            .filter_map(|frame| Some((frame.name.clone(), Place::of(frame.location.as_ref()?))));
        let (message, help) = worded(&error.without_diagnostic().to_string());
        let source = error.span().map(|span| span.source_span());
        let message = match source.and_then(called) {
            Some(name) if message.starts_with("wrong number of") => format!("`{name}`: {message}"),
            _ => message,
        };
        let place = error.span().map(Place::of);
        Box::new(Fault {
            frames: frames.collect(),
            place,
            help,
            ..*Fault::new(message)
        })
    }

    /// The diagnostic about it: first the place, then the mappers around it with their cells, then
    /// the calls. `file` is where to look when no place is known.
    pub(crate) fn diagnostic(&self, file: &Arc<str>, sources: &Sources) -> Diagnostic {
        let mut labels: Vec<Label> = Vec::new();
        let mut add = |span: Option<Span>, text: String| {
            if let Some(span) = span
                && labels
                    .iter()
                    .all(|known| known.span != span || known.text != text)
            {
                labels.push(Label { span, text });
            }
        };
        let is_native = |name: &str| name.starts_with("_bounded") || name.starts_with('<');
        let innermost = self.frames.iter().rev().find(|frame| !is_native(&frame.0));
        let place = self.place.as_ref().or(innermost.map(|frame| &frame.1));
        add(place.and_then(|p| p.span(sources)), String::new());
        for note in &self.notes {
            let site = note
                .site
                .as_ref()
                .and_then(|site| Place::of(site).span(sources));
            add(
                Some(site.unwrap_or_else(|| Span::File(file.clone()))),
                note.text.clone(),
            );
        }
        for (name, place) in self
            .frames
            .iter()
            .rev()
            .filter(|frame| !is_native(&frame.0))
        {
            if Some(place) != self.place.as_ref() {
                add(place.span(sources), format!("in the call of `{name}`"));
            }
        }
        if labels.is_empty() {
            labels.push(Label {
                span: Span::File(file.clone()),
                text: String::new(),
            });
        }
        let message = match self.notes.first() {
            Some(note) => format!("{}: {}", note.text, self.message),
            None => self.message.clone(),
        };
        Diagnostic {
            labels,
            help: self.help.clone(),
            ..Diagnostic::error(message).about(Code::Script)
        }
    }
}

/// The name of the function that a call calls.
fn called(call: &str) -> Option<&str> {
    let (name, _) = call.split_once('(')?;
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    (!name.is_empty() && !name.starts_with('_') && name.chars().all(is_name)).then_some(name)
}

/// A message that calls a function by its name alone, and not by its file too as the interpreter does.
fn without_files(message: &str) -> String {
    match message.split_once(" for call to ") {
        Some((before, name)) => {
            let name = name.rsplit('.').next().unwrap_or(name);
            format!("{before} in the call of `{name}`")
        }
        None => message.to_owned(),
    }
}

/// The interpreter's message in the words of this program, and advice that it contained.
fn worded(message: &str) -> (String, Option<String>) {
    let first = message.lines().next().unwrap_or_default();
    let more = Some("`--budget 2` allows for twice as much".to_string());
    let number = || {
        first
            .split_whitespace()
            .find_map(|word| word.parse::<u64>().ok())
    };
    if first.starts_with("Heap memory limit of") {
        let bytes = number().unwrap_or(Limits::MAPPER.heap as u64);
        return (
            format!("this needs more than {} MiB of memory", bytes >> 20),
            more.filter(|_| bytes >= Limits::ENTRY.heap as u64),
        );
    }
    if first.starts_with("Execution duration limit of") {
        let ticks = number().unwrap_or(Limits::MAPPER.steps);
        return (
            format!("this takes more than {} steps", ticks / 3 * 2),
            more.filter(|_| ticks > Limits::ENTRY.steps),
        );
    }
    if first.starts_with("Starlark call stack overflow") {
        return (
            "calls are nested too deeply; a function must not call itself".into(),
            None,
        );
    }
    if let Some(rest) = first.strip_prefix("Variable `")
        && let Some((name, rest)) = rest.split_once("` not found")
    {
        let near = rest
            .strip_prefix(", did you mean `")
            .and_then(|rest| rest.split('`').next());
        let near = near.filter(|near| !near.starts_with('_'));
        return (
            format!("unknown name `{name}`"),
            near.map(|near| format!("did you mean `{near}`?")),
        );
    }
    let first = &without_files(first);
    let text = first.trim_end_matches('.');
    let mut letters = text.chars();
    let word = text.split_whitespace().next().unwrap_or_default();
    let lower = match letters.next() {
        Some(letter) if word.chars().skip(1).all(char::is_lowercase) => {
            letter.to_lowercase().chain(letters).collect()
        }
        _ => text.to_owned(),
    };
    // What the natives refuse, beyond what an expression of a spec may use.
    let is_past = |least: u64| number().is_some_and(|n| n >= least);
    let can_be_more = lower.starts_with("this takes more than ") && is_past(Limits::ENTRY.steps)
        || lower.starts_with("this needs more than ") && is_past(Limits::ENTRY.heap as u64 >> 20);
    (lower, more.filter(|_| can_be_more))
}
