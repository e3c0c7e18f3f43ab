//! Point location: which half-edge one meets first going from a site toward -x. What a face is,
//! is not known here.

use crate::planar_map::noding::bins::{Bins, Cells};
use crate::planar_map::noding::exact::{Segment, cross, orientation};
use crate::planar_map::noding::snap_grid::Site;

/// The straight pieces of all edges in bins, without the horizontal ones, which nobody meets. Edges
/// must not cross.
pub(in crate::planar_map) struct Index {
    pieces: Vec<Segment>,
    /// The half-edge that runs down along every piece.
    down: Vec<u32>,
    bins: Option<Bins>,
}

impl Index {
    /// Sorts edges, given by their sites from source to target, into bins.
    pub fn build<E: Iterator<Item = Site>>(edges: impl Iterator<Item = E>) -> Index {
        let (mut pieces, mut down) = (Vec::new(), Vec::new());
        for (edge, mut sites) in (0u32..).zip(edges) {
            let Some(mut a) = sites.next() else { continue };
            for b in sites {
                if a[1] != b[1] {
                    let (piece, reversed) = Segment::between(a, b);
                    pieces.push(piece);
                    down.push(2 * edge + u32::from(!reversed));
                }
                a = b;
            }
        }
        let bins = (!pieces.is_empty())
            .then(|| Bins::fill(Cells::suited(&pieces), pieces.len(), |i| pieces[i]));
        Index { pieces, down, bins }
    }

    /// The half-edge that has the points just to the left of `site` on its left, or rather those
    /// just above these: the first that one meets going toward -x. None when nothing is there.
    pub fn left_of(&self, site: Site) -> Option<u32> {
        let bins = self.bins.as_ref()?;
        let row = bins.cells.row(site[1]);
        let mut best: Option<u32> = None;
        for column in (0..=bins.cells.column(site[0])).rev() {
            for &i in bins.members(row * bins.cells.columns + column) {
                if is_met(&self.pieces[i as usize], site)
                    && best.is_none_or(|b| {
                        is_right_of(&self.pieces[i as usize], &self.pieces[b as usize])
                    })
                {
                    best = Some(i);
                }
            }
            if let Some(i) = best
                && abscissa(&self.pieces[i as usize], site[1]) > bins.cells.left(column) + 1.0
            {
                break;
            }
        }
        best.map(|i| self.down[i as usize])
    }
}

/// The answers of [`Index::left_of`] for some sites by looking at every edge.
pub(in crate::planar_map) fn left_of_each<E: Iterator<Item = Site>>(
    sites: &[Site],
    edges: impl Iterator<Item = E>,
) -> Vec<Option<u32>> {
    let mut best: Vec<Option<(Segment, u32)>> = vec![None; sites.len()];
    if sites.is_empty() {
        return Vec::new();
    }
    for (edge, mut points) in (0u32..).zip(edges) {
        let Some(mut a) = points.next() else { continue };
        for b in points {
            for (site, best) in sites.iter().zip(&mut best) {
                if (a[1] <= site[1]) == (b[1] <= site[1]) {
                    continue;
                }
                let (piece, reversed) = Segment::between(a, b);
                if is_met(&piece, *site)
                    && best.is_none_or(|(other, _)| is_right_of(&piece, &other))
                {
                    *best = Some((piece, 2 * edge + u32::from(!reversed)));
                }
            }
            a = b;
        }
    }
    best.into_iter().map(|b| b.map(|b| b.1)).collect()
}

/// Whether a piece is passed going from just above `site` toward -x.
fn is_met(piece: &Segment, site: Site) -> bool {
    piece.a[1] <= site[1] && site[1] < piece.b[1] && orientation(piece.a, piece.b, site) < 0.0
}

/// Whether of two pieces that reach over a common height the first is farther right there.
fn is_right_of(p: &Segment, q: &Segment) -> bool {
    if p.a[1] < q.a[1] {
        orientation(p.a, p.b, q.a) > 0.0
    } else {
        let side = orientation(q.a, q.b, p.a);
        (if side == 0.0 {
            cross(q.delta(), p.delta())
        } else {
            side
        }) < 0.0
    }
}

/// Roughly where a piece is at a height.
fn abscissa(piece: &Segment, y: f64) -> f64 {
    let d = piece.delta();
    piece.a[0] + (y - piece.a[1]) * (d[0] / d[1])
}
