//! Arrangements masked by the faces of others (Loi 2015, section 3.5; rule R18). The
//! union of two is [`Curves::append`].

use crate::border::Border;
use crate::error::ArrangementError;
use crate::mask::overlay::{Overlay, outline};
use fretwork_geometry::planar_map::{EdgeId, FaceId, PlanarMap};
use fretwork_geometry::{Curves, Region};

/// The edges of the planar map of `input` that lie in the closed union of all bounded faces of that of
/// `mask`: cut there (`Crop`), with the edges of `mask` that bound the union added (`CropAddBoundary`),
/// or whole, those that lie in it entirely (`KeepInside`) or in part (`KeepOutside`). The named
/// points of `input` stay.
pub fn inside(
    input: &Curves,
    mask: &Curves,
    border: Border,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    by_rim(input, &rim(mask, resolution)?, border, resolution, true)
}

/// The same with the complement of that union; what lies on its border is inside.
pub fn outside(
    input: &Curves,
    mask: &Curves,
    border: Border,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    by_rim(input, &rim(mask, resolution)?, border, resolution, false)
}

/// The same as [`inside`] or, with `is_inside` false, [`outside`] where the mask is the area of a region, without its
/// holes.
pub fn by_region(
    input: &Curves,
    region: &Region,
    border: Border,
    resolution: f64,
    is_inside: bool,
) -> Result<Curves, ArrangementError> {
    // The contour has labels, but the borders within a map too.
    let rim = if region.features.is_empty() {
        &region.contour
    } else {
        &outline(region)
    };
    by_rim(input, rim, border, resolution, is_inside)
}

/// The same where the closed curves `rim` bound the mask.
pub fn by_rim(
    input: &Curves,
    rim: &Curves,
    border: Border,
    resolution: f64,
    keep_inside: bool,
) -> Result<Curves, ArrangementError> {
    let edges = PlanarMap::build(input, resolution)?.to_curves();
    let overlay = Overlay::new(&edges, rim, resolution)?;
    let is_allowed = |e: EdgeId| overlay.touches_inside(e) == keep_inside;
    let mut curves = input.filtered(|_, _| false);
    match border {
        Border::Crop | Border::CropAddBoundary => {
            overlay.add_parts(
                |_, e| is_allowed(e).then_some(()),
                |labels, ()| labels,
                &mut curves,
            );
            if border == Border::CropAddBoundary {
                curves.append(rim);
            }
        }
        Border::KeepInside | Border::KeepOutside => {
            let mut allowed = vec![[0.0; 2]; edges.len()];
            for e in overlay.map.edges() {
                if let Some(curve) = overlay.curve(e) {
                    allowed[curve][usize::from(is_allowed(e))] += overlay.map.edge_length(e);
                }
            }
            // Snapping moves ends by about a resolution.
            let is_something = |length: f64| length > 2.0 * resolution;
            let kept = edges.filtered(|i, _| match border {
                Border::KeepInside => !is_something(allowed[i][0]),
                _ => is_something(allowed[i][1]),
            });
            curves.append(&kept);
        }
    }
    Ok(curves)
}

