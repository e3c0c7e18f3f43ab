//! What a family of parallel lines is told: its angle, spacings and labels.

use fretwork_geometry::{LabelSet, Point};

/// A family of parallel lines and the labels of what they bound.
#[derive(Clone, Debug, PartialEq)]
pub struct StripesProperties {
    /// The middle of stripe 0; without it, the lower left corner of the region's box.
    pub anchor: Option<Point>,
    /// Direction of the lines, radians from +x toward +y.
    pub angle: f64,
    /// Widths of the stripes, a cycle: stripe k is `spacing[k mod n]` wide.
    pub spacing: Vec<f64>,
    /// Labels of the lines, a cycle; may be empty.
    pub edge_labels: Vec<LabelSet>,
    /// Labels of the stripes, a cycle; may be empty.
    pub face_labels: Vec<LabelSet>,
}

impl StripesProperties {
    /// Lines in direction `angle` (radians), `spacing` apart, without labels.
    pub fn new(angle: f64, spacing: Vec<f64>) -> StripesProperties {
        StripesProperties {
            anchor: None,
            angle,
            spacing,
            edge_labels: Vec::new(),
            face_labels: Vec::new(),
        }
    }
}
