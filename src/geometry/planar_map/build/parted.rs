//! Curves divided at the points that stand alone on them, so that these points are vertices of edges. Where curves cross
//! one another they are divided later, in `noding`.

use crate::index::{BoxTree, Extent};
use crate::planar_map::{EdgeId, PlanarMap};
use crate::{Bounds, Curve, Curves, Point};

/// A place on a curve: the number of the segment, the part of it, and the point that stands alone there.
type Cut = (usize, f64, Point);

/// Curves that were divided.
pub(super) struct Parted {
    pub curves: Curves,
    /// For each of them the number of the curve that it is a piece of; ascending.
    pub of: Vec<u32>,
}

/// The curves, each divided where a point that stands alone is no farther from it than `near`. None where there is no such
/// place. O((n + m) log m) for n segments and m points that are spread over the plane.
pub(super) fn parted(curves: &Curves, near: f64) -> Option<Parted> {
    let points: Vec<Point> = curves.lone().iter().map(|(p, _)| *p).collect();
    if points.is_empty() {
        return None;
    }
    let extent = |p: &Point| Extent::from([p.x, p.y]);
    let tree = BoxTree::new(&points.iter().map(extent).collect::<Vec<_>>());
    let cuts = |curve: Curve<'_>| cuts(curve.points, near, &tree, &points);
    let all: Vec<Vec<Cut>> = curves.iter().map(cuts).collect();
    if all.iter().all(Vec::is_empty) {
        return None;
    }
    let (mut parted, mut of) = (Curves::new(), Vec::new());
    for (number, (curve, cuts)) in (0u32..).zip(curves.iter().zip(all)) {
        of.extend(std::iter::repeat_n(number, cuts.len() + 1));
        let (mut piece, mut next) = (vec![curve.points[0]], 1);
        for (segment, _, at) in cuts {
            piece.extend(&curve.points[next..=segment]);
            piece.push(at);
            parted.push(std::mem::replace(&mut piece, vec![at]), curve.labels);
            next = segment + 1;
        }
        piece.extend(&curve.points[next..]);
        parted.push(piece, curve.labels);
    }
    for (at, labels) in curves.lone() {
        parted.push_lone(*at, *labels);
    }
    Some(Parted { curves: parted, of })
}

/// Gives the sources of all edges of the map of divided curves the numbers of the curves that these are pieces `of`. Two
/// pieces of one curve that run along one edge become one source that passes twice.
pub(super) fn renumber(map: &mut PlanarMap, of: &[u32]) {
    let (mut first, mut more, mut all_passes) = (Vec::new(), Vec::new(), Vec::new());
    for edge in map.edges().collect::<Vec<EdgeId>>() {
        let numbered = |curve: u32, reversed: bool| 2 * of[curve as usize] + u32::from(reversed);
        let sources = map.sources(edge);
        let mut sources: Vec<u32> = sources.map(|s| numbered(s.curve, s.reversed)).collect();
        sources.sort_unstable();
        sources.dedup();
        for same in sources.chunk_by(|a, b| a / 2 == b / 2) {
            let curve = same[0] / 2;
            let told: i32 = same.iter().map(|s| if s % 2 == 0 { 1 } else { -1 }).sum();
            let passes = map.passes(edge).filter(|p| of[p.0 as usize] == curve);
            let passes: i32 = passes.map(|p| p.1).sum();
            if passes != told {
                all_passes.push((edge.0, curve, passes));
            }
        }
        first.push(sources[0] / 2);
        more.extend(sources[1..].iter().map(|source| (edge.0, *source)));
    }
    (map.first_source, map.more_sources, map.passes) = (first, more, all_passes);
}

