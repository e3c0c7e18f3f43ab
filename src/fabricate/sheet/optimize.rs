//! The order in which a machine goes over a sheet: what is engraved, then what is drawn, then what
//! is cut, and of the cuts what is inside before what is around it, whatever layers they are on.
//! Cut first, an outline lets its part drop before the holes in it are cut.

use std::collections::BTreeSet;

use super::chains::{chained, straightened};
use super::fixed_point::{self, Cell};
use super::layer::{Item, Layer, Sheet};
use super::lines::{is_closed, outlines};
use super::nesting::Nesting;
use super::style::Role;
use super::travel_order;

/// The closed lines of a sheet on layers that are not filled, as they are before the lines that two
/// of them share are drawn only once.
pub struct Outlines {
    nesting: Nesting,
    /// The layer of each outline.
    layers: Vec<usize>,
}

impl Outlines {
    /// The outlines of all layers that are cut or drawn.
    pub fn of(sheet: &Sheet) -> Outlines {
        let (mut lines, mut layers) = (Vec::new(), Vec::new());
        for (number, layer) in sheet.layers.iter().enumerate() {
            if layer.role == Role::Engrave || layer.style.fill.is_some() {
                continue;
            }
            for line in layer.items.iter().flat_map(outlines) {
                let cells = fixed_point::cells(&line, sheet.unit_mm);
                if is_closed(&cells) {
                    lines.push(cells);
                    layers.push(number);
                }
            }
        }
        Outlines {
            nesting: Nesting::new(lines.iter().map(Vec::as_slice)),
            layers,
        }
    }

    /// The layers of the outlines around a line, one for each outline.
    pub(super) fn owners(&self, line: &[Cell]) -> Vec<usize> {
        let around = self.nesting.around(line);
        around.iter().map(|&o| self.layers[o as usize]).collect()
    }
}

/// The sheet in the order of a machine. Layers that are cut come after those that have
/// something inside of theirs; where two of them have something inside of one another, they take
/// turns and stand in the sheet more than once. Layers that are drawn do not: pens are changed once. With `is_short` lines are also chained into long
/// ones and ordered for short travel from the corner of least coordinates, and what is drawn is
/// ordered from the inside out within its layer. A sheet with filled layers is a picture, whose
/// layers stay in paint order. The set of segments stays the same, but for corners that lie exactly
/// on a straight line, which are left out of chains. O(n log n) for n points.
pub fn ordered(sheet: &Sheet, outlines: &Outlines, is_short: bool) -> Sheet {
    let jobs: Vec<Job> = (0..sheet.layers.len())
        .map(|number| Job::of(sheet, number, outlines, is_short))
        .collect();
    let is_picture = sheet.layers.iter().any(|layer| layer.style.fill.is_some());
    let groups = if is_picture {
        (0..jobs.len()).map(|number| vec![number]).collect()
    } else {
        let of = |role| (0..jobs.len()).filter(move |&i| sheet.layers[i].role == role);
        [Role::Engrave, Role::Draw, Role::Cut]
            .map(|role| of(role).collect())
            .to_vec()
    };
    let mut way = Way {
        sheet,
        at: fixed_point::cell(sheet.page_mm().min, 1.0),
        is_short,
        layers: Vec::new(),
    };
    for group in groups {
        for step in steps(&jobs, &group) {
            way.go(&jobs, &step);
        }
    }
    sheet.with(way.layers)
}

/// The lines of a layer.
#[derive(Default)]
pub(super) struct Job {
    /// In how many outlines each line lies, of those that count for its role, and the line.
    pub(super) lines: Vec<(usize, Vec<Cell>)>,
    /// The other layers that have outlines around lines of this one.
    pub(super) around: BTreeSet<usize>,
}

impl Job {
    fn of(sheet: &Sheet, number: usize, outlines: &Outlines, is_short: bool) -> Job {
        let layer = &sheet.layers[number];
        if layer.style.fill.is_some() {
            return Job::default();
        }
        let lines = layer.items.iter().flat_map(self::outlines);
        let mut lines: Vec<Vec<Cell>> = lines
            .map(|line| fixed_point::cells(&line, sheet.unit_mm))
            .filter(|line| line.len() > 1)
            .collect();
        if is_short {
            lines = chained(lines).into_iter().map(straightened).collect();
        }
        let has_inside = match layer.role {
            Role::Cut => true,
            Role::Draw => is_short,
            Role::Engrave => false,
        };
        let mut job = Job::default();
        for line in lines {
            let mut depth = 0;
            if has_inside {
                // What was cut out falls, whichever layer cut it; a pen stays at its own layer.
                let counts = |owner: &usize| match layer.role {
                    Role::Cut => sheet.layers[*owner].role == Role::Cut,
                    Role::Draw | Role::Engrave => *owner == number,
                };
                for owner in outlines.owners(&line).into_iter().filter(counts) {
                    depth += 1;
                    job.around.insert(owner);
                }
            }
            job.lines.push((depth, line));
        }
        job.around.remove(&number);
        job
    }

