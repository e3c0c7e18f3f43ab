//! One layer for what has one name.

use super::layer::{Layer, Sheet};

/// The sheet with layers of one name, role and look in one, at the place of the first. A filled
/// layer stays where it is when something filled that it may paint over lies between.
pub fn united(sheet: &Sheet) -> Sheet {
    let mut layers: Vec<Layer> = Vec::with_capacity(sheet.layers.len());
    for layer in &sheet.layers {
        let is_same = |other: &Layer| {
            (&other.name, other.role, other.style) == (&layer.name, layer.role, layer.style)
        };
        let first = layers.iter().position(is_same);
        match first.filter(|&first| !is_covered(layer, &layers[first + 1..])) {
            Some(first) => layers[first].items.extend(layer.items.iter().cloned()),
            None => layers.push(layer.clone()),
        }
    }
    sheet.with(layers)
}

/// Whether one of the layers that are painted later would hide something of a filled layer.
fn is_covered(layer: &Layer, later: &[Layer]) -> bool {
    let bounds = layer.bounds();
    let mut filled = later.iter().filter(|later| later.style.fill.is_some());
    layer.style.fill.is_some() && filled.any(|later| later.bounds().intersects(&bounds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Color, Item, Role, Style};
    use fretwork_geometry::Point;

    fn layer(name: &str, style: Style, x: f64) -> Layer {
        let ring = [[x, 0.0], [x + 1.0, 0.0], [x, 1.0], [x, 0.0]].map(Point::from);
        Layer {
            name: name.into(),
            role: Role::Cut,
            style,
            items: vec![Item::Line(ring.to_vec())],
        }
    }

    fn names(layers: Vec<Layer>) -> Vec<String> {
        let sheet = Sheet {
            page: None,
            unit_mm: 1.0,
            layers,
        };
        let of = |layer: &Layer| format!("{} {}", layer.name, layer.items.len());
        united(&sheet).layers.iter().map(of).collect()
    }

    #[test]
    fn a_label_is_one_layer() {
        let line = Style::outline(0.1);
        let (a, b) = (layer("a", line, 0.0), layer("b", line, 0.0));
        assert_eq!(names(vec![a.clone(), b.clone(), a.clone()]), ["a 2", "b 1"]);
        let engraved = Layer {
            role: Role::Engrave,
            ..a.clone()
        };
        assert_eq!(names(vec![a, engraved]), ["a 1", "a 1"]);
    }

    #[test]
    fn paint_stays_over_what_it_was_over() {
        let fill = Style::filled(Color::default());
        let (a, b) = (layer("a", fill, 0.0), layer("b", fill, 0.5));
        assert_eq!(
            names(vec![a.clone(), b.clone(), a.clone()]),
            ["a 1", "b 1", "a 1"]
        );
        let apart = layer("a", fill, 5.0);
        assert_eq!(names(vec![a, b, apart]), ["a 2", "b 1"]);
    }
}
