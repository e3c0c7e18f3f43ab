//! Where elements lie: their transforms, the boxes that those refer to, and viewports inside of others. What is drawn
//! there is not known here.

use roxmltree::Node;

use super::super::document::name;
use super::super::length::{Axis, Basis, Length};
use super::super::pen::Pen;
use super::super::report::tag_range;
use super::super::shape::{self, Element};
use super::super::style::{Own, Paint, ReferenceBox};
use super::super::{transform, viewport};
use super::Walk;
use super::state::State;
use super::window::Window;
use fretwork_geometry::{Affine, Bounds, Point};

impl<'a, 'input> Walk<'a, 'input> {
    /// From the user space inside of the element to spec units, given the state around it but with
    /// its own style. None when it has no extent.
    pub(super) fn transform(
        &mut self,
        node: Node<'a, 'input>,
        own: &Own<'a>,
        state: &State<'a>,
    ) -> Option<Affine> {
        let attribute = node.attribute_node("transform");
        let parsed = match (own.transform, attribute) {
            (Some(css), _) => transform::parse_css(css),
            (None, Some(attribute)) => transform::parse(attribute.value()),
            (None, None) => return Some(state.map),
        };
        let range = match attribute.filter(|_| own.transform.is_none()) {
            Some(attribute) => attribute.range_value(),
            None => tag_range(node),
        };
        let Ok(map) = parsed else {
            self.report.error(
                range,
                "bad transform: expected a list such as `translate(1 2) rotate(30)`",
            );
            return None;
        };
        let corner_and_size = self.reference_box(node, own, state);
        let (corner, size) = corner_and_size.unwrap_or((Point::ORIGIN, state.basis.viewport));
        let center = match own.origin {
            Some(text) => {
                let basis = Basis {
                    viewport: size,
                    ..state.basis
                };
                let Some(center) = transform::origin(text, &basis) else {
                    let message = format!("the transform origin `{text}` is not understood");
                    self.report.error(range, message);
                    return None;
                };
                center
            }
            None => Point::ORIGIN,
        };
        let center = corner + center;
        let about = match center == Point::ORIGIN {
            true => map,
            false => map.about(center),
        };
        let map = about.then(state.map);
        (map.determinant() != 0.0).then_some(map)
    }

    /// The corner and the size of the box that a transform refers to; none for the viewport.
    fn reference_box(
        &mut self,
        node: Node<'a, 'input>,
        own: &Own<'a>,
        state: &State<'a>,
    ) -> Option<(Point, Point)> {
        let tag = name(node).unwrap_or("");
        let is_stroked = state.style.stroke() != Paint::None;
        match own.reference {
            ReferenceBox::View => return None,
            ReferenceBox::Stroke if is_stroked => {
                let help = "the box without the stroke is taken";
                self.report
                    .unread(node, "`transform-box: stroke-box`", help);
            }
            _ => {}
        }
        if !shape::is_shape(tag) {
            let help = "the box of the viewport is taken; transform the shapes one by one";
            self.report
                .unread(node, "the `transform-box` of a group", help);
            return None;
        }
        let element = Element {
            node,
            name: tag,
            own,
            basis: &state.basis,
        };
        let tolerance = self.tolerance / mean_scale(&state.map).max(f64::MIN_POSITIVE);
        let mut pen = Pen::new(Affine::IDENTITY, tolerance);
        // What is wrong with it is said when it is drawn.
        let mut silent = self.report.silent();
        shape::draw(&element, &mut pen, &mut silent);
        let outline = pen.finish();
        if outline.out_of_range.is_some() {
            return None;
        }
        let bounds = Bounds::of(outline.paths.into_iter().flatten());
        let is_drawn = bounds.min.is_finite() && bounds.max.is_finite();
        is_drawn.then(|| (bounds.min, bounds.max - bounds.min))
    }

    /// The state inside the viewport of an `svg` or `symbol`, whose place and size are the
    /// attributes of `placed`.
    pub(super) fn nested_viewport(
        &mut self,
        node: Node<'a, 'input>,
        placed: Node<'a, 'input>,
        own: &Own<'a>,
        state: State<'a>,
    ) -> Option<(State<'a>, Option<Window<'a, 'input>>)> {
        let mut number = |attribute: &str, axis: Axis, default: &str| {
            let said = own.geometry(attribute).filter(|_| node == placed);
            if let Some(length) = said.and_then(|text| text.parse::<Length>().ok()) {
                return length.user(axis, &state.basis);
            }
            let inner = if node == placed || attribute == "x" || attribute == "y" {
                None
            } else {
                Some(node)
            };
            let written = [Some(placed), inner]
                .into_iter()
                .flatten()
                .find(|n| n.has_attribute(attribute));
            let length = match written {
                Some(n) => viewport::length(n, attribute, &mut self.report),
                None => None,
            };
            length
                .or(default.parse::<Length>().ok())
                .map_or(0.0, |l| l.user(axis, &state.basis))
        };
        let at = match node == placed {
            true => Point::new(number("x", Axis::X, "0"), number("y", Axis::Y, "0")),
            false => Point::ORIGIN,
        };
        let size = Point::new(
            number("width", Axis::X, "100%"),
            number("height", Axis::Y, "100%"),
        );
        let (map, viewport) = viewport::of_nested(node, at, size, &mut self.report)?;
        let is_bounded = size.x > 0.0 && size.y > 0.0 && !own.overflows();
        let first = self.drawing.shapes.len();
        let window = Window::of_viewport(node, [at, at + size], &state.map, first);
        let state = State {
            map: map.then(state.map),
            basis: Basis {
                viewport,
                ..state.basis
            },
            label: None,
            ..state
        };
        Some((state, is_bounded.then_some(window)))
    }
}

/// The mean over all directions by which `map` stretches.
pub(super) fn mean_scale(map: &Affine) -> f64 {
    map.determinant().abs().sqrt()
}
