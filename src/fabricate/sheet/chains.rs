//! Lines joined at common ends into long ones, so that a machine lifts its tool seldom.

use std::collections::HashMap;

use super::fixed_point::Cell;
use super::lines::is_closed;
use fretwork_geometry::Point;

/// The lines joined at common ends into trails, each going on as straight as it can. Closed lines
/// stay as they are.
pub fn chained(lines: Vec<Vec<Cell>>) -> Vec<Vec<Cell>> {
    let (mut chains, open): (Vec<_>, Vec<_>) = lines.into_iter().partition(|line| is_closed(line));
    let mut ends: HashMap<Cell, Vec<usize>> = HashMap::new();
    let mut order: Vec<Cell> = Vec::new();
    for (i, line) in open.iter().enumerate() {
        for end in [line[0], line[line.len() - 1]] {
            ends.entry(end)
                .or_insert_with(|| (order.push(end), Vec::new()).1)
                .push(i);
        }
    }
    let mut net = Net { open, ends };
    // A trail that begins where an odd number of ends meet leaves an even number there.
    for odd in [true, false] {
        for &start in &order {
            while net.ends[&start].len() % 2 == usize::from(odd) && !net.ends[&start].is_empty() {
                chains.push(net.trail(start));
            }
        }
    }
    chains
}

/// Open lines and which of them end where.
struct Net {
    open: Vec<Vec<Cell>>,
    ends: HashMap<Cell, Vec<usize>>,
}

impl Net {
    /// Takes a trail from `start` as far as it goes.
    fn trail(&mut self, start: Cell) -> Vec<Cell> {
        let mut trail = vec![start];
        while let Some(i) = self.straightest(&trail) {
            let mut line = std::mem::take(&mut self.open[i]);
            for end in [line[0], line[line.len() - 1]] {
                let here = self.ends.get_mut(&end).expect("every end is in the net");
                here.remove(
                    here.iter()
                        .position(|&j| j == i)
                        .expect("a line is at both its ends"),
                );
            }
            if Some(&line[0]) != trail.last() {
                line.reverse();
            }
            trail.extend_from_slice(&line[1..]);
        }
        trail
    }

    /// The line at the end of the trail that turns least from it.
    fn straightest(&self, trail: &[Cell]) -> Option<usize> {
        let at = trail[trail.len() - 1];
        let here = &self.ends[&at];
        let Some(&before) = trail.len().checked_sub(2).and_then(|i| trail.get(i)) else {
            return here.first().copied();
        };
        let ahead = direction(before, at);
        let turn = |i: &usize| {
            let line = &self.open[*i];
            let next = if line[0] == at {
                line[1]
            } else {
                line[line.len() - 2]
            };
            -ahead.dot(direction(at, next))
        };
        here.iter()
            .copied()
            .min_by(|i, j| turn(i).total_cmp(&turn(j)).then(i.cmp(j)))
    }
}

fn direction(from: Cell, to: Cell) -> Point {
    let d = Point::new((to.0 - from.0) as f64, (to.1 - from.1) as f64);
    d * (1.0 / d.length())
}

/// The line without corners at which it does not turn at all.
pub fn straightened(line: Vec<Cell>) -> Vec<Cell> {
    let mut out: Vec<Cell> = Vec::with_capacity(line.len());
    for p in line {
        if let [.., a, b] = out[..]
            && on_the_way(a, b, p)
        {
            out.pop();
        }
        out.push(p);
    }
    out
}

/// Whether `b` lies on the segment from `a` to `c`.
fn on_the_way(a: Cell, b: Cell, c: Cell) -> bool {
    let wide = |p: Cell, q: Cell| (i128::from(q.0 - p.0), i128::from(q.1 - p.1));
    let ((ux, uy), (vx, vy)) = (wide(a, b), wide(b, c));
    ux * vy == uy * vx && ux * vx + uy * vy > 0
}
