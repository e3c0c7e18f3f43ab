//! How labelled curves and areas look on a sheet.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

use super::fault::Fault;
use fretwork_diagnostic::{Diagnostic, nearest};
use fretwork_fabricate::{Color, Item, Layer, Pen};
use fretwork_geometry::polygon::{self, AreaError};
use fretwork_geometry::{Curves, Drawing, FaceId, LabelSet, PlanarMap, Polygon, Region, Ring};
use fretwork_language::kinds::artifacts::{Artifact, Paint, Role, Style};

/// The styles of an artifact.
pub struct Styles<'a> {
    /// In paint order.
    named: &'a [(Arc<str>, Style)],
    /// The width of lines where a style has none, in units of the file.
    width: f64,
    /// Millimetres in a unit of the file.
    width_mm: f64,
    /// The width that the artifact asks for, in millimetres.
    stroke: Option<f64>,
    has_role_colors: bool,
    /// The part that is drawn: its number, and its layer and its pen where it says so.
    part: usize,
    layer: Option<Arc<str>>,
    pen: Option<u32>,
    /// The labels and names of all that was drawn.
    seen: Rc<RefCell<BTreeSet<Arc<str>>>>,
    /// The names of layers that the artifact asks for, and who asks.
    asked: Rc<RefCell<BTreeMap<Arc<str>, BTreeSet<Asked>>>>,
}

impl<'a> Styles<'a> {
    /// The styles of `artifact`; lines are `width` wide (millimetres) where it does not say, and have the
    /// colours by which machines know what to do with them if `has_role_colors`, else they are black.
    pub fn new(artifact: &'a Artifact, width: f64, has_role_colors: bool) -> Styles<'a> {
        Styles {
            named: &artifact.style,
            width,
            width_mm: 1.0,
            stroke: artifact.stroke.map(|stroke| stroke.0),
            has_role_colors,
            part: 0,
            layer: None,
            pen: None,
            seen: Rc::default(),
            asked: Rc::default(),
        }
    }

    /// The same where a unit of the file is `width_mm` millimetres.
    pub fn in_units(self, width_mm: f64) -> Styles<'a> {
        Styles { width_mm, ..self }
    }

    /// The width of lines whose style has none, in units of the file.
    fn width(&self) -> f64 {
        self.stroke
            .map_or(self.width, |stroke| stroke / self.width_mm)
    }

