//! What an irregular partition is told: its density, and the labels that are drawn for its cells.

use crate::error::ArrangementError;
use fretwork_geometry::{Field, LabelSet};

/// Points per unit of area.
#[derive(Clone, Debug)]
pub enum Density {
    /// The same everywhere.
    Constant(f64),
    /// A continuous function of the plane.
    Field(Field),
}

/// How dense an irregular partition is, and the labels drawn for its cells.
#[derive(Clone, Debug)]
pub struct IrregularProperties {
    /// Mean number of cells per unit of area.
    pub density: Density,
    /// Drawn for every vertex.
    pub vertex_labels: Weighted,
    /// Drawn for every edge.
    pub edge_labels: Weighted,
    /// Drawn for every face.
    pub face_labels: Weighted,
}

impl IrregularProperties {
    /// Without labels.
    pub fn new(density: Density) -> IrregularProperties {
        let none = Weighted::default();
        IrregularProperties {
            density,
            vertex_labels: none.clone(),
            edge_labels: none.clone(),
            face_labels: none,
        }
    }
}

/// Labels of which one is drawn, each with probability weight / sum of the weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weighted(Vec<(LabelSet, f64)>);

impl Weighted {
    /// The labels with their weights, which must be finite and not negative, with a positive sum;
    /// an empty list draws the empty set.
    pub fn new(labels: Vec<(LabelSet, f64)>) -> Result<Weighted, ArrangementError> {
        if let Some((_, bad)) = labels.iter().find(|(_, w)| !(w.is_finite() && *w >= 0.0)) {
            return Err(ArrangementError::Weight(*bad));
        }
        let sum = labels.iter().map(|(_, w)| w).sum::<f64>();
        let draws_something = sum > 0.0 && sum.is_finite();
        if !labels.is_empty() && !draws_something {
            return Err(ArrangementError::Weight(sum));
        }
        Ok(Weighted(labels))
    }

    /// The label that a uniform value `u` in [0, 1) draws.
    pub fn draw(&self, u: f64) -> LabelSet {
        let mut rest = u * self.0.iter().map(|(_, w)| w).sum::<f64>();
        let mut drawn = LabelSet::EMPTY;
        for (label, weight) in self.0.iter().filter(|(_, w)| *w > 0.0) {
            drawn = *label;
            if rest < *weight {
                break;
            }
            rest -= weight;
        }
        drawn
    }

    /// Whether nothing is ever drawn.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_drawn_by_weight() {
        let (a, b) = (LabelSet::one("a"), LabelSet::one("b"));
        let weighted =
            Weighted::new(vec![(a, 1.0), (b, 3.0), (LabelSet::one("never"), 0.0)]).unwrap();
        assert_eq!(
            [0.0, 0.24, 0.25, 0.999].map(|u| weighted.draw(u)),
            [a, a, b, b]
        );
        assert_eq!(Weighted::default().draw(0.5), LabelSet::EMPTY);
        assert!(Weighted::new(vec![(a, -1.0)]).is_err() && Weighted::new(vec![(a, 0.0)]).is_err());
        assert!(Weighted::new(vec![(a, f64::NAN)]).is_err());
    }
}
