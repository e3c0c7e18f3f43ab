//! A vector drawing as it was read: flattened shapes with what their style makes of them.

use serde::{Deserialize, Serialize};

use super::{Bounds, CurveLabels, Curves, LabelSet, Point};

/// Which points a self-overlapping outline encloses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum FillRule {
    /// Those it winds round, whatever the sense.
    #[default]
    NonZero,
    /// Those a ray from which crosses it an odd number of times.
    EvenOdd,
}

/// One drawn element: its subpaths, transformed and flattened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// `data-label`, else `inkscape:label`, else `id`, else none.
    pub label: LabelSet,
    /// The polylines. A closed one repeats its first point at its end.
    pub paths: Vec<Vec<Point>>,
    /// How its interior is filled, if it is.
    pub fill: Option<FillRule>,
    /// The width of its stroke, if it has one, in the units of the coordinates.
    pub stroke: Option<f64>,
}

impl Shape {
    /// Whether the polyline numbered `i` is closed.
    pub fn is_closed(&self, i: usize) -> bool {
        let path = &self.paths[i];
        path.len() > 2 && path.first() == path.last()
    }
}

/// The shapes of a drawing in paint order, in the units of the spec, and its named points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drawing {
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// Elements labelled `point:NAME`: NAME and the place.
    pub points: Vec<(std::sync::Arc<str>, Point)>,
}

impl Drawing {
    /// The box of all shapes.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.shapes.iter().flat_map(|s| &s.paths).flatten().copied())
    }

    /// The drawing as an element: one curve per subpath with the shape's label on it and, where it
    /// is closed, on the face inside it. A first open path gives the points `start` and `end`
    /// unless the drawing names points of its own.
    pub fn curves(&self) -> Curves {
        let mut curves = Curves::new();
        for (name, at) in &self.points {
            curves.name_point(name.clone(), *at);
        }
        for shape in &self.shapes {
            for (i, path) in shape.paths.iter().enumerate() {
                let mut labels = CurveLabels::edge(shape.label);
                if shape.is_closed(i) {
                    let inside_is_left = super::polygon::signed_area(&path[..path.len() - 1]) > 0.0;
                    *(if inside_is_left { &mut labels.left } else { &mut labels.right }) = shape.label;
                } else if self.points.is_empty()
                    && let (Some(&first), Some(&last)) = (path.first(), path.last())
                {
                    curves.name_point("start", first);
                    curves.name_point("end", last);
                }
                curves.push(path.iter().copied(), labels);
            }
        }
        curves
    }
}
