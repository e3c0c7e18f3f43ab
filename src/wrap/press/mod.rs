//! An outline pressed into triangles: they are divided along it, and told which of them it surrounds.
//!
//! 1. `trace` cuts the outline where it crosses sides of triangles and maps the pieces into the plane of counting, in which
//!    the triangles of the whole way around the surface lie side by side.
//! 2. A planar map of sides and pieces divides the triangles there; it is robust against all that coincides or nearly does.
//! 3. `divide` makes triangles of its faces and finds each corner on the surface again.
//! 4. `inside` tells by the drawing which of them are filled.

mod divide;
mod edges;
mod inside;
mod trace;

use fretwork_geometry::{
    CurveLabels, Curves, Imprint, LabelSet, Mesh, PlanarMap, Polygon, planar_map,
};

use crate::WrapError;
use crate::chart::Chart;
use trace::Traced;

/// The resolution of a planar map is this many times finer than that of pressing.
const COARSER: f64 = 1024.0;

/// What is known of the triangles of an imprint, one by one.
pub struct Pressed {
    /// The divided mesh.
    pub imprint: Imprint,
    /// For each triangle the number of the flap that it is a part of; none outside of the chart.
    pub flaps: Vec<Option<u32>>,
}

/// The label of pieces of the outline.
const OUTLINE: &str = "outline";

/// The surface divided along the outline of `area`.
///
/// # Errors
/// What reaches over the chart or lies on it twice, and outlines that have too many parts.
pub fn press(mesh: &Mesh, chart: &Chart, area: &[Polygon]) -> Result<Pressed, WrapError> {
    let Traced { pieces } = trace::trace(mesh, chart, area)?;
    let mut curves = Curves::new();
    let outline = CurveLabels::edge(LabelSet::one(OUTLINE));
    for [a, b] in pieces {
        curves.push([a, b], outline);
    }
    for side in trace::sides(chart) {
        curves.push(side, CurveLabels::default());
    }
    let resolution = COARSER * planar_map::resolution(curves.bounds().longer_side());
    let map = PlanarMap::build(&curves, resolution)?;
    let mut divided = divide::divide(chart, &map, resolution);
    let filled = inside::filled(chart, &map, &divided, area);
    let inside: Vec<bool> = divided
        .faces
        .iter()
        .map(|face| filled[face.0 as usize])
        .collect();
    let rest = chart.others.iter().map(|t| mesh.triangles[*t as usize]);
    divided.append(rest);
    let count = divided.triangles.len();
    let mut flaps: Vec<Option<u32>> = divided.flaps.iter().map(|flap| Some(*flap)).collect();
    flaps.resize(count, None);
    let mut inside = inside;
    inside.resize(count, false);
    let imprint = Imprint {
        surface: mesh.clone(),
        places: divided.places,
        triangles: divided.triangles,
        inside,
    };
    Ok(Pressed { imprint, flaps })
}