    fn deepest(&self) -> usize {
        self.lines
            .iter()
            .map(|(depth, _)| *depth)
            .max()
            .unwrap_or(0)
    }
}

/// A layer, and the depth of the lines that are drawn of it; all of them without one.
pub(super) type Step = (usize, Option<usize>);

/// The layers of a group so that each comes before those that have outlines around its lines, else
/// in their order; depth by depth where that cannot be.
pub(super) fn steps(jobs: &[Job], group: &[usize]) -> Vec<Step> {
    let mut waiting = group.to_vec();
    let mut steps = Vec::new();
    while !waiting.is_empty() {
        let is_free = |layer: &usize| {
            let inner = waiting.iter().filter(|other| *other != layer);
            inner
                .clone()
                .all(|other| !jobs[*other].around.contains(layer))
        };
        let Some(free) = waiting.iter().position(is_free) else {
            break;
        };
        steps.push((waiting.remove(free), None));
    }
    let deepest = waiting.iter().map(|&layer| jobs[layer].deepest()).max();
    for depth in (0..=deepest.unwrap_or(0)).rev() {
        let has = |layer: &&usize| jobs[**layer].lines.iter().any(|(d, _)| *d == depth);
        steps.extend(
            waiting
                .iter()
                .filter(has)
                .map(|&layer| (layer, Some(depth))),
        );
    }
    steps
}

/// The way so far.
struct Way<'a> {
    sheet: &'a Sheet,
    at: Cell,
    is_short: bool,
    layers: Vec<Layer>,
}

impl Way<'_> {
    fn go(&mut self, jobs: &[Job], (number, only): &Step) {
        let (layer, job) = (&self.sheet.layers[*number], &jobs[*number]);
        let mut items = Vec::new();
        if layer.style.fill.is_some() {
            items = filled(layer, self.sheet.unit_mm);
        }
        for depth in (0..=job.deepest()).rev() {
            if only.is_some_and(|only| only != depth) {
                continue;
            }
            let level = job.lines.iter().filter(|(d, _)| *d == depth);
            let mut level: Vec<Vec<Cell>> = level.map(|(_, line)| line.clone()).collect();
            if self.is_short {
                level = travel_order::ordered(level, self.at);
            }
            for line in level {
                self.at = *line.last().unwrap_or(&self.at);
                items.push(Item::Line(fixed_point::points(&line, self.sheet.unit_mm)));
            }
        }
        self.layers.push(layer.with(items));
    }
}

