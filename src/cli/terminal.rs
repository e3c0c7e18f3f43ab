//! Printing: results to standard output, everything else to standard error.

use std::io::{self, IsTerminal as _, Write as _};

use fretwork_diagnostic::{Diagnostic, render, shown};

/// Why a command ends without success.
#[derive(Debug)]
pub enum Failure {
    /// The spec or the build is wrong, and that has been said.
    Build,
    /// Artifacts differ, and that has been said.
    Differs,
    /// The command line or the surroundings are wrong.
    Usage(String),
}

impl Failure {
    /// The failure of the command line with this message.
    pub fn usage(message: impl Into<String>) -> Failure {
        Failure::Usage(message.into())
    }
}

/// Whether standard error takes colours: it is a terminal and `NO_COLOR` is not set.
pub fn has_colour() -> bool {
    io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// As many diagnostics are shown; nobody reads more of them.
const SHOWN: usize = 100;

/// The diagnostics to show, errors before warnings, and how many more there are.
pub fn shortlist(diagnostics: &[Diagnostic]) -> (Vec<&Diagnostic>, usize) {
    let (errors, warnings): (Vec<_>, Vec<_>) = diagnostics.iter().partition(|d| d.is_error());
    let shown = errors.into_iter().chain(warnings).take(SHOWN).collect();
    (shown, diagnostics.len().saturating_sub(SHOWN))
}

/// Prints diagnostics with their source lines, and how many there are, to standard error.
pub fn print_diagnostics(diagnostics: &[Diagnostic], sources: &dyn render::Sources) {
    if diagnostics.is_empty() {
        return;
    }
    let errors = diagnostics.iter().filter(|d| d.is_error()).count();
    let total = match (errors, diagnostics.len() - errors) {
        (0, w) => counted(w, "warning"),
        (e, 0) => counted(e, "error"),
        (e, w) => format!("{}, {}", counted(e, "error"), counted(w, "warning")),
    };
    let (shown, omitted) = shortlist(diagnostics);
    let shown: Vec<Diagnostic> = shown.into_iter().cloned().collect();
    let text = render::render(&shown, sources, has_colour());
    let more = match omitted {
        0 => String::new(),
        1 => "1 more is not shown\n".to_owned(),
        n => format!("{n} more are not shown\n"),
    };
    write(&format!("{text}{more}{total}"));
}

/// A count of things whose word takes an `s` where there are several.
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// Prints errors that were rendered before, and how many there are, to standard error.
pub fn print_errors(text: &str, count: usize) {
    if count > 0 {
        write(&format!("{text}{}", counted(count, "error")));
    }
}

/// Prints a line to standard error. What is in it of names shows its control characters: a line break in the
/// name of a file begins no line.
pub fn note(line: &str) {
    write(&shown(line));
}

fn write(text: &str) {
    // Nobody is left to tell when standard error is closed.
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Prints `text` to standard output.
///
/// # Errors
/// When it cannot be written; a closed pipe (as of `| head`) counts as success.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(Failure::usage(format!(
            "cannot write to standard output: {e}"
        ))),
        _ => Ok(()),
    }
}

/// Prints a value as JSON to standard output.
///
/// # Errors
/// As [`print()`].
pub fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|e| Failure::usage(format!("cannot write JSON: {e}")))?;
    print(&(text + "\n"))
}
