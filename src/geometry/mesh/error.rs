//! What is wrong with a mesh, or with a polygon that is to become one.

use super::Point3;
use crate::counted;

/// Why a mesh cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// There is no triangle.
    #[error("the mesh has no triangles")]
    Empty,
    /// A coordinate is NaN or infinite.
    #[error("corner {corner} of the mesh has a coordinate that is not finite")]
    NotFinite {
        /// Number of the corner.
        corner: usize,
    },
    /// A triangle names a corner that there is not.
    #[error("triangle {triangle} of the mesh names a corner beyond its {corners} corners")]
    NoSuchCorner {
        /// Number of the triangle.
        triangle: usize,
        /// How many corners there are.
        corners: usize,
    },
    /// Edges with a triangle on one side only.
    #[error("the mesh is open: {} a triangle on one side only, {}", counted(*.edges, "edge has", "edges have"), place(*.edges, .near))]
    Open {
        /// How many there are.
        edges: usize,
        /// The middle of the first.
        near: Point3,
    },
    /// Edges where more than two triangles meet, or two that face opposite ways.
    #[error("the mesh is no surface: {} not join two triangles that face alike, {}", counted(*.edges, "edge does", "edges do"), place(*.edges, .near))]
    NotManifold {
        /// How many there are.
        edges: usize,
        /// The middle of the first.
        near: Point3,
    },
    /// A corner at which several fans of triangles touch.
    #[error("the mesh is pinched: parts of it touch in {}, {}", counted(*.corners, "corner", "corners"), place(*.corners, .near))]
    Pinched {
        /// How many there are.
        corners: usize,
        /// The first.
        near: Point3,
    },
    /// The triangles face inward.
    #[error("the mesh is inside out: its volume is {volume}")]
    InsideOut {
        /// The enclosed volume.
        volume: f64,
    },
}

/// Where things that are counted are, or the first of them.
fn place(count: usize, first: &Point3) -> String {
    let first = shown(first);
    match count {
        1 => format!("near {first}"),
        _ => format!("one near {first}"),
    }
}

/// A point in few digits.
fn shown(p: &Point3) -> String {
    let short = |v: f64| ((v * 1e4).round() / 1e4 + 0.0).to_string();
    format!("({}, {}, {})", short(p.x), short(p.y), short(p.z))
}

/// Why a polygon cannot be divided into triangles.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TriangulationError {
    /// A coordinate is NaN, infinite, or too large or too small to be computed with.
    #[error("({x}, {y}) is out of the range that can be computed with")]
    OutOfRange {
        /// The coordinate along x.
        x: f64,
        /// The coordinate along y.
        y: f64,
    },
    /// Sides of the polygon cross, or a corner lies on one.
    #[error("the sides of a polygon cross or touch near ({x}, {y})")]
    Crossing {
        /// The coordinate along x.
        x: f64,
        /// The coordinate along y.
        y: f64,
    },
}
