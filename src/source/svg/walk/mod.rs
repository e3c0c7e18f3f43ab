//! The tree in paint order: which elements are drawn, where, and under which label. The walk
//! keeps its own stack, so nesting costs memory but no recursion.

mod clip;
mod draw;
mod marker;
mod paint;
mod place;
mod state;
mod window;

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use roxmltree::{Document, Node, NodeId};

use super::document::{XLINK, name};
use super::length::{Axis, Basis};
use super::options::SvgOptions;
use super::report::{Report, tag_range};
use super::select::{explicit_label, find, ids, passes, sorted};
use super::shape::{self, Element};
use super::sheet::{self, Sheet};
use super::style::{Own, Style, cascade};
use super::viewport;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::budget;
use fretwork_geometry::{Affine, Drawing, Point};
use place::mean_scale;
use state::{Frame, State};
use window::Window;

/// The most points of all polylines together.
const MOST_POINTS: usize = 10_000_000;
/// The most elements that are drawn through `use` or as markers.
const MOST_INSTANCES: usize = 1_000_000;
/// Bytes for a point of a drawing, and steps for an element.
const POINT: usize = 64;
const ELEMENT_STEPS: u64 = 100;
/// How deeply `use` may lead to `use`.
const USE_DEPTH: usize = 256;

/// What [`super::select()`] returns for a parsed document.
pub fn drawing(
    document: &Document,
    file: &Arc<str>,
    options: &SvgOptions,
    id: Option<&str>,
) -> Result<(Drawing, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut report = Report::new(file);
    if !(options.tolerance > 0.0 && options.tolerance.is_finite() && options.unit_mm > 0.0) {
        let what = format!(
            "the tolerance {} is not a length above zero",
            options.tolerance
        );
        return Err(vec![Diagnostic::error(what).at(report.span(0..0), "")]);
    }
    let css = sheet::collect(document);
    let sheet = Sheet::parse(&css);
    let root = document.root_element();
    tell_unread(document, &sheet, &mut report);
    let (scale, basis) = viewport::of_root(root, options, &mut report);
    let root_scale = mean_scale(&scale);
    let state = State {
        map: scale,
        style: Style::default(),
        basis,
        stroke_scale: root_scale,
        label: None,
    };
    let mut walk = Walk {
        report,
        sheet: &sheet,
        tolerance: options.tolerance,
        root_scale,
        ids: ids(document),
        drawing: Drawing::default(),
        points: 0,
        instances: 0,
        uses: Vec::new(),
        opened: Vec::new(),
    };
    let target = match id {
        None => root,
        Some(id) => find(document, id, &mut walk.report).map_err(|d| vec![d])?,
    };
    if let Some(state) = walk.descend(target, state) {
        walk.run(target, state);
    }
    walk.finish(root, target)
}

/// Tells what of the style sheets is not read, and of animations.
fn tell_unread(document: &Document, sheet: &Sheet, report: &mut Report) {
    let style = document.descendants().find(|n| name(*n) == Some("style"));
    let at = style.unwrap_or(document.root_element());
    for (what, help) in sheet.unread.iter().cloned().chain(sheet::linked(document)) {
        report.warn(tag_range(at), what, help);
    }
    let moves = |n: &Node| {
        let tag = name(*n).unwrap_or("");
        matches!(
            tag,
            "animate" | "animateTransform" | "animateMotion" | "set"
        )
    };
    for node in document.descendants().filter(moves) {
        report.unread(node, "an animation", "the drawing is read as it is without");
    }
}

struct Walk<'a, 'input> {
    report: Report,
    sheet: &'a Sheet<'a>,
    tolerance: f64,
    root_scale: f64,
    ids: HashMap<&'a str, Node<'a, 'input>>,
    drawing: Drawing,
    points: usize,
    instances: usize,
    /// What is shown by the `use`s and markers that are being visited, outermost first.
    uses: Vec<NodeId>,
    /// What hides parts of the element that is being entered.
    opened: Vec<Window<'a, 'input>>,
}

