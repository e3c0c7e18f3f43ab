//! The mistakes of a description that need no layout (rules R3, R6 and R14), and warnings about what
//! has no effect. Mistakes inside the text of a pattern are found in `prepare`.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::syntax::Pattern;
use crate::axis::Axis;
use crate::description::{Description, PatternText, Symbol};
use crate::problem::{Part, PatternPart, Problem};

/// Reports canvases, layers, ranges and symbols that cannot be used.
pub fn values(description: &Description, problems: &mut Vec<Problem>) {
    for axis in Axis::BOTH {
        let (name, side) = (axis.side(), description.canvas[axis]);
        if !(side > 0.0 && side.is_finite()) {
            problems.push(Problem::error(
                Part::Canvas(name),
                format!("the canvas is {side} in {name}: it must be above 0"),
            ));
        }
    }
    if description.layers.is_empty() {
        problems.push(Problem::error(Part::Facade, "the facade has no layers"));
    }
    for (counter, range) in &description.counters {
        if let Some(max) = range.max.filter(|max| *max < range.min) {
            let message = format!(
                "the range of counter `{counter}` is empty: from {} to {max}",
                range.min
            );
            problems.push(Problem::error(Part::Counter(*counter), message));
        }
    }
    for (name, symbol) in &description.symbols {
        check_symbol(*name, symbol, problems);
    }
}

/// Warns of ranges for counters that no pattern has.
pub fn counters(
    description: &Description,
    patterns: &[Vec<Pattern>; 2],
    problems: &mut Vec<Problem>,
) {
    let used: BTreeSet<char> = patterns
        .iter()
        .flatten()
        .flat_map(Pattern::counters)
        .collect();
    for idle in description
        .counters
        .keys()
        .filter(|counter| !used.contains(counter))
    {
        let warning = Problem::warning(
            Part::Counter(*idle),
            format!("no pattern has a counter `{idle}`"),
        );
        let names: Vec<String> = used.iter().map(|counter| format!("`{counter}`")).collect();
        problems.push(warning.help(match names.is_empty() {
            true => "the patterns have none".to_string(),
            false => format!("the patterns have {}", names.join(", ")),
        }));
    }
}

fn check_symbol(name: char, symbol: &Symbol, problems: &mut Vec<Problem>) {
    if let Some(size) = symbol
        .size
        .filter(|size| !(*size > 0.0 && size.is_finite()))
    {
        let message = format!("the size of symbol `{name}` is {size}: it must be above 0");
        problems.push(Problem::error(Part::Symbol(name, Some("size")), message));
    }
    if !(symbol.weight > 0.0 && symbol.weight.is_finite()) {
        let message = format!(
            "the weight of symbol `{name}` is {}: it must be above 0",
            symbol.weight
        );
        problems.push(Problem::error(Part::Symbol(name, Some("weight")), message));
    }
    if symbol.fixed && symbol.weight != 1.0 {
        let message =
            format!("symbol `{name}` contradicts itself: it is fixed, so its weight says nothing");
        problems.push(Problem::error(Part::Symbol(name, Some("weight")), message));
    }
    let flags = [
        ("opaque", symbol.opaque),
        ("attached", symbol.attached),
        ("unoccludable", symbol.unoccludable),
        ("fixed", symbol.fixed),
    ];
    if let (None, Some((flag, _))) = (symbol.size, flags.into_iter().find(|(_, set)| *set)) {
        let message = format!(
            "symbol `{name}` contradicts itself: it is {flag}, but has no size, so it is never drawn"
        );
        problems
            .push(Problem::error(Part::Symbol(name, Some(flag)), message).help("give it a `size`"));
    }
}

/// Reports symbols of a pattern that are unknown or cannot be drawn, and content that replaces
/// nothing.
pub fn pattern(
    description: &Description,
    text: &PatternText,
    pattern: &Pattern,
    problems: &mut Vec<Problem>,
) {
    let part = |which: PatternPart, source: &str, symbol: char| {
        let start = source.find(symbol).unwrap_or(0);
        Part::Pattern {
            name: text.name.clone(),
            text: which,
            bytes: start..start + symbol.len_utf8(),
        }
    };
    let known = |c: &char| description.symbols.get(c).is_some_and(|s| s.size.is_some());
    let complaint = |c: char| match description.symbols.get(&c) {
        Some(_) => format!(
            "symbol `{c}` has no size, but is drawn by pattern `{}`",
            text.name
        ),
        None => format!("unknown symbol `{c}` in pattern `{}`", text.name),
    };
    let Some(content) = &pattern.content else {
        for c in pattern.control.symbols().into_iter().filter(|c| !known(c)) {
            problems.push(Problem::error(
                part(PatternPart::Whole, &text.control, c),
                complaint(c),
            ));
        }
        return;
    };
    let control = pattern.control.symbols();
    for (key, node) in content {
        let source = text
            .content
            .as_ref()
            .and_then(|content| content.get(key))
            .map_or("", |t| t);
        if !control.contains(key) {
            let message = format!(
                "pattern `{}` has content for `{key}`, which its control pattern lacks",
                text.name
            );
            let place = Part::Pattern {
                name: text.name.clone(),
                text: PatternPart::Content(*key),
                bytes: 0..source.len(),
            };
            problems.push(Problem::error(place, message));
        }
        for c in node.symbols().into_iter().filter(|c| !known(c)) {
            problems.push(Problem::error(
                part(PatternPart::Content(*key), source, c),
                complaint(c),
            ));
        }
    }
}

/// Warns of masks that name symbols which the pattern of their layer lacks.
pub fn masks(description: &Description, patterns: &[Vec<Pattern>; 2], problems: &mut Vec<Problem>) {
    for axis in Axis::BOTH {
        if patterns[axis].len() < description.layers.len() {
            continue;
        }
        let layers = description.layers.iter().rev();
        for (layer, pattern) in layers.zip(&patterns[axis]) {
            let used = pattern.letters();
            let mask = layer.visible[axis].iter().flatten();
            for c in mask.filter(|c| !used.contains(c)) {
                let message = format!(
                    "layer `{}` shows symbol `{c}`, which its pattern does not have",
                    layer.name
                );
                let part = Part::Layer(layer.name.clone(), Some(axis.mask()));
                problems.push(Problem::warning(part, message));
            }
        }
    }
}

/// Reports groups without an opaque letter: every column needs one (rule R6).
pub fn opaque(
    description: &Description,
    patterns: &[Vec<Pattern>; 2],
    problems: &mut Vec<Problem>,
) {
    let is_opaque = |c: &char| description.symbols.get(c).is_some_and(|s| s.opaque);
    for axis in Axis::BOTH {
        if patterns[axis].len() < description.layers.len() {
            continue;
        }
        let layers = || description.layers.iter().rev().zip(&patterns[axis]);
        let groups: BTreeSet<&Arc<str>> = layers().map(|(layer, _)| &layer.groups[axis]).collect();
        for group in groups {
            let mut members = layers().filter(|(layer, _)| layer.groups[axis] == *group);
            if !members.any(|(_, pattern)| pattern.solid_letters().iter().any(is_opaque)) {
                let message = format!(
                    "no symbol of group `{group}` on {} is opaque: every column needs one that is",
                    axis.name()
                );
                problems.push(
                    Problem::error(Part::Facade, message)
                        .help("set `opaque: true` on the symbols of the background"),
                );
            }
        }
    }
}
