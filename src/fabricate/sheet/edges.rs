//! Lines that run along one another without being written the same: where two faces meet, each has its own
//! points on their common border. As a planar map they have the same edges, of which only the first line
//! keeps each.

use std::collections::{BTreeMap, BTreeSet};

use fretwork_geometry::planar_map::PlanarMap;
use fretwork_geometry::{CurveLabels, Curves, EdgeId, Point, VertexId, along_others};

/// A line, and whether it runs along an earlier one somewhere; then it is what is left of it.
pub type Left = Option<Vec<Vec<Point>>>;

/// An edge in the direction of a line that runs along it.
#[derive(Clone, Copy, Debug)]
struct Step {
    edge: EdgeId,
    from: VertexId,
    to: VertexId,
    is_reversed: bool,
}

/// What is left of each line when of lines along one another only the first is drawn; `None` for a line that
/// runs along no other. Points nearer than `resolution` are one. Lines that are too far out to be compared are all left as they are.
pub fn left(lines: &[Vec<Point>], resolution: f64) -> Vec<Left> {
    let points = lines.iter().map(|line| &line[..]);
    let is_along = along_others(points, resolution, |_, _| true);
    let numbers = (0..lines.len()).filter(|number| is_along[*number]);
    let some: Vec<&Vec<Point>> = numbers.map(|number| &lines[number]).collect();
    let mut left = left_of(&some, resolution).into_iter();
    let of_line = |is_along| {
        if is_along {
            left.next().flatten()
        } else {
            None
        }
    };
    is_along.into_iter().map(of_line).collect()
}

/// The same of lines that may all run along others.
fn left_of(lines: &[&Vec<Point>], resolution: f64) -> Vec<Left> {
    let mut curves = Curves::new();
    for line in lines {
        curves.push(line.iter().copied(), CurveLabels::default());
    }
    let Ok(map) = PlanarMap::build(&curves, resolution) else {
        return vec![None; lines.len()];
    };
    let mut is_doubled = vec![false; lines.len()];
    for edge in map.edges() {
        for later in map.sources(edge).skip(1) {
            is_doubled[later.curve as usize] = true;
        }
    }
    if is_doubled.iter().all(|doubled| !doubled) {
        return vec![None; lines.len()];
    }
    let mut steps: BTreeMap<u32, Vec<Step>> = BTreeMap::new();
    for edge in map.edges() {
        let Some(first) = map.sources(edge).next() else {
            continue;
        };
        if is_doubled[first.curve as usize] {
            let (mut from, mut to) = (map.source(edge), map.target(edge));
            if first.reversed {
                std::mem::swap(&mut from, &mut to);
            }
            steps.entry(first.curve).or_default().push(Step {
                edge,
                from,
                to,
                is_reversed: first.reversed,
            });
        }
    }
    let numbered = is_doubled.iter().enumerate();
    numbered
        .map(|(number, doubled)| {
            let own = steps.remove(&(number as u32)).unwrap_or_default();
            doubled.then(|| {
                let line = lines[number];
                let corners = Corners::new(line, resolution);
                let mut pieces = chained(&map, own);
                pieces
                    .iter_mut()
                    .for_each(|piece| corners.straighten(piece));
                pieces.sort_by_cached_key(|piece| place(line, piece[0]));
                pieces
            })
        })
        .collect()
}

/// The points of a line, to be found again after they were moved by a resolution.
struct Corners {
    cells: BTreeSet<[i64; 2]>,
    side: f64,
}

impl Corners {
    fn new(line: &[Point], resolution: f64) -> Corners {
        let mut corners = Corners {
            cells: BTreeSet::new(),
            side: 4.0 * resolution,
        };
        corners.cells = line.iter().map(|p| corners.cell(*p)).collect();
        corners
    }

    fn cell(&self, p: Point) -> [i64; 2] {
        [p.x, p.y].map(|v| (v / self.side).floor() as i64)
    }

    fn has(&self, p: Point) -> bool {
        let [x, y] = self.cell(p);
        let near = |i: i64| [x + i % 3 - 1, y + i / 3 - 1];
        (0..9).any(|i| self.cells.contains(&near(i)))
    }

    /// Leaves out the points within a piece at which the line only met others.
    fn straighten(&self, piece: &mut Vec<Point>) {
        let last = piece.len() - 1;
        let mut number = 0;
        piece.retain(|p| {
            number += 1;
            number == 1 || number == last + 1 || self.has(*p)
        });
    }
}