impl<'a, 'input> Walk<'a, 'input> {
    /// The state in which `target` is met, coming down from the root; none when it is not seen.
    fn descend(&mut self, target: Node<'a, 'input>, mut state: State<'a>) -> Option<State<'a>> {
        let mut above: Vec<Node> = target
            .ancestors()
            .skip(1)
            .filter(|n| n.is_element())
            .collect();
        let root = above.pop();
        for node in root.into_iter().chain(above.into_iter().rev()) {
            let nested = name(node) == Some("svg") && Some(node) != root;
            let (entered, own) = self.enter(node, &state)?;
            state = match nested {
                true => self.nested_viewport(node, node, &own, entered)?.0,
                false => entered,
            };
            // What hides parts of a group may leave the target whole.
            self.opened.clear();
        }
        Some(state)
    }

    /// Visits `target` and what is in it.
    fn run(&mut self, target: Node<'a, 'input>, state: State<'a>) {
        let is_root = target.parent_element().is_none();
        let first = match name(target) {
            // What is never drawn where it stands is drawn when it is asked for.
            Some("defs" | "symbol" | "marker" | "pattern" | "clipPath" | "mask") => {
                self.children(target, &state)
            }
            Some("svg") if is_root => self.children(target, &state),
            _ => Some(Frame::of_one(target, state)),
        };
        let mut stack: Vec<Frame> = first.into_iter().collect();
        if let Some(frame) = stack.last_mut() {
            frame.windows.append(&mut self.opened);
        }
        while let Some(frame) = stack.last_mut() {
            if let Some(target) = frame.shows.take() {
                self.uses.push(target);
                frame.entered = true;
                // Markers wait for one another: what is in a window is known when its frame is entered.
                let first = self.drawing.shapes.len();
                frame.windows.iter_mut().for_each(|w| w.first = first);
            }
            let Some(node) = frame.next else {
                if frame.entered {
                    self.uses.pop();
                }
                let windows = stack.pop().map(|frame| frame.windows);
                for window in windows.into_iter().flatten() {
                    self.look_outside(&window);
                }
                continue;
            };
            frame.next = if frame.single {
                None
            } else {
                node.next_sibling()
            };
            let state = frame.state;
            let mut inner = self.visit(node, &state);
            let opened = std::mem::take(&mut self.opened);
            match inner
                .first_mut()
                .filter(|_| !shape::is_shape(name(node).unwrap_or("")))
            {
                Some(frame) => frame.windows.extend(opened),
                None => opened.iter().for_each(|window| self.look_outside(window)),
            }
            if self.exhausted(node) {
                return;
            }
            stack.extend(inner);
        }
    }

    /// Draws a shape, or gives the frames of what is in the element or stands at the shape.
    fn visit(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Vec<Frame<'a, 'input>> {
        let Some(tag) = name(node) else {
            return Vec::new();
        };
        self.instances += usize::from(!self.uses.is_empty());
        let frame = match tag {
            "g" | "a" => self.children(node, state),
            "svg" => self.nested(node, state),
            "switch" => self.enter(node, state).and_then(|(state, _)| {
                let chosen = node.children().find(|n| name(*n).is_some() && passes(*n));
                chosen.map(|n| Frame::of_one(n, state))
            }),
            "use" => self.instance(node, state),
            "text" | "flowRoot" => self.unread(node, state, "text", "convert it to paths"),
            "image" => self.unread(
                node,
                state,
                "an image",
                "trace it, or use it as a raster exemplar",
            ),
            "foreignObject" => self.unread(node, state, "foreign content", "convert it to paths"),
            _ if shape::is_shape(tag) => {
                return match self.enter(node, state) {
                    Some((state, own)) => self.shape(node, &own, &state),
                    None => Vec::new(),
                };
            }
            _ => None,
        };
        frame.into_iter().collect()
    }

    fn children(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<Frame<'a, 'input>> {
        let (state, _) = self.enter(node, state)?;
        let state = State {
            label: None,
            ..state
        };
        Some(Frame::of_children(node, state))
    }

    /// The frame of a nested drawing.
    fn nested(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<Frame<'a, 'input>> {
        let (state, own) = self.enter(node, state)?;
        let (state, window) = self.nested_viewport(node, node, &own, state)?;
        let mut frame = Frame::of_children(node, state);
        frame.windows.extend(window);
        Some(frame)
    }

    fn unread(
        &mut self,
        node: Node<'a, 'input>,
        state: &State<'a>,
        kind: &'static str,
        help: &'static str,
    ) -> Option<Frame<'a, 'input>> {
        let (state, _) = self.enter(node, state)?;
        if state.style.visible() {
            self.report.unread(node, kind, help);
        }
        None
    }

    /// The state inside the element: its style and transform applied; and what its style says of
    /// it alone. None when nothing of it is seen.
    fn enter(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<(State<'a>, Own<'a>)> {
        if !passes(node) {
            return None;
        }
        let report = &mut self.report;
        let mut bad = |property: &str, value: &str| {
            report.warn(
                tag_range(node),
                format!("`{property}: {value}` is not understood"),
                "it is left out",
            );
        };
        let (style, own) = cascade(&state.style, node, self.sheet, &state.basis, &mut bad);
        if own.is_hidden() {
            return None;
        }
        for what in &own.unread {
            let help = "the drawing is read without it; apply it in the drawing program";
            self.report.unread(node, what, help);
        }
        let mut basis = Basis {
            font_size: style.font_size,
            ..state.basis
        };
        if node.parent_element().is_none() {
            basis.root_font_size = style.font_size;
        }
        let mut inner = State {
            style,
            basis,
            ..*state
        };
        inner.map = self.transform(node, &own, &inner)?;
        inner.stroke_scale = match own.fixed_stroke {
            true => self.root_scale,
            false => mean_scale(&inner.map),
        };
        self.clip(node, &own, &inner);
        Some((inner, own))
    }

    /// What a `use` shows.
    fn instance(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<Frame<'a, 'input>> {
        let (state, own) = self.enter(node, state)?;
        let reference = node
            .attribute_node("href")
            .or(node.attribute_node((XLINK, "href")))?;
        let range = reference.range_value();
        let Some(id) = reference.value().trim().strip_prefix('#') else {
            self.report.warn(
                range,
                "`use` of another file is not read",
                "copy it into this drawing",
            );
            return None;
        };
        let Some(&target) = self.ids.get(id) else {
            let error = Diagnostic::error(format!("`use` of `{id}`, which is not in the drawing"));
            let error = error.at(self.report.span(range), "");
            // `sorted` makes the order of the map harmless.
            #[expect(clippy::disallowed_methods)]
            let known = sorted(self.ids.keys().copied());
            self.report.push(error.suggest(id, known));
            return None;
        };
        if self.uses.contains(&target.id()) || self.uses.len() >= USE_DEPTH {
            self.report
                .error(range, format!("`use` of `{id}` leads back to itself"));
            return None;
        }
        let element = Element {
            node,
            name: "use",
            own: &own,
            basis: &state.basis,
        };
        let mut number =
            |name: &str, axis| shape::length(&element, name, axis, &mut self.report).unwrap_or(0.0);
        let at = Point::new(number("x", Axis::X), number("y", Axis::Y));
        let label = explicit_label(node);
        let state = State {
            map: Affine::translation(at).then(state.map),
            label: label.or(state.label),
            ..state
        };
        let mut frame = match name(target) {
            Some("symbol" | "svg") => {
                let (inner, own) = self.enter(target, &state)?;
                let (state, window) = self.nested_viewport(target, node, &own, inner)?;
                let mut frame = Frame::of_children(target, state);
                frame.windows.extend(window);
                frame
            }
            _ => Frame::of_one(target, state),
        };
        frame = frame.showing(target);
        Some(frame)
    }

    /// Whether a budget is used up, which is an error.
    fn exhausted(&mut self, node: Node) -> bool {
        budget::hold("points of a drawing", self.points, POINT);
        budget::spend("elements of a drawing", ELEMENT_STEPS);
        let message = if self.points > MOST_POINTS {
            format!(
                "the drawing has more than {MOST_POINTS} points at a tolerance of {}",
                self.tolerance
            )
        } else if self.instances > MOST_INSTANCES {
            format!("`use` and markers show more than {MOST_INSTANCES} elements")
        } else {
            return false;
        };
        self.report.error(tag_range(node), message);
        true
    }

    fn finish(
        mut self,
        root: Node,
        target: Node,
    ) -> Result<(Drawing, Vec<Diagnostic>), Vec<Diagnostic>> {
        if self.drawing.shapes.is_empty() && !self.report.failed() {
            let range: Range<usize> = tag_range(target);
            let what = if root == target {
                "the drawing"
            } else {
                "the selected element"
            };
            let error = Diagnostic::error(format!("nothing visible is in {what}"))
                .at(self.report.span(range), "");
            let help = "hidden elements, definitions, text and images are not read";
            self.report.push(error.help(help));
        }
        let failed = self.report.failed();
        let diagnostics = self.report.finish();
        if failed {
            Err(diagnostics)
        } else {
            Ok((self.drawing, diagnostics))
        }
    }
}
