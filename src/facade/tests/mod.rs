//! Tests of the room as a whole: the paper's examples, random inputs against slow oracles, bad
//! input, retargeting.

mod alignment;
mod bad;
mod bulk;
mod paper;
mod sizes;
mod words;

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::description::{Description, Layer, PatternText, Range, Symbol};
use crate::layout::lay_out;
use fretwork_geometry::FacadeLayout;

/// A facade of which only x is of interest: every layer has the pattern `P` along y.
pub struct Sketch(pub Description);

impl Sketch {
    /// A canvas of this width, without layers.
    pub fn new(width: f64) -> Sketch {
        let canvas = [width, 3.0];
        let facade = Description {
            canvas,
            symbols: BTreeMap::new(),
            counters: BTreeMap::new(),
            layers: Vec::new(),
        };
        Sketch(facade).symbol("P 3 opaque")
    }

    /// Adds a symbol: its letter, size, and qualifiers.
    pub fn symbol(mut self, text: &str) -> Sketch {
        let mut words = text.split_whitespace();
        let name = words
            .next()
            .and_then(|w| w.chars().next())
            .expect("a letter");
        let mut symbol = Symbol {
            size: words.next().map(|w| w.parse().expect("a size")),
            ..Symbol::default()
        };
        for word in words {
            match word {
                "opaque" => symbol.opaque = true,
                "attached" => symbol.attached = true,
                "unoccludable" => symbol.unoccludable = true,
                "fixed" => symbol.fixed = true,
                weight => symbol.weight = weight.parse().expect("a weight"),
            }
        }
        self.0.symbols.insert(name, symbol);
        self
    }

    /// Adds several symbols.
    pub fn symbols(self, texts: &[&str]) -> Sketch {
        texts.iter().fold(self, |sketch, text| sketch.symbol(text))
    }

    /// Limits a counter.
    pub fn counter(mut self, name: char, min: i64, max: i64) -> Sketch {
        self.0.counters.insert(
            name,
            Range {
                min,
                max: Some(max),
            },
        );
        self
    }

    /// Puts a layer on top: a pattern, or `control; letter = pattern; …`.
    pub fn layer(self, name: &str, x: &str) -> Sketch {
        self.grid(name, x, "P")
    }

    /// Puts a layer on top with patterns for both axes.
    pub fn grid(mut self, name: &str, x: &str, y: &str) -> Sketch {
        let main: Arc<str> = "main".into();
        self.0.layers.push(Layer {
            name: name.into(),
            patterns: [pattern(x), pattern(y)],
            groups: [main.clone(), main],
            visible: [None, None],
        });
        self
    }

    /// The layout.
    pub fn solve(&self) -> FacadeLayout {
        lay_out(&self.0)
            .unwrap_or_else(|problems| panic!("{problems:#?}"))
            .0
    }

    /// The messages where there is no layout.
    pub fn complain(&self) -> String {
        let problems = lay_out(&self.0)
            .map(|(layout, _)| layout)
            .expect_err("no layout");
        problems
            .into_iter()
            .map(|p| format!("{:?}: {}\n", p.part, p.message))
            .collect()
    }
}

/// A pattern, or `control; letter = pattern; …`; it is called as it is written.
pub fn pattern(text: &str) -> PatternText {
    let mut parts = text.split(';');
    let control = parts.next().unwrap_or_default().trim().into();
    let content: BTreeMap<char, Arc<str>> = parts
        .map(|part| {
            let (letter, inner) = part.split_once('=').expect("letter = pattern");
            (
                letter.trim().chars().next().expect("a letter"),
                inner.trim().into(),
            )
        })
        .collect();
    PatternText {
        name: text.into(),
        control,
        content: (!content.is_empty()).then_some(content),
    }
}

/// `symbol@start+width` of the shapes of a layer in the lowest row, rounded to hundredths.
pub fn row(layout: &FacadeLayout, layer: &str) -> String {
    let number = layout
        .layers
        .iter()
        .position(|name| &**name == layer)
        .expect("a layer") as u32;
    let cells = layout
        .cells
        .iter()
        .filter(|c| c.layer == number && c.y < 1e-9);
    let round = |v: f64| (v * 100.0).round() / 100.0;
    let shown: Vec<String> = cells
        .map(|c| format!("{}@{}+{}", c.symbol_x, round(c.x), round(c.width)))
        .collect();
    shown.join(" ")
}
