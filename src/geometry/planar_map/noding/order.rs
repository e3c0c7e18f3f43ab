//! Sorting sites by place.

use crate::planar_map::noding::exact::before;
use crate::planar_map::noding::snap_grid::Site;
use crate::planar_map::parallel::accumulate;

/// The sites and their indices in reading order. They are spread over as many strips as there are
/// sites first, so that hardly any sorting is left.
pub(in crate::planar_map) fn in_reading_order(sites: &[Site]) -> Vec<(Site, u32)> {
    let (low, high) = sites.iter().fold((f64::INFINITY, 0.0f64), |(l, h), s| {
        (l.min(s[1]), h.max(s[1]))
    });
    let scale = sites.len() as f64 / (high - low + 1.0);
    let strip = |s: &Site| ((s[1] - low) * scale) as usize;
    let mut starts = vec![0u32; sites.len() + 1];
    sites.iter().for_each(|s| starts[strip(s)] += 1);
    accumulate(&mut starts);
    let mut order = vec![([0.0; 2], 0); sites.len()];
    for (i, s) in sites.iter().enumerate().rev() {
        let start = &mut starts[strip(s)];
        *start -= 1;
        order[*start as usize] = (*s, i as u32);
    }
    for w in starts.windows(2).filter(|w| w[1] - w[0] > 1) {
        order[w[0] as usize..w[1] as usize].sort_unstable_by(|p, q| before(p.0, q.0));
    }
    order
}
