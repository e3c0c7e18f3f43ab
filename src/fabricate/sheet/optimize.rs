//! Lines chained and ordered, so that a machine lifts its tool seldom and travels little.

use std::collections::HashMap;

use super::fixed_point::{self, Cell};
use super::layer::{Item, Layer, Sheet};
use super::lines::{is_closed, outlines};
use super::slabs::{Edge, Slabs};
use super::style::Role;
use super::travel_order;
use fretwork_geometry::Point;

/// The sheet with the lines of every layer that is not filled chained into long ones and ordered
/// for short travel from the corner of least coordinates. On layers that are cut, what lies inside
/// a closed line comes before it: a part is cut out last. The set of segments stays the same, but
/// for corners that lie exactly on a straight line, which are left out. O(n log n) for n points.
pub fn optimize(sheet: &Sheet) -> Sheet {
    let home = fixed_point::cell(sheet.page_mm().min, 1.0);
    let layers = sheet.layers.iter().map(|layer| match layer.style.fill {
        Some(_) => layer.clone(),
        None => optimize_layer(layer, sheet.unit_mm, home),
    });
    Sheet {
        layers: layers.collect(),
        ..sheet.clone()
    }
}

fn optimize_layer(layer: &Layer, unit_mm: f64, home: Cell) -> Layer {
    let cells = |line: Vec<Point>| {
        let mut cells: Vec<Cell> = line
            .iter()
            .map(|&p| fixed_point::cell(p, unit_mm))
            .collect();
        cells.dedup();
        cells
    };
    let lines = layer
        .items
        .iter()
        .flat_map(outlines)
        .map(cells)
        .filter(|line| line.len() > 1)
        .collect();
    let chains: Vec<Vec<Cell>> = chained(lines).into_iter().map(straightened).collect();
    let depths = if layer.role == Role::Cut {
        depths(&chains)
    } else {
        vec![0; chains.len()]
    };
    let mut levels: Vec<Vec<Vec<Cell>>> = Vec::new();
    for (chain, depth) in chains.into_iter().zip(depths) {
        if levels.len() <= depth {
            levels.resize_with(depth + 1, Vec::new);
        }
        levels[depth].push(chain);
    }
    let mut at = home;
    let mut items = Vec::new();
    for level in levels.into_iter().rev() {
        for line in travel_order::ordered(level, at) {
            at = *line.last().expect("a chain has two points or more");
            items.push(Item::Line(
                line.into_iter()
                    .map(|c| fixed_point::point(c, unit_mm))
                    .collect(),
            ));
        }
    }
    Layer {
        items,
        ..layer.clone()
    }
}