    /// The styles for the part of this number, with a layer and a pen of its own.
    pub fn of_part(&self, part: usize, layer: Option<Arc<str>>, pen: Option<u32>) -> Styles<'a> {
        Styles {
            part,
            layer,
            pen,
            seen: self.seen.clone(),
            asked: self.asked.clone(),
            ..*self
        }
    }

    /// The name of a layer that would be called `default`: what the part says, else what the style says, with the number of the pen
    /// before it.
    fn layer_name(&self, found: Option<&Look>, default: Arc<str>) -> Arc<str> {
        let style = found.map(|look| &look.style);
        let of_style = style
            .and_then(|s| s.layer.as_ref())
            .map(|layer| layer.0.clone());
        let field = match (&self.layer, &of_style) {
            (Some(_), _) => Some(Field::Part(self.part)),
            (None, Some(_)) => found.map(|look| Field::Style(look.place)),
            _ => None,
        };
        let name = self.layer.clone().or(of_style).unwrap_or(default);
        let pen = self.pen.or(style.and_then(|s| s.pen).map(|pen| pen.0));
        if let Some(field) = field {
            let mut asked = self.asked.borrow_mut();
            let by = asked.entry(name.clone()).or_default();
            by.insert(Asked { pen, field });
        }
        match pen {
            Some(pen) => format!("{pen} {name}").into(),
            None => name,
        }
    }

    /// Whether every layer that was asked for has one pen and one look: a machine and DXF have one colour a layer.
    ///
    /// # Errors
    /// When parts or labels with different pens or lines share a layer, at those that say so.
    pub fn check_layers(&self, layers: &[Layer]) -> Result<(), Fault> {
        for (name, by) in self.asked.borrow().iter() {
            let Some(first) = by.first() else { continue };
            if by.iter().any(|other| other.pen != first.pen) {
                let message = format!("the layer `{name}` is drawn by different pens");
                let help = "give all that shares it the same `pen`, or layers of their own";
                return Err(self.blamed(by, Diagnostic::error(message).help(help)));
            }
            let full = first
                .pen
                .map_or(name.clone(), |pen| format!("{pen} {name}").into());
            let lines = layers.iter().filter(|layer| layer.name == full);
            let mut lines = lines.filter(|layer| layer.style.stroke.is_some());
            let Some(first) = lines.next() else { continue };
            let is_other = |layer: &Layer| {
                (layer.style.stroke, layer.role) != (first.style.stroke, first.role)
            };
            if lines.any(is_other) {
                let message = format!("the layer `{name}` has lines of different looks");
                let help = "give what shares it one colour, one width and one role, or layers of their own";
                return Err(self.blamed(by, Diagnostic::error(message).help(help)));
            }
        }
        Ok(())
    }

    /// An error at the fields that ask for a layer.
    fn blamed(&self, by: &BTreeSet<Asked>, told: Diagnostic) -> Fault {
        let fields: BTreeSet<Field> = by.iter().map(|asked| asked.field).collect();
        fields.into_iter().fold(Fault::from(told), |fault, field| {
            let way = match field {
                Field::Part(number) => vec!["parts".into(), number.to_string(), "layer".into()],
                Field::Style(number) => {
                    let label = self.named[number].0.to_string();
                    vec!["style".into(), label, "layer".into()]
                }
            };
            fault.at(way, "this layer")
        })
    }

    /// Warnings for the styles whose labels nothing has that was drawn.
    pub fn unused(&self) -> Vec<Diagnostic> {
        let seen = self.seen.borrow();
        let keys = self.named.iter().map(|(key, _)| key);
        let unused = keys.filter(|key| &***key != "*" && !seen.contains(*key));
        let warning = |key: &Arc<str>| {
            let message = format!("nothing that is drawn has the label or the name `{key}`");
            let warning = Diagnostic::warning(message);
            match nearest(key, seen.iter().map(|name| &**name)) {
                Some(near) => warning.help(format!("did you mean `{near}`?")),
                None => warning,
            }
        };
        unused.map(warning).collect()
    }

    /// The curves as lines, a layer for each set of labels.
    pub fn lines(&self, name: &Arc<str>, role: Role, curves: &Curves) -> Vec<Layer> {
        let mut layers = Layers::default();
        for curve in curves.iter() {
            layers.add(curve.labels.edge, Item::Line(curve.points.to_vec()));
        }
        self.finish(layers, name, role, false)
    }

    /// The polygons as one layer.
    pub fn areas(
        &self,
        name: &Arc<str>,
        role: Role,
        areas: &[Polygon],
        is_filled: bool,
    ) -> Vec<Layer> {
        let place = self.place(LabelSet::EMPTY, name);
        let style = self.style(place.as_ref(), is_filled, role);
        let name = self.layer_name(place.as_ref(), name.clone());
        vec![Layer::of_areas(name, made(role), style, areas)]
    }

    /// A region: a layer for each set of labels that its parts have inside.
    pub fn region(
        &self,
        name: &Arc<str>,
        role: Role,
        region: &Region,
        is_filled: bool,
    ) -> Vec<Layer> {
        let mut layers = Layers::default();
        for (labels, polygons) in region.by_labels() {
            for polygon in polygons {
                layers.add(labels, Item::Area(polygon));
            }
        }
        self.finish(layers, name, role, is_filled)
    }

    /// The polygons as one layer, with lines and, unless the style of `label` says otherwise, in `color`.
    pub fn painted(
        &self,
        name: &Arc<str>,
        label: &Arc<str>,
        role: Role,
        areas: &[Polygon],
        color: Option<Color>,
    ) -> Layer {
        let place = self.place(LabelSet::EMPTY, label);
        let styled = self.style(place.as_ref(), color.is_some(), role);
        let has_fill = place.as_ref().is_some_and(|look| look.style.fill.is_some());
        let style = fretwork_fabricate::Style {
            stroke: styled.stroke.or_else(|| {
                color.map(|_| Pen {
                    width: self.width(),
                    color: Color::default(),
                })
            }),
            fill: if has_fill { styled.fill } else { color },
        };
        let name = self.layer_name(place.as_ref(), name.clone());
        Layer::of_areas(name, made(role), style, areas)
    }

    /// An empty layer of lines to be engraved.
    pub fn engraved(&self, name: &Arc<str>, label: &Arc<str>) -> Layer {
        let place = self.place(LabelSet::EMPTY, label);
        let style = self.style(place.as_ref(), false, Role::Engrave);
        Layer {
            name: self.layer_name(place.as_ref(), name.clone()),
            role: fretwork_fabricate::Role::Engrave,
            style,
            items: Vec::new(),
        }
    }

    /// The bounded faces of the curves' map, filled, and the curves that bound none as lines; a layer for
    /// each set of labels.
    pub fn filled(
        &self,
        name: &Arc<str>,
        role: Role,
        curves: &Curves,
        map: &PlanarMap,
    ) -> Vec<Layer> {
        // A style of lines that all bound faces has a use where the same artifact is an outline.
        for curve in curves.iter() {
            self.see(curve.labels.edge, name);
        }
        let (mut areas, mut lines) = (Layers::default(), Layers::default());
        for face in map.bounded_faces() {
            areas.add(map.face_labels(face), Item::Area(face_polygon(map, face)));
        }
        for edge in map.edges().filter(|e| map.left(*e) == map.right(*e)) {
            let line = Item::Line(map.points(edge).collect());
            lines.add(map.labels(edge).edge, line);
        }
        let mut layers = self.finish(areas, name, role, true);
        layers.extend(self.finish(lines, name, role, false));
        layers
    }

    /// The closed paths of a drawing, filled, and its open ones as lines; a layer for each label.
    ///
    /// # Errors
    /// When areas cannot be computed.
    pub fn drawing(
        &self,
        name: &Arc<str>,
        role: Role,
        drawing: &Drawing,
    ) -> Result<Vec<Layer>, AreaError> {
        let (mut areas, mut lines) = (Layers::default(), Layers::default());
        for shape in &drawing.shapes {
            let labels = shape.label;
            let (mut closed, mut open) = (Vec::new(), Vec::new());
            for (i, path) in shape.paths.iter().enumerate() {
                let to = if shape.is_closed(i) {
                    &mut closed
                } else {
                    &mut open
                };
                to.push(path.clone());
            }
            let filled = polygon::fill(&closed, shape.rule)?;
            filled
                .into_iter()
                .for_each(|area| areas.add(labels, Item::Area(area)));
            open.into_iter()
                .for_each(|line| lines.add(labels, Item::Line(line)));
        }
        let mut layers = self.finish(areas, name, role, true);
        layers.extend(self.finish(lines, name, role, false));
        Ok(layers)
    }

    /// A layer for each set of labels; those whose styles come later are painted later, numbers in their
    /// order.
    fn finish(&self, layers: Layers, name: &Arc<str>, role: Role, is_filled: bool) -> Vec<Layer> {
        let mut placed: Vec<_> = layers
            .0
            .into_iter()
            .map(|(labels, items)| (self.place(labels, name), labels, items))
            .collect();
        placed.sort_by(|(a, a_labels, _), (b, b_labels, _)| {
            let numbers = (number(*a_labels), number(*b_labels));
            let place = |look: &Option<Look>| look.as_ref().map(|look| look.place);
            place(a).cmp(&place(b)).then_with(|| match numbers {
                (Some(a), Some(b)) => a.total_cmp(&b),
                (a, b) => a.is_some().cmp(&b.is_some()),
            })
        });
        let layer = |(look, labels, items): (Option<Look>, LabelSet, Vec<Item>)| {
            let names = labels.names().join(" ");
            let name = if names.is_empty() {
                name.clone()
            } else {
                names.into()
            };
            Layer {
                name: self.layer_name(look.as_ref(), name),
                role: made(role),
                style: self.style(look.as_ref(), is_filled, role),
                items,
            }
        };
        placed.into_iter().map(layer).collect()
    }

    /// The look of the labels in order, where a label says nothing that of the next; without one that of the node's name,
    /// else that of `*`.
    fn place(&self, labels: LabelSet, node: &str) -> Option<Look> {
        self.see(labels, node);
        let numbered = |name: &str| self.named.iter().position(|(key, _)| **key == *name);
        let mut own: Vec<usize> = labels.names().iter().filter_map(|n| numbered(n)).collect();
        if own.is_empty() {
            own.extend([node, "*"].into_iter().find_map(numbered));
        }
        let place = *own.first()?;
        let mut style = self.named[place].1.clone();
        for other in own[1..].iter().map(|number| &self.named[*number].1) {
            style.fill = style.fill.or(other.fill);
            style.stroke = style.stroke.or(other.stroke);
            style.width = style.width.or(other.width);
            style.layer = style.layer.or_else(|| other.layer.clone());
            style.pen = style.pen.or(other.pen);
        }
        Some(Look { place, style })
    }

    fn see(&self, labels: LabelSet, node: &str) {
        let mut seen = self.seen.borrow_mut();
        seen.extend(labels.names().iter().cloned());
        seen.insert(node.into());
    }

    /// The look that a style gives: where it does not say, lines in the colour of their role, and black
    /// areas if they are filled.
    fn style(
        &self,
        found: Option<&Look>,
        is_filled: bool,
        role: Role,
    ) -> fretwork_fabricate::Style {
        let style = found.map(|look| &look.style);
        let paint = |paint: Option<Paint>, default: Option<Color>| match paint {
            None => default,
            Some(Paint::None) => None,
            Some(Paint::Color(color)) => Some(Color([color.0[0], color.0[1], color.0[2]])),
        };
        let color = match role {
            Role::Cut if self.has_role_colors => Color([255, 0, 0]),
            Role::Engrave if self.has_role_colors => Color([0, 0, 255]),
            _ => Color::default(),
        };
        let line = Some(color).filter(|_| !is_filled || self.stroke.is_some());
        let width = style
            .and_then(|s| s.width)
            .map_or_else(|| self.width(), |width| width.0 / self.width_mm);
        let stroke = paint(style.and_then(|s| s.stroke), line).map(|color| Pen { width, color });
        let black = is_filled.then(Color::default);
        let fill = paint(style.and_then(|s| s.fill), black);
        fretwork_fabricate::Style { stroke, fill }
    }
}

