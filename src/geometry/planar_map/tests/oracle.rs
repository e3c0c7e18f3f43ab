//! The slow, obvious planar map of curves on a lattice, whose pieces run along the sides and the
//! diagonals of unit squares: a set of steps and a flood fill. Curves start at even points and
//! move in eight directions, so that diagonals meet in points of the lattice.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;

use super::super::*;
use crate::{CurveLabels, Curves, LabelSet, Point};

/// Points of the lattice are 0..=SIZE; squares reach one beyond.
const SIZE: i32 = 12;
const DIRECTIONS: [(i32, i32); 8] = [
    (2, 0),
    (2, 2),
    (0, 2),
    (-2, 2),
    (-2, 0),
    (-2, -2),
    (0, -2),
    (2, -2),
];
/// The length of a step, exact on the grid.
const UNIT: f64 = 0.0625;

type Node = (i32, i32);
/// A quarter of a square: the square's corner of least coordinates and the side that the quarter lies on, 0
/// toward -y, 1 toward +x, 2 toward +y, 3 toward -x.
type Quarter = (i32, i32, usize);

/// A curve as the lattice points that it visits, one step apart.
fn curve(start: Node, moves: &[(usize, usize)]) -> Vec<Node> {
    let mut path = vec![(start.0 * 2, start.1 * 2)];
    for &(direction, count) in moves {
        for _ in 0..count {
            let (x, y) = path[path.len() - 1];
            let (dx, dy) = DIRECTIONS[direction];
            if (0..=SIZE).contains(&(x + dx)) && (0..=SIZE).contains(&(y + dy)) {
                path.extend([(x + dx / 2, y + dy / 2), (x + dx, y + dy)]);
            }
        }
    }
    path
}

fn paths() -> impl Strategy<Value = Vec<Vec<Node>>> {
    let moves = prop::collection::vec((0usize..8, 1usize..4), 1..6);
    let curve =
        ((0..=SIZE / 2, 0..=SIZE / 2), moves).prop_map(|(start, moves)| curve(start, &moves));
    let curve = curve.prop_filter("a point is no curve", |path| path.len() > 1);
    prop::collection::vec(curve, 1..8)
}

fn labels_of(i: usize) -> CurveLabels {
    let one = |kind: &str| LabelSet::one(&format!("{kind}{i}"));
    CurveLabels {
        edge: one("e"),
        left: one("l"),
        right: one("r"),
        start: one("s"),
        end: one("t"),
    }
}

fn curves_of(paths: &[Vec<Node>]) -> Curves {
    let mut curves = Curves::new();
    for (i, path) in paths.iter().enumerate() {
        curves.push(path.iter().map(|n| point(*n)), labels_of(i));
    }
    curves
}

fn point(n: Node) -> Point {
    Point::new(f64::from(n.0) * UNIT, f64::from(n.1) * UNIT)
}

/// The quarters on the left and on the right of a step.
fn sides((x, y): Node, (u, v): Node) -> (Vec<Quarter>, Vec<Quarter>) {
    let (cx, cy) = (x.min(u), y.min(v));
    let (left, right) = match (u - x, v - y) {
        (1, 0) => (vec![(cx, cy, 0)], vec![(cx, cy - 1, 2)]),
        (0, 1) => (vec![(cx - 1, cy, 1)], vec![(cx, cy, 3)]),
        (1, 1) => (
            vec![(cx, cy, 2), (cx, cy, 3)],
            vec![(cx, cy, 0), (cx, cy, 1)],
        ),
        (-1, 1) => (
            vec![(cx, cy, 0), (cx, cy, 3)],
            vec![(cx, cy, 1), (cx, cy, 2)],
        ),
        _ => {
            let (left, right) = sides((u, v), (x, y));
            return (right, left);
        }
    };
    (left, right)
}

/// The map by brute force.
struct Oracle {
    degree: BTreeMap<Node, BTreeSet<Node>>,
    vertex_labels: BTreeMap<Node, LabelSet>,
    regions: BTreeMap<Quarter, usize>,
    /// Of every region its labels and its quarters; region 0 is outside.
    faces: Vec<(LabelSet, usize)>,
}

