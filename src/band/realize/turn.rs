//! Outlines are turned near a seam until the tangents of both pieces agree there, by linear
//! rotation-invariant deformation (Lipman et al. 2005; Zhou 2014, section 4.2).

use fretwork_geometry::Point;

use super::placed::Placed;
use crate::exemplar::piece::Side;

/// Outlines turn over this many mean portal widths. Over a shorter way the turn itself looks like a
/// kink; over a longer one it changes ornament that has nothing to do with the seam.
const REACH: f64 = 1.5;
/// How many edges a turn is spread over. With fewer the turn shows corners of its own.
const TURN_STEPS: f64 = 8.0;
/// Tangents that differ by more than this, 69 degrees, are a corner of the ornament, and stay. A
/// greater turn also bulges outlines so far that they meet their neighbours.
const LARGEST_TURN: f64 = 1.2;
/// Half angles below this are none.
const LEAST_TURN: f64 = 1e-9;

/// Makes the tangents of the pieces `a` and `b` agree at their seam. `shared` holds the places of
/// the endpoints there.
pub fn turn(placed: &mut [Placed], a: usize, b: usize, shared: &[f64]) {
    let portals = shared.len() / 2;
    let mean = shared.chunks(2).map(|p| p[1] - p[0]).sum::<f64>() / portals.max(1) as f64;
    for port in 0..shared.len() as u16 {
        let (Some(before), Some(after)) = (
            outline(&placed[a], Side::Right, port),
            outline(&placed[b], Side::Left, port),
        ) else {
            continue;
        };
        let (d, e) = (heading(&placed[a], before), heading(&placed[b], after));
        // Each side turns by half the angle from the one to the other.
        let half = 0.5 * libm::atan2(d.cross(e), d.dot(e));
        if half.abs() > LEAST_TURN && half.abs() < 0.5 * LARGEST_TURN {
            bend(
                &mut placed[a].chains[before.0].points,
                before.1,
                half,
                REACH * mean,
            );
            bend(
                &mut placed[b].chains[after.0].points,
                after.1,
                -half,
                REACH * mean,
            );
        }
    }
}

/// The chain that begins or ends at this port, and whether it ends there.
fn outline(placed: &Placed, side: Side, port: u16) -> Option<(usize, bool)> {
    placed.chains.iter().enumerate().find_map(|(i, c)| {
        match (c.from == (side, port), c.to == (side, port)) {
            (true, _) => Some((i, false)),
            (_, true) => Some((i, true)),
            _ => None,
        }
    })
}

/// The direction of a chain at one of its ends, toward larger u.
fn heading(placed: &Placed, (chain, at_end): (usize, bool)) -> Point {
    let points = &placed.chains[chain].points;
    let n = points.len();
    let d = if at_end {
        points[n - 1] - points[n - 2]
    } else {
        points[1] - points[0]
    };
    let forward = if d.x < 0.0 { -d } else { d };
    forward * (1.0 / forward.length())
}

/// Turns a polyline by `angle` at one end, over `reach` at most. Both ends stay where they are, and
/// so does what is farther away.
///
/// Linear rotation-invariant deformation solves two systems, first for frames and then for
/// positions. Its handles are here the two ends of the part that turns, at s = 0 and s = 1 along
/// it. Among the rotations a(s) that are `angle` at s = 0 and 0 at s = 1 and that move neither end,
/// the one with the least sum of squared differences is a(s) = angle·(1 - s)(1 - 3 s). On an open
/// polyline that is all there is to solve.
fn bend(points: &mut Vec<Point>, at_end: bool, angle: f64, reach: f64) {
    if at_end {
        points.reverse();
        bend(points, false, angle, reach);
        points.reverse();
        return;
    }
    let total: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    let reach = reach.min(0.5 * total);
    let mut part = resampled(points, reach);
    let edges: Vec<Point> = part.windows(2).map(|w| w[1] - w[0]).collect();
    let mut at = 0.0;
    let mut moved = vec![part[0]];
    for edge in &edges {
        let length = edge.length();
        let s = (at + 0.5 * length) / reach;
        let a = angle * (1.0 - s) * (1.0 - 3.0 * s);
        let (sin, cos) = (libm::sin(a), libm::cos(a));
        let turned = Point::new(edge.x * cos - edge.y * sin, edge.x * sin + edge.y * cos);
        moved.push(moved[moved.len() - 1] + turned);
        at += length;
    }
    // The end is off by a rest of second order, which is spread evenly.
    let last = part.len() - 1;
    let rest = part[last] - moved[last];
    let mut at = 0.0;
    for (i, edge) in edges.iter().enumerate() {
        at += edge.length();
        part[i + 1] = moved[i + 1] + rest * (at / reach).min(1.0);
    }
    let mut sum = 0.0;
    let kept = points.windows(2).position(|w| {
        sum += w[0].distance(w[1]);
        sum > reach
    });
    let kept = kept.map_or(points.len(), |i| i + 1);
    points.splice(..kept, part);
}

/// The beginning of a polyline up to the length `reach`, in edges short enough to turn.
fn resampled(points: &[Point], reach: f64) -> Vec<Point> {
    let mut part = vec![points[0]];
    let mut left = reach;
    for w in points.windows(2) {
        let length = w[0].distance(w[1]);
        if left <= 0.0 || length == 0.0 {
            continue;
        }
        let end = w[0].lerp(w[1], (left / length).min(1.0));
        let steps = (length.min(left) / reach * TURN_STEPS).ceil().max(1.0) as usize;
        part.extend((1..=steps).map(|i| w[0].lerp(end, i as f64 / steps as f64)));
        left -= length;
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bending_turns_one_end_and_keeps_both() {
        let line: Vec<Point> = (0..=20).map(|i| Point::new(f64::from(i), 0.0)).collect();
        let mut bent = line.clone();
        bend(&mut bent, false, 0.3, 6.5);
        let n = bent.len();
        assert_eq!(
            (bent[0], bent[n - 1], bent[n - 2]),
            (line[0], line[20], line[19])
        );
        let d = bent[1] - bent[0];
        assert!((libm::atan2(d.y, d.x) - 0.3).abs() < 0.1);
        let turns = bent
            .windows(3)
            .map(|w| (w[1] - w[0]).cross(w[2] - w[1]).abs());
        assert!(turns.fold(0.0, f64::max) < 0.15, "no corner");
        assert!(bent.windows(2).all(|w| w[0].distance(w[1]) > 1e-6));
        let mut other = line.clone();
        bend(&mut other, true, 0.3, 6.5);
        assert_eq!(other[0], line[0]);
        assert!(other[other.len() - 2].y < 0.0);
    }
}
