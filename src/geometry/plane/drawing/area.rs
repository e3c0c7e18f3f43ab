//! The area that a drawing covers.

use super::Drawing;
use crate::polygon::{AreaError, Grid, stroke_outlines};
use crate::{FillRule, Polygon, Ring};

impl Drawing {
    /// What the drawing paints: interiors by their fill rules and strokes at their widths, all
    /// united, in canonical order. Open subpaths are filled as if closed, as in SVG. Round joins
    /// and caps are within `tolerance`. Points of the drawing stay exact, crossings are rounded
    /// to 4·10^-9 of the drawing's longer side.
    pub fn areas(&self, tolerance: f64) -> Result<Vec<Polygon>, AreaError> {
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(AreaError::Tolerance(tolerance));
        }
        let mut strokes: Vec<Ring> = Vec::new();
        for shape in &self.shapes {
            for (stroke, path) in shape
                .stroke
                .iter()
                .flat_map(|s| shape.paths.iter().map(move |path| (s, path)))
            {
                stroke_outlines(path, stroke, tolerance, &mut strokes);
            }
        }
        let grid = Grid::over(self.shapes.iter().flat_map(|s| &s.paths).chain(&strokes))?;
        let mut parts = grid.fill(&strokes, FillRule::NonZero)?;
        for shape in &self.shapes {
            if shape.filled {
                parts.extend(grid.fill(&shape.paths, shape.rule)?);
            }
        }
        grid.unite(&parts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Cap, Join, Shape, Stroke};
    use crate::{LabelSet, Point};

    fn drawn(paths: &[&[[f64; 2]]], fill: Option<FillRule>, stroke: Option<Stroke>) -> Shape {
        let paths = paths
            .iter()
            .map(|path| path.iter().map(|&p| Point::from(p)).collect())
            .collect();
        Shape {
            label: LabelSet::EMPTY,
            paths,
            filled: fill.is_some(),
            rule: fill.unwrap_or_default(),
            stroke,
        }
    }

    fn area(shapes: Vec<Shape>) -> f64 {
        let polygons = Drawing {
            shapes,
            points: vec![],
        }
        .areas(1e-4)
        .unwrap();
        polygons.iter().map(Polygon::area).sum()
    }

    const SQUARE: &[[f64; 2]] = &[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
    const INNER: &[[f64; 2]] = &[[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0], [1.0, 1.0]];

    #[test]
    fn fill_rules_make_holes() {
        assert_eq!(
            area(vec![drawn(&[SQUARE, INNER], Some(FillRule::EvenOdd), None)]),
            12.0
        );
        assert_eq!(
            area(vec![drawn(&[SQUARE, INNER], Some(FillRule::NonZero), None)]),
            16.0
        );
        let overlap = vec![
            drawn(&[SQUARE, INNER], Some(FillRule::EvenOdd), None),
            drawn(&[INNER], Some(FillRule::NonZero), None),
        ];
        assert_eq!(area(overlap), 16.0);
    }

    #[test]
    fn strokes_have_the_area_of_their_width() {
        let line: &[[f64; 2]] = &[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]];
        let with = |cap, join| {
            area(vec![drawn(
                &[line],
                None,
                Some(Stroke {
                    width: 2.0,
                    cap,
                    join,
                }),
            )])
        };
        let disc = std::f64::consts::PI;
        assert!((with(Cap::Butt, Join::Bevel) - 39.5).abs() < 1e-6);
        assert!((with(Cap::Butt, Join::Miter(4.0)) - 40.0).abs() < 1e-6);
        assert!((with(Cap::Butt, Join::Miter(1.2)) - 39.5).abs() < 1e-6);
        assert!((with(Cap::Square, Join::Miter(4.0)) - 44.0).abs() < 1e-6);
        assert!((with(Cap::Round, Join::Round) - (39.0 + disc + disc / 4.0)).abs() < 2e-3);
    }

    #[test]
    fn a_closed_stroke_is_a_frame() {
        let stroke = Stroke {
            width: 1.0,
            cap: Cap::Butt,
            join: Join::Miter(4.0),
        };
        let shape = drawn(&[SQUARE], None, Some(stroke));
        let polygons = Drawing {
            shapes: vec![shape],
            points: vec![],
        }
        .areas(0.01)
        .unwrap();
        assert_eq!((polygons.len(), polygons[0].holes.len()), (1, 1));
        assert!((polygons[0].area() - 16.0).abs() < 1e-6);
    }

    #[test]
    fn a_dot_has_the_area_of_its_cap() {
        let dot = |cap| {
            area(vec![drawn(
                &[&[[5.0, 5.0]]],
                None,
                Some(Stroke {
                    width: 2.0,
                    cap,
                    join: Join::Round,
                }),
            )])
        };
        assert_eq!((dot(Cap::Butt), dot(Cap::Square)), (0.0, 4.0));
        assert!((dot(Cap::Round) - std::f64::consts::PI).abs() < 1e-3);
    }

    #[test]
    fn a_line_that_turns_back_has_a_round_end() {
        let back: &[[f64; 2]] = &[[0.0, 0.0], [10.0, 0.0], [2.0, 0.0]];
        let stroke = Stroke {
            width: 2.0,
            cap: Cap::Butt,
            join: Join::Round,
        };
        assert!(
            (area(vec![drawn(&[back], None, Some(stroke))]) - (20.0 + std::f64::consts::FRAC_PI_2))
                .abs()
                < 1e-3
        );
    }
}
