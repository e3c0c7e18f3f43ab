//! Polylines as they are cut up and put together.

use super::layer::Item;
use fretwork_geometry::{Point, Polygon};

/// Whether the polyline ends where it began and goes somewhere in between.
pub fn is_closed<P: PartialEq>(line: &[P]) -> bool {
    line.len() > 2 && line.first() == line.last()
}

/// The outlines of an item as polylines; those of an area are closed, the outer one last.
pub fn outlines(item: &Item) -> Vec<Vec<Point>> {
    match item {
        Item::Line(points) => vec![points.clone()],
        Item::Area(polygon) => rings(polygon).collect(),
    }
}

/// The rings of a polygon as closed polylines, the outer one last: a machine that follows them in
/// this order cuts holes while they still are in one piece with the sheet.
pub fn rings(polygon: &Polygon) -> impl Iterator<Item = Vec<Point>> {
    let rings = polygon.holes.iter().chain([&polygon.outer]);
    rings.map(|ring| ring.iter().chain(ring.first()).copied().collect())
}

/// Cuts a polyline: `keep` gives the parts of a segment that stay, in order, and those that meet
/// end to end become one piece, across the start of a closed polyline too.
pub fn cut<P: Copy + PartialEq>(
    line: &[P],
    mut keep: impl FnMut(P, P, &mut Vec<(P, P)>),
) -> Vec<Vec<P>> {
    let mut pieces: Vec<Vec<P>> = Vec::new();
    let mut parts = Vec::new();
    for w in line.windows(2) {
        parts.clear();
        keep(w[0], w[1], &mut parts);
        for &(from, to) in &parts {
            match pieces.last_mut() {
                Some(piece) if piece.last() == Some(&from) => piece.push(to),
                _ => pieces.push(vec![from, to]),
            }
        }
    }
    let start = line.first().copied();
    if is_closed(line)
        && pieces.len() > 1
        && pieces.first().and_then(|p| p.first()).copied() == start
        && pieces.last().and_then(|p| p.last()).copied() == start
        && let Some(mut last) = pieces.pop()
    {
        last.extend_from_slice(&pieces[0][1..]);
        pieces[0] = last;
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_line_stays_whole_across_its_start() {
        let pieces = cut(&[0, 1, 2, 3, 0], |a, b, parts| {
            if (a, b) != (1, 2) {
                parts.push((a, b));
            }
        });
        assert_eq!(pieces, [[2, 3, 0, 1]]);
        let whole = cut(&[0, 1, 2, 0], |a, b, parts| parts.push((a, b)));
        assert_eq!(whole, [[0, 1, 2, 0]]);
        assert_eq!(cut(&[5], |_: i32, _, _| {}), Vec::<Vec<i32>>::new());
    }
}
