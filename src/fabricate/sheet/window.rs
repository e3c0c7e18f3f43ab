//! Windows: what of a sheet lies in a rectangle, so that what neighbours show is the whole and no more.
//!
//! Where a segment crosses a side of a window is computed from the whole segment with its ends in one
//! order, by the coordinate of that side alone: two windows that share the side get the same bits.
//! Nothing is joined, moved or left out after the cut.

use super::layer::{Item, Sheet};
use super::lines::{cut, is_closed, outlines};
use super::window_area::{self, at_x, at_y};
use fretwork_geometry::{Bounds, FillRule, Point, polygon};

/// A rectangle that holds its lower sides unless they are open, and of its upper sides those that are closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The rectangle.
    pub bounds: Bounds,
    /// Whether the sides of greatest x and of greatest y belong to it.
    pub closed: [bool; 2],
    /// Whether the sides of least x and of least y do not belong to it: another window is closed there.
    pub open: [bool; 2],
    /// Whether y was mirrored before: then the sides of least y and of greatest y change places.
    pub is_mirrored: bool,
}

impl Window {
    /// The sheet with only what lies in the window, which is its page. Lines are half-open: what runs along
    /// a side is in one of two neighbours. Areas, and closed lines on layers that are filled, are closed
    /// along the cut.
    ///
    /// # Errors
    /// When what a closed line fills cannot be computed.
    pub fn of(&self, sheet: &Sheet) -> Result<Sheet, polygon::AreaError> {
        let layers = sheet.layers.iter().map(|layer| {
            let mut items = Vec::new();
            for item in &layer.items {
                self.take(item, layer.style.fill.is_some(), &mut items)?;
            }
            Ok(layer.with(items))
        });
        Ok(Sheet {
            page: Some(self.bounds),
            ..sheet.with(layers.collect::<Result<_, polygon::AreaError>>()?)
        })
    }

    /// The parts of an item in the window, which has its sides: an area is closed along the cut.
    pub fn parts(&self, item: &Item) -> Vec<Item> {
        match item {
            Item::Area(area) => {
                let areas = window_area::cut(area, &self.bounds).into_iter();
                areas.map(Item::Area).collect()
            }
            Item::Line(line) => self.line(line).into_iter().map(Item::Line).collect(),
        }
    }

    fn take(
        &self,
        item: &Item,
        is_filled: bool,
        out: &mut Vec<Item>,
    ) -> Result<(), polygon::AreaError> {
        match item {
            Item::Area(area) if is_filled => {
                out.extend(
                    window_area::cut(area, &self.bounds)
                        .into_iter()
                        .map(Item::Area),
                );
            }
            Item::Line(points) if is_filled && is_closed(points) => {
                let areas = polygon::fill(std::slice::from_ref(points), FillRule::EvenOdd)?;
                let cut = areas
                    .iter()
                    .flat_map(|area| window_area::cut(area, &self.bounds));
                out.extend(cut.map(Item::Area));
            }
            item => {
                let lines = outlines(item).into_iter();
                out.extend(lines.flat_map(|line| self.line(&line)).map(Item::Line));
            }
        }
        Ok(())
    }

    /// Whether a point is in the window.
    pub fn holds(&self, at: Point) -> bool {
        self.has(at, at)
    }

    /// The pieces of a polyline in the window.
    pub fn line(&self, line: &[Point]) -> Vec<Vec<Point>> {
        let mut stops = Vec::new();
        cut(line, |a, b, parts| {
            if !Bounds::of([a, b]).intersects(&self.bounds) {
                return;
            }
            self.stops(a, b, &mut stops);
            for pair in stops.windows(2) {
                if self.has(pair[0], pair[1]) {
                    parts.push((pair[0], pair[1]));
                }
            }
        })
    }

    /// The ends of the segment and where it crosses the lines on which the window's sides lie, in order.
    fn stops(&self, a: Point, b: Point, stops: &mut Vec<Point>) {
        let (min, max) = (self.bounds.min, self.bounds.max);
        stops.clear();
        stops.push(a);
        stops.extend([min.x, max.x].iter().filter_map(|x| at_x(a, b, *x)));
        stops.extend([min.y, max.y].iter().filter_map(|y| at_y(a, b, *y)));
        stops.push(b);
        let along = b - a;
        let inner = stops.len() - 1;
        stops[1..inner].sort_by(|p, q| (*p - a).dot(along).total_cmp(&(*q - a).dot(along)));
        stops.dedup();
    }

