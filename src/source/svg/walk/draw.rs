//! A shape as it is drawn: its outline, its label, what is painted of it.

use roxmltree::Node;

use super::super::pen::{LARGEST, Pen, Vertex};
use super::super::report::tag_range;
use super::super::select::explicit_label;
use super::super::shape::{self, Element};
use super::super::style::{Own, Paint};
use super::Walk;
use super::state::{Frame, State};
use fretwork_geometry::{LabelSet, Point, Shape};

impl<'a, 'input> Walk<'a, 'input> {
    /// Draws a shape, and gives the frames of its markers.
    pub(super) fn shape(
        &mut self,
        node: Node<'a, 'input>,
        own: &Own<'a>,
        state: &State<'a>,
    ) -> Vec<Frame<'a, 'input>> {
        let element = Element {
            node,
            name: node.tag_name().name(),
            own,
            basis: &state.basis,
        };
        let style = &state.style;
        let has_markers = shape::is_line(element.name)
            && style.visible()
            && style.markers.iter().any(Option::is_some);
        let mut pen = match has_markers {
            true => Pen::with_vertices(state.map, self.tolerance),
            false => Pen::new(state.map, self.tolerance),
        };
        let middle = shape::draw(&element, &mut pen, &mut self.report);
        let outline = pen.finish();
        if let Some(p) = outline.out_of_range {
            let message = format!(
                "({}, {}) is too far out: coordinates go up to {LARGEST:e}",
                p.x, p.y
            );
            self.report.error(tag_range(node), message);
            return Vec::new();
        }
        let label = state
            .label
            .or(explicit_label(node))
            .or(node.attribute("id"))
            .filter(|l| !l.is_empty());
        if let Some(point) = label.and_then(|l| l.strip_prefix("point:")) {
            if let Some(at) = middle.map(|m| state.map.apply(m)).or(outline.first) {
                self.point(node, point, at);
            }
            return Vec::new();
        }
        if !outline.paths.is_empty() && style.visible() {
            self.push(node, label, outline.paths, state);
        }
        self.markers_of(node, &outline.vertices, state)
    }

    /// The frames of the markers at these vertices.
    fn markers_of(
        &mut self,
        node: Node<'a, 'input>,
        vertices: &[Vertex],
        state: &State<'a>,
    ) -> Vec<Frame<'a, 'input>> {
        match vertices {
            [] => Vec::new(),
            vertices => self.markers(node, vertices, state),
        }
    }

    /// Adds what is drawn of a shape, if it is painted.
    fn push(
        &mut self,
        node: Node<'a, 'input>,
        label: Option<&str>,
        paths: Vec<Vec<Point>>,
        state: &State<'a>,
    ) {
        let style = &state.style;
        let filled = self.paints(node, style.fill());
        let pen = style.pen(state.stroke_scale);
        let stroke = pen.filter(|_| self.paints(node, style.stroke()));
        if !filled && stroke.is_none() {
            let has_server = style.fill() != Paint::None;
            if !has_server && style.markers == [None; 3] {
                self.report.unread(
                    node,
                    "a shape without fill and stroke",
                    "give it a stroke to have it read",
                );
            }
            return;
        }
        if stroke.is_some() && style.dashed {
            self.report
                .unread(node, "the dashing of a stroke", "the line is read whole");
        }
        self.points += paths.iter().map(Vec::len).sum::<usize>();
        let label = label.map_or(LabelSet::EMPTY, LabelSet::one);
        self.drawing.shapes.push(Shape {
            label,
            paths,
            filled,
            rule: style.rule,
            stroke,
        });
    }

    fn point(&mut self, node: Node, name: &str, at: Point) {
        if name.is_empty() {
            return self.report.error(
                tag_range(node),
                "a construction point needs a name: `point:NAME`",
            );
        }
        if !(at.x.abs() <= LARGEST && at.y.abs() <= LARGEST) {
            return self.report.error(
                tag_range(node),
                format!("the point `{name}` is too far out"),
            );
        }
        if self.drawing.points.iter().any(|(n, _)| **n == *name) {
            let message = format!("the point `{name}` is in the drawing twice");
            return self
                .report
                .warn(tag_range(node), message, "the first is taken");
        }
        self.drawing.points.push((name.into(), at));
    }
}
