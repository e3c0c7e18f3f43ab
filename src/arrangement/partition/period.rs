//! Regular partitions of periodic tiles: their lines must continue across the sides of the tile.

use crate::error::ArrangementError;
use crate::partition::properties::StripesProperties;
use fretwork_geometry::numeric::lcm;
use fretwork_geometry::{Point, Region};

/// Fails, with the nearest angle and spacings that fit, when the lines and labels of `properties`
/// are not the same one period of `region` further. A region without a period takes any.
pub(crate) fn check_period(
    properties: &StripesProperties,
    region: &Region,
) -> Result<(), ArrangementError> {
    let Some(period) = region.period else {
        return Ok(());
    };
    let normal = Point::unit(properties.angle).left();
    let width = full_cycle(properties);
    let turns = Point::new(normal.x * period.x / width, normal.y * period.y / width);
    let whole = Point::new(libm::round(turns.x), libm::round(turns.y));
    // An error of the n-th line grows with n; a millionth of a cycle at the far side is not seen.
    if (turns.x - whole.x).abs() < 1e-6 && (turns.y - whole.y).abs() < 1e-6 {
        return Ok(());
    }
    let whole = if whole == Point::ORIGIN {
        dominant(turns)
    } else {
        whole
    };
    let fitting = Point::new(whole.x / period.x, whole.y / period.y);
    let angle = libm::atan2(-fitting.x, fitting.y);
    Err(ArrangementError::Period {
        angle,
        scale: 1.0 / fitting.length() / width,
    })
}

/// One cycle along the longer component, for a cycle that is longer than the tile.
fn dominant(turns: Point) -> Point {
    if turns.x.abs() > turns.y.abs() {
        Point::new(libm::copysign(1.0, turns.x), 0.0)
    } else {
        Point::new(0.0, libm::copysign(1.0, turns.y))
    }
}

/// The width after which spacings and labels repeat together.
pub(crate) fn full_cycle(properties: &StripesProperties) -> f64 {
    let n = properties.spacing.len() as u64;
    let cycles = [properties.edge_labels.len(), properties.face_labels.len()];
    let lines = cycles
        .into_iter()
        .filter(|cycle| *cycle > 0)
        .fold(n, |common, cycle| {
            lcm(common, cycle as u64).unwrap_or(common)
        });
    properties.spacing.iter().sum::<f64>() * (lines / n) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::LabelSet;

    #[test]
    fn the_nearest_fitting_lines_are_proposed_and_fit() {
        let mut tile = Region::rectangle(Point::ORIGIN, Point::new(240.0, 120.0));
        tile.period = Some(Point::new(240.0, 120.0));
        for (angle, spacing, labels) in [
            (0.0, vec![7.0], 0),
            (0.7, vec![11.0, 5.0], 3),
            (2.0, vec![500.0], 2),
        ] {
            let mut p = StripesProperties::new(angle, spacing);
            p.edge_labels = (0..labels).map(|i| LabelSet::one(&i.to_string())).collect();
            let Err(ArrangementError::Period { angle, scale }) = check_period(&p, &tile) else {
                panic!("fits")
            };
            p.angle = angle;
            p.spacing.iter_mut().for_each(|w| *w *= scale);
            assert_eq!(check_period(&p, &tile), Ok(()), "{p:?}");
        }
        assert_eq!(
            check_period(&StripesProperties::new(0.0, vec![12.0, 8.0]), &tile),
            Ok(())
        );
    }
}
