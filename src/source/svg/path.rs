//! Path data to drawing commands.

use svgtypes::{Error, PathParser, PathSegment as Segment};

use super::pen::Pen;
use fretwork_geometry::Point;
use fretwork_geometry::flatten::EllipticalArc;

/// Draws the path data `d`; the error says what is wrong and at which character (from 1).
pub fn draw(d: &str, pen: &mut Pen) -> Result<(), (usize, String)> {
    let mut trace = Trace::default();
    for segment in PathParser::from(d) {
        trace.step(segment.map_err(|e| explain(d, &e))?, pen);
    }
    Ok(())
}

/// Where the path is, and what shorthand commands refer to.
#[derive(Default)]
struct Trace {
    at: Point,
    start: Point,
    /// The last control point, if the last segment was cubic (true) or quadratic (false).
    control: Option<(bool, Point)>,
}

impl Trace {
    fn step(&mut self, segment: Segment, pen: &mut Pen) {
        let base = if segment.is_abs() {
            Point::ORIGIN
        } else {
            self.at
        };
        let to = |x: f64, y: f64| base + Point::new(x, y);
        match segment {
            Segment::MoveTo { x, y, .. } => {
                self.start = to(x, y);
                pen.move_to(self.start);
                self.advance(self.start, None);
            }
            Segment::LineTo { x, y, .. } => self.line(to(x, y), pen),
            Segment::HorizontalLineTo { abs, x } => self.line(
                Point::new(if abs { x } else { self.at.x + x }, self.at.y),
                pen,
            ),
            Segment::VerticalLineTo { abs, y } => self.line(
                Point::new(self.at.x, if abs { y } else { self.at.y + y }),
                pen,
            ),
            Segment::CurveTo {
                x1,
                y1,
                x2,
                y2,
                x,
                y,
                ..
            } => self.cubic(to(x1, y1), to(x2, y2), to(x, y), pen),
            Segment::SmoothCurveTo { x2, y2, x, y, .. } => {
                self.cubic(self.mirrored(true), to(x2, y2), to(x, y), pen)
            }
            Segment::Quadratic { x1, y1, x, y, .. } => self.quadratic(to(x1, y1), to(x, y), pen),
            Segment::SmoothQuadratic { x, y, .. } => {
                self.quadratic(self.mirrored(false), to(x, y), pen)
            }
            Segment::EllipticalArc {
                rx,
                ry,
                x_axis_rotation,
                large_arc,
                sweep,
                x,
                y,
                ..
            } => {
                let (end, radii) = (to(x, y), Point::new(rx, ry));
                let turn = x_axis_rotation.to_radians();
                let arc = EllipticalArc::between(self.at, end, radii, turn, large_arc, sweep);
                self.arc(arc, end, pen);
            }
            Segment::ClosePath { .. } => {
                pen.close();
                self.advance(self.start, None);
            }
        }
    }

    /// An arc that ends at `end`; a line where there is none between the two.
    fn arc(&mut self, arc: Option<EllipticalArc>, end: Point, pen: &mut Pen) {
        match arc {
            Some(arc) => {
                pen.arc_to(&arc, end);
                self.advance(end, None);
            }
            None => self.line(end, pen),
        }
    }

    fn line(&mut self, to: Point, pen: &mut Pen) {
        pen.line_to(to);
        self.advance(to, None);
    }

    fn cubic(&mut self, b: Point, c: Point, to: Point, pen: &mut Pen) {
        pen.cubic_to(b, c, to);
        self.advance(to, Some((true, c)));
    }

    fn quadratic(&mut self, b: Point, to: Point, pen: &mut Pen) {
        pen.quadratic_to(b, to);
        self.advance(to, Some((false, b)));
    }

    fn advance(&mut self, to: Point, control: Option<(bool, Point)>) {
        (self.at, self.control) = (to, control);
    }

    /// The last control point, mirrored in the current point; that point itself after a segment
    /// of another kind.
    fn mirrored(&self, cubic: bool) -> Point {
        match self.control {
            Some((kind, c)) if kind == cubic => self.at * 2.0 - c,
            _ => self.at,
        }
    }
}

