//! The outline of a pad: where round a sample the beams to its neighbours leave. Angles only; how large a
//! pad is, and where it lies, is decided in `frame`.

use std::f64::consts::{FRAC_PI_3, TAU};

/// Half the widest angle that one beam takes of a pad's outline. With more the two nodes of its side and
/// the middle would come to lie on a line, and the wedge between them would be flat.
const WIDEST: f64 = FRAC_PI_3;
/// The least angle between two beams, as a part of the angle that each would have if all were spread
/// evenly: wedges that are thinner are stiff to no purpose.
const LEAST: f64 = 0.4;

/// The corners of a pad and which of them are whose.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    /// The angles of the corners, each less than the next by 2π/3 at most, which holds from the last to the
    /// first, too; at least three.
    pub corners: Vec<f64>,
    /// For each neighbour the corners to the right and to the left of its beam, seen from the pad.
    pub sides: Vec<[usize; 2]>,
}

/// The outline for neighbours in these directions. It goes all the way round whatever they are, so that a
/// pad with one neighbour, or two on a line, is no hinge: the paper's wedges between one neighbour and the
/// next would be missing there, or flat.
pub(super) fn ring(angles: &[f64]) -> Ring {
    if angles.is_empty() {
        let corners = vec![0.0, TAU / 3.0, 2.0 * TAU / 3.0];
        return Ring {
            corners,
            sides: Vec::new(),
        };
    }
    let mut order: Vec<usize> = (0..angles.len()).collect();
    order.sort_by(|&a, &b| angles[a].total_cmp(&angles[b]).then(a.cmp(&b)));
    let sorted: Vec<f64> = order.iter().map(|i| angles[*i]).collect();
    let (start, gaps) = spread(&sorted);
    let mut corners = Vec::new();
    let mut sides = vec![[0; 2]; angles.len()];
    let mut at = start;
    for (k, gap) in gaps.iter().enumerate() {
        let (this, next) = (order[k], order[(k + 1) % order.len()]);
        sides[this][1] = corners.len();
        if *gap <= 2.0 * WIDEST {
            corners.push(at + gap / 2.0);
        } else {
            let rest = gap - 2.0 * WIDEST;
            let pieces = (rest / (2.0 * WIDEST)).ceil().max(1.0);
            let corner = |i: usize| at + WIDEST + rest * i as f64 / pieces;
            corners.extend((0..=pieces as usize).map(corner));
        }
        sides[next][0] = corners.len() - 1;
        at += gap;
    }
    Ring { corners, sides }
}

/// Ascending angles pushed apart: the first of them, and the gap behind each. Each gap is mixed with the even
/// one, as little as makes all wide enough, and the whole is turned back so that it has not moved on average.
fn spread(sorted: &[f64]) -> (f64, Vec<f64>) {
    let n = sorted.len();
    let even = TAU / n as f64;
    let next = |k: usize| {
        if k + 1 < n {
            sorted[k + 1]
        } else {
            sorted[0] + TAU
        }
    };
    let gaps: Vec<f64> = (0..n).map(|k| next(k) - sorted[k]).collect();
    let least = LEAST * even;
    let narrow = gaps.iter().filter(|gap| **gap < least);
    let part = narrow
        .map(|gap| (least - gap) / (even - gap))
        .fold(0.0, f64::max);
    let gaps: Vec<f64> = gaps.iter().map(|gap| gap + (even - gap) * part).collect();
    let mut at = sorted[0];
    let mut moved = 0.0;
    for (angle, gap) in sorted.iter().zip(&gaps) {
        moved += at - angle;
        at += gap;
    }
    (sorted[0] - moved / n as f64, gaps)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(angles: &[f64]) {
        let ring = ring(angles);
        let n = ring.corners.len();
        assert!(n >= 3);
        let least = LEAST * TAU / angles.len().max(1) as f64;
        for k in 0..n {
            let next = if k + 1 < n {
                ring.corners[k + 1]
            } else {
                ring.corners[0] + TAU
            };
            let span = next - ring.corners[k];
            assert!(span <= 2.0 * WIDEST + 1e-9, "{angles:?}: {span}");
            assert!(span >= 0.5 * least.min(WIDEST), "{angles:?}: {span}");
        }
        for [right, left] in &ring.sides {
            assert_eq!((right + 1) % n, *left, "{angles:?}");
        }
    }

    #[test]
    fn goes_round_whatever_the_neighbours() {
        check(&[]);
        check(&[1.0]);
        check(&[0.0, std::f64::consts::PI]);
        check(&[0.0, 0.0]);
        check(&[0.3, 0.3, 0.3, 0.3, 0.3]);
        check(&[-3.0, 3.1, 0.0, 0.01]);
        check(&[2.0, -2.0, 0.5, 1.0, -0.5, -1.0, 3.0]);
    }

    #[test]
    fn even_neighbours_share_corners() {
        let angles: Vec<f64> = (0..6).map(|k| f64::from(k) * FRAC_PI_3).collect();
        let ring = ring(&angles);
        assert_eq!(ring.corners.len(), 6);
        assert!((ring.corners[0] - FRAC_PI_3 / 2.0).abs() < 1e-12);
        assert_eq!(ring.sides[1], [0, 1]);
    }
}
