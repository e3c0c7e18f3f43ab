//! What all jobs of a build have to say, each error once: a node that fails on one region after another has the same to say of
//! each, but for the places that it names.

use std::collections::BTreeMap;

use super::database::Database;
use super::job::Job;
use super::modules::told;
use fretwork_diagnostic::{Code, Diagnostic, Span};

/// What makes errors of two jobs one: where they are, what they are about, and what they say apart from its numbers.
type Kind = (Vec<Span>, Option<Code>, String, Option<String>);

/// What evaluating the jobs had to say. Of errors of several jobs that differ in numbers only, those of the first job are kept.
pub fn told_once(db: &Database, jobs: &[Job]) -> Vec<Diagnostic> {
    let each = jobs.iter().map(|job| told(db, job));
    once(each)
}

fn once(each: impl Iterator<Item = Vec<Diagnostic>>) -> Vec<Diagnostic> {
    let mut first: BTreeMap<Kind, usize> = BTreeMap::new();
    let mut all = Vec::new();
    for (number, said) in each.enumerate() {
        let is_kept =
            |d: &Diagnostic| !d.is_error() || *first.entry(kind(d)).or_insert(number) == number;
        all.extend(said.into_iter().filter(is_kept));
    }
    all
}

fn kind(diagnostic: &Diagnostic) -> Kind {
    let spans = diagnostic.labels.iter().map(|label| label.span.clone());
    let help = diagnostic.help.as_deref().map(without_numbers);
    let message = without_numbers(&diagnostic.message);
    (spans.collect(), diagnostic.code, message, help)
}

fn without_numbers(text: &str) -> String {
    let is_kept = |c: &char| !(c.is_ascii_digit() || matches!(c, '.' | '-'));
    text.chars().filter(is_kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bug: a mapper that fails was told for each region that it was evaluated on.
    #[test]
    fn an_error_of_several_regions_is_told_once() {
        let span = |name: &str| Span::File(name.into());
        let of = |at: &str, name: &str| {
            Diagnostic::error(format!("on the face at {at}: no")).at(span(name), "")
        };
        let warning = |at: &str| Diagnostic::warning(at).at(span("a"), "");
        let each = vec![
            vec![of("(1, 2.5)", "a"), of("(3, 4)", "a"), warning("1")],
            vec![of("(-7, 1)", "a"), warning("2")],
            vec![of("(5, 6)", "b")],
        ];
        let kept: Vec<String> = once(each.into_iter())
            .into_iter()
            .map(|d| d.message)
            .collect();
        let errors = ["(1, 2.5)", "(3, 4)"].map(|at| format!("on the face at {at}: no"));
        let rest = [
            "1".to_string(),
            "2".into(),
            "on the face at (5, 6): no".into(),
        ];
        assert_eq!(kept, [&errors[..], &rest[..]].concat());
    }
}
