//! The words `scale`, `mirror`, `rotate`, `at`, `repeat` as affine maps, in this order.

use crate::geometry::{Affine, Point};
use crate::spec::placement::{PlaneAxis, PlanePlacement, Repeat, SpaceAxis, SpacePlacement, Turn};

/// The maps of a placement: one, or one per copy of `repeat`.
pub fn maps(placement: &PlanePlacement) -> Vec<Affine> {
    let [x, y] = placement.scale.0;
    let [ax, ay] = placement.at.0;
    let first = Affine::scale(x, y)
        .then(mirror(placement.mirror))
        .then(Affine::rotation(placement.rotate.0))
        .then(Affine::translation(Point::new(ax, ay)));
    match &placement.repeat {
        None => vec![first],
        Some(repeat) => copies(repeat).into_iter().map(|copy| first.then(copy)).collect(),
    }
}

/// The maps of a place in space, as they are seen from above: a turn about the z axis, no z.
pub fn plane_maps(placement: &SpacePlacement) -> Vec<Affine> {
    let [x, y, _] = placement.scale.0;
    let [ax, ay, _] = placement.at.0;
    let mirror = match placement.mirror {
        Some(SpaceAxis::X) => Affine::scale(-1.0, 1.0),
        Some(SpaceAxis::Y) => Affine::scale(1.0, -1.0),
        Some(SpaceAxis::Z) | None => Affine::IDENTITY,
    };
    let first = Affine::scale(x, y)
        .then(mirror)
        .then(Affine::rotation(placement.rotate.0[2]))
        .then(Affine::translation(Point::new(ax, ay)));
    placement.repeat.as_ref().map_or(vec![first], |repeat| copies(repeat).into_iter().map(|c| first.then(c)).collect())
}

/// The maps from the first copy to each.
fn copies(repeat: &Repeat) -> Vec<Affine> {
    let moved = |x: f64, y: f64| Affine::translation(Point::new(x, y));
    match repeat {
        Repeat::Turn { count, angle } => (0..*count).map(|i| Affine::rotation(angle * f64::from(i))).collect(),
        Repeat::Row { count, step: [x, y, _] } => (0..*count).map(f64::from).map(|i| moved(x * i, y * i)).collect(),
        // The third axis stands upright on the drawing plane.
        Repeat::Grid { count: [columns, rows, _], step: [x, y, _] } => (0..*rows)
            .flat_map(|j| (0..*columns).map(move |i| (f64::from(i), f64::from(j))))
            .map(|(i, j)| moved(x * i, y * j))
            .collect(),
    }
}

/// The map of a turn about the centre of what is turned.
pub fn turn(turn: &Turn, center: Point) -> Affine {
    let [x, y] = turn.scale.0;
    Affine::scale(x, y).then(mirror(turn.mirror)).then(Affine::rotation(turn.rotate.0)).about(center)
}

fn mirror(axis: Option<PlaneAxis>) -> Affine {
    match axis {
        None => Affine::IDENTITY,
        Some(PlaneAxis::X) => Affine::scale(-1.0, 1.0),
        Some(PlaneAxis::Y) => Affine::scale(1.0, -1.0),
    }
}
