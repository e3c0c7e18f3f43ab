//! The task that is solved along one axis: the symbols, patterns and layers of a facade with numbers
//! in place of names, and sizes as multiples of one step.

use std::collections::{BTreeMap, BTreeSet};

use super::grid::Grid;
use crate::axis::Axis;
use crate::description::{Description, Range};
use crate::pattern::prepare::Prepared;
use crate::pattern::syntax::Pattern;
use crate::size::least_squares::Preference;

/// One axis of a facade.
#[derive(Clone, Debug)]
pub struct AxisTask<'a> {
    /// The side of the canvas.
    pub canvas: f64,
    /// The step that all sizes are multiples of.
    pub grid: Grid,
    /// The symbols in use, by name.
    pub symbols: Vec<AxisSymbol>,
    /// The numbers of the symbols without a size, ascending.
    pub wildcards: Vec<usize>,
    /// The patterns in use.
    pub patterns: Vec<&'a Pattern>,
    /// A line for each layer, the uppermost first.
    pub lines: Vec<Line>,
    /// The number of groups that the lines are in.
    pub groups: usize,
    /// The ranges of counters that the facade lists.
    pub ranges: BTreeMap<char, Range>,
}

/// A symbol of an axis; its attributes are those of [`crate::Symbol`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct AxisSymbol {
    pub name: char,
    pub size: Option<f64>,
    pub opaque: bool,
    pub attached: bool,
    pub unoccludable: bool,
    pub fixed: bool,
    pub weight: f64,
}

/// The part of a layer along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// The number of its pattern.
    pub pattern: usize,
    /// The number of its alignment group.
    pub group: usize,
}

/// What the canvas and the tolerance leave (rule R5), in steps.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// The greatest length of a word, and of all columns together.
    pub longest: i64,
    /// The least length of the uppermost word.
    pub shortest: i64,
    /// The greatest alignment error.
    pub error: i64,
}

impl<'a> AxisTask<'a> {
    /// The task along `axis`; `None` if no symbol on it has a size.
    pub fn new(
        description: &Description,
        prepared: &'a Prepared,
        axis: Axis,
    ) -> Option<AxisTask<'a>> {
        let mut patterns: Vec<&Pattern> = Vec::new();
        let mut groups: Vec<&str> = Vec::new();
        let mut lines = Vec::new();
        for (layer, pattern) in description
            .layers
            .iter()
            .rev()
            .zip(&prepared.patterns[axis])
        {
            lines.push(Line {
                pattern: number_of(&mut patterns, pattern),
                group: number_of(&mut groups, &layer.groups[axis]),
            });
        }
        let names: BTreeSet<char> = patterns.iter().flat_map(|p| p.letters()).collect();
        let symbols: Vec<AxisSymbol> = names
            .into_iter()
            .map(|name| symbol(description, name))
            .collect();
        let grid = Grid::of(&symbols.iter().filter_map(|s| s.size).collect::<Vec<_>>())?;
        let wildcards = (0..symbols.len())
            .filter(|i| symbols[*i].size.is_none())
            .collect();
        Some(AxisTask {
            canvas: description.canvas[axis],
            grid,
            symbols,
            wildcards,
            patterns,
            lines,
            groups: groups.len(),
            ranges: description.counters.clone(),
        })
    }

    /// The same task with some counters fixed.
    pub fn with_counters(&self, fixed: &BTreeMap<char, i64>) -> AxisTask<'a> {
        let mut task = self.clone();
        let ranges = fixed.iter().map(|(name, k)| (*name, Range::only(*k)));
        task.ranges.extend(ranges);
        task
    }

    /// The values that a counter may take.
    pub fn range(&self, counter: char) -> Range {
        self.ranges.get(&counter).copied().unwrap_or_default()
    }

    /// The window at a tolerance, which is a length.
    pub fn window(&self, tolerance: f64) -> Window {
        Window {
            longest: self.grid.floor(self.canvas + tolerance),
            shortest: self.grid.ceil(self.canvas - tolerance),
            error: self.grid.floor(tolerance),
        }
    }

    /// What the sizes of the symbols should come near to.
    pub fn preferences(&self) -> Vec<Preference> {
        let symbols = self.symbols.iter();
        symbols
            .map(|s| Preference {
                size: s.size,
                weight: s.weight,
                fixed: s.fixed,
            })
            .collect()
    }

    /// The preferred length of a symbol in steps; a wildcard counts as one step.
    pub fn steps(&self, symbol: char) -> i64 {
        let known = self
            .symbols
            .iter()
            .find(|s| s.name == symbol)
            .and_then(|s| s.size);
        known.map_or(1, |size| self.grid.steps(size))
    }

    /// Whether the words of a pattern must fill the canvas, because no opaque letter can lie above
    /// them in their group.
    pub fn is_rigid(&self, pattern: usize) -> bool {
        let mut lines = self.lines.iter().enumerate();
        lines.all(|(i, line)| {
            let above = || self.lines[..i].iter().filter(|l| l.group == line.group);
            line.pattern != pattern || !above().any(|line| self.has_opaque(line))
        })
    }

    fn has_opaque(&self, line: &Line) -> bool {
        let mut opaque = self.symbols.iter().filter(|s| s.opaque);
        opaque.any(|s| self.patterns[line.pattern].uses(s.name))
    }
}

/// The number of an item in a list, which it is added to if it is new.
fn number_of<T: PartialEq>(list: &mut Vec<T>, item: T) -> usize {
    list.iter()
        .position(|other| *other == item)
        .unwrap_or_else(|| {
            list.push(item);
            list.len() - 1
        })
}

fn symbol(description: &Description, name: char) -> AxisSymbol {
    let symbol = description.symbols.get(&name).copied().unwrap_or_default();
    AxisSymbol {
        name,
        size: symbol.size,
        opaque: symbol.opaque,
        attached: symbol.attached,
        unoccludable: symbol.unoccludable,
        fixed: symbol.fixed,
        weight: symbol.weight,
    }
}
