//! Curves of maps that run along one another: as edges of a planar map they have the labels of all of them, and are drawn
//! with these. Which of equal lines is drawn in the end is decided where a sheet is made ready.

use std::borrow::Cow;

use super::page::Page;
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::uncovered;
use fretwork_geometry::{CurveLabels, Curves, LabelSet, Point, along_others};

/// The curves, of which those parts that lie on others with other labels are curves of their own, before all others and once,
/// with the labels of all that lie there. Curves along no such part stay as they are, and so do all where the plane is not
/// that of a map: in a drawing the first of two lines hides the other.
///
/// # Errors
/// When they form no planar map.
pub(crate) fn united<'a>(
    curves: &'a Curves,
    page: &Page<'_>,
) -> Result<Cow<'a, Curves>, Diagnostic> {
    let labels: Vec<LabelSet> = curves.iter().map(|curve| curve.labels.edge).collect();
    if page.plane.is_none() || labels.iter().all(|other| *other == labels[0]) {
        return Ok(Cow::Borrowed(curves));
    }
    let resolution = page.resolution(curves.bounds());
    let is_other = |a: u32, b: u32| labels[a as usize] != labels[b as usize];
    let lines = curves.iter().map(|curve| curve.points);
    let is_along = along_others(lines, resolution, is_other);
    let some = curves.filtered(|number, _| is_along[number]);
    let (mut lines, labels) = shared(&some, page)?;
    if lines.is_empty() {
        return Ok(Cow::Borrowed(curves));
    }
    let mut all = Curves::new();
    for (line, labels) in lines.iter().zip(labels) {
        all.push(line.iter().copied(), CurveLabels::edge(labels));
    }
    let count = lines.len();
    lines.extend(some.iter().map(|curve| curve.points.to_vec()));
    let mut left = uncovered(&lines, resolution).into_iter().skip(count);
    for (curve, is_along) in curves.iter().zip(is_along) {
        let left = is_along.then(|| left.next()).flatten().flatten();
        match left {
            Some(pieces) => pieces
                .into_iter()
                .for_each(|piece| all.push(piece, curve.labels)),
            None => all.push(curve.points.iter().copied(), curve.labels),
        }
    }
    Ok(Cow::Owned(all))
}

/// The edges of the planar map of curves along which several of them run, with the labels of all of these where one lacks some.
fn shared(
    curves: &Curves,
    page: &Page<'_>,
) -> Result<(Vec<Vec<Point>>, Vec<LabelSet>), Diagnostic> {
    if curves.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let map = page.planar_map(curves)?;
    let own: Vec<_> = curves.iter().map(|curve| curve.labels.edge).collect();
    let is_shared = |edge: &_| {
        let all = map.labels(*edge).edge;
        map.sources(*edge)
            .any(|source| own[source.curve as usize] != all)
    };
    let edges = map.edges().filter(is_shared);
    let told = edges.map(|edge| (map.points(edge).collect(), map.labels(edge).edge));
    Ok(told.unzip())
}
