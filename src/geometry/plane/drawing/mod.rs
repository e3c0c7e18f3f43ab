//! A vector drawing as it was read: flattened shapes with what their style makes of them. The area
//! that it paints is in `area`, the region that it encloses in `region`; files are not read here.

mod area;
mod region;

pub use region::{Enclosed, RegionError};

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{Affine, Bounds, CurveLabels, Curves, LabelSet, Point, polygon};

/// Which points a self-overlapping outline encloses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum FillRule {
    /// Those it winds round, whatever the sense.
    #[default]
    NonZero,
    /// Those a ray from which crosses it an odd number of times.
    EvenOdd,
}

/// What a stroke has at the ends of an open polyline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cap {
    /// Nothing: it ends square at the end point.
    #[default]
    Butt,
    /// Half a disc.
    Round,
    /// Half a square.
    Square,
}

/// What a stroke has at a corner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Join {
    /// Its sides drawn on until they meet, unless the tip is farther than this many half widths
    /// from the corner: then as [`Join::Bevel`].
    Miter(f64),
    /// A disc.
    Round,
    /// The corner cut off.
    Bevel,
}

impl Default for Join {
    fn default() -> Join {
        Join::Miter(4.0)
    }
}

/// How a line is widened to an area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stroke {
    /// The full width, above zero.
    pub width: f64,
    /// At the ends.
    pub cap: Cap,
    /// At the corners.
    pub join: Join,
}

impl Stroke {
    /// A stroke with round ends and corners: everything within half its width of the line.
    pub fn round(width: f64) -> Stroke {
        Stroke {
            width,
            cap: Cap::Round,
            join: Join::Round,
        }
    }
}

/// One drawn element: its subpaths, transformed and flattened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// `data-label`, else `inkscape:label`, else `id`, else none.
    pub label: LabelSet,
    /// The polylines. A closed one repeats its first point at its end; one of a single point is
    /// a dot, which only a stroke gives an area.
    pub paths: Vec<Vec<Point>>,
    /// Whether its interior is filled.
    pub filled: bool,
    /// What its interior is.
    pub rule: FillRule,
    /// Its stroke, if it has one, in the units of the coordinates.
    pub stroke: Option<Stroke>,
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
    pub points: Vec<(Arc<str>, Point)>,
}

impl Drawing {
    /// The box of all polylines; the width of strokes does not count.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.shapes.iter().flat_map(|s| &s.paths).flatten().copied())
    }

    /// The image under `map`; the widths of strokes grow as lengths do on average.
    pub fn transformed(&self, map: &Affine) -> Drawing {
        let mut image = self.clone();
        let growth = map.determinant().abs().sqrt();
        for shape in &mut image.shapes {
            shape
                .paths
                .iter_mut()
                .flatten()
                .for_each(|p| *p = map.apply(*p));
            if let Some(stroke) = &mut shape.stroke {
                stroke.width *= growth;
            }
        }
        image
            .points
            .iter_mut()
            .for_each(|(_, p)| *p = map.apply(*p));
        image
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
            for (i, path) in shape
                .paths
                .iter()
                .enumerate()
                .filter(|(_, path)| path.len() > 1)
            {
                if self.points.is_empty() && !shape.is_closed(i) {
                    curves.name_point("start", path[0]);
                    curves.name_point("end", path[path.len() - 1]);
                }
                curves.push(path.iter().copied(), curve_labels(shape.label, path));
            }
        }
        curves
    }
}

/// What a polyline with this label carries: if it is closed, the face inside it has the label too.
fn curve_labels(label: LabelSet, path: &[Point]) -> CurveLabels {
    let mut labels = CurveLabels::edge(label);
    if path.len() > 2 && path.first() == path.last() {
        let inside_is_left = polygon::signed_area(path) > 0.0;
        *(if inside_is_left {
            &mut labels.left
        } else {
            &mut labels.right
        }) = label;
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(label: &str, path: &[[f64; 2]]) -> Shape {
        let paths = vec![path.iter().map(|&p| Point::from(p)).collect()];
        Shape {
            label: LabelSet::one(label),
            paths,
            filled: false,
            rule: FillRule::NonZero,
            stroke: Some(Stroke::round(1.0)),
        }
    }

    #[test]
    fn a_closed_path_labels_its_interior_side_whichever_way_it_runs() {
        let ring = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        let mut back = ring;
        back.reverse();
        let drawing = Drawing {
            shapes: vec![shape("a", &ring), shape("b", &back)],
            points: vec![],
        };
        let curves = drawing.curves();
        let (a, b) = (curves.get(0).labels, curves.get(1).labels);
        assert_eq!(
            (a.edge, a.left, a.right),
            (LabelSet::one("a"), LabelSet::one("a"), LabelSet::EMPTY)
        );
        assert_eq!(
            (b.edge, b.left, b.right),
            (LabelSet::one("b"), LabelSet::EMPTY, LabelSet::one("b"))
        );
        assert!(curves.named_points().is_empty());
    }

    #[test]
    fn only_a_drawing_without_points_names_its_ends() {
        let open = [[0.0, 0.0], [5.0, 0.0], [5.0, 3.0]];
        let mut drawing = Drawing {
            shapes: vec![shape("a", &open), shape("b", &[[9.0, 9.0], [8.0, 8.0]])],
            points: vec![],
        };
        let curves = drawing.curves();
        assert_eq!(curves.point_named("start"), Some(Point::new(0.0, 0.0)));
        assert_eq!(curves.point_named("end"), Some(Point::new(5.0, 3.0)));
        drawing.points.push(("tip".into(), Point::ORIGIN));
        let curves = drawing.curves();
        assert_eq!(curves.named_points().len(), 1);
        assert_eq!(curves.point_named("start"), None);
    }

    #[test]
    fn dots_are_no_curves() {
        let drawing = Drawing {
            shapes: vec![shape("a", &[[0.0, 0.0]])],
            points: vec![],
        };
        assert!(drawing.curves().is_empty() && drawing.curves().named_points().is_empty());
    }
}
