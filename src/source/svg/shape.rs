//! Shape elements to drawing commands.

use roxmltree::Node;
use svgtypes::NumberListParser;

use super::length::{Axis, Length};
use super::path;
use super::pen::Pen;
use super::report::{Report, tag_range, value_range};
use fretwork_geometry::Point;
use fretwork_geometry::flatten::EllipticalArc;

/// Whether `name` is the name of an element that [`draw`] draws.
pub fn is_shape(name: &str) -> bool {
    matches!(
        name,
        "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon"
    )
}

/// Draws the element; what is wrong with it is reported. For a rectangle, a circle and an ellipse
/// the middle is returned: the place that it marks as a construction point.
pub fn draw(
    node: Node,
    name: &str,
    viewport: Point,
    pen: &mut Pen,
    report: &mut Report,
) -> Option<Point> {
    let mut reader = Reader {
        node,
        viewport,
        report,
    };
    match name {
        "path" => reader.path(pen),
        "rect" => return reader.rect(pen),
        "circle" => return reader.circle(pen),
        "ellipse" => return reader.ellipse(pen),
        "line" => {
            let from = Point::new(reader.number("x1", Axis::X), reader.number("y1", Axis::Y));
            let to = Point::new(reader.number("x2", Axis::X), reader.number("y2", Axis::Y));
            pen.move_to(from);
            pen.line_to(to);
        }
        "polyline" => reader.polyline(pen, false),
        "polygon" => reader.polyline(pen, true),
        _ => {}
    }
    None
}

struct Reader<'r, 'a, 'input> {
    node: Node<'a, 'input>,
    viewport: Point,
    report: &'r mut Report,
}

impl Reader<'_, '_, '_> {
    /// The length in attribute `name`; none when it is missing, `auto` or bad, which is reported.
    fn length(&mut self, name: &str, axis: Axis) -> Option<f64> {
        let attribute = self
            .node
            .attribute_node(name)
            .filter(|a| a.value().trim() != "auto")?;
        let text = attribute.value();
        let Ok(length) = text.parse::<Length>() else {
            self.report
                .error(attribute.range_value(), format!("`{text}` is not a length"));
            return None;
        };
        let number = length.user(axis, self.viewport);
        if number.is_nan() {
            let message = format!("`{text}` is a percentage of a viewport whose size is not known");
            self.report.error(attribute.range_value(), message);
            return None;
        }
        Some(number)
    }

    fn number(&mut self, name: &str, axis: Axis) -> f64 {
        self.length(name, axis).unwrap_or(0.0)
    }

    /// As [`Reader::length`], for a size; one below zero is reported.
    fn size(&mut self, name: &str, axis: Axis) -> Option<f64> {
        let size = self.length(name, axis)?;
        if size < 0.0 {
            let range = self
                .node
                .attribute_node(name)
                .map_or(tag_range(self.node), |a| a.range_value());
            self.report.error(range, format!("`{name}` is negative"));
            return None;
        }
        Some(size)
    }

    fn path(&mut self, pen: &mut Pen) {
        let Some(data) = self
            .node
            .attribute_node("d")
            .filter(|d| d.value().trim() != "none")
        else {
            return;
        };
        if let Err((at, message)) = path::draw(data.value(), pen) {
            self.report.error(value_range(data, at), message);
        }
    }

    fn polyline(&mut self, pen: &mut Pen, closed: bool) {
        let Some(attribute) = self.node.attribute_node("points") else {
            return;
        };
        let numbers: Result<Vec<f64>, _> = NumberListParser::from(attribute.value()).collect();
        let Some(numbers) = numbers.ok().filter(|n| n.len() % 2 == 0) else {
            self.report.error(
                attribute.range_value(),
                "`points` is not a list of pairs of finite numbers",
            );
            return;
        };
        for (i, xy) in numbers.chunks_exact(2).enumerate() {
            let p = Point::new(xy[0], xy[1]);
            if i == 0 {
                pen.move_to(p)
            } else {
                pen.line_to(p)
            }
        }
        if closed {
            pen.close();
        }
    }

    fn circle(&mut self, pen: &mut Pen) -> Option<Point> {
        let center = Point::new(self.number("cx", Axis::X), self.number("cy", Axis::Y));
        let r = self.size("r", Axis::Diagonal).unwrap_or(0.0);
        ring(center, Point::new(r, r), pen);
        Some(center)
    }

    fn ellipse(&mut self, pen: &mut Pen) -> Option<Point> {
        let center = Point::new(self.number("cx", Axis::X), self.number("cy", Axis::Y));
        let (rx, ry) = (self.size("rx", Axis::X), self.size("ry", Axis::Y));
        let radii = Point::new(rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
        ring(center, radii, pen);
        Some(center)
    }

    fn rect(&mut self, pen: &mut Pen) -> Option<Point> {
        let min = Point::new(self.number("x", Axis::X), self.number("y", Axis::Y));
        let size = Point::new(
            self.size("width", Axis::X).unwrap_or(0.0),
            self.size("height", Axis::Y).unwrap_or(0.0),
        );
        let (rx, ry) = (self.size("rx", Axis::X), self.size("ry", Axis::Y));
        let r = Point::new(
            rx.or(ry).unwrap_or(0.0).min(size.x / 2.0),
            ry.or(rx).unwrap_or(0.0).min(size.y / 2.0),
        );
        if size.x > 0.0 && size.y > 0.0 {
            rounded(min, min + size, r, pen);
        }
        Some(min + size * 0.5)
    }
}

/// An ellipse, once round from its point of greatest x toward +y.
fn ring(center: Point, radii: Point, pen: &mut Pen) {
    if !(radii.x > 0.0 && radii.y > 0.0) {
        return;
    }
    let (u, v) = (Point::new(radii.x, 0.0), Point::new(0.0, radii.y));
    let arc = EllipticalArc {
        center,
        u,
        v,
        start: 0.0,
        sweep: std::f64::consts::TAU,
    };
    pen.move_to(center + u);
    pen.arc_to(&arc, center + u);
    pen.close();
}

/// A rectangle whose corners are quarters of ellipses with the half axes `r`, from its upper left
/// corner (as drawn) along its upper side.
fn rounded(min: Point, max: Point, r: Point, pen: &mut Pen) {
    let sharp = !(r.x > 0.0 && r.y > 0.0);
    let r = if sharp { Point::ORIGIN } else { r };
    let corners = [
        (
            Point::new(max.x, min.y),
            Point::new(0.0, r.y),
            Point::new(-r.x, r.y),
            -1.0,
        ),
        (max, Point::new(-r.x, 0.0), Point::new(-r.x, -r.y), 0.0),
        (
            Point::new(min.x, max.y),
            Point::new(0.0, -r.y),
            Point::new(r.x, -r.y),
            1.0,
        ),
        (min, Point::new(r.x, 0.0), Point::new(r.x, r.y), 2.0),
    ];
    pen.move_to(min + Point::new(r.x, 0.0));
    for (corner, end, center, quarter) in corners {
        if sharp {
            pen.line_to(corner);
            continue;
        }
        let begin = if end.x == 0.0 {
            Point::new(center.x, 0.0)
        } else {
            Point::new(0.0, center.y)
        };
        pen.line_to(corner + begin);
        let (u, v) = (Point::new(r.x, 0.0), Point::new(0.0, r.y));
        let quarter_turn = std::f64::consts::FRAC_PI_2;
        let arc = EllipticalArc {
            center: corner + center,
            u,
            v,
            start: quarter * quarter_turn,
            sweep: quarter_turn,
        };
        pen.arc_to(&arc, corner + end);
    }
    pen.close();
}
