//! What a facade is made of, with names resolved to values: the room's own plain input. Reading it
//! from a spec, and the places of its parts in files, belong to others.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::candidate::Range;

/// A facade to lay out.
#[derive(Clone, Debug, PartialEq)]
pub struct Facade {
    /// Width and height of the canvas, above zero.
    pub canvas: [f64; 2],
    /// The symbols that patterns may name.
    pub symbols: BTreeMap<char, Symbol>,
    /// The values of counters; the others start at 1.
    pub counters: BTreeMap<char, Range>,
    /// The layers, the lowest first.
    pub layers: Vec<Layer>,
}

/// A symbol's attributes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Symbol {
    /// The preferred size, in the unit of the canvas; none for a wildcard.
    pub size: Option<f64>,
    /// Covers the whole of its column.
    pub opaque: bool,
    /// Bears no hole beside it.
    pub attached: bool,
    /// Bears only opaque shapes above it.
    pub unoccludable: bool,
    /// Is never resized.
    pub fixed: bool,
    /// How much a square of a change counts.
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

/// A layer: an outer product of two patterns.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its name.
    pub name: Arc<str>,
    /// The patterns along x and y.
    pub patterns: [PatternText; 2],
    /// The alignment groups along x and y.
    pub groups: [Arc<str>; 2],
    /// The symbols that are drawn, along x and y; none: all.
    pub visible: [Option<BTreeSet<char>>; 2],
}

/// A named pattern that is not parsed yet.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PatternText {
    /// Its name.
    pub name: Arc<str>,
    /// The pattern, or the control pattern.
    pub control: Arc<str>,
    /// Patterns for letters of the control pattern.
    pub content: Option<BTreeMap<char, Arc<str>>>,
}
