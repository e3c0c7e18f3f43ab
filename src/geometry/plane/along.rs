//! Which lines run along others, found without the crossings of all: hatches cross much and seldom lie on one another.
//!
//! Where two pieces lie on one line, an end of one of them lies on the other. Pieces of about one direction are looked at together, in a
//! frame in which they are level, so that their boxes are thin and an end finds few.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::index::{BoxTree, Extent};
use crate::{Bounds, Point, budget};

/// Lines that are no farther apart than so many resolutions may be one in a planar map.
const NEAR: f64 = 2.0;
/// Half of the directions of a circle are looked at in so many parts.
const DIRECTIONS: i64 = 4096;
/// What pieces have in common that is shorter than so many times how near they are is an end that they share, and a piece that
/// is shorter than the second number is too short to have a direction.
const SHORT: f64 = 4.0;
const VAGUE: f64 = 40.0;
/// Steps of the budget for a piece.
const STEPS: u64 = 100;

/// A piece of a line between two points, and the line's number.
struct Piece {
    line: u32,
    ends: [Point; 2],
}

/// For each line whether a part of it may be one with a part of another line, or of itself, in a planar map of this
/// `resolution`, a length. `counts` tells by the numbers of two lines whether they matter. Pieces of fewer than 80 resolutions, and
/// parts of fewer than 8, are passed over. O(n log n) for n pieces of which few are in one place.
pub fn along_others<'a>(
    lines: impl Iterator<Item = &'a [Point]>,
    resolution: f64,
    counts: impl Fn(u32, u32) -> bool + Sync,
) -> Vec<bool> {
    let near = NEAR * resolution;
    let mut pieces = Vec::new();
    let mut is_along = Vec::new();
    for (line, points) in (0u32..).zip(lines) {
        is_along.push(false);
        let ends = points.windows(2).map(|ends| [ends[0], ends[1]]);
        let is_clear = |ends: &[Point; 2]| ends[0].distance(ends[1]) > VAGUE * near;
        pieces.extend(ends.filter(is_clear).map(|ends| Piece { line, ends }));
    }
    budget::spend("pieces of lines", STEPS * pieces.len() as u64);
    let mut numbered: Vec<(i64, u32)> = (0u32..)
        .zip(&pieces)
        .flat_map(|(number, piece)| directions(piece, near).map(move |n| (n, number)))
        .collect();
    numbered.par_sort_unstable();
    let groups: Vec<&[(i64, u32)]> = numbered.chunk_by(|a, b| a.0 == b.0).collect();
    let found = groups.par_iter().flat_map_iter(|group| {
        let alike: Vec<&Piece> = group.iter().map(|(_, n)| &pieces[*n as usize]).collect();
        let angle = group[0].0 as f64 * PI / DIRECTIONS as f64;
        along(&alike, (angle, near), &counts)
    });
    for line in found.collect::<Vec<u32>>() {
        is_along[line as usize] = true;
    }
    is_along
}

/// The numbers of the directions that a piece may have, whose ends may lie `near` by. Up is down.
fn directions(piece: &Piece, near: f64) -> impl Iterator<Item = i64> + use<> {
    let along = piece.ends[1] - piece.ends[0];
    let angle = libm::atan2(along.y, along.x);
    let vague = 2.0 * near / along.length();
    let number = |angle: f64| (angle * DIRECTIONS as f64 / PI).round() as i64;
    let all = number(angle - vague)..=number(angle + vague);
    all.map(|number| number.rem_euclid(DIRECTIONS))
}

