//! Which of a facade's shapes stands in a cell. What the shapes look like has no part in it.

use std::collections::BTreeSet;

use crate::axis::Axis;
use crate::description::Description;
use crate::pattern::prepare::Prepared;
use fretwork_language::kinds::facades::{Shape, ShapeKey, Shapes};

/// The number of the shape that stands in the cells of two symbols in a layer. Keys for the layer come
/// before general ones, and among these `XY` before `X*` before `*Y` before `*`.
pub fn shape(shapes: &Shapes, layer: &str, x: char, y: char) -> Option<usize> {
    let fits = shapes.0.iter().enumerate().filter(|(_, (key, _))| {
        key.layer
            .as_ref()
            .is_none_or(|name| bare(&name.name) == layer)
            && key.x.is_none_or(|letter| letter.0 == x)
            && key.y.is_none_or(|letter| letter.0 == y)
    });
    let rank = |(_, (key, _)): &(usize, &(ShapeKey, Shape))| {
        (key.layer.is_some(), key.x.is_some(), key.y.is_some())
    };
    fits.max_by_key(rank).map(|(number, _)| number)
}

/// The numbers of the shapes that stand in no cell, whatever the layout is. None if the description has
/// mistakes.
pub fn idle_shapes(description: &Description, shapes: &Shapes) -> Vec<usize> {
    let Ok((prepared, _)) = Prepared::new(description) else {
        return Vec::new();
    };
    let mut used = BTreeSet::new();
    for (number, layer) in description.layers.iter().rev().enumerate() {
        let drawn = |axis: Axis| {
            let letters = prepared.patterns[axis][number].solid_letters();
            let mask = layer.visible[axis].clone();
            letters
                .into_iter()
                .filter(move |c| mask.as_ref().is_none_or(|mask| mask.contains(c)))
        };
        for x in drawn(Axis::X) {
            used.extend(drawn(Axis::Y).filter_map(|y| shape(shapes, &layer.name, x, y)));
        }
    }
    (0..shapes.0.len()).filter(|n| !used.contains(n)).collect()
}

/// A name without its section.
fn bare(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(_, bare)| bare)
}

#[cfg(test)]
mod tests {
    use fretwork_language::kinds::facades::{Body, CellBox};
    use fretwork_language::scalar::{Length, PositiveLength};

    use super::*;

    fn plane(key: &str) -> (ShapeKey, Shape) {
        let shape = Shape {
            offset: Length(0.0),
            material: None,
            fill: None,
            body: Body::Box(CellBox {
                depth: PositiveLength(1.0),
            }),
        };
        (ShapeKey::of(key).expect("a key"), shape)
    }

    #[test]
    fn shapes_that_no_cell_can_hold_are_idle() {
        let sketch = crate::tests::Sketch::new(4.0)
            .symbols(&["A 1 opaque", "B 1 opaque", "C 1 opaque"])
            .layer("base", "A|B")
            .layer("top", "A");
        let keys = ["AP", "BP", "C*", "top.BP", "top.AP", "PA"];
        let shapes = Shapes(keys.iter().map(|key| plane(key)).collect());
        assert_eq!(idle_shapes(&sketch.0, &shapes), [2, 3, 5]);
    }

    #[test]
    fn the_most_specific_key_wins() {
        let keys = [
            "*", "*P", "A*", "AP", "base.*", "base.*P", "base.A*", "base.AP",
        ];
        let of = |taken: usize, layer: &str, x: char, y: char| {
            let mut all: Vec<(ShapeKey, Shape)> = Vec::new();
            for (number, key) in keys.iter().enumerate().take(taken) {
                let body = Body::Box(CellBox {
                    depth: PositiveLength(1.0),
                });
                let shape = Shape {
                    offset: Length(number as f64),
                    material: None,
                    fill: None,
                    body,
                };
                all.push((ShapeKey::of(key).expect("a key"), shape));
            }
            shape(&Shapes(all), layer, x, y).map(|number| keys[number])
        };
        for taken in 1..=keys.len() {
            assert_eq!(of(taken, "base", 'A', 'P'), Some(keys[taken - 1]));
        }
        assert_eq!(of(0, "base", 'A', 'P'), None);
        assert_eq!(of(8, "pillars", 'A', 'P'), Some("AP"));
        assert_eq!(of(8, "pillars", 'C', 'Q'), Some("*"));
        assert_eq!(of(8, "base", 'C', 'Q'), Some("base.*"));
    }
}
