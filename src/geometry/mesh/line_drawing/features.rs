//! The edges of a mesh that are drawn.

use rayon::prelude::*;

use super::LineKind;
use crate::mesh::{Mesh, doubled_normal};
use crate::{Point3, View};

/// An edge that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    /// Its corners, the lower number first.
    pub corners: [u32; 2],
    /// What it is drawn for.
    pub kind: LineKind,
    /// The triangles beside it: the first two in the order of their numbers, one twice where there is one only.
    pub beside: [u32; 2],
}

/// A triangle whose normal leans by less than this from the plane of drawing is seen edge-on, and faces neither way.
const EDGE_ON: f64 = 1e-9;

/// The cosine of the angle between two normals below which their triangles look into opposite directions.
const BACK_TO_BACK: f64 = -1.0 + 1e-9;

/// How a triangle faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Facing {
    Toward,
    Away,
    /// Edge-on, or without area.
    Neither,
}

/// The edges to draw, in the order of their corners, and whether every edge of the mesh lies between two triangles.
pub(super) fn edges(mesh: &Mesh, view: &View, crease: f64) -> (Vec<Edge>, bool) {
    let normal = |t: &[u32; 3]| doubled_normal(mesh.corners(*t)).unit();
    let normals: Vec<Option<Point3>> = mesh.triangles.par_iter().map(normal).collect();
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (t, number) in mesh.triangles.iter().zip(0..) {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            sides.push(([a.min(b), a.max(b)], number));
        }
    }
    sides.par_sort_unstable();
    let mut is_closed = true;
    let mut edges = Vec::new();
    for run in sides.chunk_by(|a, b| a.0 == b.0) {
        is_closed &= run.len().is_multiple_of(2);
        let beside: Vec<u32> = run.iter().map(|side| side.1).collect();
        let beside = without_joints(mesh, run[0].0, beside, &normals);
        let (Some(first), Some(kind)) = (beside.first(), kind(&beside, &normals, view, crease))
        else {
            continue;
        };
        edges.push(Edge {
            corners: run[0].0,
            kind,
            beside: [*first, *beside.get(1).unwrap_or(first)],
        });
    }
    (edges, is_closed)
}

/// The triangles beside an edge but for those that lie back to back, where bodies stand against each other: nobody sees the
/// joint of two bricks whose faces are flush, and no triangle is left in the middle of the face that both have.
fn without_joints(
    mesh: &Mesh,
    edge: [u32; 2],
    mut beside: Vec<u32>,
    normals: &[Option<Point3>],
) -> Vec<u32> {
    let [a, b] = edge.map(|corner| mesh.positions[corner as usize]);
    // From the edge to the third corner, square to the edge.
    let aside = |triangle: u32| {
        let corners = mesh.triangles[triangle as usize];
        let third = corners.iter().find(|corner| !edge.contains(corner));
        let third = third.map_or(Point3::ORIGIN, |c| mesh.positions[*c as usize] - a);
        let along = b - a;
        third - along * (third.dot(along) / along.dot(along))
    };
    let is_joint = |s: u32, t: u32| match (normals[s as usize], normals[t as usize]) {
        (Some(m), Some(n)) => m.dot(n) < BACK_TO_BACK && aside(s).dot(aside(t)) > 0.0,
        _ => false,
    };
    // A sheet that is folded flat has an edge.
    if beside.len() == 2 {
        return beside;
    }
    let joint = |beside: &[u32]| {
        let pairs = (0..beside.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let mut pairs = pairs.into_iter();
        pairs.find(|(i, j)| is_joint(beside[*i], beside[*j]))
    };
    while let Some((i, j)) = joint(&beside) {
        beside.remove(i);
        beside.remove(j);
    }
    beside
}

/// What the edge between triangles is drawn for, if it is.
fn kind(beside: &[u32], normals: &[Option<Point3>], view: &View, crease: f64) -> Option<LineKind> {
    if beside.len() == 1 {
        return Some(LineKind::Border);
    }
    let facing = |triangle: u32| match normals[triangle as usize] {
        Some(normal) if normal.dot(view.toward()) > EDGE_ON => Facing::Toward,
        Some(normal) if normal.dot(view.toward()) < -EDGE_ON => Facing::Away,
        _ => Facing::Neither,
    };
    let has = |wanted| beside.iter().any(|triangle| facing(*triangle) == wanted);
    if has(Facing::Toward) && (has(Facing::Away) || has(Facing::Neither)) {
        return Some(LineKind::Silhouette);
    }
    // Where several bodies touch, an edge bends from every triangle to every other.
    let pairs = beside
        .iter()
        .flat_map(|a| beside.iter().map(move |b| (*a, *b)));
    let bends = |(a, b): (u32, u32)| match (normals[a as usize], normals[b as usize]) {
        (Some(a), Some(b)) => a.dot(b) < crease,
        _ => false,
    };
    pairs.into_iter().any(bends).then_some(LineKind::Crease)
}