impl Oracle {
    fn of(paths: &[Vec<Node>]) -> Oracle {
        let mut oracle = Oracle {
            degree: BTreeMap::new(),
            vertex_labels: BTreeMap::new(),
            regions: BTreeMap::new(),
            faces: Vec::new(),
        };
        for (i, path) in paths.iter().enumerate() {
            for w in path.windows(2) {
                oracle.degree.entry(w[0]).or_default().insert(w[1]);
                oracle.degree.entry(w[1]).or_default().insert(w[0]);
            }
            let (labels, last) = (labels_of(i), path.len() - 1);
            for (node, label) in [(path[0], labels.start), (path[last], labels.end)] {
                let all = oracle.vertex_labels.entry(node).or_default();
                *all = all.union(label);
            }
        }
        oracle.flood();
        for (i, path) in paths.iter().enumerate() {
            for w in path.windows(2) {
                let (left, right) = sides(w[0], w[1]);
                for (quarters, label) in [(left, labels_of(i).left), (right, labels_of(i).right)] {
                    let face = &mut oracle.faces[oracle.regions[&quarters[0]]].0;
                    *face = face.union(label);
                }
            }
        }
        oracle.faces[0].0 = LabelSet::EMPTY;
        oracle
    }

    fn has(&self, a: Node, b: Node) -> bool {
        self.degree.get(&a).is_some_and(|n| n.contains(&b))
    }

    /// The quarters that nothing separates from this one.
    fn open(&self, (x, y, side): Quarter) -> Vec<Quarter> {
        let across = [
            ((x, y), (x + 1, y), (x, y - 1, 2)),
            ((x + 1, y), (x + 1, y + 1), (x + 1, y, 3)),
        ];
        let beyond = [
            ((x, y + 1), (x + 1, y + 1), (x, y + 1, 0)),
            ((x, y), (x, y + 1), (x - 1, y, 1)),
        ];
        let (a, b, out) = if side < 2 {
            across[side]
        } else {
            beyond[side - 2]
        };
        let mut open = if self.has(a, b) { vec![] } else { vec![out] };
        let (rising, falling) = (
            self.has((x, y), (x + 1, y + 1)),
            self.has((x + 1, y), (x, y + 1)),
        );
        // The rising diagonal lies between sides 3 and 0 and between 1 and 2, the falling one between the others.
        let next = |side: usize| if side % 2 == 1 { rising } else { falling };
        if !next(side) {
            open.push((x, y, (side + 1) % 4));
        }
        if !next((side + 3) % 4) {
            open.push((x, y, (side + 3) % 4));
        }
        open
    }

    fn flood(&mut self) {
        let square = -1..=SIZE;
        for y in square.clone() {
            for x in square.clone() {
                for side in 0..4 {
                    if self.regions.contains_key(&(x, y, side)) {
                        continue;
                    }
                    let face = self.faces.len();
                    self.faces.push((LabelSet::EMPTY, 0));
                    let mut stack = vec![(x, y, side)];
                    while let Some(q) = stack.pop() {
                        if !square.contains(&q.0)
                            || !square.contains(&q.1)
                            || self.regions.contains_key(&q)
                        {
                            continue;
                        }
                        self.regions.insert(q, face);
                        self.faces[face].1 += 1;
                        stack.extend(self.open(q));
                    }
                }
            }
        }
    }

    fn is_vertex(&self, node: Node) -> bool {
        self.vertex_labels.contains_key(&node) || self.degree[&node].len() != 2
    }

