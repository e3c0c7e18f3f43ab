//! Meshes as line drawings: the edges that are to be drawn, and which parts of them are seen.
//!
//! 1. `features` finds borders, silhouettes and creases.
//! 2. `occlusion` takes from each of them what lies behind a triangle.
//! 3. `covered` leaves out what is hidden where a line that is seen is drawn over it.
//! 4. `chains` joins what is left to lines.
//!
//! All of it is geometry in the plane and along the view, no picture is searched for what is hidden (Appel, The notion of
//! quantitative invisibility, 1967, asks the same of each edge by counting).

mod chains;
mod covered;
mod features;
mod occlusion;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

use super::Mesh;
use crate::budget::{self, Meter};
use crate::{Point, View};

use features::edges;
use occlusion::Occluders;

/// Bytes for a triangle in a drawing, with its share of the edges and of the grid.
const TRIANGLE: usize = 200;
/// Steps for a triangle, and for one that an edge may be behind.
const TRIANGLE_STEPS: u64 = 60;
const BEHIND_STEPS: u64 = 5;

/// What an edge is drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LineKind {
    /// The surface ends there.
    Border,
    /// It turns away from the viewer there.
    Silhouette,
    /// It is bent sharply there.
    Crease,
}

/// A line of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its points, as the view draws them.
    pub points: Vec<Point>,
    /// What it is drawn for.
    pub kind: LineKind,
    /// Whether it is seen; otherwise something lies before it.
    pub is_visible: bool,
}

/// Which lines are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// The cosine of the angle between the normals of two triangles, below which their edge is a crease.
    pub crease: f64,
    /// Those that are hidden too.
    pub hidden: bool,
}

/// The lines of a mesh in a view: its borders, its silhouette and its creases, and of them what no triangle hides. Lines that
/// a triangle lies before by less than about 10⁻⁷ of the size of the mesh count as seen, what runs along a silhouette behind it
/// as hidden. Of what is hidden only that is given over which no line is drawn that is seen.
///
/// Corners in one place are one. Lines stand in the order of the edges of the mesh; the same for any number of threads. O(n log n)
/// where the edges that are drawn lie behind few of the n triangles each.
pub fn line_drawing(mesh: &Mesh, view: &View, wanted: Wanted) -> Vec<Line> {
    let mesh = mesh.welded();
    if mesh.triangles.is_empty() {
        return Vec::new();
    }
    budget::make("triangles", mesh.triangles.len(), TRIANGLE);
    budget::spend(
        "triangles of a drawing",
        TRIANGLE_STEPS * mesh.triangles.len() as u64,
    );
    let (mut edges, is_closed) = edges(&mesh, view, wanted.crease);
    let occluders = Occluders::new(&mesh, view, is_closed);
    edges.retain(|edge| occluders.is_line(edge));
    let meter = Meter::current();
    let parts: Vec<Vec<Stretch>> = edges
        .par_iter()
        .enumerate()
        .map(|(number, edge)| {
            meter.during(|| {
                let hidden = occluders.hidden(edge);
                stretches(number as u32, &hidden, wanted.hidden)
            })
        })
        .collect();
    let mut parts = parts.concat();
    if wanted.hidden {
        parts = covered::uncovered(&edges, parts, &occluders);
    }
    chains::join(&edges, &parts, &occluders)
}

/// A part of an edge: from and to, as parts of its length.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stretch {
    /// The number of the edge.
    edge: u32,
    from: f64,
    to: f64,
    is_visible: bool,
}

/// The parts of an edge that are seen, and with `all` those that are hidden, from its beginning to its end.
fn stretches(edge: u32, hidden: &[[f64; 2]], all: bool) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    let mut add = |from: f64, to: f64, is_visible: bool| {
        if to > from && (is_visible || all) {
            stretches.push(Stretch {
                edge,
                from,
                to,
                is_visible,
            });
        }
    };
    let mut at = 0.0;
    for &[from, to] in hidden {
        add(at, from, true);
        add(from, to, false);
        at = to;
    }
    add(at, 1.0, true);
    stretches
}
