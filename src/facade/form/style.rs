//! Which of a facade's shapes stands in a cell. What the shapes look like has no part in it.

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

/// A name without its section.
fn bare(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(_, bare)| bare)
}

#[cfg(test)]
mod tests {
    use fretwork_language::kinds::facades::{Body, CellBox};
    use fretwork_language::scalar::{Length, PositiveLength};

    use super::*;

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
