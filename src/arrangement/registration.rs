//! What is engraved on slices so that they can be stacked: the outline of the next one, and their numbers.

use std::sync::Arc;

use crate::border::Border;
use crate::error::ArrangementError;
use crate::mask;
use crate::relabel;
use fretwork_geometry::drawing::Join;
use fretwork_geometry::planar_map::resolution;
use fretwork_geometry::polygon::{offset, widest_place};
use fretwork_geometry::{
    Affine, CurveLabels, Curves, LabelSet, Point, Polygon, Region, cutout, letters,
};

/// How much of the circle that fits in a slice a number may take.
const ROOM: f64 = 0.8;
/// The size of numbers where it is not said, as a part of the longer side of the largest slice.
const SIZE: f64 = 1.0 / 15.0;
/// Lines nearer to the border of their slice than this part of its size are the border.
const BORDER: f64 = 1e-3;

/// A slice: its number, its area, and where the origin of the body is drawn.
struct Slice {
    number: u32,
    area: Vec<Polygon>,
    origin: Point,
}

/// For every slice the outline of the next one, as far as it lies inside, with the label `outline`, and its number in
/// single lines, with the label `number`: `size` large where there is room for it, at the widest place of its largest part.
///
/// # Errors
/// When `region` has no slices, or their areas cannot be computed.
pub fn registration(region: &Region, size: Option<f64>) -> Result<Curves, ArrangementError> {
    let slices = numbered(region);
    if slices.is_empty() {
        return Err(ArrangementError::NoSlices);
    }
    let longest = slices
        .iter()
        .map(|slice| side(&slice.area))
        .fold(0.0, f64::max);
    let size = size.unwrap_or(SIZE * longest);
    let mut curves = Curves::new();
    for slice in &slices {
        if let Some(next) = slices.iter().find(|other| other.number == slice.number + 1) {
            curves.append(&outline(slice, next)?);
        }
        curves.append(&number(slice, size));
    }
    Ok(curves)
}

/// The slices of a region: its parts whose labels are the names of points.
fn numbered(region: &Region) -> Vec<Slice> {
    let parts = region.by_labels();
    let slice = |(name, origin): &(Arc<str>, Point)| {
        let own = parts.iter().find(|(labels, _)| labels.contains(name))?;
        Some(Slice {
            number: name.parse().ok()?,
            area: own.1.clone(),
            origin: *origin,
        })
    };
    region
        .contour
        .named_points()
        .iter()
        .filter_map(slice)
        .collect()
}

fn side(area: &[Polygon]) -> f64 {
    Region::of_area(area.to_vec()).bounds().longer_side()
}

/// The outline of the next slice inside of one.
fn outline(slice: &Slice, next: &Slice) -> Result<Curves, ArrangementError> {
    let moved = cutout::mapped(&next.area, |p| p + (slice.origin - next.origin));
    let size = side(&slice.area);
    let inner = offset(
        &slice.area,
        -BORDER * size,
        Join::Miter(4.0),
        1e-2 * BORDER * size,
    )?;
    let lines = Region::of_area(moved).contour;
    let mut inside = Curves::new();
    for polygon in &inner {
        let mut ways = mask::inside(
            &lines,
            &ring(&polygon.outer),
            Border::Crop,
            resolution(size),
        )?;
        for hole in &polygon.holes {
            ways = mask::outside(&ways, &ring(hole), Border::Crop, resolution(size))?;
        }
        inside.append(&ways);
    }
    Ok(labelled(&inside, "outline"))
}

/// A ring as a closed curve.
fn ring(ring: &[Point]) -> Curves {
    let mut curves = Curves::new();
    let closed = ring.iter().chain(ring.first()).copied();
    curves.push(closed, CurveLabels::default());
    curves
}

/// The number of a slice, about the widest place of its largest part.
fn number(slice: &Slice, size: f64) -> Curves {
    let area = |polygon: &&Polygon| polygon.area();
    let largest = slice.area.iter().max_by(|a, b| area(a).total_cmp(&area(b)));
    let Some((at, room)) = largest.and_then(widest_place) else {
        return Curves::new();
    };
    let text = slice.number.to_string();
    let written = letters::write(&text, 1.0).expect("there are letters for all figures");
    let bounds = written.bounds();
    let radius = bounds.min.distance(bounds.max) / 2.0;
    let scale = size.min(ROOM * room / radius);
    let place = Affine::translation(-bounds.center())
        .then(Affine::scale(scale, scale))
        .then(Affine::translation(at));
    labelled(&written.transformed(&place), "number")
}

/// The lines with one label.
fn labelled(lines: &Curves, label: &str) -> Curves {
    let labels = CurveLabels::edge(LabelSet::one(label));
    relabel::labelled(lines, |_| labels)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Squares on one another, as slices side by side.
    fn pyramid(sides: &[f64]) -> Region {
        let mut whole = Region::of_area(Vec::new());
        for (i, side) in sides.iter().enumerate() {
            let name = (i + 1).to_string();
            let center = Point::new(20.0 * i as f64, 0.0);
            let half = Point::new(side / 2.0, side / 2.0);
            let square = Region::rectangle(center - half, center + half);
            let square = square.labelled(LabelSet::one(&name));
            whole.contour.append(&square.contour);
            whole.contour.name_point(name, center);
            whole.area.extend(square.area);
        }
        whole
    }

    fn length(curves: &Curves, label: &str) -> f64 {
        let own = curves.iter().filter(|c| c.labels.edge.contains(label));
        own.flat_map(|c| c.points.windows(2))
            .map(|w| w[0].distance(w[1]))
            .sum()
    }

    #[test]
    fn each_slice_has_the_outline_of_the_next_and_its_number() {
        let lines = registration(&pyramid(&[10.0, 6.0, 8.0]), Some(2.0)).unwrap();
        // The third is wider than the second, which has nothing of it.
        assert!((length(&lines, "outline") - 24.0).abs() < 1e-3);
        let numbers = lines.filtered(|_, curve| curve.labels.edge.contains("number"));
        assert!(numbers.bounds().contains(Point::new(20.0, 0.0)));
        assert!((numbers.bounds().height() - 1.4).abs() < 1e-9);
        // What is drawn in the hole of a slice is not on it.
        let mut pair = pyramid(&[10.0, 4.0]);
        let hole = Region::rectangle(Point::new(-3.0, -3.0), Point::new(3.0, 3.0));
        pair.area[0].holes = vec![hole.area[0].outer.iter().rev().copied().collect()];
        let lines = registration(&pair, Some(1.0)).unwrap();
        assert_eq!(length(&lines, "outline"), 0.0);
        let small = registration(&pyramid(&[1.0]), Some(2.0)).unwrap();
        assert!(small.bounds().width() < 1.0);
    }

    #[test]
    fn a_region_without_slices_is_refused() {
        let page = Region::rectangle(Point::ORIGIN, Point::new(1.0, 1.0));
        assert_eq!(registration(&page, None), Err(ArrangementError::NoSlices));
    }
}
