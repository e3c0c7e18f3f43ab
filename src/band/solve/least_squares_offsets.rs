//! Where the pieces stand across the curve in the end (Zhou 2014, section 4.1): near their best
//! alignment, but without the drift that it adds up to. How the outlines are then joined is in
//! `realize`.

use crate::exemplar::seam::Seam;

/// The offsets δ of the pieces of a sequence: argmin Σ M (δ_i + τ_i - δ_(i+1))², where M is the
/// number of endpoints at the seam and the first and the last offset are 0. A loop has no first
/// piece: there, 0 is midway between the lowest and the highest offset. `seams` holds the seam
/// after each piece with its M, and for a loop also the one that closes it.
///
/// On a path the normal equations have an explicit solution: M times the misfit is the same at all
/// seams, so that each seam takes its share 1/M of what the rises add up to. Where a seam joins no
/// portals, the parts beside it are independent. Such a part keeps the first or the last piece at 0
/// if it has one of them; otherwise it is centred.
pub fn least_squares_offsets(seams: &[(Seam, usize)], pieces: usize, closed: bool) -> Vec<f64> {
    let mut offsets = vec![0.0; pieces];
    let loose = |k: usize| seams[k].1 == 0;
    if let Some(broken) = (closed && !seams.is_empty())
        .then(|| (0..pieces).find(|&k| loose(k)))
        .flatten()
    {
        // A loop that is open somewhere is laid out from that place.
        let order: Vec<usize> = (0..pieces).map(|i| (broken + 1 + i) % pieces).collect();
        for part in order.chunk_by(|&a, _| !loose(a)) {
            align(seams, part, &mut offsets);
            centre(part, &mut offsets);
        }
        return offsets;
    }
    if closed {
        share_out(seams, pieces, &mut offsets);
        let (low, high) = offsets.iter().fold((0.0f64, 0.0f64), |(low, high), &d| {
            (low.min(d), high.max(d))
        });
        offsets.iter_mut().for_each(|d| *d -= 0.5 * (low + high));
        return offsets;
    }
    let order: Vec<usize> = (0..pieces).collect();
    let parts: Vec<&[usize]> = order.chunk_by(|&a, _| !loose(a)).collect();
    let last = parts.len().saturating_sub(1);
    for (i, part) in parts.iter().enumerate() {
        if last == 0 {
            share_out(&seams[..pieces - 1], pieces, &mut offsets);
            continue;
        }
        align(seams, part, &mut offsets);
        if i == last {
            let end = part.last().map_or(0.0, |&k| offsets[k]);
            part.iter().for_each(|&k| offsets[k] -= end);
        } else if i > 0 {
            centre(part, &mut offsets);
        }
    }
    offsets
}

/// The offsets of pieces that are all joined: the sum of the rises is taken back in shares of 1/M.
fn share_out(seams: &[(Seam, usize)], pieces: usize, offsets: &mut [f64]) {
    let total: f64 = seams.iter().map(|s| s.0.rise).sum();
    let shares: f64 = seams.iter().map(|s| 1.0 / s.1 as f64).sum();
    for k in 1..pieces {
        let (seam, m) = seams[k - 1];
        offsets[k] = offsets[k - 1] + seam.rise - total / shares / m as f64;
    }
}

/// The offsets of a part where each piece has its best alignment with the one before it.
fn align(seams: &[(Seam, usize)], part: &[usize], offsets: &mut [f64]) {
    for w in part.windows(2) {
        offsets[w[1]] = offsets[w[0]] + seams[w[0]].0.rise;
    }
}

/// Moves a part so that its mean offset is 0.
fn centre(part: &[usize], offsets: &mut [f64]) {
    let mean = part.iter().map(|&k| offsets[k]).sum::<f64>() / part.len() as f64;
    part.iter().for_each(|&k| offsets[k] -= mean);
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    fn seam(rise: f64, m: usize) -> (Seam, usize) {
        (
            Seam {
                cost: 0.0,
                rise,
                gap: 0.0,
            },
            m,
        )
    }

    fn misfit(seams: &[(Seam, usize)], d: &[f64]) -> f64 {
        let at = |k: usize| d[k % d.len()];
        seams
            .iter()
            .enumerate()
            .map(|(k, (s, m))| *m as f64 * (at(k) + s.rise - at(k + 1)).powi(2))
            .sum()
    }

    #[test]
    fn no_other_offsets_fit_better() {
        let seed = Seed::root(3);
        for case in 0..20 {
            let s = seed.number(case);
            let closed = case % 2 == 1;
            let n = 7;
            let count = if closed { n } else { n - 1 };
            let seams: Vec<_> = (0..count as u64)
                .map(|k| {
                    seam(
                        s.range(k, -1.0, 2.0),
                        2 + 2 * (s.unit(k + 50) * 3.0) as usize,
                    )
                })
                .collect();
            let best = least_squares_offsets(&seams, n, closed);
            let (low, high) = best.iter().fold((f64::MAX, f64::MIN), |(low, high), &d| {
                (low.min(d), high.max(d))
            });
            assert!(if closed {
                (low + high).abs() < 1e-12
            } else {
                best[0] == 0.0 && best[n - 1].abs() < 1e-12
            });
            let least = misfit(&seams, &best);
            for k in 1..if closed { n } else { n - 1 } {
                for step in [-1e-3, 1e-3] {
                    let mut other = best.clone();
                    other[k] += step;
                    assert!(misfit(&seams, &other) > least);
                }
            }
        }
    }

    #[test]
    fn parts_that_nothing_joins_are_independent() {
        let seams = [
            seam(1.0, 2),
            seam(0.0, 0),
            seam(2.0, 2),
            seam(0.0, 0),
            seam(4.0, 2),
        ];
        let offsets = |pieces, closed| least_squares_offsets(&seams, pieces, closed);
        assert_eq!(offsets(6, false), [0.0, 1.0, -1.0, 1.0, -4.0, 0.0]);
        assert_eq!(offsets(5, true), [1.0, 2.0, -1.0, 1.0, -3.0]);
    }
}