/// Where along a line the place nearest to `p` is: the number of the segment, and where in it, in billionths.
fn place(line: &[Point], p: Point) -> (usize, i64) {
    let nearest = line.windows(2).enumerate().map(|(number, w)| {
        let along = w[1] - w[0];
        let length = along.dot(along);
        let part = if length > 0.0 {
            ((p - w[0]).dot(along) / length).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (w[0].lerp(w[1], part).distance(p), number, part)
    });
    let least = nearest.min_by(|a, b| a.0.total_cmp(&b.0));
    least.map_or((0, 0), |(_, number, part)| (number, (part * 1e9) as i64))
}

/// The polylines that steps form, each from where no other step leads to, or anywhere on a closed one.
fn chained(map: &PlanarMap, mut steps: Vec<Step>) -> Vec<Vec<Point>> {
    let mut next: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
    let mut arriving: BTreeMap<VertexId, usize> = BTreeMap::new();
    steps.sort_by_key(|step| (step.from, step.edge));
    for (number, step) in steps.iter().enumerate().rev() {
        next.entry(step.from).or_default().push(number);
        *arriving.entry(step.to).or_default() += 1;
    }
    let leaves = |number: &usize| !arriving.contains_key(&steps[*number].from);
    let (open, closed): (Vec<usize>, Vec<usize>) = (0..steps.len()).partition(leaves);
    let mut is_done = vec![false; steps.len()];
    let mut lines = Vec::new();
    for start in open.into_iter().chain(closed) {
        let mut line: Vec<Point> = Vec::new();
        let mut at = Some(start).filter(|start| !is_done[*start]);
        while let Some(number) = at {
            is_done[number] = true;
            let step = steps[number];
            let mut points: Vec<Point> = map.points(step.edge).collect();
            if step.is_reversed {
                points.reverse();
            }
            line.extend(points.into_iter().skip(usize::from(!line.is_empty())));
            let onward = next.get_mut(&step.to);
            at = onward.and_then(|onward| {
                onward.retain(|number| !is_done[*number]);
                onward.last().copied()
            });
        }
        if line.len() > 1 {
            lines.push(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|&p| p.into()).collect()
    }

    fn once(lines: &[Vec<Point>]) -> Vec<Left> {
        left(lines, fretwork_geometry::planar_map::resolution(10.0))
    }

    fn length(lines: &[Vec<Point>]) -> f64 {
        let pairs = lines.iter().flat_map(|line| line.windows(2));
        pairs.map(|w| w[0].distance(w[1])).sum()
    }

    #[test]
    fn a_border_with_other_points_is_left_out_once() {
        let (a, b) = (Point::new(0.0, 0.0), Point::new(1.0, 3.0));
        let stops = |places: &[f64]| -> Vec<Point> {
            places.iter().map(|place| a.lerp(b, *place)).collect()
        };
        let mine = stops(&[0.0, 0.137, 0.5, 1.0]);
        let mut theirs = stops(&[1.0, 0.771, 0.309, 0.0]);
        theirs.push(Point::new(-5.0, 0.0));
        let left = once(&[mine, theirs, line(&[[9.0, 9.0], [9.0, 10.0]])]);
        assert_eq!(left[0], None);
        assert_eq!(left[2], None);
        let rest = left[1].as_ref().expect("it runs along the first");
        assert_eq!((rest.len(), rest[0].len()), (1, 2));
        assert!((length(rest) - 5.0).abs() < 1e-6, "{rest:?}");
    }

    #[test]
    fn what_runs_along_the_middle_cuts_a_line_in_two() {
        let left = once(&[
            line(&[[3.0, 0.0], [6.0, 0.0]]),
            line(&[[0.0, 0.0], [9.0, 0.0]]),
        ]);
        let rest = left[1].as_ref().expect("it runs along the first");
        assert_eq!(
            rest,
            &[
                line(&[[0.0, 0.0], [3.0, 0.0]]),
                line(&[[6.0, 0.0], [9.0, 0.0]])
            ]
        );
    }

    #[test]
    fn what_a_line_meets_leaves_no_points_in_it() {
        let lines = [
            line(&[[0.0, 0.0], [2.0, 0.0]]),
            line(&[[2.0, 0.0], [0.0, 0.0], [0.0, 4.0], [2.0, 4.0]]),
            line(&[[0.0, 2.0], [1.0, 2.0]]),
        ];
        let left = once(&lines);
        let rest = left[1].as_ref().expect("it runs along the first");
        assert_eq!(rest, &[line(&[[0.0, 0.0], [0.0, 4.0], [2.0, 4.0]])]);
    }

    #[test]
    fn lines_that_only_cross_keep_their_points() {
        let cross = [
            line(&[[0.0, 0.0], [2.0, 2.0]]),
            line(&[[0.0, 2.0], [2.0, 0.0]]),
        ];
        assert_eq!(once(&cross), [None, None]);
    }
}