/// Who asks for a layer, and for which pen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Asked {
    pen: Option<u32>,
    field: Field,
}

/// Where an artifact names a layer: at a part or at a style, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Field {
    Part(usize),
    Style(usize),
}

/// A look that was found.
struct Look {
    /// The number of its style in paint order; of several, of the first.
    place: usize,
    style: Style,
}

/// Items by their labels, in the order of the labels' first occurrence.
#[derive(Default)]
struct Layers(Vec<(LabelSet, Vec<Item>)>);

impl Layers {
    fn add(&mut self, labels: LabelSet, item: Item) {
        match self.0.iter_mut().find(|(l, _)| *l == labels) {
            Some((_, items)) => items.push(item),
            None => self.0.push((labels, vec![item])),
        }
    }
}

/// The number that a layer is called, if it is one.
fn number(labels: LabelSet) -> Option<f64> {
    let names = labels.names();
    match &names[..] {
        [name] => name.parse().ok().filter(|number: &f64| number.is_finite()),
        _ => None,
    }
}

/// What a machine does with a part.
fn made(role: Role) -> fretwork_fabricate::Role {
    match role {
        Role::Cut => fretwork_fabricate::Role::Cut,
        Role::Engrave => fretwork_fabricate::Role::Engrave,
        Role::Draw => fretwork_fabricate::Role::Draw,
    }
}

/// The area of a bounded face: its outer boundary, and its holes, without the edges that dangle in
/// it.
pub(crate) fn face_polygon(map: &PlanarMap, face: FaceId) -> Polygon {
    let ring = |cycle: &mut dyn Iterator<Item = fretwork_geometry::HalfEdge>| -> Ring {
        let sides = cycle.filter(|h| map.face(h.twin()) != face);
        let points = sides.flat_map(|h| {
            let mut points = map.half_edge_points(h);
            points.pop();
            points
        });
        points.collect()
    };
    let holes = map
        .inner_boundaries(face)
        .map(|mut cycle| ring(&mut cycle))
        .filter(|hole| hole.len() > 2)
        .collect();
    Polygon {
        outer: ring(&mut map.outer_boundary(face)),
        holes,
    }
}
