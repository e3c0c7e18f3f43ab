//! Shape elements to drawing commands.

use roxmltree::Node;
use svgtypes::NumberListParser;

use super::length::{Axis, Basis, Length};
use super::path;
use super::pen::Pen;
use super::report::{Report, tag_range, value_range};
use super::style::Own;
use fretwork_geometry::Point;
use fretwork_geometry::flatten::EllipticalArc;

/// Whether `name` is the name of an element that [`draw`] draws.
pub fn is_shape(name: &str) -> bool {
    matches!(
        name,
        "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon"
    )
}

/// Whether lines like this one carry markers.
pub fn is_line(name: &str) -> bool {
    matches!(name, "path" | "line" | "polyline" | "polygon")
}

/// A shape element.
#[derive(Clone, Copy)]
pub struct Element<'r, 'a, 'input> {
    /// The element.
    pub node: Node<'a, 'input>,
    /// Its name.
    pub name: &'r str,
    /// What its style says of its place and size.
    pub own: &'r Own<'a>,
    /// What its lengths are taken of.
    pub basis: &'r Basis,
}

/// Draws the element; what is wrong with it is reported. For a rectangle, a circle and an ellipse
/// the middle is returned: the place that it marks as a construction point.
pub fn draw(element: &Element, pen: &mut Pen, report: &mut Report) -> Option<Point> {
    let mut reader = Reader { element, report };
    match element.name {
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

/// The length that the style or the attribute `name` of the element says; none when it says none, or `auto`, or a
/// bad one, which is reported.
pub fn length(element: &Element, name: &str, axis: Axis, report: &mut Report) -> Option<f64> {
    let node = element.node;
    let attribute = node.attribute_node(name);
    let said = element.own.geometry(name);
    let text = said.or(attribute.map(|a| a.value()))?;
    if text.trim() == "auto" {
        return None;
    }
    let range = attribute
        .filter(|_| said.is_none())
        .map_or(tag_range(node), |a| a.range_value());
    let Ok(length) = text.parse::<Length>() else {
        report.error(range, format!("`{text}` is not a length"));
        return None;
    };
    if length.millimetres().is_some() && !element.basis.is_physical {
        let message = "a length has a unit such as mm, and the drawing has no physical size";
        let help = "give the root element a width and height in mm; without, 1mm is 3.78 user units, \
                    and a user unit is a unit of the spec";
        report.note(node, message.into(), help);
    }
    let number = length.user(axis, element.basis);
    if number.is_nan() {
        let message = format!("`{text}` is a percentage of a viewport whose size is not known");
        report.error(range, message);
        return None;
    }
    Some(number)
}

struct Reader<'r, 'e, 'a, 'input> {
    element: &'r Element<'e, 'a, 'input>,
    report: &'r mut Report,
}

impl Reader<'_, '_, '_, '_> {
    fn length(&mut self, name: &str, axis: Axis) -> Option<f64> {
        length(self.element, name, axis, self.report)
    }

    fn number(&mut self, name: &str, axis: Axis) -> f64 {
        self.length(name, axis).unwrap_or(0.0)
    }

    /// As [`length`], for a size; one below zero is reported.
    fn size(&mut self, name: &str, axis: Axis) -> Option<f64> {
        let size = self.length(name, axis)?;
        if size < 0.0 {
            let node = self.element.node;
            let attribute = node.attribute_node(name);
            let range = attribute.map_or(tag_range(node), |a| a.range_value());
            self.report.error(range, format!("`{name}` is negative"));
            return None;
        }
        Some(size)
    }

    fn path(&mut self, pen: &mut Pen) {
        if let Some(said) = self.element.own.geometry("d") {
            return self.path_of_style(said, pen);
        }
        let data = self.element.node.attribute_node("d");
        let Some(data) = data.filter(|d| d.value().trim() != "none") else {
            return;
        };
        if let Err((at, message)) = path::draw(data.value(), pen) {
            self.report.error(value_range(data, at), message);
        }
    }

    /// Draws what stands in `path("…")`.
    fn path_of_style(&mut self, said: &str, pen: &mut Pen) {
        let inside = said.strip_prefix("path(").and_then(|d| d.strip_suffix(')'));
        let data = inside.map(|d| d.trim().trim_matches(['"', '\'']));
        let result = match data {
            Some(data) => path::draw(data, pen).map_err(|(_, message)| message),
            None if said == "none" => Ok(()),
            None => Err(format!("`d: {said}` is not understood")),
        };
        if let Err(message) = result {
            self.report.error(tag_range(self.element.node), message);
        }
    }

    fn polyline(&mut self, pen: &mut Pen, closed: bool) {
        let Some(attribute) = self.element.node.attribute_node("points") else {
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