/// The edges between a bounded and the unbounded face of the planar map of `mask`.
fn rim(mask: &Curves, resolution: f64) -> Result<Curves, ArrangementError> {
    let map = PlanarMap::build(mask, resolution)?;
    let mut rim = Curves::new();
    for e in map.edges() {
        if (map.left(e) == FaceId::UNBOUNDED) != (map.right(e) == FaceId::UNBOUNDED) {
            rim.push(map.points(e), map.labels(e));
        }
    }
    Ok(rim)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::planar_map::resolution;
    use fretwork_geometry::{CurveLabels, LabelSet, Point, Seed};
    use std::f64::consts::PI;

    const ALL: [Border; 4] = [
        Border::Crop,
        Border::CropAddBoundary,
        Border::KeepInside,
        Border::KeepOutside,
    ];

    fn ring(center: [f64; 2], radius: f64, n: u32, label: &str) -> Curves {
        let mut curves = Curves::new();
        let at = |i: u32| {
            Point::from(center) + Point::unit(2.0 * PI * f64::from(i % n) / f64::from(n)) * radius
        };
        curves.push((0..=n).map(at), CurveLabels::edge(LabelSet::one(label)));
        curves
    }

    fn length(curves: &Curves) -> f64 {
        curves
            .iter()
            .flat_map(|c| c.points.windows(2))
            .map(|w| w[0].distance(w[1]))
            .sum()
    }

    fn map(curves: &Curves) -> PlanarMap {
        PlanarMap::build(curves, resolution(10.0)).unwrap()
    }

    #[test]
    fn a_ring_is_cut_where_it_leaves_the_mask() {
        let (a, b) = (ring([0.0, 0.0], 2.0, 8, "a"), ring([2.0, 0.1], 1.0, 7, "b"));
        let at = |operator: fn(&Curves, &Curves, Border, f64) -> _, border| {
            let curves: Result<Curves, ArrangementError> =
                operator(&a, &b, border, resolution(10.0));
            curves.unwrap()
        };
        let (inner, outer) = (at(inside, Border::Crop), at(outside, Border::Crop));
        assert!((length(&inner) + length(&outer) - length(&a)).abs() < 1e-7);
        // The ring's vertex is inside the mask, so the inner part is two curves, the outer one.
        assert_eq!((inner.len(), outer.len()), (2, 1));
        assert_eq!(
            (map(&inner).vertex_count(), map(&outer).vertex_count()),
            (3, 2)
        );
        let with_rim = at(inside, Border::CropAddBoundary);
        assert!((length(&with_rim) - length(&inner) - length(&b)).abs() < 1e-7);
        assert_eq!(
            at(inside, Border::KeepOutside),
            at(outside, Border::KeepOutside)
        );
        assert!(
            at(inside, Border::KeepInside).is_empty() && at(outside, Border::KeepInside).is_empty()
        );
    }

    #[test]
    fn faces_inside_rings_belong_to_the_mask_and_its_inner_edges_cut_nothing() {
        let mut mask = ring([0.0, 0.0], 4.0, 12, "b");
        mask.append(&ring([0.0, 0.0], 2.0, 12, "b"));
        mask.push(
            [Point::new(0.0, -9.0), Point::new(0.0, 9.0)],
            CurveLabels::default(),
        );
        let mut line = Curves::new();
        line.push(
            [Point::new(-6.0, 0.3), Point::new(6.0, 0.3)],
            CurveLabels::default(),
        );
        line.name_point("here", Point::ORIGIN);
        let inner = inside(&line, &mask, Border::Crop, resolution(10.0)).unwrap();
        assert_eq!(
            (inner.len(), inner.point_named("here")),
            (1, Some(Point::ORIGIN))
        );
        assert_eq!(
            outside(&line, &mask, Border::Crop, resolution(10.0))
                .unwrap()
                .len(),
            2
        );
        // What lies along the rim, on either side of the mask, is inside.
        let rim = ring([0.0, 0.0], 4.0, 12, "a");
        for border in ALL {
            assert!(
                length(
                    &outside(
                        &rim,
                        &ring([0.0, 0.0], 4.0, 12, "b"),
                        border,
                        resolution(10.0)
                    )
                    .unwrap()
                ) < 26.0
            );
        }
        assert_eq!(
            inside(&rim, &mask, Border::KeepInside, resolution(10.0))
                .unwrap()
                .len(),
            1
        );
        assert!(
            outside(&rim, &mask, Border::KeepOutside, resolution(10.0))
                .unwrap()
                .is_empty()
        );
    }

    #[test]
    fn the_mask_of_a_region_has_its_holes() {
        let square = |low: f64, high: f64| {
            Region::rectangle(Point::new(low, low), Point::new(high, high)).area
        };
        let mut area = square(0.0, 9.0);
        area[0].holes = vec![square(3.0, 6.0)[0].outer.clone()];
        let page = Region::of_area(area);
        let mut line = Curves::new();
        line.push(
            [Point::new(-1.0, 4.0), Point::new(10.0, 4.0)],
            CurveLabels::default(),
        );
        let cut =
            |is_inside| by_region(&line, &page, Border::Crop, resolution(9.0), is_inside).unwrap();
        assert_eq!((cut(true).len(), cut(false).len()), (2, 3));
        assert!((length(&cut(true)) - 6.0).abs() < 1e-6);
    }

    #[test]
    fn pieces_follow_the_curve_wherever_it_lies() {
        for turn in 0..12 {
            let map = fretwork_geometry::Affine::rotation(f64::from(turn) * PI / 6.0 + 0.05);
            let (a, b) = (
                ring([0.0, 0.0], 2.0, 9, "a").transformed(&map),
                ring([2.0, 0.1], 1.0, 7, "b").transformed(&map),
            );
            let count =
                |f: fn(&Curves, &Curves, Border, f64) -> Result<Curves, ArrangementError>| {
                    f(&a, &b, Border::Crop, resolution(10.0)).unwrap().len()
                };
            assert_eq!((count(inside), count(outside)), (2, 1), "turn {turn}");
        }
    }

    #[test]
    fn inside_and_outside_make_the_whole() {
        for case in 0..20 {
            let seed = Seed::root(case);
            let rings = |name: &str, count: u64| {
                let seed = seed.name(name);
                let mut curves = Curves::new();
                for i in 0..count {
                    let at = [seed.range(3 * i, 1.0, 9.0), seed.range(3 * i + 1, 1.0, 9.0)];
                    curves.append(&ring(
                        at,
                        seed.range(3 * i + 2, 0.3, 2.0),
                        5 + i as u32,
                        name,
                    ));
                }
                curves
            };
            let (a, b) = (rings("a", 9), rings("b", 6));
            let whole = map(&a);
            let part =
                |f: fn(&Curves, &Curves, Border, f64) -> Result<Curves, ArrangementError>,
                 border| { map(&f(&a, &b, border, resolution(10.0)).unwrap()) };
            let (inner, outer) = (part(inside, Border::Crop), part(outside, Border::Crop));
            assert!(
                (inner.length() + outer.length() - whole.length()).abs() < 1e-6,
                "case {case}"
            );
            let (kept, dropped) = (
                part(inside, Border::KeepOutside),
                part(outside, Border::KeepInside),
            );
            assert!((kept.length() + dropped.length() - whole.length()).abs() < 1e-6);
            assert_eq!(kept.edge_count() + dropped.edge_count(), whole.edge_count());
            // Pieces of edges: joined again, no vertex is left that was neither a vertex nor a cut.
            let cuts = inner
                .vertices()
                .filter(|v| inner.outgoing(*v).count() == 1)
                .count();
            assert!(
                cuts <= outer
                    .vertices()
                    .filter(|v| outer.outgoing(*v).count() == 1)
                    .count()
                    + whole.vertex_count()
            );
            let mut joined = inside(&a, &b, Border::Crop, resolution(10.0)).unwrap();
            joined.append(&outside(&a, &b, Border::Crop, resolution(10.0)).unwrap());
            assert_eq!(map(&joined).face_count(), whole.face_count());
            let mut twice = a.clone();
            twice.append(&a);
            assert_eq!(
                map(&twice).to_curves(),
                whole.to_curves(),
                "a union with itself is the same map"
            );
        }
    }
}
