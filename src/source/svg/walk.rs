//! The tree in paint order: which elements are drawn, where, and under which label. The walk
//! keeps its own stack, so nesting costs memory but no recursion.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use roxmltree::{Document, Node, NodeId};

use super::SvgOptions;
use super::document::{XLINK, name};
use super::length::{Axis, Length};
use super::pen::{LARGEST, Pen};
use super::report::{Report, tag_range};
use super::select::{explicit_label, find, ids, passes, sorted};
use super::shape;
use super::sheet::{self, Sheet};
use super::style::{Own, Style, cascade};
use super::{transform, viewport};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine, Drawing, LabelSet, Point, Shape};

/// The most points of all polylines together.
const MOST_POINTS: usize = 10_000_000;
/// The most elements that are drawn through `use`.
const MOST_INSTANCES: usize = 1_000_000;
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
    if let Some(style) = document.descendants().find(|n| name(*n) == Some("style")) {
        for selector in &sheet.unread {
            let message = format!("the selector `{selector}` is not understood");
            report.warn(
                tag_range(style),
                message,
                "its rules are left out; give the elements classes",
            );
        }
    }
    let root = document.root_element();
    let (scale, size) = viewport::of_root(root, options, &mut report);
    let root_scale = mean_scale(&scale);
    let state = State {
        map: scale,
        style: Style::default(),
        viewport: size,
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

/// What an element inherits.
#[derive(Clone, Copy)]
struct State<'a> {
    /// From user space to spec units.
    map: Affine,
    style: Style,
    /// The size that percentages are taken of.
    viewport: Point,
    /// Spec units per user unit of stroke width.
    stroke_scale: f64,
    /// The label of a `use`, for the shape that it shows.
    label: Option<&'a str>,
}

/// An element whose children are being visited, or a single element.
struct Frame<'a, 'input> {
    next: Option<Node<'a, 'input>>,
    /// Whether only `next` is visited, not its siblings.
    single: bool,
    /// Whether the frame was opened by a `use`.
    used: bool,
    state: State<'a>,
    /// The viewport that what is in the frame is shown through.
    window: Option<Window<'a, 'input>>,
}

/// The viewport of a nested `svg` or a `symbol`.
struct Window<'a, 'input> {
    node: Node<'a, 'input>,
    /// Its corners in order, in spec units.
    corners: [Point; 4],
    /// The number of the first shape in it.
    first: usize,
}

