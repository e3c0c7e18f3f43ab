//! Elements put at cells as a spec declares it: the usual mappers without a script.

use std::sync::Arc;

use crate::cells::Cell;
use crate::error::ArrangementError;
use crate::place::similarity::{match_face, match_point, match_points, rotate, scale};
use fretwork_geometry::planar_map::{EdgeId, PlanarMap};
use fretwork_geometry::{Affine, Curves, LabelSet, Point, Seed, Snap};
use fretwork_language::kinds::arrangements::{Cells, FacePoint, Place};
use fretwork_language::scalar::Label;

/// The random values of a cell, by what they decide.
const CHANCE: u64 = 0;
const ELEMENT: u64 = 1;
const ROTATE: u64 = 2;
const SCALE: u64 = 3;
const FLIP: u64 = 4;

/// A copy of one of `elements` at every cell of `map` that `kind` speaks of; what is drawn at random
/// depends on `seed` and the place of the cell, rounded by `snap`.
///
/// On a vertex or a face the centre of the element's box is put at the vertex or at the point
/// `kind.at` of the face. On an edge two points of the element are put at its ends, by default
/// those named `start` and `end`, and the element may be mirrored at the line between them. Then it
/// is scaled and turned about the centre of its box.
///
/// # Errors
/// When an element for edges does not have the points.
pub fn place(
    map: &PlanarMap,
    kind: &Place,
    elements: &[Arc<Curves>],
    seed: Seed,
    snap: Snap,
) -> Result<Curves, ArrangementError> {
    let cells: Vec<Cell> = match kind.cells {
        Cells::Vertices(_) => map.vertices().map(Cell::Vertex).collect(),
        Cells::Edges(_) => map.edges().map(Cell::Edge).collect(),
        Cells::Faces(_) => map.bounded_faces().map(Cell::Face).collect(),
    };
    let random = (seed, snap);
    place_at(map, kind, elements, random, &cells)
}

/// The same at some of the cells.
///
/// # Errors
/// Those of [`place`].
pub(crate) fn place_at(
    map: &PlanarMap,
    kind: &Place,
    elements: &[Arc<Curves>],
    (seed, snap): (Seed, Snap),
    cells: &[Cell],
) -> Result<Curves, ArrangementError> {
    let mut placed = Curves::new();
    for &cell in cells {
        let drawn = |n| cell.random(map, seed, snap, n);
        let is_chosen = kind
            .r#where
            .as_ref()
            .is_none_or(|labels| has_any(labels_of(map, cell), &labels.0));
        if elements.is_empty() || !is_chosen || drawn(CHANCE) >= kind.chance.0 {
            continue;
        }
        let element = &elements[(drawn(ELEMENT) * elements.len() as f64) as usize];
        let put = match cell {
            Cell::Edge(e) => at_edge(map, e, kind, element, drawn(FLIP) < kind.flip.0)?,
            Cell::Vertex(v) => match_point(element, element.bounds().center(), map.location(v)),
            Cell::Face(f) => {
                let at = match kind.at {
                    FacePoint::Centroid => map.centroid(f),
                    FacePoint::Center => cell.bounds(map).center(),
                };
                let fitted = if kind.fit {
                    match_face(element, map, f)
                } else {
                    Curves::clone(element)
                };
                match_point(&fitted, fitted.bounds().center(), at)
            }
        };
        let between = |n, low: f64, high: f64| low + (high - low) * drawn(n);
        let factor = between(SCALE, kind.scale.low.0, kind.scale.high.0);
        let angle = between(ROTATE, kind.rotate.low.0, kind.rotate.high.0);
        let put = if factor == 1.0 {
            put
        } else {
            scale(&put, factor)
        };
        placed.append(&if angle == 0.0 {
            put
        } else {
            rotate(&put, angle)
        });
    }
    Ok(placed)
}

/// Whether more than the cell decides on what is put there.
pub(crate) fn is_random(kind: &Place, elements: usize) -> bool {
    elements > 1
        || kind.chance.0 < 1.0
        || kind.scale.low.0 != kind.scale.high.0
        || kind.rotate.low.0 != kind.rotate.high.0
        || kind.flip.0 > 0.0 && kind.flip.0 < 1.0
}

fn at_edge(
    map: &PlanarMap,
    e: EdgeId,
    kind: &Place,
    element: &Curves,
    is_flipped: bool,
) -> Result<Curves, ArrangementError> {
    let point = |name: Option<&str>, default: &str| {
        let name = name.unwrap_or(default);
        element
            .point_named(name)
            .ok_or_else(|| ArrangementError::NoPoint {
                name: name.to_owned(),
                known: element
                    .named_points()
                    .iter()
                    .map(|(name, _)| name.to_string())
                    .collect(),
            })
    };
    let from = point(kind.from.as_ref().map(|t| &*t.0), "start")?;
    let to = point(kind.to.as_ref().map(|t| &*t.0), "end")?;
    let ends = [map.location(map.source(e)), map.location(map.target(e))];
    if is_flipped {
        return Ok(match_points(&mirrored(element, from, to), [from, to], ends));
    }
    Ok(match_points(element, [from, to], ends))
}

