//! Curves of maps that run along one another: as edges of a planar map they have the labels of all of them, and are drawn
//! with these. Which of equal lines is drawn in the end is decided where a sheet is made ready.

use std::borrow::Cow;

use super::page::Page;
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::uncovered;
use fretwork_geometry::{CurveLabels, Curves, Point};

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
    let mut labels = curves.iter().map(|curve| curve.labels.edge);
    let first = labels.next();
    if page.plane.is_none() || labels.all(|other| Some(other) == first) {
        return Ok(Cow::Borrowed(curves));
    }
    let map = page.planar_map(curves)?;
    let own: Vec<_> = curves.iter().map(|curve| curve.labels.edge).collect();
    let is_united = |edge: &_| {
        let all = map.labels(*edge).edge;
        map.sources(*edge)
            .any(|source| own[source.curve as usize] != all)
    };
    let mut lines: Vec<Vec<Point>> = Vec::new();
    let mut labels = Vec::new();
    for edge in map.edges().filter(is_united) {
        lines.push(map.points(edge).collect());
        labels.push(map.labels(edge).edge);
    }
    if lines.is_empty() {
        return Ok(Cow::Borrowed(curves));
    }
    let count = lines.len();
    lines.extend(curves.iter().map(|curve| curve.points.to_vec()));
    let left = uncovered(&lines, page.resolution(curves.bounds()));
    let mut all = Curves::new();
    for (line, labels) in lines.iter().zip(labels) {
        all.push(line.iter().copied(), CurveLabels::edge(labels));
    }
    for (left, curve) in left.into_iter().skip(count).zip(curves.iter()) {
        match left {
            None => all.push(curve.points.iter().copied(), curve.labels),
            Some(pieces) => pieces
                .into_iter()
                .for_each(|piece| all.push(piece, curve.labels)),
        }
    }
    Ok(Cow::Owned(all))
}
