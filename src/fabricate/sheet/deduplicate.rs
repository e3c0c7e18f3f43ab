//! No line twice: a laser that goes over a line again burns it.

use std::collections::HashMap;

use super::edges;
use super::fixed_point::{self, Cell};
use super::layer::{Item, Layer, Sheet};
use super::lines::{cut, outlines};
use super::style::Role;
use fretwork_geometry::Point;
use fretwork_geometry::numeric::gcd;

/// The sheet without the parts of lines that an earlier line of the same role covers, whole
/// segments or pieces of them, on the same layer or another. Areas on layers that are not filled
/// become their outlines; filled layers stay as they are. Lines are the same when they are the same edges of a planar
/// map of this resolution, or when they are written the same: coordinates are rounded to those of the file.
pub fn deduplicate(sheet: &Sheet, resolution: f64) -> Sheet {
    let mut covered: HashMap<Role, Covered> = HashMap::new();
    let mut layers = Vec::with_capacity(sheet.layers.len());
    for (layer, lines) in sheet.layers.iter().zip(once(sheet, resolution)) {
        if layer.style.fill.is_some() {
            layers.push(layer.clone());
            continue;
        }
        let covered = covered.entry(layer.role).or_default();
        let mut items = Vec::with_capacity(layer.items.len());
        for line in lines {
            let cells = fixed_point::cells(&line, sheet.unit_mm);
            for piece in cut(&cells, |a, b, parts| covered.take(a, b, parts)) {
                items.push(Item::Line(fixed_point::points(&piece, sheet.unit_mm)));
            }
        }
        layers.push(layer.with(items));
    }
    sheet.with(layers)
}

/// The lines of each layer that is not filled, none along an earlier one of its role.
fn once(sheet: &Sheet, resolution: f64) -> Vec<Vec<Vec<Point>>> {
    let mut lines = vec![Vec::new(); sheet.layers.len()];
    for role in [Role::Cut, Role::Engrave, Role::Draw] {
        let is_meant = |layer: &Layer| layer.role == role && layer.style.fill.is_none();
        let layers = sheet.layers.iter().enumerate();
        let (mut all, mut of_layer) = (Vec::new(), Vec::new());
        for (number, layer) in layers.filter(|(_, layer)| is_meant(layer)) {
            for line in layer.items.iter().flat_map(outlines) {
                all.push(line);
                of_layer.push(number);
            }
        }
        let left = edges::left(&all, resolution).into_iter();
        for ((whole, left), number) in all.into_iter().zip(left).zip(of_layer) {
            match left {
                Some(pieces) => lines[number].extend(pieces),
                None => lines[number].push(whole),
            }
        }
    }
    lines
}

/// What is drawn, by supporting line: its direction without common factor, and where it lies.
#[derive(Default)]
struct Covered(HashMap<(i64, i64, i128), Vec<(i64, i64)>>);

impl Covered {
    /// Appends to `parts` what of the segment is not covered yet, and covers it.
    fn take(&mut self, a: Cell, b: Cell, parts: &mut Vec<(Cell, Cell)>) {
        let (mut dx, mut dy) = (b.0 - a.0, b.1 - a.1);
        let factor = gcd(dx.unsigned_abs(), dy.unsigned_abs()) as i64;
        if factor == 0 {
            return;
        }
        let sign = if (dx, dy) < (0, 0) { -1 } else { 1 };
        (dx, dy) = (dx / factor * sign, dy / factor * sign);
        let place = i128::from(dx) * i128::from(a.1) - i128::from(dy) * i128::from(a.0);
        let intervals = self.0.entry((dx, dy, place)).or_default();
        // A number that grows by one from each grid point of the line to the next.
        let number = |c: Cell| {
            if dx != 0 {
                c.0.div_euclid(dx)
            } else {
                c.1.div_euclid(dy)
            }
        };
        let (first, last) = (number(a), number(b));
        let at = |n: i64| (a.0 + (n - first) * dx, a.1 + (n - first) * dy);
        let mut free = uncovered(intervals, first.min(last), first.max(last));
        cover(intervals, first.min(last), first.max(last));
        if last < first {
            free.reverse();
            free.iter_mut()
                .for_each(|(from, to)| std::mem::swap(from, to));
        }
        parts.extend(free.into_iter().map(|(from, to)| (at(from), at(to))));
    }
}

