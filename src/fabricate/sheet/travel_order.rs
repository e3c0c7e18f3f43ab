//! A short way through many lines: always on to the nearest one, then stretches of the way
//! reversed where that shortens it (2-opt, within a window). Closed lines may be entered at any
//! corner, open ones at either end.

use super::fixed_point::Cell;
use super::lines::is_closed;
use fretwork_geometry::index::KdTree;

/// How many lines a reversed stretch has at most. Longer stretches cost more for each line and,
/// after a way that goes on to what is nearest, hardly ever shorten it.
const WINDOW: usize = 50;
/// How often the way is gone over. The first passes gain nearly all.
const PASSES: usize = 4;

/// The lines in the order of a short way from `home`, turned to be drawn from the point where the
/// way comes to them. Equal input gives equal output; O(n log n) for n points, roughly.
pub fn ordered(lines: Vec<Vec<Cell>>, home: Cell) -> Vec<Vec<Cell>> {
    let mut visits = nearest_first(&lines, home);
    shorten(&mut visits, home);
    let mut lines = lines;
    let drawn = |visit: Visit| {
        let mut line = std::mem::take(&mut lines[visit.line as usize]);
        if visit.closed {
            line.pop();
            line.rotate_left(visit.corner as usize);
            line.push(line[0]);
        } else if line[0] != visit.entry {
            line.reverse();
        }
        line
    };
    visits.into_iter().map(drawn).collect()
}

#[derive(Clone, Copy)]
struct Visit {
    line: u32,
    /// Where a closed line is entered.
    corner: u32,
    closed: bool,
    entry: Cell,
    exit: Cell,
}

fn nearest_first(lines: &[Vec<Cell>], home: Cell) -> Vec<Visit> {
    let mut doors: Vec<Visit> = Vec::new();
    let mut first_door = Vec::with_capacity(lines.len() + 1);
    for (i, line) in lines.iter().enumerate() {
        first_door.push(doors.len());
        let (line_number, closed) = (i as u32, is_closed(line));
        let mut door = |corner: usize, exit: Cell| {
            doors.push(Visit {
                line: line_number,
                corner: corner as u32,
                closed,
                entry: line[corner],
                exit,
            });
        };
        if closed {
            (0..line.len() - 1).for_each(|corner| door(corner, line[corner]));
        } else {
            door(0, line[line.len() - 1]);
            door(line.len() - 1, line[0]);
        }
    }
    first_door.push(doors.len());
    let mut tree = KdTree::new(doors.iter().map(|d| plain(d.entry)).collect());
    let mut at = home;
    let mut visits = Vec::with_capacity(lines.len());
    while let Some(i) = tree.nearest(plain(at)) {
        let visit = doors[i];
        let line = visit.line as usize;
        (first_door[line]..first_door[line + 1]).for_each(|door| tree.remove(door));
        at = visit.exit;
        visits.push(visit);
    }
    visits
}

fn shorten(visits: &mut [Visit], home: Cell) {
    for _ in 0..PASSES {
        let mut improved = false;
        for i in 0..visits.len() {
            let before = if i == 0 { home } else { visits[i - 1].exit };
            let mut best = (-1e-9, i);
            for j in i..visits.len().min(i + WINDOW) {
                // After the last line the way ends; there is nothing to get back to.
                let onward = |from: Cell| {
                    visits
                        .get(j + 1)
                        .map_or(0.0, |next| distance(from, next.entry))
                };
                let now = distance(before, visits[i].entry) + onward(visits[j].exit);
                let then = distance(before, visits[j].exit) + onward(visits[i].entry);
                if then - now < best.0 {
                    best = (then - now, j);
                }
            }
            if best.0 < -1e-9 {
                let stretch = &mut visits[i..=best.1];
                stretch.reverse();
                stretch
                    .iter_mut()
                    .for_each(|v| std::mem::swap(&mut v.entry, &mut v.exit));
                improved = true;
            }
        }
        if !improved {
            return;
        }
    }
}

fn distance(a: Cell, b: Cell) -> f64 {
    let (dx, dy) = ((a.0 - b.0) as f64, (a.1 - b.1) as f64);
    (dx * dx + dy * dy).sqrt()
}

fn plain((x, y): Cell) -> [f64; 2] {
    [x as f64, y as f64]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_lines_are_entered_at_the_nearest_corner() {
        let square = vec![(10, 10), (20, 10), (20, 20), (10, 20), (10, 10)];
        let open = vec![(30, 21), (21, 21)];
        let way = ordered(vec![open, square], (0, 30));
        assert_eq!(
            way,
            [
                vec![(10, 20), (10, 10), (20, 10), (20, 20), (10, 20)],
                vec![(21, 21), (30, 21)]
            ]
        );
    }

    #[test]
    fn reversing_stretches_shortens_the_way() {
        let dash = |x: i64| vec![(x, 0), (x, 1)];
        let lines: Vec<_> = [3, -4, 8, -16, 1, 40].map(dash).to_vec();
        let way = ordered(lines, (0, 0));
        let travel: f64 = way.windows(2).map(|w| distance(w[0][1], w[1][0])).sum();
        assert!(travel <= 80.0, "{travel} {way:?}");
    }
}
