//! Lines made into a sheet that holds together: thickened, bridged, cut to a region.

use crate::connect::bridges::bridges;
use crate::error::ArrangementError;
use crate::limit::LIMIT;
use fretwork_geometry::drawing::{Join, Stroke};
use fretwork_geometry::neck::narrowest_neck;
use fretwork_geometry::polygon::{fill, intersect, offset, stroke_outlines, subtract, unite};
use fretwork_geometry::{Bounds, Curves, Cutout, FillRule, Point, Polygon, Region, Ring};

/// Round ends and corners are polygons within this part of the width.
const ROUNDNESS: f64 = 0.01;

/// How often what the border cuts apart again is bridged again.
const ROUNDS: usize = 8;

/// The lines of `input` as wide as `width`, cut to `region`, in exactly `components` pieces; in as many as come
/// out when that is nothing. Where `frame` is above 0, what of the region is nearer to its border than that belongs to
/// them. Bridges as wide as the lines are added, straight, inside the region
/// and of least total length, between the outlines of pieces; no piece is ever dropped. The
/// number of pieces is counted on the result.
///
/// # Errors
/// When the width is not a positive number, when the frame leaves nothing open, when there are fewer pieces than asked for, when pieces cannot be
/// joined by straight bridges inside the region, and when there is too much to do.
pub fn connect(
    input: &Curves,
    region: &Region,
    width: f64,
    frame: f64,
    components: Option<usize>,
) -> Result<Cutout, ArrangementError> {
    if !(width.is_finite() && width > 0.0) {
        return Err(ArrangementError::Spacing {
            spacing: width,
            least: 0.0,
        });
    }
    if input.points().len() > LIMIT {
        return Err(ArrangementError::TooMany {
            what: "points of lines",
            count: input.points().len() as f64,
        });
    }
    let mut pieces = widened(input, Some(region), width)?;
    if frame > 0.0 {
        pieces.extend(rim(region, frame)?);
        pieces = unite(&pieces)?;
    }
    let Some(wanted) = components else {
        return measured(pieces);
    };
    for _ in 0..ROUNDS {
        if pieces.len() <= wanted {
            break;
        }
        let ways = bridges(&pieces, region, wanted);
        let between = strokes(ways.iter().map(|way| way.as_slice()), width)?;
        let joined = intersect(
            &unite(&[pieces.as_slice(), &between].concat())?,
            &region.area,
        )?;
        if joined.len() >= pieces.len() {
            break;
        }
        pieces = joined;
    }
    let cutout = measured(pieces)?;
    if cutout.components == wanted {
        Ok(cutout)
    } else {
        Err(ArrangementError::Components {
            found: cutout.components,
            wanted,
        })
    }
}

/// The lines of `input` as wide as `width`, cut to a region where there is one. On a tile, what reaches over a side comes in
/// on the opposite one.
///
/// # Errors
/// When there is too much to do.
pub fn widened(
    input: &Curves,
    region: Option<&Region>,
    width: f64,
) -> Result<Vec<Polygon>, ArrangementError> {
    let Some(region) = region else {
        return strokes(input.iter().map(|curve| curve.points), width);
    };
    let lines = match region.period {
        None => strokes(input.iter().map(|curve| curve.points), width)?,
        Some(period) => {
            let moves: Vec<Point> = (-1..=1)
                .flat_map(|i| (-1..=1).map(move |j| (i, j)))
                .map(|(i, j)| Point::new(f64::from(i) * period.x, f64::from(j) * period.y))
                .collect();
            let tile = region.bounds().grown(width);
            let mut copies = Curves::new();
            moves.iter().for_each(|by| copies.append_moved(input, *by));
            let near = copies
                .filtered(|_, curve| Bounds::of(curve.points.iter().copied()).intersects(&tile));
            strokes(near.iter().map(|curve| curve.points), width)?
        }
    };
    Ok(intersect(&lines, &region.area)?)
}

/// What of a region is nearer to its border than `frame`.
fn rim(region: &Region, frame: f64) -> Result<Vec<Polygon>, ArrangementError> {
    let open = offset(&region.area, -frame, Join::Miter(10.0), ROUNDNESS * frame)?;
    if open.is_empty() {
        return Err(ArrangementError::Frame(frame));
    }
    Ok(subtract(&region.area, &open)?)
}

/// The cutout of `pieces` with its narrowest place.
fn measured(pieces: Vec<Polygon>) -> Result<Cutout, ArrangementError> {
    let mut cutout = Cutout::planar(pieces)?;
    cutout.measures.min_width = narrowest_neck(&cutout.polygons).map(|neck| neck.width);
    Ok(cutout)
}

