//! Parts of regions that are drawn by the general engine: what is left around blocks of tiles, and what lies near a
//! window. Partitions are anchored in them as in the whole.
//!
//! The new borders that arise lie so far from what is used that nothing of them is seen there; so it does not matter that
//! they run along one another in places.

use crate::tiled::lattice::TileNumber;
use crate::tiled::rows::Tiling;
use fretwork_geometry::{Bounds, CurveLabels, Curves, LabelSet, Point, Polygon, Region, Ring};

/// Blocks of tiles are made smaller by this part of a tile, so that they do not touch.
const GAP: f64 = 1.0 / 64.0;

/// The region without the blocks of tiles, which lie inside of it.
pub(crate) fn without(region: &Region, tiling: &Tiling, blocks: &[[TileNumber; 2]]) -> Region {
    let mut area = region.area.clone();
    let mut contour = region.contour.clone();
    for [from, to] in blocks {
        let [u0, v0] = from.map(|n| n as f64 + GAP);
        let [u1, v1] = to.map(|n| n as f64 + 1.0 - GAP);
        let corners = [[u0, v0], [u0, v1], [u1, v1], [u1, v0]];
        let mut ring: Ring = corners
            .map(|c| tiling.origin + tiling.lattice.point(c))
            .to_vec();
        // Holes run clockwise.
        if tiling.lattice.periods[0].cross(tiling.lattice.periods[1]) < 0.0 {
            ring.reverse();
        }
        let is_only = area.len() == 1;
        let around = area
            .iter_mut()
            .find(|polygon| is_only || polygon.contains(ring[0]));
        let Some(polygon) = around else { continue };
        let closed = ring.iter().chain(ring.first()).copied();
        contour.push(closed, CurveLabels::default());
        polygon.holes.push(ring);
    }
    part(region, area, contour)
}

/// What of the region lies in a box.
pub(crate) fn near(region: &Region, within: &Bounds) -> Region {
    let ring = |ring: &Ring| clipped(ring, within);
    let polygon = |polygon: &Polygon| Polygon {
        outer: ring(&polygon.outer),
        holes: polygon
            .holes
            .iter()
            .map(ring)
            .filter(|ring| ring.len() > 2)
            .collect(),
    };
    let area = region.area.iter().map(polygon);
    let area = area.filter(|polygon| polygon.outer.len() > 2).collect();
    part(region, area, clipped_contour(&region.contour, within))
}

fn part(region: &Region, area: Vec<Polygon>, contour: Curves) -> Region {
    Region {
        area,
        contour,
        period: None,
        within: region.within,
        whole: Some(region.page()),
        features: Vec::new(),
        columns: Vec::new(),
    }
}

/// The ring cut to a box, by Sutherland and Hodgman (1974): where it leaves the box several times, it runs back along the
/// side.
fn clipped(ring: &Ring, within: &Bounds) -> Ring {
    let depths: [&dyn Fn(Point) -> f64; 4] = [
        &|p| p.x - within.min.x,
        &|p| within.max.x - p.x,
        &|p| p.y - within.min.y,
        &|p| within.max.y - p.y,
    ];
    let mut ring = ring.clone();
    for depth in depths {
        let mut kept = Vec::with_capacity(ring.len() + 4);
        let Some(mut before) = ring.last().copied() else {
            return ring;
        };
        for p in ring {
            let (a, b) = (depth(before), depth(p));
            if (a < 0.0) != (b < 0.0) {
                kept.push(before.lerp(p, a / (a - b)));
            }
            if b >= 0.0 {
                kept.push(p);
            }
            before = p;
        }
        ring = kept;
    }
    ring
}

/// The pieces of the contour in a box, with the labels of their curves.
fn clipped_contour(contour: &Curves, within: &Bounds) -> Curves {
    let mut pieces = Curves::new();
    for curve in contour.iter() {
        let mut piece: Vec<Point> = Vec::new();
        let mut labels = curve.labels;
        let mut flush = |piece: &mut Vec<Point>, labels: CurveLabels| {
            pieces.push(piece.drain(..), labels);
        };
        let bare = CurveLabels {
            start: LabelSet::EMPTY,
            end: LabelSet::EMPTY,
            ..labels
        };
        labels.end = LabelSet::EMPTY;
        for ends in curve.points.windows(2) {
            let Some([from, to]) = inside(ends[0], ends[1], within) else {
                flush(&mut piece, labels);
                labels = bare;
                continue;
            };
            if piece.last() != Some(&from) {
                flush(&mut piece, labels);
                if from != curve.points[0] {
                    labels = bare;
                }
                piece.push(from);
            }
            piece.push(to);
        }
        if piece.last() == curve.points.last() {
            labels.end = curve.labels.end;
        }
        flush(&mut piece, labels);
    }
    pieces
}

/// The part of a segment in a box, by Liang and Barsky (1984); its ends are those of the segment where these are inside.
pub(crate) fn inside(a: Point, b: Point, within: &Bounds) -> Option<[Point; 2]> {
    let d = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for (step, room) in [
        (-d.x, a.x - within.min.x),
        (d.x, within.max.x - a.x),
        (-d.y, a.y - within.min.y),
        (d.y, within.max.y - a.y),
    ] {
        if step == 0.0 {
            if room < 0.0 {
                return None;
            }
            continue;
        }
        let part = room / step;
        if step < 0.0 {
            from = from.max(part);
        } else {
            to = to.min(part);
        }
    }
    if from >= to {
        return None;
    }
    let start = if from > 0.0 { a.lerp(b, from) } else { a };
    let end = if to < 1.0 { a.lerp(b, to) } else { b };
    Some([start, end])
}
