//! Markers: what stands at the vertices of lines (SVG 2, chapter 11.6).

use roxmltree::Node;

use super::super::document::name;
use super::super::length::{Axis, Basis, Length};
use super::super::pen::Vertex;
use super::super::report::tag_range;
use super::super::style::cascade;
use super::super::{transform, viewport};
use super::state::{Frame, State};
use super::window::Window;
use super::{MOST_INSTANCES, Walk, mean_scale};
use fretwork_geometry::{Affine, Point};

/// A marker element as a line with a certain style shows it.
struct Marker<'a, 'input> {
    node: Node<'a, 'input>,
    /// From the user space of its content to the vertex, along the line.
    map: Affine,
    /// The corners of its viewport there.
    corners: [Point; 2],
    is_clipped: bool,
    /// What its content inherits.
    state: State<'a>,
}

impl<'a, 'input> Walk<'a, 'input> {
    /// The frames of all markers of a line.
    pub fn markers(
        &mut self,
        node: Node<'a, 'input>,
        vertices: &[Vertex],
        state: &State<'a>,
    ) -> Vec<Frame<'a, 'input>> {
        let mut frames = Vec::new();
        let known: Vec<Option<Marker>> = state
            .style
            .markers
            .map(|id| id.and_then(|id| self.marker(node, id, state)))
            .into();
        for (i, vertex) in vertices.iter().enumerate() {
            let mut places =
                vec![usize::from(i > 0) + usize::from(i > 0 && i + 1 == vertices.len())];
            if vertices.len() == 1 {
                places.push(2);
            }
            for place in places {
                let Some(marker) = &known[place] else {
                    continue;
                };
                self.instances += 1;
                if self.instances > MOST_INSTANCES {
                    return frames;
                }
                frames.push(self.placed(marker, vertex, place == 0, state));
            }
        }
        frames
    }

    /// The element of a marker with this id; none where it is not there, which is told, or shows itself.
    fn marker_element(&mut self, node: Node<'a, 'input>, id: &str) -> Option<Node<'a, 'input>> {
        let found = self.ids.get(id).copied();
        let Some(marker) = found.filter(|n| name(*n) == Some("marker")) else {
            let help = "nothing is shown for it, as in browsers";
            self.report.note(
                node,
                format!("the marker `{id}` is not in the drawing"),
                help,
            );
            return None;
        };
        // A line in its own marker has none.
        (!self.uses.contains(&marker.id())).then_some(marker)
    }

    /// The marker with this id; none where nothing is shown by it.
    fn marker(
        &mut self,
        node: Node<'a, 'input>,
        id: &'a str,
        state: &State<'a>,
    ) -> Option<Marker<'a, 'input>> {
        let marker = self.marker_element(node, id)?;
        let above = state.style.context_of(self.style_above(marker));
        let (style, own) = cascade(&above, marker, self.sheet, &state.basis, &mut |_, _| {});
        let basis = Basis {
            font_size: style.font_size,
            ..state.basis
        };
        let mut side = |name: &str, axis| {
            let length = viewport::length(marker, name, &mut self.report);
            length.map_or(3.0, |l| l.user(axis, &basis))
        };
        let size = Point::new(side("markerWidth", Axis::X), side("markerHeight", Axis::Y));
        if !(size.x > 0.0 && size.y > 0.0) {
            return None;
        }
        let (inner, view) = viewport::of_nested(marker, Point::ORIGIN, size, &mut self.report)?;
        let basis = Basis {
            viewport: view,
            ..basis
        };
        let hook = inner.apply(Point::new(
            self.hook(marker, "refX", Axis::X, &basis)?,
            self.hook(marker, "refY", Axis::Y, &basis)?,
        ));
        let scale = match marker.attribute("markerUnits") {
            Some("userSpaceOnUse") => 1.0,
            _ => state.style.width,
        };
        let onto = Affine::translation(hook * -1.0).then(Affine::scale(scale, scale));
        Some(Marker {
            node: marker,
            map: inner.then(onto),
            corners: [onto.apply(Point::ORIGIN), onto.apply(size)],
            is_clipped: !own.overflows(),
            state: State {
                style,
                basis,
                label: None,
                ..*state
            },
        })
    }

    /// The place in a marker that comes to the vertex, in its user space.
    fn hook(
        &mut self,
        marker: Node<'a, 'input>,
        name: &str,
        axis: Axis,
        basis: &Basis,
    ) -> Option<f64> {
        let Some(attribute) = marker.attribute_node(name) else {
            return Some(0.0);
        };
        let text = match attribute.value().trim() {
            "left" | "top" => "0%",
            "center" => "50%",
            "right" | "bottom" => "100%",
            other => other,
        };
        let length = text.parse::<Length>().ok().map(|l| l.user(axis, basis));
        if length.is_none_or(|l| !l.is_finite()) {
            let message = format!("`{}` is not a length", attribute.value());
            self.report.error(attribute.range_value(), message);
            return None;
        }
        length
    }

    /// The frame of a marker at a vertex.
    fn placed(
        &mut self,
        marker: &Marker<'a, 'input>,
        vertex: &Vertex,
        is_start: bool,
        state: &State<'a>,
    ) -> Frame<'a, 'input> {
        let turn = self.turn(marker.node, vertex, is_start);
        let there = turn.then(Affine::translation(vertex.at)).then(state.map);
        let map = marker.map.then(there);
        let inner = State {
            map,
            stroke_scale: mean_scale(&map),
            ..marker.state
        };
        let mut frame = Frame::of_children(marker.node, inner).showing(marker.node);
        if marker.is_clipped {
            let first = self.drawing.shapes.len();
            let window = Window::of_viewport(marker.node, marker.corners, &there, first);
            frame.windows.push(window);
        }
        frame
    }

    /// The rotation of a marker at a vertex: along the line, or the same everywhere.
    fn turn(&mut self, marker: Node<'a, 'input>, vertex: &Vertex, is_start: bool) -> Affine {
        let orient = marker.attribute("orient").unwrap_or("0").trim();
        if !matches!(orient, "auto" | "auto-start-reverse") {
            let angle = match orient.ends_with(|c: char| c.is_ascii_digit() || c == '.') {
                true => format!("rotate({orient}deg)"),
                false => format!("rotate({orient})"),
            };
            return transform::parse_css(&angle).unwrap_or_else(|_| {
                let message = format!("`orient: {orient}` is not understood");
                self.report
                    .warn(tag_range(marker), message, "it is left out");
                Affine::IDENTITY
            });
        }
        let along = match (vertex.into, vertex.out) {
            (Some(a), Some(b)) if (a + b).length() > 1e-9 => a + b,
            (Some(a), _) | (None, Some(a)) => a,
            (None, None) => Point::new(1.0, 0.0),
        };
        let back = is_start && orient == "auto-start-reverse";
        let unit = along * (if back { -1.0 } else { 1.0 } / along.length());
        Affine([unit.x, unit.y, -unit.y, unit.x, 0.0, 0.0])
    }
}