    fn components(&self) -> usize {
        let mut seen = BTreeSet::new();
        let mut count = 0;
        for &start in self.degree.keys() {
            count += usize::from(!seen.contains(&start));
            let mut stack = vec![start];
            while let Some(n) = stack.pop() {
                if seen.insert(n) {
                    stack.extend(&self.degree[&n]);
                }
            }
        }
        count
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_map_of_lattice_curves_is_that_of_the_flood_fill(paths in paths()) {
        let map = PlanarMap::build(&curves_of(&paths), resolution(1.0)).unwrap();
        prop_assert_eq!(map.check(), Ok(()));
        let oracle = Oracle::of(&paths);
        let vertices: Vec<Node> = oracle.degree.keys().copied().filter(|n| oracle.is_vertex(*n)).collect();
        let ends: usize = vertices.iter().map(|n| oracle.degree[n].len()).sum();
        prop_assert_eq!(map.vertex_count(), vertices.len());
        prop_assert_eq!(map.edge_count(), ends / 2);
        prop_assert_eq!(map.face_count(), oracle.faces.len() - 1);
        prop_assert_eq!(map.component_count(), oracle.components());
        for v in map.vertices() {
            let at = map.location(v);
            let node = ((at.x / UNIT) as i32, (at.y / UNIT) as i32);
            prop_assert_eq!(at, point(node));
            prop_assert_eq!(map.vertex_labels(v), oracle.vertex_labels.get(&node).copied().unwrap_or_default());
        }
        let steps: usize = oracle.degree.values().map(BTreeSet::len).sum();
        let pieces: usize = map.edges().map(|e| map.points(e).count() - 1).sum();
        prop_assert_eq!(pieces, steps / 2);
    }

    #[test]
    fn every_place_is_in_the_face_that_the_flood_fill_gives_it(paths in paths()) {
        let map = PlanarMap::build(&curves_of(&paths), resolution(1.0)).unwrap();
        let oracle = Oracle::of(&paths);
        let mut face_of: BTreeMap<usize, FaceId> = BTreeMap::from([(0, FaceId::UNBOUNDED)]);
        for (&(x, y, side), &region) in &oracle.regions {
            let (dx, dy) = [(0.5, 0.25), (0.75, 0.5), (0.5, 0.75), (0.25, 0.5)][side];
            let face = map.face_at(Point::new((f64::from(x) + dx) * UNIT, (f64::from(y) + dy) * UNIT));
            prop_assert_eq!(*face_of.entry(region).or_insert(face), face);
        }
        let faces: BTreeSet<FaceId> = face_of.values().copied().collect();
        prop_assert_eq!(faces.len(), oracle.faces.len());
        for (region, (labels, quarters)) in oracle.faces.iter().enumerate() {
            let face = face_of[&region];
            prop_assert_eq!(map.face_labels(face), *labels);
            if region > 0 {
                let area = *quarters as f64 * UNIT * UNIT / 4.0;
                prop_assert!((map.face_area(face) - area).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn edges_carry_the_labels_of_all_curves_along_them(paths in paths()) {
        let map = PlanarMap::build(&curves_of(&paths), resolution(1.0)).unwrap();
        for e in map.edges() {
            let ends: Vec<Node> = map.points(e).map(|p| ((p.x / UNIT) as i32, (p.y / UNIT) as i32)).collect();
            let (mut edge, mut left, mut right) = (LabelSet::EMPTY, LabelSet::EMPTY, LabelSet::EMPTY);
            let mut first = None;
            for (i, path) in paths.iter().enumerate() {
                for w in path.windows(2) {
                    let forward = ends.windows(2).any(|p| p[0] == w[0] && p[1] == w[1]);
                    if !forward && !ends.windows(2).any(|p| p[0] == w[1] && p[1] == w[0]) {
                        continue;
                    }
                    let labels = if forward { labels_of(i) } else { labels_of(i).reversed() };
                    (edge, left, right) = (edge.union(labels.edge), left.union(labels.left), right.union(labels.right));
                    let runs: &mut (usize, [bool; 2]) = first.get_or_insert((i, [false; 2]));
                    if runs.0 == i {
                        runs.1[usize::from(forward)] = true;
                    }
                }
            }
            let carried = map.labels(e);
            prop_assert_eq!((carried.edge, carried.left, carried.right), (edge, left, right));
            let source = map.sources(e).next().unwrap();
            prop_assert_eq!(first.map(|f| (f.0, f.1[1])), Some((source.curve as usize, true)), "{:?}", e);
        }
    }
}
