//! From a facade's description to its two axes, with every mistake that can be told before any
//! word is laid out (rules R3, R14).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::candidate::{Axis, Line, Range, Symbol, counters_of};
use super::grid::Grid;
use super::input::{Facade, PatternText};
use super::pattern::{Node, Pattern, PatternError, parse};
use super::problem::{Part, PatternPart, Problem};

/// The patterns of a facade, parsed, by axis and layer (the uppermost first).
#[derive(Clone, Debug)]
pub struct Prepared {
    patterns: [Vec<Pattern>; 2],
}

impl Prepared {
    /// Parses and checks all of `facade`; errors, or the patterns and warnings.
    pub fn new(facade: &Facade) -> Result<(Prepared, Vec<Problem>), Vec<Problem>> {
        let mut problems = Vec::new();
        check_values(facade, &mut problems);
        let mut seen = BTreeSet::new();
        let patterns = [0, 1].map(|axis| {
            let texts = facade
                .layers
                .iter()
                .rev()
                .map(|layer| &layer.patterns[axis]);
            texts
                .filter_map(|text| {
                    read(facade, text, seen.insert(text.name.clone()), &mut problems)
                })
                .collect()
        });
        check_masks(facade, &patterns, &mut problems);
        check_opaque(facade, &patterns, &mut problems);
        check_counters(facade, &patterns, &mut problems);
        if problems
            .iter()
            .any(|p| p.severity == fretwork_diagnostic::Severity::Error)
        {
            return Err(problems);
        }
        Ok((Prepared { patterns }, problems))
    }

    /// The counters that both axes use.
    pub fn shared_counters(&self) -> Vec<char> {
        let of = |axis: usize| {
            self.patterns[axis]
                .iter()
                .flat_map(counters_of)
                .collect::<BTreeSet<char>>()
        };
        of(0).intersection(&of(1)).copied().collect()
    }

    /// An axis (0 is x), with some counters fixed; `None` when no symbol on it has a size.
    pub fn axis(
        &self,
        facade: &Facade,
        axis: usize,
        fixed: &BTreeMap<char, i64>,
    ) -> Option<Axis<'_>> {
        let mut patterns: Vec<&Pattern> = Vec::new();
        let mut groups: Vec<&str> = Vec::new();
        let mut lines = Vec::new();
        for (layer, pattern) in facade.layers.iter().rev().zip(&self.patterns[axis]) {
            lines.push(Line {
                pattern: number_of(&mut patterns, pattern),
                group: number_of(&mut groups, &layer.groups[axis]),
            });
        }
        let names: BTreeSet<char> = patterns.iter().flat_map(|p| used_symbols(p)).collect();
        let symbols: Vec<Symbol> = names.into_iter().map(|name| symbol(facade, name)).collect();
        let grid = Grid::of(&symbols.iter().filter_map(|s| s.size).collect::<Vec<_>>())?;
        let mut ranges = facade.counters.clone();
        ranges.extend(fixed.iter().map(|(counter, k)| {
            (
                *counter,
                Range {
                    min: *k,
                    max: Some(*k),
                },
            )
        }));
        let wildcards = (0..symbols.len())
            .filter(|i| symbols[*i].size.is_none())
            .collect();
        let groups = groups.len();
        Some(Axis {
            canvas: facade.canvas[axis],
            grid,
            symbols,
            wildcards,
            patterns,
            lines,
            groups,
            ranges,
        })
    }
}

fn number_of<T: PartialEq>(list: &mut Vec<T>, item: T) -> usize {
    list.iter()
        .position(|other| *other == item)
        .unwrap_or_else(|| {
            list.push(item);
            list.len() - 1
        })
}

/// The symbols that letters of the words can be.
fn used_symbols(pattern: &Pattern) -> BTreeSet<char> {
    let content = pattern.content.iter().flatten();
    let control = pattern.control.symbols().into_iter();
    let kept = control.filter(|c| {
        pattern
            .content
            .as_ref()
            .is_none_or(|content| !content.contains_key(c))
    });
    kept.chain(content.flat_map(|(_, node)| node.symbols()))
        .collect()
}

fn symbol(facade: &Facade, name: char) -> Symbol {
    let symbol = facade.symbols.get(&name).copied().unwrap_or_default();
    Symbol {
        name,
        size: symbol.size,
        opaque: symbol.opaque,
        attached: symbol.attached,
        unoccludable: symbol.unoccludable,
        fixed: symbol.fixed,
        weight: symbol.weight,
    }
}

