//! What is engraved on slices so that they can be stacked: the outline of the next one, and their numbers.

use std::sync::Arc;

use crate::border::Border;
use crate::error::ArrangementError;
use crate::mask;
use crate::relabel;
use fretwork_geometry::drawing::Join;
use fretwork_geometry::planar_map::resolution;
use fretwork_geometry::polygon::{intersect, offset, subtract, widest_place};
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

/// For every slice the outline of the next one, as far as it lies inside, with the label `outline`; of one that has
/// nothing of the next inside, the next one has its outline, with the label `below`. And for each of its pieces its number in
/// single lines, with the label `number`: `size` large where there is room for it, clear of the outline, where the next slice
/// will lie if there is room.
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
        let other = |number: u32| slices.iter().find(|other| other.number == number);
        let next = other(slice.number + 1);
        if let Some(next) = next {
            curves.append(&outline(slice, next, "outline")?);
        }
        // A sheet that is wider than the one below it has its mark on its lower side.
        if let Some(below) = other(slice.number.saturating_sub(1))
            && outline(below, slice, "outline")?.is_empty()
        {
            curves.append(&outline(slice, below, "below")?);
        }
        for piece in &slice.area {
            curves.append(&number(slice, piece, next, size)?);
        }
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

/// The area of another slice where it comes to lie on this one.
fn moved(next: &Slice, slice: &Slice) -> Vec<Polygon> {
    cutout::mapped(&next.area, |p| p + (slice.origin - next.origin))
}

/// The outline of another slice inside of one.
fn outline(slice: &Slice, next: &Slice, label: &str) -> Result<Curves, ArrangementError> {
    let moved = moved(next, slice);
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
    Ok(labelled(&inside, label))
}

/// A ring as a closed curve.
fn ring(ring: &[Point]) -> Curves {
    let mut curves = Curves::new();
    let closed = ring.iter().chain(ring.first()).copied();
    curves.push(closed, CurveLabels::default());
    curves
}

/// The number of a slice on one of its pieces, about the widest place on either side of the next slice's outline.
fn number(
    slice: &Slice,
    piece: &Polygon,
    next: Option<&Slice>,
    size: f64,
) -> Result<Curves, ArrangementError> {
    let text = slice.number.to_string();
    let written = letters::write(&text, 1.0).expect("there are letters for all figures");
    let bounds = written.bounds();
    let radius = bounds.min.distance(bounds.max) / 2.0;
    let piece = std::slice::from_ref(piece);
    let next = next.map_or(Vec::new(), |next| moved(next, slice));
    let under = widest(&intersect(piece, &next)?);
    let open = || Ok::<_, ArrangementError>(widest(&subtract(piece, &next)?));
    let has_room = |(_, room): &(Point, f64)| ROOM * room >= size * radius;
    let place = match under.filter(has_room) {
        Some(under) => Some(under),
        None => wider(under, open()?),
    };
    let Some((at, room)) = place else {
        return Ok(Curves::new());
    };
    let scale = size.min(ROOM * room / radius);
    let place = Affine::translation(-bounds.center())
        .then(Affine::scale(scale, scale))
        .then(Affine::translation(at));
    Ok(labelled(&written.transformed(&place), "number"))
}

/// The place in some polygons that is farthest from their borders, and how far it is.
fn widest(area: &[Polygon]) -> Option<(Point, f64)> {
    area.iter()
        .filter_map(widest_place)
        .fold(None, |best, found| wider(best, Some(found)))
}

/// Of two places the one with more room; of equals the first.
fn wider(a: Option<(Point, f64)>, b: Option<(Point, f64)>) -> Option<(Point, f64)> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.1 > a.1 { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// The lines with one label.
fn labelled(lines: &Curves, label: &str) -> Curves {
    let labels = CurveLabels::edge(LabelSet::one(label));
    relabel::labelled(lines, |_| labels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Bounds;

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
        assert!((length(&lines, "below") - 24.0).abs() < 1e-3);
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
    fn each_piece_has_the_number_and_no_number_crosses_an_outline() {
        let mut pair = pyramid(&[10.0, 9.0]);
        // The first has a second piece beside it.
        let aside = Region::rectangle(Point::new(6.0, -2.0), Point::new(9.0, 2.0));
        let aside = aside.labelled(LabelSet::one("1"));
        pair.contour.append(&aside.contour);
        pair.area.extend(aside.area);
        // Of the second, half is missing, so that its outline runs through the middle of the first.
        pair.area[1]
            .outer
            .iter_mut()
            .for_each(|p| p.x = p.x.max(20.0));
        let contour = pair.contour.filtered(|i, _| !(4..8).contains(&i));
        let half = Region::of_area(vec![pair.area[1].clone()]).labelled(LabelSet::one("2"));
        pair.contour = contour;
        pair.contour.append(&half.contour);
        let lines = registration(&pair, Some(1.0)).unwrap();
        let numbers = lines.filtered(|_, curve| curve.labels.edge.contains("number"));
        let ends = |range: std::ops::Range<f64>| {
            let points = numbers.iter().flat_map(|c| c.points.to_vec());
            Bounds::of(points.filter(|p| range.contains(&p.x)))
        };
        let (first, second) = (ends(-5.0..5.0), ends(5.5..9.5));
        assert!(!first.is_empty() && !second.is_empty());
        assert!(first.min.x > 0.0, "{first:?}");
    }

    #[test]
    fn a_region_without_slices_is_refused() {
        let page = Region::rectangle(Point::ORIGIN, Point::new(1.0, 1.0));
        assert_eq!(registration(&page, None), Err(ArrangementError::NoSlices));
    }
}