/// The mirror image at the line through two points.
fn mirrored(curves: &Curves, a: Point, b: Point) -> Curves {
    let d = b - a;
    let (cosine, sine) = (
        (d.x * d.x - d.y * d.y) / d.dot(d),
        2.0 * d.x * d.y / d.dot(d),
    );
    if !(cosine.is_finite() && sine.is_finite()) {
        return curves.clone();
    }
    curves.transformed(&Affine([cosine, sine, sine, -cosine, 0.0, 0.0]).about(a))
}

fn labels_of(map: &PlanarMap, cell: Cell) -> LabelSet {
    match cell {
        Cell::Vertex(v) => map.vertex_labels(v),
        Cell::Edge(e) => map.labels(e).edge,
        Cell::Face(f) => map.face_labels(f),
    }
}

pub(crate) fn has_any(labels: LabelSet, wanted: &[Label]) -> bool {
    wanted.iter().any(|label| labels.contains(&label.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::planar_map::resolution;
    use fretwork_geometry::{CurveLabels, Region};
    use fretwork_language::Ref;
    use fretwork_language::scalar::{Angle, Fraction, Scale, Text};
    use fretwork_language::value::{OneOrMany, Range};

    fn kind(cells: Cells) -> Place {
        let same = |v| Range { low: v, high: v };
        Place {
            element: OneOrMany(vec![]),
            r#where: None,
            chance: Fraction(1.0),
            from: None,
            to: None,
            flip: Fraction(0.0),
            at: FacePoint::Centroid,
            rotate: Range {
                low: Angle(0.0),
                high: Angle(0.0),
            },
            scale: same(Scale(1.0)),
            fit: false,
            cells,
        }
    }

    /// A hook of three points from (0, 0) to (2, 0) by (1, 1).
    fn hook() -> Arc<Curves> {
        let mut hook = Curves::new();
        let points = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]].map(Point::from);
        hook.push(points, CurveLabels::edge(LabelSet::one("hook")));
        hook.name_point("start", points[0]);
        hook.name_point("end", points[2]);
        Arc::new(hook)
    }

    fn square() -> PlanarMap {
        let region =
            Region::rectangle(Point::ORIGIN, Point::new(8.0, 8.0)).labelled(LabelSet::one("page"));
        PlanarMap::build(&region.contour, resolution(8.0)).unwrap()
    }

    fn at(kind: &Place) -> Result<Curves, ArrangementError> {
        place(
            &square(),
            kind,
            &[hook()],
            Seed::root(1),
            Snap::of(&Region::rectangle(Point::ORIGIN, Point::new(8.0, 8.0))),
        )
    }

    #[test]
    fn elements_replace_edges_on_either_side() {
        let mut edges = kind(Cells::Edges(Ref::new("page")));
        let straight = at(&edges).unwrap();
        assert_eq!((straight.len(), straight.bounds().min), (4, Point::ORIGIN));
        edges.flip = Fraction(1.0);
        let flipped = at(&edges).unwrap();
        assert_eq!(flipped.bounds().min, Point::new(-4.0, -4.0));
        edges.to = Some(Text("tip".into()));
        let Err(ArrangementError::NoPoint { name, known }) = at(&edges) else {
            panic!("no tip")
        };
        assert_eq!((name.as_str(), known.len()), ("tip", 2));
    }

    #[test]
    fn elements_are_put_into_chosen_faces_and_on_vertices() {
        let mut faces = kind(Cells::Faces(Ref::new("page")));
        assert_eq!(at(&faces).unwrap().bounds().center(), Point::new(4.0, 4.0));
        faces.fit = true;
        faces.scale = Range {
            low: Scale(0.5),
            high: Scale(0.5),
        };
        let radius = at(&faces).unwrap().bounds().width() / 2.0;
        assert!(
            radius > 1.0 && radius < 2.0,
            "half of the circle of radius 4, whose box is smaller: {radius}"
        );
        faces.r#where = Some(OneOrMany(vec![Label("other".into())]));
        assert!(at(&faces).unwrap().is_empty());
        let mut vertices = kind(Cells::Vertices(Ref::new("page")));
        assert_eq!(at(&vertices).unwrap().len(), 4);
        vertices.chance = Fraction(0.0);
        assert!(at(&vertices).unwrap().is_empty());
    }
}
