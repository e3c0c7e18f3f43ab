//! An outline cut where it crosses the sides of triangles, each piece mapped into the plane of counting.

use std::collections::BTreeMap;

use rayon::prelude::*;

use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::{Bounds, Mesh, Point, Polygon, budget};

use super::edges::edges;
use crate::WrapError;
use crate::chart::{Chart, Flap, Room};

/// Places are on a side of a triangle within this part of the triangle.
const ON_SIDE: f64 = 1e-9;
/// So much of an edge may lie on no triangle, or on two.
const LOST: f64 = 1e-6;

/// Steps charged for an edge of the outline, and for a triangle that it may cross.
const EDGE: u64 = 200;

/// The pieces of an outline.
pub struct Traced {
    /// Segments in the plane of counting.
    pub pieces: Vec<[Point; 2]>,
}

/// The sides of all triangles of a chart in the plane of counting, each once.
pub fn sides(chart: &Chart) -> Vec<[Point; 2]> {
    let mut known: BTreeMap<[u64; 4], [Point; 2]> = BTreeMap::new();
    for flap in &chart.flaps {
        for i in 0..3 {
            let (a, b) = (flap.plan[i], flap.plan[(i + 1) % 3]);
            let (a, b) = if (a.x, a.y) < (b.x, b.y) {
                (a, b)
            } else {
                (b, a)
            };
            known.insert([a.x, a.y, b.x, b.y].map(f64::to_bits), [a, b]);
        }
    }
    known.into_values().collect()
}

/// The outline of `area` in pieces, each on one triangle.
///
/// # Errors
/// On a chart that is a patch, an outline that leaves it or lies on it twice.
pub fn trace(mesh: &Mesh, chart: &Chart, area: &[Polygon]) -> Result<Traced, WrapError> {
    let edges: Vec<[Point; 2]> = edges(area).filter(|[a, b]| a != b).collect();
    budget::spend("edges to be wrapped", EDGE * edges.len() as u64);
    let boxes: Vec<Extent<2>> = chart
        .flaps
        .iter()
        .map(|flap| Bounds::of(flap.drawn).into())
        .collect();
    let tree = BoxTree::new(&boxes);
    let is_patch = matches!(chart.room, Room::Flaps);
    let work = |edge: &[Point; 2]| {
        let met = tree.meeting(&Bounds::of(*edge).into());
        let mut cut = Cut::default();
        for number in met {
            cut.by(*edge, &chart.flaps[number as usize], number);
        }
        if is_patch {
            cut.check(*edge, chart, mesh)?;
        }
        Ok(cut
            .pieces
            .into_iter()
            .map(|piece| piece.ends)
            .collect::<Vec<_>>())
    };
    let found: Result<Vec<Vec<[Point; 2]>>, WrapError> = edges.par_iter().map(work).collect();
    let pieces: Vec<[Point; 2]> = found?.into_iter().flatten().collect();
    Ok(Traced { pieces })
}

/// A piece of an edge.
struct Piece {
    /// From where to where along the edge.
    along: [f64; 2],
    /// It runs on a side of its triangle, so that the neighbour has it too.
    is_on_side: bool,
    flap: u32,
    ends: [Point; 2],
}

/// The pieces of one edge.
#[derive(Default)]
struct Cut {
    pieces: Vec<Piece>,
}

impl Cut {
    /// Adds what of an edge lies on a triangle.
    fn by(&mut self, [p, q]: [Point; 2], flap: &Flap, number: u32) {
        let way = q - p;
        let mut places = vec![(0.0, onto(flap, p)), (1.0, onto(flap, q))];
        for i in 0..3 {
            // From the lower number of a corner to the higher, so that both triangles at a side find the same place.
            let j = (i + 1) % 3;
            let (i, j) = if flap.corners[i] < flap.corners[j] {
                (i, j)
            } else {
                (j, i)
            };
            let (a, side) = (flap.drawn[i], flap.drawn[j] - flap.drawn[i]);
            let across = way.cross(side);
            if across.abs() <= 1e-14 * way.length() * side.length() {
                continue;
            }
            let t = (a - p).cross(side) / across;
            let s = (a - p).cross(way) / across;
            if (0.0..=1.0).contains(&t) && (-ON_SIDE..=1.0 + ON_SIDE).contains(&s) {
                places.push((t, flap.plan[i].lerp(flap.plan[j], s.clamp(0.0, 1.0))));
            }
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in places.windows(2) {
            let along = [pair[0].0, pair[1].0];
            if along[1] - along[0] < 1e-13 {
                continue;
            }
            let least = least_weight(flap, p + way * (0.5 * (along[0] + along[1])));
            if least >= -ON_SIDE {
                self.pieces.push(Piece {
                    along,
                    is_on_side: least <= ON_SIDE,
                    flap: number,
                    ends: [pair[0].1, pair[1].1],
                });
            }
        }
    }

    /// An error where a part of the edge lies on no triangle or on two that are no neighbours.
    fn check(&mut self, [p, q]: [Point; 2], chart: &Chart, mesh: &Mesh) -> Result<(), WrapError> {
        self.pieces
            .sort_by(|a, b| a.along[0].total_cmp(&b.along[0]).then(a.flap.cmp(&b.flap)));
        let mut reached = 0.0f64;
        for piece in &self.pieces {
            if piece.along[0] > reached + LOST {
                break;
            }
            if piece.along[1].min(reached) > piece.along[0] + LOST && !piece.is_on_side {
                let corner = chart.flaps[piece.flap as usize].corners[0];
                let at = mesh.positions[corner as usize];
                return Err(WrapError::TurnsBack { at, fits: None });
            }
            reached = reached.max(piece.along[1]);
        }
        if reached >= 1.0 - LOST {
            return Ok(());
        }
        let lost = [p.lerp(q, reached), q];
        let by = lost.map(|p| off(chart, p));
        Err(WrapError::TooLarge {
            by: by[0].max(by[1]),
            fits: None,
        })
    }
}

/// How far a place is from what the triangles cover.
fn off(chart: &Chart, p: Point) -> f64 {
    let to_side = |a: Point, b: Point| {
        let way = b - a;
        let t = ((p - a).dot(way) / way.dot(way)).clamp(0.0, 1.0);
        a.lerp(b, t).distance(p)
    };
    let corners = chart.flaps.iter().map(|flap| flap.drawn);
    corners
        .map(|[a, b, c]| to_side(a, b).min(to_side(b, c)).min(to_side(c, a)))
        .fold(f64::INFINITY, f64::min)
}

/// How much of each corner of a triangle is in a place, in the drawing or in the plane of counting.
pub fn weights([a, b, c]: [Point; 3], p: Point) -> [f64; 3] {
    let whole = (b - a).cross(c - a);
    let of_b = (p - a).cross(c - a) / whole;
    let of_c = (b - a).cross(p - a) / whole;
    [1.0 - of_b - of_c, of_b, of_c]
}

fn least_weight(flap: &Flap, p: Point) -> f64 {
    weights(flap.drawn, p)
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

/// A place of the drawing in the plane of counting.
fn onto(flap: &Flap, p: Point) -> Point {
    let [a, b, c] = weights(flap.drawn, p);
    flap.plan[0] * a + flap.plan[1] * b + flap.plan[2] * c
}