/// The lines joined at common ends into trails, each going on as straight as it can. Closed lines
/// stay as they are.
fn chained(lines: Vec<Vec<Cell>>) -> Vec<Vec<Cell>> {
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
fn straightened(line: Vec<Cell>) -> Vec<Cell> {
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

/// Inside how many closed lines each line begins.
fn depths(lines: &[Vec<Cell>]) -> Vec<usize> {
    let plain = |c: Cell| Point::new(c.0 as f64, c.1 as f64);
    let closed = lines.iter().enumerate().filter(|(_, line)| is_closed(line));
    let edges = closed.flat_map(|(i, line)| {
        line.windows(2).map(move |w| Edge {
            a: plain(w[0]),
            b: plain(w[1]),
            outline: i as u32,
        })
    });
    let slabs = Slabs::new(edges.collect());
    let depth = |(i, line): (usize, &Vec<Cell>)| {
        let crossed = slabs
            .crossed(plain(line[0]))
            .map(|e| e.outline)
            .filter(|&o| o as usize != i);
        let mut crossed: Vec<u32> = crossed.collect();
        crossed.sort_unstable();
        crossed
            .chunk_by(|a, b| a == b)
            .filter(|run| run.len() % 2 == 1)
            .count()
    };
    lines.iter().enumerate().map(depth).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;
    use fretwork_geometry::Seed;
    use std::collections::BTreeMap;

    fn sheet(role: Role, lines: &[&[[f64; 2]]]) -> Sheet {
        let items = lines
            .iter()
            .map(|line| Item::Line(line.iter().map(|&p| p.into()).collect()))
            .collect();
        let layers = vec![Layer {
            name: "a".into(),
            role,
            style: Style::outline(0.1),
            items,
        }];
        Sheet {
            page: None,
            unit_mm: 1.0,
            layers,
        }
    }

    fn lines(sheet: &Sheet) -> Vec<Vec<[f64; 2]>> {
        sheet.layers[0]
            .items
            .iter()
            .map(|item| item.points().map(Into::into).collect())
            .collect()
    }

    #[test]
    fn straight_lines_are_joined_through_crossings() {
        let cross = sheet(
            Role::Draw,
            &[
                &[[0.0, 0.0], [1.0, 0.0]],
                &[[1.0, -1.0], [1.0, 0.0]],
                &[[2.0, 0.0], [1.0, 0.0]],
                &[[1.0, 0.0], [1.0, 1.0]],
            ],
        );
        assert_eq!(
            lines(&optimize(&cross)),
            [[[0.0, 0.0], [2.0, 0.0]], [[1.0, -1.0], [1.0, 1.0]]]
        );
    }

    #[test]
    fn what_is_inside_is_cut_first() {
        let square = |a: f64, b: f64| [[a, a], [b, a], [b, b], [a, b], [a, a]];
        let (outer, middle, inner) = (square(0.0, 9.0), square(1.0, 8.0), square(2.0, 3.0));
        let nested = [&outer[..], &inner, &[[4.0, 4.0], [5.0, 4.0]], &middle];
        let order = |role| -> Vec<f64> {
            lines(&optimize(&sheet(role, &nested)))
                .iter()
                .map(|l| l.iter().map(|p| p[0]).fold(9.0, f64::min))
                .collect()
        };
        assert_eq!(order(Role::Cut), [2.0, 4.0, 1.0, 0.0]);
        assert_eq!(order(Role::Draw), [0.0, 1.0, 2.0, 4.0]);
    }

    /// Length by segment, each in unit steps, so that merging does not matter.
    fn drawn(sheet: &Sheet) -> BTreeMap<[i64; 4], usize> {
        let mut steps = BTreeMap::new();
        for line in lines(sheet) {
            for w in line.windows(2) {
                let [a, b] = [w[0], w[1]].map(|p| [p[0].round() as i64, p[1].round() as i64]);
                let n = (b[0] - a[0]).abs().max((b[1] - a[1]).abs());
                for i in 0..n {
                    let at = |i: i64| [a[0] + (b[0] - a[0]) / n * i, a[1] + (b[1] - a[1]) / n * i];
                    let (p, q) = (at(i).min(at(i + 1)), at(i).max(at(i + 1)));
                    *steps.entry([p[0], p[1], q[0], q[1]]).or_default() += 1;
                }
            }
        }
        steps
    }

    #[test]
    fn every_segment_is_drawn_as_often_as_before_and_travel_shrinks() {
        let seed = Seed::root(11);
        let mut all: Vec<Vec<[f64; 2]>> = Vec::new();
        for i in 0..400 {
            let s = seed.number(i);
            let p = [(s.unit(0) * 30.0).floor(), (s.unit(1) * 30.0).floor()];
            all.push(vec![
                p,
                if s.unit(2) < 0.5 {
                    [p[0] + 1.0, p[1]]
                } else {
                    [p[0], p[1] + 1.0]
                },
            ]);
        }
        let before = sheet(
            Role::Draw,
            &all.iter().map(Vec::as_slice).collect::<Vec<_>>(),
        );
        let after = optimize(&before);
        assert_eq!(drawn(&after), drawn(&before));
        let travel = |sheet: &Sheet| -> f64 {
            let lines = lines(sheet);
            lines
                .windows(2)
                .map(|w| Point::from(*w[0].last().unwrap()).distance(w[1][0].into()))
                .sum()
        };
        assert!(
            travel(&after) < travel(&before) / 10.0,
            "{} {}",
            travel(&after),
            travel(&before)
        );
        assert_eq!(optimize(&before), after);
    }
}
