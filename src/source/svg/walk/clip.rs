//! Which parts of a drawing are behind clips and masks (CSS Masking, level 1). A clip that is convex, or several of
//! which one holds all of a line, hides nothing of it.

use roxmltree::Node;

use super::super::document::name;
use super::super::length::{Axis, Basis};
use super::super::pen::Pen;
use super::super::shape::{self, Element};
use super::super::style::{Own, Paint, Style, cascade, opacity, reference};
use super::super::viewport;
use super::state::State;
use super::window::{CLIP, Window, is_convex, is_inside, rectangle};
use super::{Walk, mean_scale};
use fretwork_geometry::{Affine, Point};

impl<'a, 'input> Walk<'a, 'input> {
    /// Tells of what was drawn outside of a window, which hides it from view.
    pub fn look_outside(&mut self, window: &Window<'a, 'input>) {
        let drawn = &self.drawing.shapes[window.first..];
        let slack = self.tolerance.max(1e-6 * window.size());
        if !drawn.iter().all(|shape| window.holds(shape, slack)) {
            let (what, help) = window.told;
            self.report.unread(window.node, what, help);
        }
    }

    /// Opens the windows of the clip and the mask of an element, or tells of them at once.
    pub fn clip(&mut self, node: Node<'a, 'input>, own: &Own<'a>, state: &State<'a>) {
        let clips = [(own.clip, "clipPath"), (own.mask, "mask")];
        for (said, tag) in clips {
            let Some(said) = said else { continue };
            let target = reference(said).map(|id| self.ids.get(id).copied());
            let areas = match target {
                // What is not there clips nothing.
                Some(None) if tag == "clipPath" => continue,
                Some(Some(target)) if name(target) == Some(tag) => {
                    self.areas(target, tag == "mask", state)
                }
                _ => Some(Vec::new()),
            };
            // The box of the element always holds it.
            let Some(areas) = areas else { continue };
            if areas.is_empty() {
                self.report.unread(node, CLIP.0, CLIP.1);
                continue;
            }
            let first = self.drawing.shapes.len();
            self.opened.push(Window::of_clip(node, areas, first));
        }
    }

    /// The convex areas that a clip or a mask shows, in spec units; none where it shows at least the box of
    /// the element.
    fn areas(
        &mut self,
        target: Node<'a, 'input>,
        is_mask: bool,
        state: &State<'a>,
    ) -> Option<Vec<Vec<Point>>> {
        let units = match is_mask {
            true => "maskContentUnits",
            false => "clipPathUnits",
        };
        let is_of_box = target.attribute(units) == Some("objectBoundingBox");
        let map = if is_of_box {
            Affine::IDENTITY
        } else {
            state.map
        };
        let above = self.style_above(target);
        let (style, own) = cascade(&above, target, self.sheet, &state.basis, &mut |_, _| {});
        if own.clip.is_some() || own.mask.is_some() || own.transform.is_some() {
            return Some(Vec::new());
        }
        let state = State {
            map,
            style,
            ..*state
        };
        let mut areas: Vec<Vec<Point>> = Vec::new();
        for child in target.children() {
            areas.extend(self.area(child, is_mask, &state));
        }
        if is_mask && !self.mask_is_wide(target, &state) {
            return Some(Vec::new());
        }
        let corners = rectangle(Point::ORIGIN, Point::new(1.0, 1.0));
        let holds = |area: &Vec<Point>| corners.iter().all(|p| is_inside(area, *p, 1e-6));
        match is_of_box {
            true if areas.iter().any(holds) => None,
            true => Some(Vec::new()),
            false => Some(areas),
        }
    }

    /// Whether the box of a mask, outside of which nothing is seen, is that of the element or larger.
    fn mask_is_wide(&mut self, mask: Node<'a, 'input>, state: &State<'a>) -> bool {
        if mask.attribute("maskUnits") == Some("userSpaceOnUse") {
            // A box in user space is compared with the viewport, which is as much as a browser shows.
            let mut side = |name: &str, axis| {
                let length = viewport::length(mask, name, &mut self.report);
                length.map(|l| l.user(axis, &state.basis))
            };
            let (x, y) = (side("x", Axis::X), side("y", Axis::Y));
            let (w, h) = (side("width", Axis::X), side("height", Axis::Y));
            let view = state.basis.viewport;
            let covers = |from: Option<f64>, size: Option<f64>, whole: f64| match (from, size) {
                (Some(from), Some(size)) => from <= 0.0 && from + size >= whole,
                _ => false,
            };
            return covers(x, w, view.x) && covers(y, h, view.y);
        }
        let share = |name: &str, default: f64| match mask.attribute(name) {
            None => default,
            Some(text) => opacity(text).unwrap_or(f64::NAN),
        };
        let (x, y) = (share("x", -0.1), share("y", -0.1));
        let (w, h) = (share("width", 1.2), share("height", 1.2));
        x <= 0.0 && y <= 0.0 && x + w >= 1.0 && y + h >= 1.0
    }

    /// The area of a shape in a clip or mask, if it is convex, and seen through.
    fn area(
        &mut self,
        node: Node<'a, 'input>,
        is_mask: bool,
        state: &State<'a>,
    ) -> Option<Vec<Point>> {
        let tag = name(node).filter(|tag| shape::is_shape(tag))?;
        let ignore = &mut |_: &str, _: &str| {};
        let (style, own) = cascade(&state.style, node, self.sheet, &state.basis, ignore);
        let is_white = style.fill() == Paint::Color { is_white: true } && !own.is_translucent();
        let is_plain = own.clip.is_none() && own.mask.is_none() && own.unread.is_empty();
        if own.is_hidden() || !style.visible() || !is_plain || is_mask && !is_white {
            return None;
        }
        let state = &State { style, ..*state };
        let map = self.transform(node, &own, state)?;
        let basis = Basis {
            font_size: style.font_size,
            ..state.basis
        };
        let element = Element {
            node,
            name: tag,
            own: &own,
            basis: &basis,
        };
        let mut pen = Pen::new(map, self.tolerance.max(1e-6 * mean_scale(&map)));
        shape::draw(&element, &mut pen, &mut self.report);
        let outline = pen.finish();
        let [ring] = &outline.paths[..] else {
            return None;
        };
        let mut ring = ring.clone();
        if ring.first() == ring.last() {
            ring.pop();
        }
        (outline.out_of_range.is_none() && is_convex(&ring)).then_some(ring)
    }

    /// The properties that `node` inherits from the elements around it.
    pub fn style_above(&self, node: Node<'a, 'input>) -> Style<'a> {
        let mut above: Vec<Node> = node.ancestors().skip(1).filter(Node::is_element).collect();
        above.reverse();
        let mut style = Style::default();
        for node in above {
            let basis = Basis {
                font_size: style.font_size,
                ..Basis::of(Point::ORIGIN)
            };
            style = cascade(&style, node, self.sheet, &basis, &mut |_, _| {}).0;
        }
        style
    }
}
