//! What an artifact shows as features on the ground: points, lines and areas with their labels, for GeoJSON. Looks
//! play no part here.

use std::sync::Arc;

use super::fault::Fault;
use super::page::Page;
use super::ready::Ready;
use super::sheet::Part;
use super::style::face_polygon;
use super::united::united;
use fretwork_action::{Data, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::format::geojson::{Feature, Shape};
use fretwork_fabricate::{Item, Layer, Role, Sheet, Style};
use fretwork_geometry::{Affine, Attribute, Curves, Field, LabelSet, Point, Region};
use fretwork_geometry::{cutout, polygon};
use fretwork_language::kinds::artifacts::Draw;
use serde_json::{Map, Value as Json, json};

/// Features that were made ready, of which windows are cut.
pub struct ReadyGround {
    ready: Ready,
    /// The properties of each layer's features, by the number that is its name.
    properties: Vec<Map<String, Json>>,
    /// Points, each with the number of its properties.
    points: Vec<(Point, usize)>,
}

/// The features that show `parts` in the coordinates of the map, no segment of a line twice, before a window is cut of them.
///
/// # Errors
/// When a part has no place on the ground, or areas cannot be computed.
pub fn ready_ground(parts: &[Part<'_>], page: &Page<'_>) -> Result<ReadyGround, Fault> {
    let mut shapes = Shapes::default();
    for part in parts {
        for map in &part.maps {
            shapes.add(part, map, page)?;
        }
    }
    let whole = Sheet {
        page: page.region.as_ref().map(|region| region.bounds()),
        unit_mm: 1.0,
        layers: shapes.layers,
    };
    // What is near a window was drawn, perhaps nothing.
    match page.window {
        None if shapes.points.is_empty() => whole.check()?,
        _ => whole.check_numbers()?,
    }
    let clip = page.region.as_ref().filter(|_| page.artifact.clip);
    if let Some(region) = clip {
        let is_in = |at: Point| region.area.iter().any(|area| area.holds(at));
        shapes.points.retain(|(at, _)| is_in(*at));
    }
    let ready = Ready::new(whole, page, clip.map(|region| &region.area[..]), false)?;
    Ok(ReadyGround {
        ready,
        properties: shapes.properties,
        points: shapes.points,
    })
}

impl ReadyGround {
    /// What of it comes near the window of `page`.
    pub fn near(&self, page: &Page<'_>) -> ReadyGround {
        ReadyGround {
            ready: self.ready.near(page),
            properties: self.properties.clone(),
            points: self.points.clone(),
        }
    }

    /// What of it lies in the window of `page`, and warnings.
    ///
    /// # Errors
    /// When what a closed line fills cannot be computed.
    pub fn features(self, page: &Page<'_>) -> Result<(Vec<Feature>, Vec<Diagnostic>), Fault> {
        let mut points = self.points;
        points.retain(|(at, _)| self.ready.holds(*at, page));
        let points = points.into_iter().map(|(at, number)| Feature {
            shape: Shape::Point(at),
            properties: self.properties[number].clone(),
        });
        let (sheet, warnings) = self.ready.cut(page)?;
        let features = sheet.layers.into_iter().flat_map(|layer| {
            let number: Option<usize> = layer.name.parse().ok();
            let known = number.and_then(|number| self.properties.get(number));
            let properties = known.cloned().unwrap_or_default();
            layer.items.into_iter().map(move |shape| Feature {
                shape: Shape::Item(shape),
                properties: properties.clone(),
            })
        });
        Ok((points.chain(features).collect(), warnings))
    }
}

/// Layers of which each has the number of its properties for a name.
#[derive(Default)]
struct Shapes {
    layers: Vec<Layer>,
    properties: Vec<Map<String, Json>>,
    points: Vec<(Point, usize)>,
    /// The node, the labels and whether it is filled, of layers that may be added to, with their numbers.
    keys: Vec<((Arc<str>, LabelSet, bool), usize)>,
}

impl Shapes {
    fn add(&mut self, part: &Part<'_>, map: &Affine, page: &Page<'_>) -> Result<(), Diagnostic> {
        let is_filled = page.artifact.draw == Some(Draw::Filled);
        let name = &part.name;
        let Value::Data(data) = part.value else {
            return Err(placeless(name));
        };
        match data {
            Data::Region(region) if !region.features.is_empty() => self.points(name, region, map),
            Data::Curves(curves) => self.lone(name, curves, map),
            Data::Region(region) => self.lone(name, &region.contour, map),
            _ => {}
        }
        match data {
            Data::Curves(curves) if is_filled => self.faces(name, &curves.transformed(map), page),
            Data::Curves(curves) => self.lines(name, &page.near(curves, map), page),
            Data::Region(region) if is_filled && !region.features.is_empty() => {
                self.table(name, &region.transformed(map), page)
            }
            Data::Region(region) => {
                let region = region.transformed(map);
                if is_filled {
                    for area in region.area {
                        self.push(name, LabelSet::EMPTY, true, Item::Area(area));
                    }
                    return Ok(());
                }
                self.lines(name, &region.contour, page)
            }
            Data::Drawing(drawing) => {
                let curves = drawing.transformed(map).curves();
                if is_filled {
                    return self.faces(name, &curves, page);
                }
                self.lines(name, &curves, page)
            }
            Data::Cutout(cutout) => {
                let is_area = page.artifact.draw != Some(Draw::Outline);
                for area in cutout::mapped(&cutout.flat(), |p| map.apply(p)) {
                    self.push(name, LabelSet::EMPTY, is_area, Item::Area(area));
                }
                Ok(())
            }
            _ => Err(placeless(name)),
        }
    }

    fn lines(
        &mut self,
        name: &Arc<str>,
        curves: &Curves,
        page: &Page<'_>,
    ) -> Result<(), Diagnostic> {
        for curve in united(curves, page)?.iter() {
            let line = Item::Line(curve.points.to_vec());
            self.push(name, curve.labels.edge, false, line);
        }
        Ok(())
    }

    /// The points of a map's features, each with its labels and what the table says of it.
    fn points(&mut self, name: &Arc<str>, region: &Region, map: &Affine) {
        for feature in region.features.iter().filter(|f| !f.points.is_empty()) {
            let number = self.layer(name, feature.labels, false);
            self.tell(number, region, feature);
            let places = feature.points.iter().map(|p| (map.apply(*p), number));
            self.points.extend(places);
        }
    }

    /// Points that stand alone, with their labels.
    fn lone(&mut self, name: &Arc<str>, curves: &Curves, map: &Affine) {
        for (at, labels) in curves.lone() {
            let number = self.numbered(name, *labels, false);
            self.points.push((map.apply(*at), number));
        }
    }

    /// Adds what the table says of a feature to the properties of a layer.
    fn tell(&mut self, layer: usize, region: &Region, feature: &fretwork_geometry::Feature) {
        for column in &region.columns {
            let own = self.properties[layer].entry(&**column);
            own.or_insert_with(|| table_value(feature.attribute(column)));
        }
    }

    /// The bounded faces, and as lines what bounds none.
    fn faces(
        &mut self,
        name: &Arc<str>,
        curves: &Curves,
        page: &Page<'_>,
    ) -> Result<(), Diagnostic> {
        let map = page.planar_map(curves)?;
        for face in map.bounded_faces() {
            let area = Item::Area(face_polygon(&map, face));
            self.push(name, map.face_labels(face), true, area);
        }
        for edge in map.edges().filter(|e| map.left(*e) == map.right(*e)) {
            let line = Item::Line(map.points(edge).collect());
            self.push(name, map.labels(edge).edge, false, line);
        }
        Ok(())
    }

    /// The faces of a map, each with what the table says of the first feature that covers it.
    fn table(
        &mut self,
        name: &Arc<str>,
        region: &Region,
        page: &Page<'_>,
    ) -> Result<(), Diagnostic> {
        let map = page.planar_map(&region.contour)?;
        let numbered = region.features.iter().enumerate();
        let numbered = numbered.filter(|(_, feature)| !feature.area.is_empty());
        let numbers = numbered.map(|(number, feature)| (feature.area.clone(), number as f64));
        let covering = Field::per_face(numbers.collect());
        for face in map.bounded_faces() {
            let area = face_polygon(&map, face);
            let inside = polygon::inner_point(std::slice::from_ref(&area));
            let found = covering.value(inside);
            if found.is_nan() {
                continue;
            }
            let layer = self.layer(name, map.face_labels(face), true);
            self.tell(layer, region, &region.features[found as usize]);
            self.layers[layer].items.push(Item::Area(area));
        }
        Ok(())
    }

    fn push(&mut self, name: &Arc<str>, labels: LabelSet, is_filled: bool, item: Item) {
        let number = self.numbered(name, labels, is_filled);
        self.layers[number].items.push(item);
    }

    /// The number of the layer for this, a new one if there is none.
    fn numbered(&mut self, name: &Arc<str>, labels: LabelSet, is_filled: bool) -> usize {
        let key = (name.clone(), labels, is_filled);
        let known = self.keys.iter().find(|(known, _)| *known == key);
        if let Some((_, number)) = known {
            return *number;
        }
        let number = self.layer(name, labels, is_filled);
        self.keys.push((key, number));
        number
    }

    /// A new layer; gives its number.
    fn layer(&mut self, name: &Arc<str>, labels: LabelSet, is_filled: bool) -> usize {
        let number = self.layers.len();
        let style = if is_filled {
            Style::filled(Default::default())
        } else {
            Style::outline(1.0)
        };
        self.layers.push(Layer {
            name: number.to_string().into(),
            role: Role::Draw,
            style,
            items: Vec::new(),
        });
        let names: Vec<Arc<str>> = labels.names().to_vec();
        let properties =
            json!({ "labels": names.iter().map(|n| &**n).collect::<Vec<_>>(), "node": &**name });
        self.properties
            .push(properties.as_object().cloned().unwrap_or_default());
        number
    }
}

/// A value of a table as it is written; nothing is `null`, so that all features have the same properties.
pub fn table_value(value: Option<&Attribute>) -> Json {
    match value {
        None => Json::Null,
        Some(Attribute::Whole(number)) => json!(number),
        Some(Attribute::Number(number)) => json!(number),
        Some(Attribute::Truth(truth)) => json!(truth),
        Some(Attribute::Text(text)) => json!(&**text),
        Some(Attribute::Nested { json, .. }) => {
            serde_json::from_str(json).unwrap_or_else(|_| json!(&**json))
        }
    }
}

fn placeless(name: &str) -> Diagnostic {
    Diagnostic::error(format!("`{name}` has no place on the ground"))
}