fn check_values(facade: &Facade, problems: &mut Vec<Problem>) {
    for (name, side) in ["width", "height"].into_iter().zip(facade.canvas) {
        if !(side > 0.0 && side.is_finite()) {
            problems.push(Problem::error(
                Part::Canvas(name),
                format!("the canvas is {side} in {name}: it must be above 0"),
            ));
        }
    }
    if facade.layers.is_empty() {
        problems.push(Problem::error(Part::Facade, "the facade has no layers"));
    }
    for (counter, range) in &facade.counters {
        if let Some(max) = range.max.filter(|max| *max < range.min) {
            let message = format!(
                "the range of counter `{counter}` is empty: from {} to {max}",
                range.min
            );
            problems.push(Problem::error(Part::Counter(*counter), message));
        }
    }
    for (name, symbol) in &facade.symbols {
        check_symbol(*name, symbol, problems);
    }
}

/// Warns of ranges for counters that no pattern has.
fn check_counters(facade: &Facade, patterns: &[Vec<Pattern>; 2], problems: &mut Vec<Problem>) {
    let used: BTreeSet<char> = patterns.iter().flatten().flat_map(counters_of).collect();
    for idle in facade
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

fn check_symbol(name: char, symbol: &super::input::Symbol, problems: &mut Vec<Problem>) {
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

/// The mistakes of a pattern that show in its texts alone.
pub fn mistakes(text: &PatternText) -> Vec<Problem> {
    parse_all(text).err().unwrap_or_default()
}

fn parse_all(text: &PatternText) -> Result<Pattern, Vec<Problem>> {
    let mut found = Vec::new();
    let mut node = |which: PatternPart, text_of: &Arc<str>| -> Option<Node> {
        let told = |e: PatternError| {
            let bytes = bytes_of(text_of, e.offset, e.length);
            found.push(Problem::error(
                Part::Pattern {
                    name: text.name.clone(),
                    text: which,
                    bytes,
                },
                e.to_string(),
            ));
        };
        parse(text_of).map_err(told).ok()
    };
    let control = node(control_part(text), &text.control);
    let content: Option<Vec<Option<(char, Node)>>> = text.content.as_ref().map(|content| {
        content
            .iter()
            .map(|(c, t)| node(PatternPart::Content(*c), t).map(|node| (*c, node)))
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

/// Parses one pattern; reports its mistakes if it is `new`.
fn read(
    facade: &Facade,
    text: &PatternText,
    new: bool,
    problems: &mut Vec<Problem>,
) -> Option<Pattern> {
    let pattern = parse_all(text)
        .map_err(|found| problems.extend(found.into_iter().filter(|_| new)))
        .ok()?;
    if new {
        check_pattern(facade, text, &pattern, problems);
    }
    Some(pattern)
}

fn check_pattern(
    facade: &Facade,
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
    let known = |c: &char| facade.symbols.get(c).is_some_and(|s| s.size.is_some());
    let complain = |c: char| match facade.symbols.get(&c) {
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
                complain(c),
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
                complain(c),
            ));
        }
    }
}

fn check_masks(facade: &Facade, patterns: &[Vec<Pattern>; 2], problems: &mut Vec<Problem>) {
    for (axis, (field, patterns)) in ["visible.x", "visible.y"]
        .into_iter()
        .zip(patterns)
        .enumerate()
    {
        if patterns.len() < facade.layers.len() {
            continue;
        }
        for (layer, pattern) in facade.layers.iter().rev().zip(patterns) {
            let used = used_symbols(pattern);
            for c in layer.visible[axis]
                .iter()
                .flatten()
                .filter(|c| !used.contains(c))
            {
                let message = format!(
                    "layer `{}` shows symbol `{c}`, which its pattern has not",
                    layer.name
                );
                problems.push(Problem::warning(
                    Part::Layer(layer.name.clone(), Some(field)),
                    message,
                ));
            }
        }
    }
}

/// Every column needs an opaque letter (rule R6).
fn check_opaque(facade: &Facade, patterns: &[Vec<Pattern>; 2], problems: &mut Vec<Problem>) {
    for (axis, (name, patterns)) in ["x", "y"].into_iter().zip(patterns).enumerate() {
        if patterns.len() < facade.layers.len() {
            continue;
        }
        let groups: BTreeSet<&Arc<str>> = facade
            .layers
            .iter()
            .map(|layer| &layer.groups[axis])
            .collect();
        for group in groups {
            let members = facade
                .layers
                .iter()
                .rev()
                .zip(patterns)
                .filter(|(layer, _)| layer.groups[axis] == *group);
            let opaque = |c: &char| facade.symbols.get(c).is_some_and(|s| s.opaque);
            let solid = |p: &Pattern| -> BTreeSet<char> {
                match &p.content {
                    None => used_symbols(p),
                    Some(content) => content.values().flat_map(Node::symbols).collect(),
                }
            };
            if !members
                .into_iter()
                .any(|(_, p)| solid(p).iter().any(opaque))
            {
                let message = format!(
                    "no symbol of group `{group}` on {name} is opaque: every column needs one that is"
                );
                problems.push(
                    Problem::error(Part::Facade, message)
                        .help("set `opaque: true` on the symbols of the background"),
                );
            }
        }
    }
}
