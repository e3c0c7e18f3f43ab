//! Point location: which half-edge one meets first going from a site toward -x. What a face is,
//! is not known here.

use super::bins::{Bins, Cells};
use super::exact::{Segment, cross, orientation};
use super::lattice::Site;

/// The straight pieces of all edges in bins. Edges must not cross.
pub(super) struct Index {
    /// From the lower to the upper end; the half-edge that runs down along it.
    risers: Vec<(Site, Site, u32)>,
    bins: Option<Bins>,
}

impl Index {
    /// Sorts edges, given by their sites from source to target, into bins.
    pub fn build<E: Iterator<Item = Site>>(edges: impl Iterator<Item = E>) -> Index {
        let mut risers = Vec::new();
        for (edge, mut sites) in (0u32..).zip(edges) {
            let Some(mut a) = sites.next() else { continue };
            for b in sites {
                // A horizontal piece is never met.
                if a[1] < b[1] {
                    risers.push((a, b, 2 * edge + 1));
                } else if a[1] > b[1] {
                    risers.push((b, a, 2 * edge));
                }
                a = b;
            }
        }
        let segments: Vec<Segment> = risers.iter().map(|r| Segment::between(r.0, r.1).0).collect();
        let bins =
            (!segments.is_empty()).then(|| Bins::fill(Cells::suited(&segments), segments.len(), |i| segments[i]));
        Index { risers, bins }
    }

    /// The half-edge that has the points just to the left of `site` on its left, or rather those
    /// just above these: the first that one meets going toward -x. None when nothing is there.
    pub fn left_of(&self, site: Site) -> Option<u32> {
        let bins = self.bins.as_ref()?;
        let row = bins.cells.row(site[1]);
        let mut best: Option<u32> = None;
        for column in (0..=bins.cells.column(site[0])).rev() {
            for &i in bins.members(row * bins.cells.columns + column) {
                let (low, high, _) = self.risers[i as usize];
                let met = low[1] <= site[1] && site[1] < high[1] && orientation(low, high, site) < 0.0;
                if met && best.is_none_or(|b| self.is_right_of(i, b)) {
                    best = Some(i);
                }
            }
            if let Some(i) = best
                && self.abscissa(i, site[1]) > bins.cells.left(column) + 1.0
            {
                break;
            }
        }
        best.map(|i| self.risers[i as usize].2)
    }

    /// Whether of two pieces that reach over a common height the first is farther right there.
    fn is_right_of(&self, i: u32, j: u32) -> bool {
        let ((a, b, _), (c, d, _)) = (self.risers[i as usize], self.risers[j as usize]);
        if a[1] < c[1] {
            orientation(a, b, c) > 0.0
        } else {
            let side = orientation(c, d, a);
            let side = if side == 0.0 { cross([d[0] - c[0], d[1] - c[1]], [b[0] - a[0], b[1] - a[1]]) } else { side };
            side < 0.0
        }
    }

    /// Roughly where a piece is at a height.
    fn abscissa(&self, i: u32, y: f64) -> f64 {
        let (a, b, _) = self.risers[i as usize];
        a[0] + (y - a[1]) * ((b[0] - a[0]) / (b[1] - a[1]))
    }
}
