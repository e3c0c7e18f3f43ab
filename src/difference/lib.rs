//! What differs between two states of one file: how much geometry was added, how much removed, how much both have in
//! common, and a picture of it. What the states are of, and where they come from, is not known here.
//!
//! Drawings are compared layer by layer ([`areas`], [`lines`]), bodies by booleans ([`bodies`]); [`picture`] shows either.

pub mod areas;
pub mod bodies;
pub mod lines;
pub mod picture;

use serde::Serialize;

use fretwork_fabricate::{Item, Layer, Sheet};
use fretwork_geometry::{Bounds, Model, Point, Polygon};

/// A drawing or a body in the units of its file.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A drawing as it is finished, without what makes up for a beam.
    Drawing(Drawing),
    /// A body in millimetres.
    Body(Model),
}

/// A drawing in the units of its file, y down.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The page.
    pub page: Bounds,
    /// From the lowest.
    pub layers: Vec<Layer>,
    /// The word for its unit.
    pub unit: &'static str,
}

impl Drawing {
    /// What stands on `sheet`, in a file whose unit is called `unit`.
    pub fn of(sheet: &Sheet, unit: &'static str) -> Drawing {
        let scaled = |layer: &Layer| Layer {
            items: layer
                .items
                .iter()
                .map(|item| item.mapped(|p| p * sheet.unit_mm))
                .collect(),
            ..layer.clone()
        };
        Drawing {
            page: sheet.page_mm(),
            layers: sheet.layers.iter().map(scaled).collect(),
            unit,
        }
    }

    /// A drawing of nothing in the place of another one.
    fn empty(other: &Drawing) -> Drawing {
        Drawing {
            layers: Vec::new(),
            ..other.clone()
        }
    }
}

/// How much differs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Amounts {
    /// What the state after has alone.
    pub added: f64,
    /// What the state before has alone.
    pub removed: f64,
    /// What both have.
    pub common: f64,
    /// The unit: that of areas where there are some, else of lengths; of bodies that of volumes.
    pub unit: &'static str,
}

/// Both differ if more than this part of what either has is not in both.
const SAME: f64 = 1e-6;

impl Amounts {
    /// Whether the geometry is the same but for rounding.
    pub fn is_same(&self) -> bool {
        let differing = self.added + self.removed;
        differing <= SAME * (differing + self.common)
    }

    /// The amounts without the noise of rounding.
    fn rounded(self) -> Amounts {
        let least = 1e-9 * (self.added + self.removed + self.common);
        let round = |v: f64| if v <= least { 0.0 } else { significant(v) };
        Amounts {
            added: round(self.added),
            removed: round(self.removed),
            common: round(self.common),
            unit: self.unit,
        }
    }
}

/// A number with nine digits.
fn significant(v: f64) -> f64 {
    format!("{v:.8e}").parse().unwrap_or(v)
}

/// What differs between two states of a file.
#[derive(Clone, Debug)]
pub struct Difference {
    /// How much; none where it cannot be told.
    pub amounts: Option<Amounts>,
    /// Whether the geometry is known to be the same.
    pub is_same: bool,
    /// What it looks like; none where there is nothing to be seen.
    pub overlay: Option<Overlay>,
}

/// The states of a file laid over one another.
#[derive(Clone, Debug)]
pub enum Overlay {
    /// Drawings.
    Drawing(Sketch),
    /// Bodies: what is common, removed and added, each a part of that name if there is some.
    Body(Model),
}

/// Two drawings laid over one another.
#[derive(Clone, Debug, Default)]
pub struct Sketch {
    /// The page of both.
    pub page: Option<Bounds>,
    /// What either has; what is only in one lies under the pieces of that.
    pub all: Pieces,
    /// What was removed.
    pub removed: Pieces,
    /// What was added.
    pub added: Pieces,
}

/// Areas and lines.
#[derive(Clone, Debug, Default)]
pub struct Pieces {
    /// Areas.
    pub areas: Vec<Polygon>,
    /// Lines.
    pub lines: Vec<Vec<Point>>,
}

/// What differs between a state of a file before and one after; either may be missing, not both.
pub fn compare(before: Option<&Shape>, after: Option<&Shape>) -> Difference {
    match (before, after) {
        (Some(Shape::Drawing(before)), Some(Shape::Drawing(after))) => drawings(before, after),
        (Some(Shape::Drawing(before)), None) => drawings(before, &Drawing::empty(before)),
        (None, Some(Shape::Drawing(after))) => drawings(&Drawing::empty(after), after),
        (Some(Shape::Body(before)), Some(Shape::Body(after))) => bodies::compare(before, after),
        (Some(Shape::Body(before)), None) => bodies::compare(before, &Model::default()),
        (None, Some(Shape::Body(after))) => bodies::compare(&Model::default(), after),
        _ => Difference {
            amounts: None,
            is_same: false,
            overlay: None,
        },
    }
}

fn drawings(before: &Drawing, after: &Drawing) -> Difference {
    let areas = areas::compare(&before.layers, &after.layers);
    let lines = lines::compare(&before.layers, &after.layers);
    let of_lines = lines.amounts(before.unit);
    let of_areas = areas.as_ref().map(|areas| areas.amounts(after.unit));
    let has_areas = of_areas.is_some_and(|a| a.added + a.removed + a.common > 0.0);
    // Where areas stay as they were, what has become of the lines is told.
    let amounts = match of_areas {
        Some(of_areas) if has_areas && (of_lines.is_same() || !of_areas.is_same()) => {
            Some(of_areas)
        }
        Some(_) => Some(of_lines),
        None => None,
    };
    // The same place on maps of two units is not the same.
    let is_same = before.unit == after.unit && amounts.is_some_and(|amounts| amounts.is_same());
    let overlay = areas.map(|areas| Overlay::Drawing(sketch(before, after, areas, lines)));
    Difference {
        amounts: amounts.map(Amounts::rounded),
        is_same,
        overlay,
    }
}

fn sketch(before: &Drawing, after: &Drawing, areas: areas::Areas, lines: lines::Lines) -> Sketch {
    let area = |item: &Item| match item {
        Item::Area(area) => Some(area.clone()),
        Item::Line(_) => None,
    };
    let line = |item: &Item| match item {
        Item::Line(line) => Some(line.clone()),
        Item::Area(_) => None,
    };
    Sketch {
        page: Some(before.page.union(after.page)),
        all: Pieces {
            areas: items(before, after, area),
            lines: items(before, after, line),
        },
        removed: Pieces {
            areas: areas.removed,
            lines: lines.removed,
        },
        added: Pieces {
            areas: areas.added,
            lines: lines.added,
        },
    }
}

fn items<T>(before: &Drawing, after: &Drawing, of: impl Fn(&Item) -> Option<T>) -> Vec<T> {
    let layers = before.layers.iter().chain(&after.layers);
    layers
        .flat_map(|layer| layer.items.iter().filter_map(&of))
        .collect()
}

#[cfg(test)]
mod tests;