/// Where points stand on a polyline, in order along it, apart from one another and from its ends.
fn cuts(line: &[Point], near: f64, tree: &BoxTree<2>, points: &[Point]) -> Vec<Cut> {
    let mut cuts: Vec<Cut> = Vec::new();
    for (segment, ends) in line.windows(2).enumerate() {
        let view = Bounds::of([ends[0], ends[1]]).grown(near);
        tree.for_meeting(&Extent::from(view), |number| {
            let at = points[number as usize];
            let along = ends[1] - ends[0];
            let part = (at - ends[0]).dot(along) / along.dot(along);
            let part = if part.is_finite() {
                part.clamp(0.0, 1.0)
            } else {
                0.0
            };
            if (ends[0].lerp(ends[1], part) - at).length() <= near {
                cuts.push((segment, part, at));
            }
        });
    }
    cuts.sort_by(|a, b| (a.0.cmp(&b.0)).then(a.1.total_cmp(&b.1)));
    let is_apart = |a: Point, b: Point| (a - b).length() > near;
    let ends = [line[0], line[line.len() - 1]];
    cuts.retain(|cut| ends.iter().all(|end| is_apart(*end, cut.2)));
    cuts.dedup_by(|b, a| !is_apart(a.2, b.2));
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar_map::{PlanarMap, resolution};
    use crate::{CurveLabels, LabelSet};

    fn map(curves: &Curves) -> PlanarMap {
        let map = PlanarMap::build(curves, resolution(10.0)).unwrap();
        map.check().unwrap();
        map
    }

    #[test]
    fn a_point_on_an_edge_parts_it() {
        let mut curves = Curves::new();
        let road = CurveLabels::edge(LabelSet::one("road"));
        let place = |x: f64, y: f64| Point::new(x, y);
        curves.push([place(0.0, 0.0), place(6.0, 0.0), place(6.0, 4.0)], road);
        assert_eq!(
            (map(&curves).vertex_count(), map(&curves).edge_count()),
            (2, 1)
        );
        // In the middle of a segment, a hair beside one, at a corner, at an end, and nowhere near.
        for (at, label) in [
            (place(2.0, 0.0), "gate"),
            (place(4.0, 1e-12), "well"),
            (place(6.0, 0.0), "bend"),
            (place(0.0, 0.0), "start"),
            (place(3.0, 1.0), "aside"),
        ] {
            curves.push_lone(at, LabelSet::one(label));
        }
        let map = map(&curves);
        assert_eq!((map.vertex_count(), map.edge_count()), (6, 4));
        for (label, degree) in [
            ("gate", 2),
            ("well", 2),
            ("bend", 2),
            ("start", 1),
            ("aside", 0),
        ] {
            let own = map
                .vertices()
                .find(|v| map.vertex_labels(*v).contains(label));
            assert_eq!(
                own.map(|v| map.outgoing(v).count()),
                Some(degree),
                "{label}"
            );
        }
        assert!(map.edges().all(|e| map.labels(e).edge.contains("road")));
        let again = PlanarMap::build(&map.to_curves(), resolution(10.0)).unwrap();
        assert_eq!(again.to_curves(), map.to_curves());
    }

    #[test]
    fn the_sources_of_parted_curves_are_the_whole_curves() {
        let mut curves = Curves::new();
        // There, back and there again along its second half.
        let bends = [[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [4.0, 0.0]];
        curves.push(bends.map(Point::from), CurveLabels::default());
        let other = [[4.0, 0.0], [0.0, 0.0], [0.0, 3.0]];
        curves.push(other.map(Point::from), CurveLabels::default());
        let plain = map(&curves);
        curves.push_lone(Point::new(3.0, 0.0), LabelSet::EMPTY);
        curves.push_lone(Point::new(1.0, 0.0), LabelSet::EMPTY);
        let parted = map(&curves);
        assert!(parted.edge_count() > plain.edge_count());
        let told = |map: &PlanarMap, at: f64| {
            let here = |e: &EdgeId| {
                let ends = [map.source(*e), map.target(*e)].map(|v| map.location(v));
                ends.iter().all(|p| p.y == 0.0) && (ends[0].x - at) * (ends[1].x - at) < 0.0
            };
            let edge = map.edges().find(here).unwrap();
            let runs_right = map.location(map.source(edge)).x < at;
            assert!(map.sources(edge).all(|source| source.curve < 2));
            let sign = if runs_right { 1 } else { -1 };
            let passes = map.passes(edge);
            let mut passes: Vec<_> = passes.map(|(curve, sum)| (curve, sum * sign)).collect();
            passes.sort_unstable();
            passes
        };
        // The first curve runs to the right along all, once more than to the left.
        for at in [0.5, 1.5, 2.5, 3.5] {
            assert_eq!(told(&parted, at), [(0, 1), (1, -1)], "{at}");
        }
        assert_eq!(told(&plain, 2.0), [(0, 1), (1, -1)]);
    }

    #[test]
    fn points_on_closed_curves_and_crossings_part_them_too() {
        let mut curves = Curves::new();
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
        curves.push(corners.map(Point::from), CurveLabels::default());
        curves.push(
            [Point::new(-2.0, 2.0), Point::new(6.0, 2.0)],
            CurveLabels::default(),
        );
        let before = map(&curves);
        for at in [[2.0, 4.0], [4.0, 2.0], [4.0, 2.0], [2.0, 2.0]] {
            curves.push_lone(at.into(), LabelSet::EMPTY);
        }
        let after = map(&curves);
        // Of the four, the place where lines cross was a vertex before.
        assert_eq!(after.vertex_count(), before.vertex_count() + 2);
        assert_eq!(after.edge_count(), before.edge_count() + 2);
        assert_eq!(after.face_count(), before.face_count());
    }
}