/// The lines of pieces of about one direction that lie on others.
fn along(
    alike: &[&Piece],
    (angle, near): (f64, f64),
    counts: &(impl Fn(u32, u32) -> bool + Sync),
) -> Vec<u32> {
    let mut found = Vec::new();
    if alike.len() < 2 {
        return found;
    }
    let (u, v) = (libm::cos(angle), libm::sin(angle));
    let turned = |p: Point| Point::new(p.x * u + p.y * v, p.y * u - p.x * v);
    let level: Vec<[Point; 2]> = alike.iter().map(|piece| piece.ends.map(turned)).collect();
    let box_of = |ends: &[Point; 2]| Extent::from(Bounds::of(*ends));
    let tree = BoxTree::of(level.iter().map(box_of).collect());
    for (number, ends) in (0u32..).zip(&level) {
        let line = alike[number as usize].line;
        for end in ends {
            let view = Extent::from(Bounds::of([*end]).grown(near));
            tree.for_meeting(&view, |other| {
                let there = alike[other as usize].line;
                if other != number
                    && counts(line, there)
                    && share(ends, &level[other as usize], near)
                {
                    found.extend([line, there]);
                }
            });
        }
    }
    found
}

/// Whether two pieces that are about level have a part in common.
fn share(a: &[Point; 2], b: &[Point; 2], near: f64) -> bool {
    let range = |ends: &[Point; 2]| [ends[0].x.min(ends[1].x), ends[0].x.max(ends[1].x)];
    let ([a0, a1], [b0, b1]) = (range(a), range(b));
    let (from, to) = (a0.max(b0), a1.min(b1));
    let height = |ends: &[Point; 2], x: f64| {
        let part = (x - ends[0].x) / (ends[1].x - ends[0].x);
        ends[0].y + (ends[1].y - ends[0].y) * part
    };
    let apart = |x: f64| (height(a, x) - height(b, x)).abs();
    to - from > SHORT * near && apart(from) <= near && apart(to) <= near
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CurveLabels, Curves, LabelSet, PlanarMap, Seed, planar_map};

    /// The curves that a planar map has along others with other labels.
    fn oracle(curves: &Curves, resolution: f64) -> Vec<bool> {
        let map = PlanarMap::build(curves, resolution).expect("it is a planar map");
        let own: Vec<LabelSet> = curves.iter().map(|curve| curve.labels.edge).collect();
        let mut is_along = vec![false; curves.len()];
        for edge in map.edges() {
            for source in map.sources(edge) {
                is_along[source.curve as usize] |=
                    own[source.curve as usize] != map.labels(edge).edge;
            }
        }
        is_along
    }

    #[test]
    fn curves_along_others_are_those_of_the_planar_map() {
        let mut found = 0;
        for round in 0..60 {
            let seed = Seed::root(round);
            let mut curves = Curves::new();
            // Lines through few places in few directions, so that many lie on others, and many touch in their ends.
            let turn = [0.0, 0.4, 1.3][round as usize % 3];
            for n in 0..40 {
                let whole = |k: u64| (seed.unit(8 * n + k) * 4.0).floor();
                let angle = turn + PI / 4.0 * (seed.unit(8 * n) * 8.0).floor();
                let place = Point::new(whole(1), whole(2)) * 10.0;
                let from = place + Point::unit(angle) * (whole(3) * 3.0);
                let bend = from + Point::unit(angle) * (2.0 + whole(4) * 5.0);
                let end = bend + Point::unit(angle + 1.0) * (1.0 + whole(5));
                let label = ["a", "b"][(seed.unit(8 * n + 6) * 2.0) as usize];
                curves.push([from, bend, end], CurveLabels::edge(LabelSet::of([label])));
            }
            let resolution = planar_map::resolution(100.0);
            let labels: Vec<LabelSet> = curves.iter().map(|curve| curve.labels.edge).collect();
            let lines = curves.iter().map(|curve| curve.points);
            let told = along_others(lines, resolution, |a, b| {
                labels[a as usize] != labels[b as usize]
            });
            assert_eq!(told, oracle(&curves, resolution), "{round}");
            found += told.iter().filter(|is_along| **is_along).count();
        }
        assert!(found > 300, "{found}");
    }

    #[test]
    fn a_line_may_run_along_itself() {
        let line = [[0.0, 0.0], [4.0, 0.0], [1.0, 0.0]].map(Point::from);
        let corner = [[0.0, 5.0], [4.0, 5.0], [8.0, 5.0], [8.0, 9.0]].map(Point::from);
        let lines = [&line[..], &corner[..]];
        let told = along_others(lines.into_iter(), 1e-6, |_, _| true);
        assert_eq!(told, [true, false]);
    }
}
