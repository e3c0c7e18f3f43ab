//! How labelled curves and areas look on a sheet.

use std::sync::Arc;

use fretwork_fabricate::{Color, Item, Layer, Pen};
use fretwork_geometry::{Curves, FaceId, LabelSet, PlanarMap, Polygon, Ring};
use fretwork_language::kinds::artifacts::{Artifact, Paint, Role, Style};

/// Colours of faces without a style: light, so that lines show on them.
const FILL: Color = Color([0xd8, 0xd8, 0xd8]);

/// The styles of an artifact.
pub struct Looks<'a> {
    /// In paint order.
    styles: &'a [(Arc<str>, Style)],
    width: f64,
    has_stroke: bool,
}

impl<'a> Looks<'a> {
    /// The looks of `artifact`; lines are `width` wide (millimetres) where it does not say.
    pub fn new(artifact: &'a Artifact, width: f64) -> Looks<'a> {
        Looks {
            styles: &artifact.style,
            width: artifact.stroke.map_or(width, |stroke| stroke.0),
            has_stroke: artifact.stroke.is_some(),
        }
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
        let style = self.style(self.place(LabelSet::EMPTY, name), is_filled);
        vec![Layer::of_areas(name.clone(), made(role), style, areas)]
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
        let styled = self.style(place, color.is_some());
        let has_fill = place.is_some_and(|place| self.styles[place].1.fill.is_some());
        let style = fretwork_fabricate::Style {
            stroke: styled.stroke.or_else(|| {
                color.map(|_| Pen {
                    width: self.width,
                    color: Color::default(),
                })
            }),
            fill: if has_fill { styled.fill } else { color },
        };
        Layer::of_areas(name.clone(), made(role), style, areas)
    }

    /// An empty layer of lines to be engraved.
    pub fn engraved(&self, name: &Arc<str>, label: &Arc<str>) -> Layer {
        let style = self.style(self.place(LabelSet::EMPTY, label), false);
        Layer {
            name: name.clone(),
            role: fretwork_fabricate::Role::Engrave,
            style,
            items: Vec::new(),
        }
    }

    /// The bounded faces of `map`, a layer for each set of labels.
    pub fn faces(&self, name: &Arc<str>, map: &PlanarMap) -> Vec<Layer> {
        let mut layers = Layers::default();
        for face in map.bounded_faces() {
            layers.add(map.face_labels(face), Item::Area(face_polygon(map, face)));
        }
        self.finish(layers, name, Role::Draw, true)
    }

    /// A layer for each set of labels; those whose styles come later are painted later.
    fn finish(&self, layers: Layers, name: &Arc<str>, role: Role, is_filled: bool) -> Vec<Layer> {
        let mut placed: Vec<_> = layers
            .0
            .into_iter()
            .map(|(labels, items)| (self.place(labels, name), labels, items))
            .collect();
        placed.sort_by_key(|(place, ..)| *place);
        let layer = |(place, labels, items): (Option<usize>, LabelSet, Vec<Item>)| {
            let names = labels.names().join(" ");
            let name = if names.is_empty() {
                name.clone()
            } else {
                names.into()
            };
            Layer {
                name,
                role: made(role),
                style: self.style(place, is_filled),
                items,
            }
        };
        placed.into_iter().map(layer).collect()
    }

    /// The number of the first style of the labels in order, else that of the node's name, else that of `*`.
    fn place(&self, labels: LabelSet, node: &str) -> Option<usize> {
        let names = labels.names();
        let mut known = names.iter().map(|name| &**name).chain([node, "*"]);
        known.find_map(|name| self.styles.iter().position(|(key, _)| **key == *name))
    }

    /// The look that a style gives; without one, black lines.
    fn style(&self, place: Option<usize>, is_filled: bool) -> fretwork_fabricate::Style {
        let style = place.map(|place| &self.styles[place].1);
        let paint = |paint: Option<Paint>, default: Option<Color>| match paint {
            None => default,
            Some(Paint::None) => None,
            Some(Paint::Color(color)) => Some(Color([color.0[0], color.0[1], color.0[2]])),
        };
        let black = Some(Color::default()).filter(|_| !is_filled || self.has_stroke);
        let width = style
            .and_then(|s| s.width)
            .map_or(self.width, |width| width.0);
        let stroke = paint(style.and_then(|s| s.stroke), black).map(|color| Pen { width, color });
        let fill = paint(style.and_then(|s| s.fill), is_filled.then_some(FILL));
        fretwork_fabricate::Style {
            stroke,
            fill: fill.filter(|_| is_filled || stroke.is_none()),
        }
    }
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
fn face_polygon(map: &PlanarMap, face: FaceId) -> Polygon {
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
