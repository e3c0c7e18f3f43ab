//! A comparison as text: for people, as annotations, and as Markdown.

use std::fmt::Write as _;

use serde_json::Value;

use super::change::{Change, Status};
use super::comparison::Comparison;
use crate::github::{self, LONGEST, SHOWN};
use fretwork_diagnostic::shown;
use fretwork_engine::difference::Amounts;

/// A line for each artifact that is not the same, the measures that changed below it, and a line that counts.
pub fn human(comparison: &Comparison) -> String {
    let mut out = String::new();
    for change in in_order(comparison) {
        let word = change.status.word();
        let _ = write!(out, "{word:<8} {}", shown(&change.path));
        if let Some(amounts) = &change.geometry
            && change.status != Status::Redrawn
        {
            let _ = write!(out, "  {}", in_words(amounts));
        }
        out.push('\n');
        if change.status == Status::Changed || change.status == Status::Redrawn {
            for (name, pair) in &change.measures {
                let _ = writeln!(out, "         {name}: {}", arrow(pair));
            }
        }
    }
    out + &counts(comparison) + "\n"
}

/// The artifacts that are not the same, those first that matter most.
pub fn in_order(comparison: &Comparison) -> impl Iterator<Item = &Change> {
    let statuses = Status::ALL.into_iter().filter(|s| *s != Status::Same);
    statuses.flat_map(|status| {
        let all = comparison.artifacts.iter();
        all.filter(move |change| change.status == status)
    })
}

/// How many artifacts have which status.
pub fn counts(comparison: &Comparison) -> String {
    let of = |status: Status| match comparison.count_of(status) {
        0 => None,
        count => Some(format!("{count} {}", status.word())),
    };
    let counts: Vec<String> = Status::ALL.into_iter().filter_map(of).collect();
    let states = format!("{} to {}", comparison.before, comparison.after);
    match &counts[..] {
        [] => format!("{}: no artifacts", shown(&states)),
        counts => format!("{}: {}", shown(&states), counts.join(", ")),
    }
}

/// `+3.2 mm² -1 mm², 240 mm² in common`.
pub fn in_words(amounts: &Amounts) -> String {
    let unit = amounts.unit.replace('2', "²").replace('3', "³");
    let [added, removed, common] = [amounts.added, amounts.removed, amounts.common].map(number);
    format!("+{added} {unit} -{removed} {unit}, {common} {unit} in common")
}

/// A number with six digits.
fn number(amount: f64) -> String {
    let rounded: f64 = format!("{amount:.5e}").parse().unwrap_or(amount);
    rounded.to_string()
}

/// `BEFORE → AFTER`, a dash for what is not there.
pub fn arrow([before, after]: &[Value; 2]) -> String {
    let text = |value: &Value| match value {
        Value::Null => "–".to_string(),
        value => shown(&value.to_string()).into_owned(),
    };
    format!("{} → {}", text(before), text(after))
}

/// Annotations for what is another object, ten of them and a notice that counts the rest.
pub fn notices(comparison: &Comparison) -> String {
    let differing = in_order(comparison).filter(|change| change.status.differs());
    let mut out = String::new();
    let mut rest = 0;
    for (number, change) in differing.enumerate() {
        if number < SHOWN {
            let amounts = change.geometry.as_ref().map(in_words);
            let message = format!("{} {}", change.path, amounts.unwrap_or_default());
            out += &github::notice(&change.spec, change.status.word(), message.trim_end());
        } else {
            rest += 1;
        }
    }
    if rest > 0 {
        let more = match rest {
            1 => "1 more artifact differs".to_owned(),
            rest => format!("{rest} more artifacts differ"),
        };
        let _ = writeln!(out, "::notice::{more}");
    }
    out
}

/// A section for the summary of a job.
pub fn markdown(comparison: &Comparison) -> String {
    let mut out = format!(
        "### fretwork diff\n\n{}\n\n",
        github::plain(&counts(comparison))
    );
    out += "| | artifact | added | removed | in common | measures |\n| --- | --- | ---: | ---: | ---: | --- |\n";
    for (number_of, change) in in_order(comparison).enumerate() {
        let line = row(change);
        if out.len() + line.len() > LONGEST {
            let rest = in_order(comparison).count() - number_of;
            let _ = writeln!(out, "\nand {rest} more");
            break;
        }
        out += &line;
    }
    out + "\n"
}

/// A row of the table.
fn row(change: &Change) -> String {
    let amounts = change.geometry.as_ref().map_or(" | | ".to_string(), |a| {
        let unit = a.unit.replace('2', "²").replace('3', "³");
        let amounts = [a.added, a.removed, a.common];
        let amounts = amounts.map(|amount| format!("{} {unit}", number(amount)));
        amounts.join(" | ")
    });
    let is_shown = change.status == Status::Changed;
    let measures = change.measures.iter().filter(|_| is_shown);
    let measures: Vec<String> = measures
        .map(|(name, pair)| github::plain(&format!("{name} {}", arrow(pair))))
        .collect();
    let (word, path) = (change.status.word(), github::cell(&change.path));
    format!(
        "| {word} | {path} | {amounts} | {} |\n",
        measures.join("<br>")
    )
}