fn explain(d: &str, error: &Error) -> (usize, String) {
    match error {
        Error::UnexpectedData(at) | Error::InvalidNumber(at) | Error::InvalidChar(_, at) => {
            let found = d.chars().nth(at - 1);
            let found = found.map_or("the end".to_string(), |c| format!("`{c}`"));
            let what = match error {
                Error::InvalidNumber(_) => format!("expected a finite number here, not {found}"),
                _ if *at == 1 => format!("expected `M` here, not {found}"),
                _ => format!("{found} cannot stand here"),
            };
            (*at, format!("bad path data: {what}"))
        }
        _ => (
            d.chars().count(),
            "bad path data: it ends inside a command".to_string(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Affine;

    fn drawn(d: &str) -> Vec<Vec<[f64; 2]>> {
        let mut pen = Pen::new(Affine::IDENTITY, 0.01);
        draw(d, &mut pen).unwrap();
        pen.finish()
            .paths
            .into_iter()
            .map(|path| path.into_iter().map(Into::into).collect())
            .collect()
    }

    #[test]
    fn every_command_has_both_forms() {
        assert_eq!(
            drawn("M1 2 3 4h2v-1H0V0z"),
            drawn("m1,2 2,2 l2 0 0-1L0 3 0 0 1 2")
        );
        assert_eq!(
            drawn("M0 0C0 5 5 5 5 0S10-5 10 0"),
            drawn("m0 0c0 5 5 5 5 0 0-5 5-5 5 0")
        );
        assert_eq!(drawn("M0 0Q5 5 10 0T20 0"), drawn("m0 0q5 5 10 0 5-5 10 0"));
        assert_eq!(drawn("M0 0A5 5 0 0110 0"), drawn("m0 0a5,5,0,0,1,10,0"));
        assert_eq!(drawn("M0 0S5 5 5 0"), drawn("M0 0C0 0 5 5 5 0"));
        assert_eq!(drawn("M0 0 5 5T9 9"), drawn("M0 0 5 5Q5 5 9 9"));
    }

    #[test]
    fn what_follows_a_close_begins_where_it_closed() {
        assert_eq!(
            drawn("M1 1h1v1zh-1"),
            [
                vec![[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 1.0]],
                vec![[1.0, 1.0], [0.0, 1.0]]
            ]
        );
        assert_eq!(
            drawn("M1 1h1v1zm1 1h1").last().unwrap(),
            &[[2.0, 2.0], [3.0, 2.0]]
        );
    }

    #[test]
    fn moves_alone_draw_nothing_and_dots_are_one_point() {
        assert_eq!(drawn("M1 1M2 2m3 3"), Vec::<Vec<[f64; 2]>>::new());
        assert_eq!(drawn(""), Vec::<Vec<[f64; 2]>>::new());
        assert_eq!(
            drawn("M1 1h0M2 2zM3 3A0 5 0 0 0 3 3"),
            [[[1.0, 1.0]], [[2.0, 2.0]], [[3.0, 3.0]]]
        );
    }

    #[test]
    fn arcs_without_a_radius_are_straight_and_short_ones_grow() {
        assert_eq!(drawn("M0 0A0 5 0 0 1 9 9"), [[[0.0, 0.0], [9.0, 9.0]]]);
        let grown = &drawn("M0 0A1 1 0 0 1 10 0")[0];
        let lowest = grown.iter().map(|p| p[1]).fold(0.0, f64::min);
        assert!((lowest + 5.0).abs() < 0.01, "{lowest}");
        assert_eq!(drawn("M0 0A-5-5 0 0 1 10 0"), drawn("M0 0A5 5 0 0 1 10 0"));
    }

    #[test]
    fn errors_say_where() {
        let error = |d: &str| draw(d, &mut Pen::new(Affine::IDENTITY, 0.1)).unwrap_err();
        assert_eq!(error("L1 1").0, 1);
        assert_eq!(error("M1 1 L2 x").0, 9);
        assert_eq!(error("M0 0 ü").0, 6);
        assert_eq!(
            error("M0 0A1 1 0 2 0 5 5"),
            (12, "bad path data: `2` cannot stand here".into())
        );
        assert!(error("M0 0L1").1.contains("path data"));
        assert!(error("M0 0L1 1e999").1.contains("finite number"));
        assert_eq!(error("M1 1Z5 5").0, 6);
    }
}
