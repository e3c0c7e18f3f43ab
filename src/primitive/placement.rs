//! The words `scale`, `mirror`, `rotate`, `at`, `repeat` as affine maps, in this order, and the word `side` of a thickness.

use fretwork_geometry::{Affine, Affine3, Point, Point3, Side};
use fretwork_language::kinds::side;
use fretwork_language::placement::{
    PlaneAxis, PlanePlacement, Repeat, SpaceAxis, SpacePlace, SpacePlacement, Turn,
};

/// Where a thickness goes, as the kernel says it.
pub fn thickness_side(side: side::Side) -> Side {
    match side {
        side::Side::Center => Side::Center,
        side::Side::Inside => Side::Inside,
        side::Side::Outside => Side::Outside,
    }
}

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
        Some(repeat) => copies(&repeat.0)
            .into_iter()
            .map(|copy| first.then(copy))
            .collect(),
    }
}

/// The maps of a place in space, as they are seen from above: a turn about the z axis, no z.
pub fn plane_maps(placement: &SpacePlacement) -> Vec<Affine> {
    let place = &placement.place;
    let [x, y, _] = place.scale.0;
    let [ax, ay, _] = place.at.0;
    let mirror = match place.mirror {
        Some(SpaceAxis::X) => Affine::scale(-1.0, 1.0),
        Some(SpaceAxis::Y) => Affine::scale(1.0, -1.0),
        Some(SpaceAxis::Z) | None => Affine::IDENTITY,
    };
    let first = Affine::scale(x, y)
        .then(mirror)
        .then(Affine::rotation(place.rotate.0[2]))
        .then(Affine::translation(Point::new(ax, ay)));
    let of = |repeat: Repeat| {
        copies(&repeat.flat())
            .into_iter()
            .map(|copy| first.then(copy))
            .collect()
    };
    placement.repeat.map_or(vec![first], of)
}

/// The maps from the first copy to each.
fn copies(repeat: &Repeat) -> Vec<Affine> {
    let copy = |(angle, [x, y, _]): (f64, [f64; 3])| {
        Affine::rotation(angle).then(Affine::translation(Point::new(x, y)))
    };
    repeat.copies().into_iter().map(copy).collect()
}

/// The map of a turn about the centre of what is turned.
pub fn turn(turn: &Turn, center: Point) -> Affine {
    let [x, y] = turn.scale.0;
    Affine::scale(x, y)
        .then(mirror(turn.mirror))
        .then(Affine::rotation(turn.rotate.0))
        .about(center)
}

fn mirror(axis: Option<PlaneAxis>) -> Affine {
    match axis {
        None => Affine::IDENTITY,
        Some(PlaneAxis::X) => Affine::scale(-1.0, 1.0),
        Some(PlaneAxis::Y) => Affine::scale(1.0, -1.0),
    }
}

/// The maps of a place in space: one, or one per copy of `repeat`.
pub fn space_maps(placement: &SpacePlacement) -> Vec<Affine3> {
    let first = space_place(&placement.place);
    match &placement.repeat {
        None => vec![first],
        Some(repeat) => space_copies(repeat)
            .iter()
            .map(|copy| first.then(copy))
            .collect(),
    }
}

/// The map of a place in space.
pub fn space_place(place: &SpacePlace) -> Affine3 {
    space_map(place.scale.0, place.mirror, place.rotate.0, place.at.0)
}

/// Scaled, mirrored, turned about x, then y, then z (radians), moved.
pub fn space_map(
    scale: [f64; 3],
    mirror: Option<SpaceAxis>,
    rotate: [f64; 3],
    at: [f64; 3],
) -> Affine3 {
    let mirror = match mirror {
        None => [1.0, 1.0, 1.0],
        Some(SpaceAxis::X) => [-1.0, 1.0, 1.0],
        Some(SpaceAxis::Y) => [1.0, -1.0, 1.0],
        Some(SpaceAxis::Z) => [1.0, 1.0, -1.0],
    };
    let axes = [
        Affine3::IDENTITY.x,
        Affine3::IDENTITY.y,
        Affine3::IDENTITY.z,
    ];
    let scaled = Affine3::scale(scale.into()).then(&Affine3::scale(mirror.into()));
    let turns = axes
        .into_iter()
        .zip(rotate)
        .filter(|(_, angle)| *angle != 0.0);
    let turned = turns.fold(scaled, |map, (axis, angle)| {
        map.then(&Affine3::rotation(axis, angle))
    });
    turned.then(&Affine3::translation(at.into()))
}

/// The maps from the first copy to each, in space.
fn space_copies(repeat: &Repeat) -> Vec<Affine3> {
    let copy = |(angle, step): (f64, [f64; 3])| {
        let turned = if angle == 0.0 {
            Affine3::IDENTITY
        } else {
            Affine3::rotation(Affine3::IDENTITY.z, angle)
        };
        turned.then(&Affine3::translation(Point3::from(step)))
    };
    repeat.copies().into_iter().map(copy).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_scaled_mirrored_turned_and_moved() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let map = space_map(
            [2.0, 1.0, 1.0],
            Some(SpaceAxis::X),
            [quarter, 0.0, quarter],
            [10.0, 0.0, 0.0],
        );
        // (1, 1, 0) → (-2, 1, 0) → about x: (-2, 0, 1) → about z: (0, -2, 1) → moved.
        let image = map.apply(Point3::new(1.0, 1.0, 0.0));
        assert!(image.distance(Point3::new(10.0, -2.0, 1.0)) < 1e-12);
    }

    #[test]
    fn copies_go_round_the_z_axis_or_along_the_axes() {
        let turned = space_copies(&Repeat::Turn {
            count: 4,
            angle: std::f64::consts::FRAC_PI_2,
        });
        assert!(
            turned[1]
                .apply(Point3::new(1.0, 0.0, 5.0))
                .distance(Point3::new(0.0, 1.0, 5.0))
                < 1e-12
        );
        let grid = space_copies(&Repeat::Grid {
            count: [2, 3, 2],
            step: [1.0, 10.0, 100.0],
        });
        assert_eq!(
            (grid.len(), grid[11].origin),
            (12, Point3::new(1.0, 20.0, 100.0))
        );
        let row = space_copies(&Repeat::Row {
            count: 3,
            step: [0.0, 1.0, 2.0],
        });
        assert_eq!(row[2].origin, Point3::new(0.0, 2.0, 4.0));
    }
}
