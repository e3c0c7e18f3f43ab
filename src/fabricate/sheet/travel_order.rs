//! A short way through many lines: always on to the nearest one, then stretches of the way
//! reversed where that shortens it (2-opt, within a window). Closed lines may be entered at any
//! corner, open ones at either end.

use super::fixed_point::Cell;
use super::lines::is_closed;

/// How many lines a reversed stretch has at most.
const WINDOW: usize = 50;
/// How often the way is gone over.
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
    let mut tree = Tree::new(doors.iter().map(|d| d.entry).collect());
    let mut at = home;
    let mut visits = Vec::with_capacity(lines.len());
    while let Some(i) = tree.nearest(at) {
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
    squared(a, b).sqrt()
}

fn squared(a: Cell, b: Cell) -> f64 {
    let (dx, dy) = ((a.0 - b.0) as f64, (a.1 - b.1) as f64);
    dx * dx + dy * dy
}

/// A balanced kd-tree whose points can be taken out. The median of each stretch of `order` is the
/// node of that stretch; levels split by x and by y in turn.
struct Tree {
    points: Vec<Cell>,
    order: Vec<u32>,
    place: Vec<u32>,
    /// How many points are left in the stretch whose median is here.
    left: Vec<u32>,
    taken: Vec<bool>,
}

impl Tree {
    fn new(points: Vec<Cell>) -> Tree {
        let n = points.len();
        let mut tree = Tree {
            order: (0..n as u32).collect(),
            place: vec![0; n],
            left: vec![0; n],
            taken: vec![false; n],
            points,
        };
        let mut stretches = vec![(0, n, true)];
        while let Some((low, high, by_x)) = stretches.pop() {
            if low == high {
                continue;
            }
            let middle = (low + high) / 2;
            let points = &tree.points;
            let key = |&i: &u32| {
                let (x, y) = points[i as usize];
                if by_x { (x, y, i) } else { (y, x, i) }
            };
            tree.order[low..high].select_nth_unstable_by_key(middle - low, key);
            tree.left[middle] = (high - low) as u32;
            stretches.extend([(low, middle, !by_x), (middle + 1, high, !by_x)]);
        }
        for (place, &i) in tree.order.iter().enumerate() {
            tree.place[i as usize] = place as u32;
        }
        tree
    }

    /// Takes a point out.
    fn remove(&mut self, point: usize) {
        if std::mem::replace(&mut self.taken[point], true) {
            return;
        }
        let place = self.place[point] as usize;
        let (mut low, mut high) = (0, self.points.len());
        loop {
            let middle = (low + high) / 2;
            self.left[middle] -= 1;
            match place.cmp(&middle) {
                std::cmp::Ordering::Less => high = middle,
                std::cmp::Ordering::Equal => return,
                std::cmp::Ordering::Greater => low = middle + 1,
            }
        }
    }

    /// The point nearest to `at`; of several the first.
    fn nearest(&self, at: Cell) -> Option<usize> {
        let mut best = (f64::INFINITY, usize::MAX);
        self.search(at, 0, self.points.len(), true, &mut best);
        (best.1 != usize::MAX).then_some(best.1)
    }

    fn search(&self, at: Cell, low: usize, high: usize, by_x: bool, best: &mut (f64, usize)) {
        let middle = (low + high) / 2;
        if low == high || self.left[middle] == 0 {
            return;
        }
        let i = self.order[middle] as usize;
        let here = (squared(at, self.points[i]), i);
        if !self.taken[i] && here < *best {
            *best = here;
        }
        let (p, q) = (self.points[i], at);
        let beyond = if by_x { q.0 - p.0 } else { q.1 - p.1 };
        let (near, far) = ((low, middle), (middle + 1, high));
        let (near, far) = if beyond < 0 { (near, far) } else { (far, near) };
        self.search(at, near.0, near.1, !by_x, best);
        if (beyond as f64) * (beyond as f64) <= best.0 {
            self.search(at, far.0, far.1, !by_x, best);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    #[test]
    fn the_tree_agrees_with_looking_at_every_point() {
        let seed = Seed::root(5);
        let at = |i: i64| {
            let s = seed.number(i);
            ((s.unit(0) * 20.0) as i64, (s.unit(1) * 20.0) as i64)
        };
        let points: Vec<Cell> = (0..300).map(at).collect();
        let mut tree = Tree::new(points.clone());
        let mut left: Vec<usize> = (0..300).collect();
        for k in 0..300 {
            let q = at(1000 + k);
            let expected = left.iter().copied().min_by(|&i, &j| {
                squared(q, points[i])
                    .total_cmp(&squared(q, points[j]))
                    .then(i.cmp(&j))
            });
            let found = tree.nearest(q);
            assert_eq!(found, expected);
            tree.remove(found.unwrap());
            left.retain(|&i| Some(i) != found);
        }
        assert_eq!(tree.nearest((0, 0)), None);
    }

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
