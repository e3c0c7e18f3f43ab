//! How far from a cell lies what `place` and `transform` put there, from their definitions.

use std::sync::Arc;

use crate::near::locality::Spread;
use fretwork_geometry::{Curves, Point};
use fretwork_language::kinds::arrangements::{Cells, ExtendedCells, FacePoint, Place, Transform};
use fretwork_language::placement::PlaneRepeat;

/// An inset outline that moves outward goes no farther than so many times its distance at corners.
const MITER: f64 = 4.0;

/// How far from a cell elements lie. None where an element has no points to be put by.
pub(crate) fn of_elements(kind: &Place, elements: &[Arc<Curves>]) -> Option<Spread> {
    let factor = kind.scale.low.0.abs().max(kind.scale.high.0.abs());
    match kind.cells {
        Cells::Edges(_) => {
            let shares = elements.iter().map(|element| share_of_edge(kind, element));
            let share = shares
                .reduce(|a, b| Some(a?.max(b?)))
                .unwrap_or(Some(0.0))?;
            // What is turned or scaled moves about the middle of its box, which is no farther from the start of the edge than its
            // points are; these are no farther from it than half the diagonal of the box.
            let is_moved = factor != 1.0 || kind.scale.low != kind.scale.high || is_turned(kind);
            let most = if is_moved { 1.0 + 1.5 * factor } else { 1.0 };
            Some(Spread {
                share: share * most,
                ..Spread::default()
            })
        }
        Cells::Faces(_) if kind.fit => {
            // A fitted element lies in a circle in the face about its centroid.
            let moved = if kind.at == FacePoint::Center {
                1.0
            } else {
                0.0
            };
            Some(Spread {
                share: moved + (factor - 1.0).max(0.0),
                ..Spread::default()
            })
        }
        Cells::Vertices(_) | Cells::Faces(_) => {
            let radii = elements.iter().map(|element| radius(element));
            Some(Spread {
                length: factor * radii.fold(0.0, f64::max),
                ..Spread::default()
            })
        }
    }
}

fn is_turned(kind: &Place) -> bool {
    kind.rotate.low.0 != 0.0 || kind.rotate.high.0 != 0.0
}

/// How far points of an element are from the middle of its box.
fn radius(element: &Curves) -> f64 {
    let center = element.bounds().center();
    let distances = element.points().iter().map(|p| p.distance(center));
    distances.fold(0.0, f64::max)
}

/// How far points of an element are from the point that is put at the start of an edge, in parts of the distance to the one
/// that is put at its end.
fn share_of_edge(kind: &Place, element: &Curves) -> Option<f64> {
    let named = |name: &Option<_>, default: &str| {
        let name: &Option<fretwork_language::scalar::Text> = name;
        element.point_named(name.as_ref().map_or(default, |text| &*text.0))
    };
    let (from, to): (Point, Point) = (named(&kind.from, "start")?, named(&kind.to, "end")?);
    let base = from.distance(to);
    let distances = element.points().iter().map(|p| p.distance(from));
    let farthest = distances.fold(base, f64::max);
    Some(if base > 0.0 { farthest / base } else { 0.0 })
}

/// How far from a cell lies what it is transformed to.
pub(crate) fn of_transform(kind: &Transform) -> Spread {
    let [x, y] = kind.scale.0.map(f64::abs);
    let factor = x.max(y);
    let is_edge = matches!(kind.cells, ExtendedCells::Edges(_));
    let outward = if is_edge {
        0.0
    } else {
        (-kind.inset.0).max(0.0)
    };
    let [right, up] = kind.at.0;
    let copies = kind
        .repeat
        .as_ref()
        .map(|PlaneRepeat(repeat)| repeat.copies());
    let steps = copies.into_iter().flatten();
    let farthest = steps.map(|(_, [x, y, _])| Point::new(x, y).length());
    let moved = Point::new(right, up).length() + farthest.fold(0.0, f64::max);
    let keeps_box = kind.rotate.0 == 0.0 && kind.repeat.is_none() && factor <= 1.0;
    Spread {
        length: moved + 2.0 * MITER * outward * (1.0 + factor),
        share: if keeps_box { 0.0 } else { factor / 2.0 },
        is_inside: false,
    }
}
