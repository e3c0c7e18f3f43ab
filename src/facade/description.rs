//! What a facade is made of, with names resolved to values: the room's own plain input. Reading it
//! from a spec, and knowing where its parts stand in files, belong to others.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The description of a facade to lay out.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Effort and height of the canvas, above zero.
    pub canvas: [f64; 2],
    /// The symbols that patterns may name.
    pub symbols: BTreeMap<char, Symbol>,
    /// The ranges of counters. A counter without one starts at 1.
    pub counters: BTreeMap<char, Range>,
    /// The layers, the lowest first.
    pub layers: Vec<Layer>,
}

/// The attributes of a symbol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symbol {
    /// The preferred size, in the unit of the canvas; a wildcard has none.
    pub size: Option<f64>,
    /// Whether the symbol hides whatever lies below it.
    pub opaque: bool,
    /// Whether an empty entry may not lie beside the symbol.
    pub attached: bool,
    /// Whether only wholly opaque entries may cover the symbol.
    pub unoccludable: bool,
    /// Whether the symbol keeps its preferred size.
    pub fixed: bool,
    /// The factor of the symbol's squared change of size in the size error.
    pub weight: f64,
}

impl Default for Symbol {
    fn default() -> Symbol {
        Symbol {
            size: None,
            opaque: false,
            attached: false,
            unoccludable: false,
            fixed: false,
            weight: 1.0,
        }
    }
}

/// The values that a counter may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range {
    /// The least value.
    pub min: i64,
    /// The greatest value; none if only the canvas limits the counter.
    pub max: Option<i64>,
}

impl Default for Range {
    /// The range of a counter that the facade does not list.
    fn default() -> Range {
        Range { min: 1, max: None }
    }
}

impl Range {
    /// The range that holds one value only.
    pub fn only(value: i64) -> Range {
        Range {
            min: value,
            max: Some(value),
        }
    }

    /// The value in the range that is nearest to 0, where words are shortest.
    pub fn nearest_to_zero(self) -> i64 {
        0i64.clamp(self.min, self.max.unwrap_or(i64::MAX).max(self.min))
    }
}

/// A layer: an outer product of two patterns.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// The name of the layer.
    pub name: Arc<str>,
    /// The patterns along x and y.
    pub patterns: [PatternText; 2],
    /// The alignment groups along x and y.
    pub groups: [Arc<str>; 2],
    /// The symbols that are drawn along x and y; none if all of them are.
    pub visible: [Option<BTreeSet<char>>; 2],
}

/// A named pattern that is not parsed yet.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PatternText {
    /// The name of the pattern.
    pub name: Arc<str>,
    /// The whole of a plain pattern, or the control pattern.
    pub control: Arc<str>,
    /// The patterns that replace letters of the control pattern.
    pub content: Option<BTreeMap<char, Arc<str>>>,
}
