//! What the definition of an arrangement tells of its repetitions.

use std::sync::Arc;

use crate::partition::period::full_cycle;
use crate::partition::properties::StripesProperties;
use crate::tiled::family::{Common, Family, common};
use crate::tiled::lattice::Lattice;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::Point;

/// A tile has at most about so many cells (rule E2).
const CELLS: f64 = 1e5;

/// The lines that an arrangement is made of, which repeat.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Regularity {
    /// All of them.
    pub families: Arc<[Family]>,
    /// Those of them that stay in place when the region is moved.
    pub fixed: Arc<[Family]>,
    /// The mean area of the smallest of the cells that lines of one partition bound; infinite where no lines cross.
    pub cell_area: f64,
}

/// Why an arrangement is not drawn by tiles: a clause that follows `because`, and the place that it speaks of.
#[derive(Clone, Debug, PartialEq)]
pub struct Irregular {
    /// The clause.
    pub text: Arc<str>,
    /// The place.
    pub span: Option<Span>,
}

impl Irregular {
    pub(crate) fn new(text: impl Into<Arc<str>>) -> Irregular {
        Irregular {
            text: text.into(),
            span: None,
        }
    }

    pub(crate) fn at(self, span: &Span) -> Irregular {
        Irregular {
            span: self.span.or_else(|| Some(span.clone())),
            ..self
        }
    }

    /// What the general engine refused where it was watched.
    pub(crate) fn refused(diagnostics: &[Diagnostic]) -> Irregular {
        let Some(first) = diagnostics.first() else {
            return Irregular::new("its evaluation fails");
        };
        let label = first.labels.first();
        Irregular {
            text: first.message.as_str().into(),
            span: label.map(|label| label.span.clone()),
        }
    }
}

impl Regularity {
    /// What all of `several` have in common.
    pub fn of_all<'a>(several: impl IntoIterator<Item = &'a Regularity>) -> Regularity {
        let (mut families, mut fixed, mut cell_area) = (Vec::new(), Vec::new(), f64::INFINITY);
        for one in several {
            add(&mut families, &one.families);
            add(&mut fixed, &one.fixed);
            cell_area = cell_area.min(one.cell_area);
        }
        Regularity {
            families: families.into(),
            fixed: fixed.into(),
            cell_area,
        }
    }

    /// That of an arrangement drawn in each of the cells of this one.
    pub fn filled_with(&self, with: &Regularity) -> Regularity {
        let mut families = self.families.to_vec();
        add(&mut families, &with.fixed);
        Regularity {
            families: families.into(),
            fixed: self.fixed.clone(),
            cell_area: self.cell_area.min(with.cell_area),
        }
    }

    /// That of lines; `is_fixed` says whether their anchor is.
    pub fn of_lines(lines: &[&StripesProperties], is_fixed: bool) -> Regularity {
        let families: Arc<[Family]> = lines.iter().map(|lines| of(lines)).collect();
        let fixed = if is_fixed {
            families.clone()
        } else {
            Arc::default()
        };
        let cell_area = match lines {
            [a, b] => {
                let turn = of(a).normal.cross(of(b).normal).abs();
                mean(&a.spacing) * mean(&b.spacing) / turn
            }
            _ => f64::INFINITY,
        };
        Regularity {
            families,
            fixed,
            cell_area,
        }
    }

    /// The moves that keep all of it, if these are a lattice of not too large tiles.
    ///
    /// # Errors
    /// Why there is none.
    pub fn lattice(&self) -> Result<Lattice, Irregular> {
        match common(&self.families) {
            Some(Common::Lattice(lattice)) if lattice.area() / self.cell_area <= CELLS => {
                Ok(lattice)
            }
            Some(Common::Lattice(_)) => Err(Irregular::new(
                "its periods have a common multiple of more than 100000 cells only",
            )),
            Some(Common::Lines(_) | Common::All) => Err(Irregular::new(
                "its lines go on to the border of the region",
            )),
            None => Err(self.apart()),
        }
    }

    /// That there is no such move, with what the families repeat by.
    fn apart(&self) -> Irregular {
        let rounded = |v: f64| libm::round(v * 1e6) / 1e6 + 0.0;
        let shown = self.families.iter().map(|family| {
            let across = libm::atan2(family.normal.y, family.normal.x).to_degrees();
            let along = rounded((across + 90.0).rem_euclid(180.0));
            format!("{} (lines at {along} degrees)", rounded(family.width))
        });
        let shown = shown.collect::<Vec<_>>().join(", ");
        Irregular::new(format!("its periods have no common multiple: {shown}"))
    }
}

fn add(families: &mut Vec<Family>, more: &[Family]) {
    for family in more {
        if !families.contains(family) {
            families.push(*family);
        }
    }
}

fn mean(spacing: &[f64]) -> f64 {
    spacing.iter().sum::<f64>() / spacing.len().max(1) as f64
}

/// The lines with their labels: after how much they repeat (Loi 2015, section 4.2.1).
fn of(lines: &StripesProperties) -> Family {
    // As the lines themselves are turned, so that upright ones have upright periods.
    let clean = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
    let (sine, cosine) = (libm::sin(lines.angle), libm::cos(lines.angle));
    Family {
        normal: Point::new(clean(cosine), clean(sine)).left(),
        width: full_cycle(lines),
    }
}
