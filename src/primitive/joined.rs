//! What is told of regions that are made of cutouts: whether parts of a union touch, and whether an outline is simple. The
//! areas themselves are made in `region`.

use std::collections::BTreeMap;
use std::sync::Arc;

use fretwork_action::{Action, Data, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::polygon::Gap;
use fretwork_geometry::{Carrier, Point, Polygon, Region, TopologyError, polygon, topology};
use fretwork_language::{Ref, wants};

/// Warnings about the union `united` of `parts`, those that `of` names: one for each part, or group of parts, that touches
/// none of the others. Nothing where no part is a cutout: a region of many pieces is nothing unusual.
pub fn loose_parts(
    action: &Action,
    of: &[Ref<wants::Region>],
    parts: &[Arc<Region>],
    united: &[Polygon],
) -> Vec<Diagnostic> {
    if !has_cutout(action, of) || united.len() < 2 {
        return Vec::new();
    }
    let groups = touching(parts, united);
    let mut warnings = Vec::new();
    for (gap, [joined, n]) in gaps(parts, &groups) {
        let others = if parts.len() > 2 {
            format!("`{}` and the other parts", of[joined].name)
        } else {
            format!("`{}`", of[joined].name)
        };
        let message = format!(
            "`{}` does not touch {others}: a gap of {} is left from {} to {}",
            of[n].name,
            rounded(gap.width()),
            place(gap.from),
            place(gap.to),
        );
        let at = action.definition.field(&["union", &n.to_string()]);
        warnings.push(Diagnostic::warning(message).at(at, "lies apart"));
    }
    warnings
}

/// The gaps that have to be closed so that all groups hang together: the shortest ways from what hangs together with the
/// first part to the group that is nearest to it, one after another (Prim, 1957). With the parts between which each is, the
/// one that is new last.
fn gaps(parts: &[Arc<Region>], groups: &[usize]) -> Vec<(Gap, [usize; 2])> {
    let area = |group: usize| -> Vec<Polygon> {
        let own = parts.iter().zip(groups).filter(|(_, g)| **g == group);
        own.flat_map(|(part, _)| part.area.iter().cloned())
            .collect()
    };
    let mut left: Vec<usize> = (1..groups.len()).filter(|n| groups[*n] == *n).collect();
    let mut best: BTreeMap<usize, (Gap, usize)> = BTreeMap::new();
    let (mut new, mut found) = (0, Vec::new());
    while !left.is_empty() {
        let joined = area(new);
        for group in &left {
            let Some(gap) = polygon::gap(&area(*group), &joined) else {
                continue;
            };
            let is_nearer = |(known, _): &(Gap, usize)| gap.width() < known.width();
            if best.get(group).is_none_or(is_nearer) {
                best.insert(*group, (gap, new));
            }
        }
        let width = |group: &usize| {
            best.get(group)
                .map_or(f64::INFINITY, |(gap, _)| gap.width())
        };
        let Some(nearest) = left
            .iter()
            .copied()
            .min_by(|a, b| width(a).total_cmp(&width(b)))
        else {
            break;
        };
        left.retain(|group| *group != nearest);
        if let Some((gap, from)) = best.remove(&nearest) {
            found.push((gap, [from, nearest]));
        }
        new = nearest;
    }
    found.sort_by_key(|(_, [_, n])| *n);
    found
}

/// A warning where an area that is made of a cutout touches itself: what holds together at a point only has no number of
/// pieces that anything can be made in.
pub fn touching_itself(
    action: &Action,
    of: &[Ref<wants::Region>],
    area: &[Polygon],
) -> Option<Diagnostic> {
    if !has_cutout(action, of) {
        return None;
    }
    let TopologyError::Touching(at) = topology::count(area).err()? else {
        return None;
    };
    let message = format!("the outline touches itself at {}", place(at));
    let warning = Diagnostic::warning(message).at(action.span(), "in this region");
    Some(warning.help("whether parts that touch at a point hold together is left to chance"))
}

/// An error where two of the parts lie on no common plane: what is laid on a surface, or runs along a curve in space, is
/// unrolled for itself, and says nothing of where the other one is.
///
/// # Errors
/// The first such pair.
pub fn check_plane(action: &Action, of: &[Ref<wants::Region>]) -> Result<(), Vec<Diagnostic>> {
    let mut unrolled: Option<(&Ref<wants::Region>, &Carrier)> = None;
    for part in of {
        let carrier = match action.value(part) {
            Value::Data(Data::Cutout(cutout)) if !cutout.is_in_place() => &cutout.carrier,
            _ => continue,
        };
        let Some((first, known)) = unrolled else {
            unrolled = Some((part, carrier));
            continue;
        };
        let is_common = match (known, carrier) {
            (Carrier::Strip(a), Carrier::Strip(b)) => a == b,
            (Carrier::Ring { ribbon: a, .. }, Carrier::Ring { ribbon: b, .. }) => a == b,
            _ => false,
        };
        if !is_common {
            let message = format!(
                "`{}` and `{}` are each unrolled about a middle of their own, and have no common plane",
                first.name, part.name
            );
            let error = Diagnostic::error(message).at(action.span(), "in this region");
            return Err(vec![error.help(
                "combine the regions that they are made from, and `wrap` the result; \
                 or use one after the other, as in a `carve` for each and their `intersection`",
            )]);
        }
    }
    Ok(())
}

fn has_cutout(action: &Action, of: &[Ref<wants::Region>]) -> bool {
    let is_cutout = |reference| matches!(action.value(reference), Value::Data(Data::Cutout(_)));
    of.iter().any(is_cutout)
}

/// For every part the first of those that it hangs together with in `united`.
fn touching(parts: &[Arc<Region>], united: &[Polygon]) -> Vec<usize> {
    let boxes: Vec<Extent<2>> = united.iter().map(|p| p.bounds().into()).collect();
    let tree = BoxTree::new(&boxes);
    let piece_at = |p: Point| {
        let near = tree.meeting(&Extent::from([p.x, p.y]));
        near.into_iter().find(|n| united[*n as usize].contains(p))
    };
    let mut sets = UnionFind::new(parts.len());
    let mut owner: BTreeMap<u32, u32> = BTreeMap::new();
    for (n, part) in (0..).zip(parts) {
        for piece in part
            .area
            .iter()
            .filter_map(inner_point)
            .filter_map(piece_at)
        {
            sets.unite(*owner.entry(piece).or_insert(n), n);
        }
    }
    let roots: Vec<u32> = (0..parts.len() as u32).map(|n| sets.find(n)).collect();
    let first = |root: &u32| roots.iter().position(|other| other == root);
    roots.iter().filter_map(first).collect()
}

/// A point inside: the middle of the widest stretch of a level line half way between two corners.
fn inner_point(polygon: &Polygon) -> Option<Point> {
    let mut levels: Vec<f64> = polygon.outer.iter().map(|p| p.y).collect();
    levels.sort_unstable_by(f64::total_cmp);
    let tallest = levels
        .windows(2)
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    let y = 0.5 * (tallest[0] + tallest[1]);
    let mut crossings: Vec<f64> = Vec::new();
    for ring in polygon.rings() {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if (a.y > y) != (b.y > y) {
                crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
        }
    }
    crossings.sort_unstable_by(f64::total_cmp);
    let stretches = crossings.chunks_exact(2);
    let widest = stretches.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    Some(Point::new(0.5 * (widest[0] + widest[1]), y))
}

fn place(p: Point) -> String {
    format!("({}, {})", rounded(p.x), rounded(p.y))
}

/// A length for people, to three digits after the point.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, side: f64) -> Arc<Region> {
        let corner = Point::new(x, 0.0);
        Region::rectangle(corner, corner + Point::new(side, side)).into()
    }

    #[test]
    fn parts_that_meet_are_one_group() {
        let parts = [
            square(0.0, 2.0),
            square(5.0, 2.0),
            square(1.0, 2.0),
            square(6.0, 3.0),
        ];
        let all: Vec<Polygon> = parts.iter().flat_map(|p| p.area.clone()).collect();
        let united = polygon::unite(&all).unwrap();
        assert_eq!(touching(&parts, &united), [0, 1, 0, 1]);
    }

    #[test]
    fn a_point_inside_is_in_no_hole() {
        let frame = polygon::subtract(&square(0.0, 9.0).area, &square(1.0, 7.9).area).unwrap();
        let point = inner_point(&frame[0]).unwrap();
        assert!(frame[0].contains(point));
    }
}