/// The union of polylines widened to `width` with round ends and corners.
fn strokes<'a>(
    lines: impl Iterator<Item = &'a [fretwork_geometry::Point]>,
    width: f64,
) -> Result<Vec<Polygon>, ArrangementError> {
    let mut rings: Vec<Ring> = Vec::new();
    for line in lines {
        stroke_outlines(line, &Stroke::round(width), ROUNDNESS * width, &mut rings);
    }
    Ok(fill(&rings, FillRule::NonZero)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{CurveLabels, Seed};

    fn page() -> Region {
        Region::rectangle(Point::ORIGIN, Point::new(100.0, 60.0))
    }

    fn lines(seed: Seed, count: u64) -> Curves {
        let mut curves = Curves::new();
        for i in 0..count {
            let seed = seed.number(i as i64);
            let from = Point::new(seed.range(0, -5.0, 105.0), seed.range(1, -5.0, 65.0));
            curves.push(
                [from, from + Point::unit(seed.range(2, 0.0, 6.0)) * 9.0],
                CurveLabels::default(),
            );
        }
        curves
    }

    #[test]
    fn lines_become_as_many_pieces_as_asked_for() {
        for case in 0..6 {
            let input = lines(Seed::root(case), 40);
            let loose = connect(&input, &page(), 0.8, 0.0, None).unwrap();
            assert!(loose.components > 5);
            for wanted in [1, 3] {
                let joined = connect(&input, &page(), 0.8, 0.0, Some(wanted)).unwrap();
                assert_eq!(joined.components, wanted);
                assert!(joined.measures.area > loose.measures.area);
                let bounds = joined
                    .polygons
                    .iter()
                    .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
                assert!(bounds.min.x >= -1e-6 && bounds.max.x <= 100.0 + 1e-6);
                // Nothing was dropped.
                let kept: f64 = intersect(&joined.polygons, &loose.polygons)
                    .unwrap()
                    .iter()
                    .map(Polygon::area)
                    .sum();
                assert!((kept / loose.measures.area - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn one_piece_needs_no_bridge_and_keeps_its_holes() {
        let frame = Region::rectangle(Point::new(10.0, 10.0), Point::new(50.0, 50.0)).contour;
        let cutout = connect(&frame, &page(), 2.0, 0.0, Some(1)).unwrap();
        assert_eq!((cutout.components, cutout.holes), (1, 1));
        assert!((cutout.measures.min_width.unwrap() - 2.0).abs() < 1e-6);
        assert!(
            (cutout.measures.area - 4.0 * 40.0 * 2.0 - (std::f64::consts::PI - 4.0)).abs() < 0.1
        );
    }

    #[test]
    fn lines_become_one_piece_with_a_frame() {
        let input = lines(Seed::root(3), 40);
        let cutout = connect(&input, &page(), 0.8, 3.0, Some(1)).unwrap();
        assert_eq!(cutout.components, 1);
        // Every place nearer to the border than the frame is wide belongs to it.
        let seed = Seed::root(4);
        for i in 0..200 {
            let p = Point::new(
                seed.range(2 * i, 0.0, 100.0),
                seed.range(2 * i + 1, 0.0, 60.0),
            );
            let to_border = p.x.min(p.y).min(100.0 - p.x).min(60.0 - p.y);
            let inside = cutout.polygons.iter().any(|polygon| polygon.contains(p));
            assert!(inside || to_border > 2.999, "{p:?}");
        }
        let bare = connect(&Curves::new(), &page(), 1.0, 3.0, Some(1)).unwrap();
        assert!((bare.measures.area - (6000.0 - 94.0 * 54.0)).abs() < 1e-4);
        let whole = connect(&input, &page(), 1.0, 30.0, Some(1));
        assert_eq!(whole, Err(ArrangementError::Frame(30.0)));
    }

    #[test]
    fn refusals() {
        let input = lines(Seed::root(1), 5);
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(connect(&input, &page(), width, 0.0, Some(1)).is_err());
        }
        let none = connect(&Curves::new(), &page(), 1.0, 0.0, Some(1));
        assert_eq!(
            none,
            Err(ArrangementError::Components {
                found: 0,
                wanted: 1
            })
        );
        assert_eq!(
            connect(&Curves::new(), &page(), 1.0, 0.0, None)
                .unwrap()
                .polygons,
            []
        );
        let few = connect(&input, &page(), 1.0, 0.0, Some(50));
        assert!(matches!(
            few,
            Err(ArrangementError::Components { wanted: 50, .. })
        ));
    }
}
