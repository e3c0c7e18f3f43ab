//! Diagnostics as workflow commands of GitHub, which become annotations beside the lines of a change, and the
//! summary of a job.

use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::time::Duration;

use super::artifacts::Status;
use super::outcome::Outcome;
use super::placed::Placed;
use super::terminal::{self, counted};
use fretwork_diagnostic::Severity;

/// GitHub shows so many annotations of a level of one step.
pub const SHOWN: usize = 10;
/// The longest summary that GitHub takes, less some room.
pub const LONGEST: usize = (1 << 20) - 4096;
/// The slowest nodes are told.
const SLOWEST: usize = 10;

/// The commands, errors first, ten of a level and a notice that counts the rest.
pub fn commands(diagnostics: &[Placed]) -> String {
    let mut out = String::new();
    let mut rest = 0;
    for (severity, level) in [(Severity::Error, "error"), (Severity::Warning, "warning")] {
        let of_level = diagnostics.iter().filter(|d| d.severity == severity);
        for (number, diagnostic) in of_level.enumerate() {
            if number < SHOWN {
                out += &command(level, diagnostic);
            } else {
                rest += 1;
            }
        }
    }
    if rest > 0 {
        let _ = writeln!(
            out,
            "::notice::{} in the log",
            match rest {
                1 => "1 more error or warning is".to_owned(),
                rest => format!("{rest} more errors and warnings are"),
            }
        );
    }
    out
}

fn command(level: &str, diagnostic: &Placed) -> String {
    let mut properties = Vec::new();
    let mut property = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            properties.push(format!("{name}={}", escaped_property(&value)));
        }
    };
    property("file", diagnostic.file.clone());
    let number = |n: Option<usize>| n.map(|n| n.to_string());
    property("line", number(diagnostic.line));
    property("col", number(diagnostic.column));
    property("endLine", number(diagnostic.end_line));
    property("endColumn", number(diagnostic.end_column));
    property("title", Some(diagnostic.code.to_string()));
    let help = diagnostic.help.iter().map(|help| format!("\nhelp: {help}"));
    let message = format!("{}{}", diagnostic.message, help.collect::<String>());
    format!(
        "::{level} {}::{}\n",
        properties.join(","),
        escaped(&message)
    )
}

/// A notice about a file.
pub fn notice(file: &str, title: &str, message: &str) -> String {
    let [file, title] = [file, title].map(escaped_property);
    format!("::notice file={file},title={title}::{}\n", escaped(message))
}

fn escaped(text: &str) -> String {
    let percent = text.replace('%', "%25");
    percent.replace('\r', "%0D").replace('\n', "%0A")
}

fn escaped_property(text: &str) -> String {
    escaped(text).replace(':', "%3A").replace(',', "%2C")
}

/// Appends what the build did to the summary of the job.
pub fn summarize(outcome: &Outcome, elapsed: Duration) {
    append(&summary(outcome, elapsed));
}

/// Appends Markdown to the file that `$GITHUB_STEP_SUMMARY` names. One that cannot be written is told and is no failure.
pub fn append(text: &str) {
    let Some(path) = std::env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) else {
        return;
    };
    let file = OpenOptions::new().append(true).create(true).open(&path);
    if let Err(error) = file.and_then(|mut file| file.write_all(text.as_bytes())) {
        terminal::note(&format!("cannot write the summary of the job: {error}"));
    }
}

/// Markdown: artifacts with their sizes, counts, times, the slowest nodes.
fn summary(outcome: &Outcome, elapsed: Duration) -> String {
    let report = &outcome.report;
    let errors = report.diagnostics.iter().filter(|d| d.is_error()).count();
    let evaluated = report.nodes.iter().filter(|n| n.was_evaluated());
    let mut out = format!(
        "### fretwork\n\n{}, {}; {} of {} evaluated in {:.2} s\n\n",
        counted(errors, "error"),
        counted(report.diagnostics.len() - errors, "warning"),
        evaluated.clone().count(),
        counted(report.nodes.len(), "node"),
        elapsed.as_secs_f64()
    );
    let mut slowest: Vec<_> = evaluated.collect();
    slowest.sort_by(|a, b| b.ms.total_cmp(&a.ms).then_with(|| a.name.cmp(&b.name)));
    out += "| slowest nodes | ms |\n| --- | ---: |\n";
    for node in slowest.iter().take(SLOWEST) {
        let _ = writeln!(out, "| {} | {:.0} |", cell(&node.name), node.ms);
    }
    out += "\n| artifact | bytes | |\n| --- | ---: | --- |\n";
    for (number, artifact) in outcome.written.iter().enumerate() {
        let status = match artifact.status {
            Status::Written => "written",
            Status::Unchanged => "unchanged",
            Status::Different => "is not what the spec gives",
            Status::Missing => "missing",
        };
        let line = format!(
            "| {} | {} | {status} |\n",
            cell(&artifact.path),
            artifact.bytes
        );
        if out.len() + line.len() > LONGEST {
            let _ = writeln!(out, "\nand {} more", outcome.written.len() - number);
            break;
        }
        out += &line;
    }
    out + "\n"
}

/// A text that ends no cell of a table.
pub fn cell(text: &str) -> String {
    let shown = fretwork_diagnostic::shown(text);
    format!("`{}`", shown.replace('|', "\\|").replace('`', "'"))
}

/// A text in a cell that is no code: nothing in it is taken for markup.
pub fn plain(text: &str) -> String {
    let mut out = String::new();
    for c in fretwork_diagnostic::shown(text).chars() {
        if "\\|`*_<>[]&#~".contains(c) {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placed(severity: Severity, message: &str) -> Placed {
        Placed {
            code: "value",
            severity,
            message: message.into(),
            file: Some("specs/a,b%:\n.yaml".into()),
            line: Some(3),
            column: Some(5),
            end_line: Some(3),
            end_column: Some(9),
            help: Some("50% is enough".into()),
            path: Vec::new(),
        }
    }

    #[test]
    fn properties_and_messages_are_escaped() {
        assert_eq!(
            commands(&[placed(Severity::Error, "too\nlong: 1, 2")]),
            "::error file=specs/a%2Cb%25%3A%0A.yaml,line=3,col=5,endLine=3,endColumn=9,title=value::\
             too%0Along: 1, 2%0Ahelp: 50%25 is enough\n"
        );
    }

    #[test]
    fn ten_of_a_level_are_shown_and_errors_come_first() {
        let mut all: Vec<Placed> = (0..14).map(|_| placed(Severity::Warning, "w")).collect();
        all.push(placed(Severity::Error, "e"));
        let text = commands(&all);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("::error") && lines[1].starts_with("::warning"));
        assert_eq!(lines.len(), 12);
        assert_eq!(
            lines[11],
            "::notice::4 more errors and warnings are in the log"
        );
    }

    #[test]
    fn cells_of_tables_stay_cells() {
        assert_eq!(cell("a|b`c"), "`a\\|b'c`");
    }
}