/// The items of a filled layer. Where they are cut and none is painted over another, those inside
/// of others come first.
fn filled(layer: &Layer, unit_mm: f64) -> Vec<Item> {
    let cells = |item: &Item| -> Vec<Vec<Cell>> {
        let lines = outlines(item).into_iter();
        lines
            .map(|line| fixed_point::cells(&line, unit_mm))
            .collect()
    };
    let of_items: Vec<Vec<Vec<Cell>>> = layer.items.iter().map(cells).collect();
    let closed = of_items.iter().flatten().filter(|line| is_closed(line));
    let nesting = Nesting::new(closed.map(Vec::as_slice));
    // The outline of an item comes last. In an odd number of others it lies on something filled.
    let depth = |lines: &Vec<Vec<Cell>>| lines.last().map_or(0, |line| nesting.around(line).len());
    let depths: Vec<usize> = of_items.iter().map(depth).collect();
    if layer.role != Role::Cut || depths.iter().any(|depth| depth % 2 == 1) {
        return layer.items.clone();
    }
    let mut items: Vec<(usize, &Item)> = depths.into_iter().zip(&layer.items).collect();
    items.sort_by_key(|(depth, _)| std::cmp::Reverse(*depth));
    items.into_iter().map(|(_, item)| item.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;
    use fretwork_geometry::Point;
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

    fn optimize(sheet: &Sheet) -> Sheet {
        ordered(sheet, &Outlines::of(sheet), true)
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
        assert_eq!(order(Role::Draw), [2.0, 4.0, 1.0, 0.0]);
        assert_eq!(order(Role::Engrave), [0.0, 1.0, 2.0, 4.0]);
    }

    /// A sheet with a layer for each list of squares, given by their least and greatest corner.
    fn squares(layers: &[(&str, Role, &[(f64, f64)])]) -> Sheet {
        let square = |&(a, b): &(f64, f64)| {
            let corners = [[a, a], [b, a], [b, b], [a, b], [a, a]];
            Item::Line(corners.map(Point::from).to_vec())
        };
        let layer = |(name, role, of): &(&str, Role, &[(f64, f64)])| Layer {
            name: (*name).into(),
            role: *role,
            style: Style::outline(0.1),
            items: of.iter().map(square).collect(),
        };
        Sheet {
            page: None,
            unit_mm: 1.0,
            layers: layers.iter().map(layer).collect(),
        }
    }

    fn names_and_counts(sheet: &Sheet) -> Vec<(String, usize)> {
        let of = |layer: &Layer| (layer.name.to_string(), layer.items.len());
        sheet.layers.iter().map(of).collect()
    }

    #[test]
    fn layers_inside_of_others_come_first() {
        let sheet = squares(&[
            ("plate", Role::Cut, &[(0.0, 100.0)]),
            ("mark", Role::Engrave, &[(60.0, 70.0)]),
            ("window", Role::Cut, &[(20.0, 60.0)]),
            ("note", Role::Draw, &[(80.0, 81.0)]),
        ]);
        let named = |names: [&str; 4]| names.map(|name| (name.to_owned(), 1)).to_vec();
        for is_short in [false, true] {
            let ordered = ordered(&sheet, &Outlines::of(&sheet), is_short);
            let expected = named(["mark", "note", "window", "plate"]);
            assert_eq!(names_and_counts(&ordered), expected);
        }
    }

    #[test]
    fn layers_inside_of_one_another_take_turns() {
        let sheet = squares(&[
            ("a", Role::Cut, &[(0.0, 100.0), (210.0, 220.0)]),
            ("b", Role::Cut, &[(200.0, 300.0), (10.0, 20.0)]),
        ]);
        let turns = [("a", 1), ("b", 1), ("a", 1), ("b", 1)].map(|(n, c)| (n.to_owned(), c));
        assert_eq!(names_and_counts(&optimize(&sheet)), turns);
    }

    #[test]
    fn layers_that_are_drawn_stay_whole() {
        let layers: [(&str, Role, &[(f64, f64)]); 2] = [
            ("a", Role::Draw, &[(0.0, 100.0), (210.0, 220.0)]),
            ("b", Role::Draw, &[(200.0, 300.0), (10.0, 20.0)]),
        ];
        let whole = [("a", 2), ("b", 2)].map(|(n, c)| (n.to_owned(), c));
        assert_eq!(names_and_counts(&optimize(&squares(&layers))), whole);
    }

    #[test]
    fn holes_are_cut_before_an_outline_that_a_neighbour_has_a_part_of() {
        // The second square shares a side with the first, so it is no closed line any more.
        let frame = [[9.0, 0.0], [18.0, 0.0], [18.0, 9.0], [9.0, 9.0], [9.0, 0.0]];
        let hole = [
            [12.0, 3.0],
            [15.0, 3.0],
            [15.0, 6.0],
            [12.0, 6.0],
            [12.0, 3.0],
        ];
        let first = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [0.0, 0.0]];
        let before = sheet(Role::Cut, &[&first, &frame, &hole]);
        let once = super::super::deduplicate::deduplicate(
            &before,
            fretwork_geometry::planar_map::resolution(10.0),
        );
        let after = lines(&ordered(&once, &Outlines::of(&before), true));
        assert_eq!((after.len(), after[0].len()), (3, 5));
        assert!(after[0].iter().all(|p| p[0] >= 12.0 && p[0] <= 15.0));
    }

    #[test]
    fn filled_cuts_are_ordered_unless_they_are_painted_over_one_another() {
        let mut sheet = squares(&[("a", Role::Cut, &[(0.0, 9.0), (1.0, 8.0), (2.0, 3.0)])]);
        sheet.layers[0].style = Style::filled(crate::Color::default());
        let order = |sheet: &Sheet| -> Vec<f64> {
            let least = |line: &Vec<[f64; 2]>| line.iter().map(|p| p[0]).fold(9.0, f64::min);
            lines(&optimize(sheet)).iter().map(least).collect()
        };
        assert_eq!(order(&sheet), [0.0, 1.0, 2.0]);
        // A frame around an island.
        let ring = |item: &Item| item.points().take(4).collect::<Vec<Point>>();
        let rings: Vec<Vec<Point>> = sheet.layers[0].items.iter().map(ring).collect();
        let area = |outer: usize, holes: &[usize]| {
            Item::Area(fretwork_geometry::Polygon {
                outer: rings[outer].clone(),
                holes: holes.iter().map(|&hole| rings[hole].clone()).collect(),
            })
        };
        sheet.layers[0].items = vec![area(0, &[1]), area(2, &[])];
        assert_eq!(order(&sheet), [2.0, 0.0]);
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
