//! The texts of a description's patterns, parsed, with the mistakes in them. What can be wrong beyond
//! one text is in `check`.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::check;
use super::syntax::{Pattern, PatternError, PatternTree, parse};
use crate::axis::Axis;
use crate::description::{Description, PatternText};
use crate::problem::{Part, PatternPart, Problem};
use fretwork_diagnostic::Severity;

/// The patterns of a facade.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The patterns along each axis, of the uppermost layer first.
    pub patterns: [Vec<Pattern>; 2],
}

impl Prepared {
    /// Parses and checks a whole description (rules R3 and R14): the patterns and warnings.
    ///
    /// # Errors
    /// All mistakes, with the warnings.
    pub fn new(description: &Description) -> Result<(Prepared, Vec<Problem>), Vec<Problem>> {
        let mut problems = Vec::new();
        check::values(description, &mut problems);
        let mut seen = BTreeSet::new();
        let patterns = Axis::BOTH.map(|axis| {
            let layers = description.layers.iter().rev();
            layers
                .map(|layer| &layer.patterns[axis])
                .filter_map(|text| {
                    let is_new = seen.insert(text.name.clone());
                    read(description, text, is_new, &mut problems)
                })
                .collect()
        });
        check::masks(description, &patterns, &mut problems);
        check::opaque(description, &patterns, &mut problems);
        check::counters(description, &patterns, &mut problems);
        if problems.iter().any(|p| p.severity == Severity::Error) {
            return Err(problems);
        }
        Ok((Prepared { patterns }, problems))
    }

    /// The counters that both axes use.
    pub fn shared_counters(&self) -> Vec<char> {
        let of = |axis: Axis| {
            self.patterns[axis]
                .iter()
                .flat_map(Pattern::counters)
                .collect::<BTreeSet<char>>()
        };
        of(Axis::X).intersection(&of(Axis::Y)).copied().collect()
    }
}

/// The mistakes of a pattern that show in its texts alone.
pub fn mistakes(text: &PatternText) -> Vec<Problem> {
    parse_all(text).err().unwrap_or_default()
}

/// Parses one pattern. Its mistakes are reported only if it is new: several layers may use it.
fn read(
    description: &Description,
    text: &PatternText,
    is_new: bool,
    problems: &mut Vec<Problem>,
) -> Option<Pattern> {
    let pattern = parse_all(text)
        .map_err(|found| problems.extend(found.into_iter().filter(|_| is_new)))
        .ok()?;
    if is_new {
        check::pattern(description, text, &pattern, problems);
    }
    Some(pattern)
}

fn parse_all(text: &PatternText) -> Result<Pattern, Vec<Problem>> {
    let mut found = Vec::new();
    let mut tree = |which: PatternPart, source: &Arc<str>| -> Option<PatternTree> {
        let report = |e: PatternError| {
            let part = Part::Pattern {
                name: text.name.clone(),
                text: which,
                bytes: bytes_of(source, e.offset, e.length),
            };
            found.push(Problem::error(part, e.to_string()));
        };
        parse(source).map_err(report).ok()
    };
    let control = tree(control_part(text), &text.control);
    let content: Option<Vec<Option<(char, PatternTree)>>> = text.content.as_ref().map(|content| {
        content
            .iter()
            .map(|(c, t)| tree(PatternPart::Content(*c), t).map(|tree| (*c, tree)))
            .collect()
    });
    let content = content.map(|content| content.into_iter().flatten().collect());
    match control {
        Some(control) if found.is_empty() => Ok(Pattern { control, content }),
        _ => Err(found),
    }
}

/// The bytes of some characters of a text.
fn bytes_of(text: &str, offset: usize, length: usize) -> std::ops::Range<usize> {
    let at = |n: usize| {
        text.char_indices()
            .nth(n)
            .map_or(text.len(), |(byte, _)| byte)
    };
    at(offset)..at(offset + length)
}

fn control_part(text: &PatternText) -> PatternPart {
    if text.content.is_some() {
        PatternPart::Control
    } else {
        PatternPart::Whole
    }
}