impl Window<'_, '_> {
    /// Whether `p` is inside, or outside by no more than `slack`.
    fn has(&self, p: Point, slack: f64) -> bool {
        let sides = (0..4).map(|i| (self.corners[i], self.corners[(i + 1) % 4]));
        let distances = sides.map(|(a, b)| (b - a).cross(p - a) / a.distance(b));
        let (low, high) = distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| {
            (l.min(d), h.max(d))
        });
        // A mirrored viewport has its inside on the other side of all four.
        low >= -slack || high <= slack
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
    /// The elements shown by the `use`s that are being visited, outermost first.
    uses: Vec<NodeId>,
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
            state = self.enter(node, &state)?;
            if nested {
                state = self.nested_viewport(node, node, state)?.0;
            }
        }
        Some(state)
    }

    /// Visits `target` and what is in it.
    fn run(&mut self, target: Node<'a, 'input>, state: State<'a>) {
        let root = target.parent_element().is_none();
        let mut stack = match name(target) {
            // What is never drawn where it stands is drawn when it is asked for.
            Some("defs" | "symbol" | "marker" | "pattern" | "clipPath" | "mask") => {
                self.children(target, &state)
            }
            Some("svg") if root => self.children(target, &state),
            _ => Some(Frame {
                next: Some(target),
                single: true,
                used: false,
                state,
                window: None,
            }),
        }
        .into_iter()
        .collect::<Vec<_>>();
        while let Some(frame) = stack.last_mut() {
            let Some(node) = frame.next else {
                if frame.used {
                    self.uses.pop();
                }
                let window = stack.pop().and_then(|frame| frame.window);
                window
                    .into_iter()
                    .for_each(|window| self.look_outside(&window));
                continue;
            };
            frame.next = if frame.single {
                None
            } else {
                node.next_sibling()
            };
            let state = frame.state;
            let inner = self.visit(node, &state);
            if self.exhausted(node) {
                return;
            }
            stack.extend(inner);
        }
    }

    /// Draws a shape, or gives the frame of what is in the element.
    fn visit(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<Frame<'a, 'input>> {
        let tag = name(node)?;
        self.instances += usize::from(!self.uses.is_empty());
        match tag {
            "g" | "a" => self.children(node, state),
            "svg" => {
                let state = self.enter(node, state)?;
                let (state, window) = self.nested_viewport(node, node, state)?;
                Some(Frame {
                    next: node.first_child(),
                    single: false,
                    used: false,
                    state,
                    window,
                })
            }
            "switch" => {
                let state = self.enter(node, state)?;
                let chosen = node.children().find(|n| name(*n).is_some() && passes(*n));
                chosen.map(|n| Frame {
                    next: Some(n),
                    single: true,
                    used: false,
                    state,
                    window: None,
                })
            }
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
                let state = self.enter(node, state)?;
                self.shape(node, tag, &state);
                None
            }
            _ => None,
        }
    }

    fn children(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<Frame<'a, 'input>> {
        let state = State {
            label: None,
            ..self.enter(node, state)?
        };
        Some(Frame {
            next: node.first_child(),
            single: false,
            used: false,
            state,
            window: None,
        })
    }

    fn unread(
        &mut self,
        node: Node<'a, 'input>,
        state: &State<'a>,
        kind: &'static str,
        help: &'static str,
    ) -> Option<Frame<'a, 'input>> {
        let state = self.enter(node, state)?;
        if state.style.visible() {
            self.report.unread(node, kind, help);
        }
        None
    }

    /// The state inside the element: its style and transform applied. None when nothing of it is seen.
    fn enter(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<State<'a>> {
        if !passes(node) {
            return None;
        }
        let tag = node.tag_name().name();
        let report = &mut self.report;
        let mut bad = |property: &str, value: &str| {
            report.warn(
                tag_range(node),
                format!("`{property}: {value}` is not understood"),
                "it is left out",
            );
        };
        let (style, own) = cascade(
            &state.style,
            node,
            tag,
            self.sheet,
            state.viewport,
            &mut bad,
        );
        if own.is_hidden() {
            return None;
        }
        if own.is_clipped() {
            self.report.unread(
                node,
                "a clip or mask",
                "what it hides is read; cut the paths in the drawing program",
            );
        }
        let map = self.transform(node, &own, state)?;
        let stroke_scale = if own.fixed_stroke {
            self.root_scale
        } else {
            mean_scale(&map)
        };
        Some(State {
            map,
            style,
            stroke_scale,
            ..*state
        })
    }

    fn transform(
        &mut self,
        node: Node<'a, 'input>,
        own: &Own<'a>,
        state: &State<'a>,
    ) -> Option<Affine> {
        let attribute = node.attribute_node("transform");
        // CSS writes units where the attribute has none.
        let css = own
            .transform
            .map(|text| text.replace("px", "").replace("deg", ""));
        let Some(text) = css.as_deref().or(attribute.map(|a| a.value())) else {
            return Some(state.map);
        };
        let range = || attribute.map_or(tag_range(node), |a| a.range_value());
        let Ok(map) = transform::parse(text) else {
            self.report.error(
                range(),
                "bad transform: expected a list such as `translate(1 2) rotate(30)`",
            );
            return None;
        };
        let map = match own.origin {
            None => map,
            Some(text) => match transform::origin(text, state.viewport) {
                Some(center) => map.about(center),
                None => {
                    self.report.error(
                        range(),
                        format!("the transform origin `{text}` is not understood"),
                    );
                    return None;
                }
            },
        };
        let map = map.then(state.map);
        (map.determinant() != 0.0).then_some(map)
    }

    /// The state inside the viewport of an `svg` or `symbol`, whose place and size are the
    /// attributes of `placed`.
    fn nested_viewport(
        &mut self,
        node: Node<'a, 'input>,
        placed: Node<'a, 'input>,
        state: State<'a>,
    ) -> Option<(State<'a>, Option<Window<'a, 'input>>)> {
        let mut number = |attribute: &str, axis: Axis, default: &str| {
            let own = if node == placed || attribute == "x" || attribute == "y" {
                None
            } else {
                Some(node)
            };
            let written = [Some(placed), own]
                .into_iter()
                .flatten()
                .find(|n| n.has_attribute(attribute));
            let length = match written {
                Some(n) => viewport::length(n, attribute, &mut self.report),
                None => None,
            };
            length
                .or(default.parse::<Length>().ok())
                .map_or(0.0, |l| l.user(axis, state.viewport))
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
        let corners = [
            at,
            at + Point::new(size.x, 0.0),
            at + size,
            at + Point::new(0.0, size.y),
        ];
        let is_bounded =
            size.x > 0.0 && size.y > 0.0 && node.attribute("overflow") != Some("visible");
        let window = Window {
            node,
            corners: corners.map(|corner| state.map.apply(corner)),
            first: self.drawing.shapes.len(),
        };
        Some((
            State {
                map: map.then(state.map),
                viewport,
                label: None,
                ..state
            },
            is_bounded.then_some(window),
        ))
    }

    /// Tells of what was drawn outside of a viewport, which hides it from view.
    fn look_outside(&mut self, window: &Window<'a, 'input>) {
        let drawn = &self.drawing.shapes[window.first..];
        let slack = self
            .tolerance
            .max(1e-6 * window.corners[0].distance(window.corners[2]));
        if drawn
            .iter()
            .flat_map(|shape| shape.paths.iter().flatten())
            .any(|p| !window.has(*p, slack))
        {
            let help = "what lies outside of it is read; cut the paths in the drawing program";
            self.report
                .unread(window.node, "the edge of a nested drawing or symbol", help);
        }
    }

    /// What a `use` shows.
    fn instance(&mut self, node: Node<'a, 'input>, state: &State<'a>) -> Option<Frame<'a, 'input>> {
        let state = self.enter(node, state)?;
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
        let mut number = |attribute: &str, axis| {
            viewport::length(node, attribute, &mut self.report)
                .map_or(0.0, |l| l.user(axis, state.viewport))
        };
        let at = Point::new(number("x", Axis::X), number("y", Axis::Y));
        let label = explicit_label(node);
        let state = State {
            map: Affine::translation(at).then(state.map),
            label: label.or(state.label),
            ..state
        };
        let frame = match name(target) {
            Some("symbol" | "svg") => {
                let inner = self.enter(target, &state)?;
                let (state, window) = self.nested_viewport(target, node, inner)?;
                Frame {
                    next: target.first_child(),
                    single: false,
                    used: true,
                    state,
                    window,
                }
            }
            _ => Frame {
                next: Some(target),
                single: true,
                used: true,
                state,
                window: None,
            },
        };
        self.uses.push(target.id());
        Some(frame)
    }

    fn shape(&mut self, node: Node<'a, 'input>, tag: &str, state: &State<'a>) {
        let mut pen = Pen::new(state.map, self.tolerance);
        let middle = shape::draw(node, tag, state.viewport, &mut pen, &mut self.report);
        let outline = pen.finish();
        if let Some(p) = outline.out_of_range {
            let message = format!(
                "({}, {}) is too far out: coordinates go up to {LARGEST:e}",
                p.x, p.y
            );
            return self.report.error(tag_range(node), message);
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
            return;
        }
        let (filled, rule) = (state.style.filled(), state.style.rule);
        let stroke = state.style.stroked(state.stroke_scale);
        if outline.paths.is_empty() || !state.style.visible() {
            return;
        }
        if !filled && stroke.is_none() {
            return self.report.unread(
                node,
                "a shape without fill and stroke",
                "give it a stroke to have it read",
            );
        }
        if stroke.is_some() && state.style.dashed {
            self.report
                .unread(node, "the dashing of a stroke", "the line is read whole");
        }
        self.points += outline.paths.iter().map(Vec::len).sum::<usize>();
        let label = label.map_or(LabelSet::EMPTY, LabelSet::one);
        self.drawing.shapes.push(Shape {
            label,
            paths: outline.paths,
            filled,
            rule,
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

    /// Whether a budget is used up, which is an error.
    fn exhausted(&mut self, node: Node) -> bool {
        let message = if self.points > MOST_POINTS {
            format!(
                "the drawing has more than {MOST_POINTS} points at a tolerance of {}",
                self.tolerance
            )
        } else if self.instances > MOST_INSTANCES {
            format!("`use` shows more than {MOST_INSTANCES} elements")
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

/// The mean over all directions by which `map` stretches.
fn mean_scale(map: &Affine) -> f64 {
    map.determinant().abs().sqrt()
}
