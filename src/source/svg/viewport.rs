//! `viewBox`, `preserveAspectRatio`, and the size of the whole drawing.

use roxmltree::Node;
use svgtypes::{Align, AspectRatio, ViewBox};

use super::document::INKSCAPE;
use super::length::{Axis, Basis, Length, USER_PER_MM};
use super::options::SvgOptions;
use super::report::{Report, tag_range};
use fretwork_geometry::{Affine, Point};

/// The scale of the root element from user units to spec units, and what relative lengths are taken
/// of there (NaN where the drawing does not say).
///
/// A drawing with a physical size has that size; without a `viewBox` its user units are the 96th part of an
/// inch, as in browsers. Else one user unit is one unit of the spec. The origin of user space stays
/// the origin.
pub fn of_root(root: Node, options: &SvgOptions, report: &mut Report) -> (Affine, Basis) {
    let (width, height) = (
        length(root, "width", report),
        length(root, "height", report),
    );
    let physical = |l: Option<Length>| l.and_then(Length::millimetres);
    let size = (physical(width), physical(height));
    let is_physical = size.0.or(size.1).is_some();
    let basis = |viewport: Point| Basis {
        is_physical,
        ..Basis::of(viewport)
    };
    let Some(view_box) = view_box(root, report) else {
        let unknown = Basis::of(Point::new(f64::NAN, f64::NAN));
        let own = |l: Option<Length>, axis| l.map_or(f64::NAN, |l| l.user(axis, &unknown));
        let viewport = Point::new(own(width, Axis::X), own(height, Axis::Y));
        if !is_physical {
            return (Affine::IDENTITY, basis(viewport));
        }
        if is_of_old_inkscape(root) {
            report.warn(
                tag_range(root),
                "the drawing has no `viewBox`, and its user units are read as 96 to the inch",
                "Inkscape before 0.92 meant 90: open it in a newer one, which asks, and save it",
            );
        }
        let scale = 1.0 / (USER_PER_MM * options.unit_mm);
        return (Affine::scale(scale, scale), basis(viewport));
    };
    let inner = Point::new(view_box.w, view_box.h);
    let scale = match size {
        (None, None) => return (Affine::IDENTITY, basis(inner)),
        (Some(w), None) => Point::new(w / inner.x, w / inner.x),
        (None, Some(h)) => Point::new(h / inner.y, h / inner.y),
        (Some(w), Some(h)) => fitted(
            Point::new(w / inner.x, h / inner.y),
            aspect_ratio(root, report),
        ),
    };
    if !(scale.x > 0.0 && scale.y > 0.0) {
        report.error(
            tag_range(root),
            "the drawing's width and height must be above zero",
        );
        return (Affine::IDENTITY, basis(inner));
    }
    (
        Affine::scale(scale.x / options.unit_mm, scale.y / options.unit_mm),
        basis(inner),
    )
}

/// Whether a version of Inkscape wrote the drawing for which an inch had 90 user units.
fn is_of_old_inkscape(root: Node) -> bool {
    let version = root.attribute((INKSCAPE, "version")).unwrap_or("");
    let minor = version.strip_prefix("0.").map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_digit());
        &rest[..end.unwrap_or(rest.len())]
    });
    minor
        .and_then(|minor| minor.parse().ok())
        .is_some_and(|minor: u32| minor < 92)
}

/// The map from the user space of a nested `svg` or a `symbol` to the space around it, and the
/// size that percentages inside are taken of. Its viewport is at `at` and as large as `size`.
/// None where it is too thin to show anything.
pub fn of_nested(
    node: Node,
    at: Point,
    size: Point,
    report: &mut Report,
) -> Option<(Affine, Point)> {
    let Some(view_box) = view_box(node, report) else {
        return Some((Affine::translation(at), size));
    };
    if size.x.is_nan() || size.y.is_nan() {
        report.error(
            tag_range(node),
            "its size is a percentage of a viewport without one",
        );
        return None;
    }
    if !(size.x > 0.0 && size.y > 0.0) {
        return None;
    }
    let inner = Point::new(view_box.w, view_box.h);
    let aspect = aspect_ratio(node, report);
    let scale = fitted(Point::new(size.x / inner.x, size.y / inner.y), aspect);
    let room = size - Point::new(inner.x * scale.x, inner.y * scale.y);
    let (fx, fy) = alignment(aspect.align);
    let corner = at + Point::new(room.x * fx, room.y * fy);
    let map = Affine::translation(Point::new(-view_box.x, -view_box.y))
        .then(Affine::scale(scale.x, scale.y))
        .then(Affine::translation(corner));
    Some((map, inner))
}

/// The `viewBox`, when there is one; a bad one is reported.
fn view_box(node: Node, report: &mut Report) -> Option<ViewBox> {
    let attribute = node.attribute_node("viewBox")?;
    match attribute.value().parse::<ViewBox>() {
        Ok(view_box) => Some(view_box),
        Err(error) => {
            report.error(attribute.range_value(), error.to_string());
            None
        }
    }
}

/// The length in attribute `name`, when there is one; a bad one is reported. `auto` is none.
pub fn length(node: Node, name: &str, report: &mut Report) -> Option<Length> {
    let attribute = node
        .attribute_node(name)
        .filter(|a| a.value().trim() != "auto")?;
    let parsed = attribute.value().parse::<Length>();
    if parsed.is_err() {
        report.error(
            attribute.range_value(),
            format!("`{}` is not a length", attribute.value()),
        );
    }
    parsed.ok()
}

fn aspect_ratio(node: Node, report: &mut Report) -> AspectRatio {
    let Some(attribute) = node.attribute_node("preserveAspectRatio") else {
        return AspectRatio::default();
    };
    attribute.value().parse().unwrap_or_else(|_| {
        report.error(
            attribute.range_value(),
            "`preserveAspectRatio` is not understood",
        );
        AspectRatio::default()
    })
}

fn fitted(scale: Point, aspect: AspectRatio) -> Point {
    let one = if aspect.slice {
        scale.x.max(scale.y)
    } else {
        scale.x.min(scale.y)
    };
    if aspect.align == Align::None {
        scale
    } else {
        Point::new(one, one)
    }
}

/// Which share of the free room lies before the content, along x and y.
fn alignment(align: Align) -> (f64, f64) {
    match align {
        Align::None | Align::XMinYMin => (0.0, 0.0),
        Align::XMidYMin => (0.5, 0.0),
        Align::XMaxYMin => (1.0, 0.0),
        Align::XMinYMid => (0.0, 0.5),
        Align::XMidYMid => (0.5, 0.5),
        Align::XMaxYMid => (1.0, 0.5),
        Align::XMinYMax => (0.0, 1.0),
        Align::XMidYMax => (0.5, 1.0),
        Align::XMaxYMax => (1.0, 1.0),
    }
}