/// The parts of `low..high` outside the intervals, which are disjoint and in order.
fn uncovered(intervals: &[(i64, i64)], low: i64, high: i64) -> Vec<(i64, i64)> {
    let mut free = Vec::new();
    let mut at = low;
    let first = intervals.partition_point(|&(_, to)| to <= low);
    for &(from, to) in intervals[first..]
        .iter()
        .take_while(|&&(from, _)| from < high)
    {
        if at < from {
            free.push((at, from));
        }
        at = at.max(to);
    }
    if at < high {
        free.push((at, high));
    }
    free
}

/// Unites the intervals with `low..high`.
fn cover(intervals: &mut Vec<(i64, i64)>, low: i64, high: i64) {
    let first = intervals.partition_point(|&(_, to)| to < low);
    let end = first + intervals[first..].partition_point(|&(from, _)| from <= high);
    let met = &intervals[first..end];
    let low = met.first().map_or(low, |&(from, _)| from.min(low));
    let high = met.last().map_or(high, |&(_, to)| to.max(high));
    intervals.splice(first..end, [(low, high)]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Color, Style};
    use fretwork_geometry::{Point, Polygon};

    fn line(points: &[[f64; 2]]) -> Item {
        Item::Line(points.iter().map(|&p| p.into()).collect())
    }

    fn layer(role: Role, items: Vec<Item>) -> Layer {
        Layer {
            name: "a".into(),
            role,
            style: Style::outline(0.1),
            items,
        }
    }

    fn result(layers: Vec<Layer>) -> Vec<Vec<Item>> {
        let sheet = Sheet {
            page: None,
            unit_mm: 1.0,
            layers,
        };
        let sheet = deduplicate(&sheet, fretwork_geometry::planar_map::resolution(10.0));
        sheet.layers.into_iter().map(|l| l.items).collect()
    }

    #[test]
    fn neighbours_are_cut_apart_once() {
        let square = |x: f64| {
            let outer = [[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]]
                .map(Point::from)
                .to_vec();
            Item::Area(Polygon {
                outer,
                holes: vec![],
            })
        };
        let once = result(vec![layer(Role::Cut, vec![square(0.0), square(1.0)])]);
        let whole = line(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]);
        assert_eq!(
            once,
            [[
                whole,
                line(&[[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0]])
            ]]
        );
    }

    #[test]
    fn parts_of_segments_are_found_in_either_direction() {
        let long = line(&[[0.0, 0.0], [9.0, 3.0]]);
        let inner = line(&[[6.0, 2.0], [3.0, 1.0]]);
        assert_eq!(
            result(vec![layer(Role::Cut, vec![long.clone(), inner.clone()])]),
            [[long.clone()]]
        );
        let around = line(&[[12.0, 4.0], [-3.0, -1.0]]);
        let pieces = [
            inner.clone(),
            line(&[[12.0, 4.0], [6.0, 2.0]]),
            line(&[[3.0, 1.0], [-3.0, -1.0]]),
        ];
        assert_eq!(
            result(vec![layer(Role::Cut, vec![inner, around])]),
            [pieces]
        );
        let beside = line(&[[0.0, 0.0001], [9.0, 3.0001]]);
        assert_eq!(
            result(vec![layer(Role::Cut, vec![long.clone(), beside])])[0].len(),
            2
        );
    }

    #[test]
    fn roles_and_filled_layers_are_apart() {
        let a = line(&[[0.0, 0.0], [1.0, 0.0]]);
        let mut filled = layer(Role::Cut, vec![a.clone()]);
        filled.style = Style::filled(Color::default());
        let layers = vec![
            layer(Role::Cut, vec![a.clone()]),
            layer(Role::Engrave, vec![a.clone()]),
            filled,
        ];
        assert_eq!(result(layers), [[a.clone()], [a.clone()], [a.clone()]]);
        let twice = vec![
            layer(Role::Cut, vec![a.clone(), a.clone()]),
            layer(Role::Cut, vec![a.clone()]),
        ];
        assert_eq!(result(twice), [vec![a], vec![]]);
    }

    #[test]
    fn intervals_stay_disjoint_and_in_order() {
        let mut intervals = Vec::new();
        for (low, high) in [(5, 9), (1, 2), (20, 30), (2, 3), (4, 6), (40, 50), (8, 45)] {
            cover(&mut intervals, low, high);
        }
        assert_eq!(intervals, [(1, 3), (4, 50)]);
        assert_eq!(uncovered(&intervals, -5, 60), [(-5, 1), (3, 4), (50, 60)]);
        assert_eq!(uncovered(&intervals, 3, 4), [(3, 4)]);
        assert_eq!(uncovered(&intervals, 10, 20), []);
    }
}