    /// Whether what lies between two stops is in the window.
    fn has(&self, p: Point, q: Point) -> bool {
        let middle = p.lerp(q, 0.5);
        let (min, max) = (self.bounds.min, self.bounds.max);
        // What runs along a side has both of its ends on it, exactly.
        let side = |p: f64, q: f64, middle: f64| if p == q { p } else { middle };
        let (x, y) = (side(p.x, q.x, middle.x), side(p.y, q.y, middle.y));
        let within = |v: f64, low: f64, high: f64, axis: usize| {
            let is_above = v > low || (v == low && !self.open[axis]);
            is_above && (v < high || (v == high && self.closed[axis]))
        };
        let in_x = within(x, min.x, max.x, 0);
        let in_y = if self.is_mirrored {
            within(-y, -max.y, -min.y, 1)
        } else {
            within(y, min.y, max.y, 1)
        };
        in_x && in_y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::Seed;

    fn window(x: [f64; 2], y: [f64; 2], closed: [bool; 2]) -> Window {
        Window {
            bounds: Bounds {
                min: Point::new(x[0], y[0]),
                max: Point::new(x[1], y[1]),
            },
            closed,
            open: [false; 2],
            is_mirrored: false,
        }
    }

    fn line(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|&p| p.into()).collect()
    }

    #[test]
    fn what_runs_along_a_side_is_drawn_once() {
        let left = window([0.0, 4.0], [0.0, 4.0], [false; 2]);
        let right = window([4.0, 8.0], [0.0, 4.0], [true; 2]);
        let border = line(&[[4.0, 1.0], [4.0, 3.0]]);
        assert!(left.line(&border).is_empty());
        assert_eq!(right.line(&border), vec![border.clone()]);
        let mut beyond = window([8.0, 9.0], [0.0, 4.0], [true; 2]);
        beyond.open[0] = true;
        assert!(beyond.line(&line(&[[8.0, 1.0], [8.0, 3.0]])).is_empty());
        let far = line(&[[8.0, 1.0], [8.0, 3.0]]);
        assert_eq!(right.line(&far), vec![far.clone()]);
        assert!(
            window([4.0, 8.0], [0.0, 4.0], [false; 2])
                .line(&far)
                .is_empty()
        );
    }

    #[test]
    fn a_mirrored_window_is_closed_at_its_other_side() {
        let mut upper = window([0.0, 4.0], [-8.0, -4.0], [false; 2]);
        upper.is_mirrored = true;
        // North is at y = -8, which is open, and the south at -4 belongs to it.
        assert_eq!(upper.line(&line(&[[1.0, -4.0], [2.0, -4.0]])).len(), 1);
        assert!(upper.line(&line(&[[1.0, -8.0], [2.0, -8.0]])).is_empty());
    }

    #[test]
    fn neighbours_meet_in_the_same_points_and_are_the_whole() {
        let seed = Seed::root(3);
        for round in 0..300 {
            let key = seed.number(round);
            let at = |n: u64| Point::new(key.range(n, -3.0, 11.0), key.range(n + 50, -3.0, 11.0));
            let whole: Vec<Point> = (0..6).map(at).collect();
            let (x, y) = (key.range(200, 2.0, 6.0), key.range(201, 2.0, 6.0));
            let cuts = [[-3.0, x, 11.0], [-3.0, y, 11.0]];
            let mut pieces = Vec::new();
            for i in 0..2 {
                for j in 0..2 {
                    let part = window(
                        [cuts[0][i], cuts[0][i + 1]],
                        [cuts[1][j], cuts[1][j + 1]],
                        [i == 1, j == 1],
                    );
                    pieces.extend(part.line(&whole));
                }
            }
            let length =
                |line: &Vec<Point>| -> f64 { line.windows(2).map(|w| w[0].distance(w[1])).sum() };
            let all: f64 = pieces.iter().map(length).sum();
            assert!((all - length(&whole)).abs() < 1e-9);
            let mut ends: Vec<[u64; 2]> = pieces
                .iter()
                .flat_map(|piece| [piece[0], piece[piece.len() - 1]])
                .filter(|p| p.x == x || p.y == y)
                .map(|p| [p.x.to_bits(), p.y.to_bits()])
                .collect();
            ends.sort_unstable();
            assert!(ends.chunks(2).all(|pair| pair[0] == pair[1]), "{round}");
        }
    }
}
