//! The lines of fills as areas, widened and clipped to the visible part of their cells.

use fretwork_geometry::drawing::{FillRule, Stroke};
use fretwork_geometry::polygon::{AreaError, fill, intersect, stroke_outlines};
use fretwork_geometry::{Curves, Facade, Point, Polygon};

/// The greatest distance of a rounded corner from a circle, in widths of the line. A finer one only adds
/// triangles that cannot be made; a coarser one shows in renderings.
const ROUNDNESS: f64 = 0.05;

/// The areas of the lines in a cell, on the canvas with y up; `None` if the cell has no fill. `seen` is the
/// visible part of the cell in the plane of the elevation.
pub fn ridges(
    facade: &Facade,
    cell: usize,
    seen: &[Polygon],
) -> Result<Option<Vec<Polygon>>, AreaError> {
    let (Some(lines), Some(shape)) = (facade.fills.get(&(cell as u32)), facade.shape(cell)) else {
        return Ok(None);
    };
    let widened = intersect(&widened(lines, shape.relief.width)?, seen)?;
    let height = facade.layout.height;
    let upward = |ring: &Vec<Point>| {
        ring.iter()
            .rev()
            .map(|p| Point::new(p.x, height - p.y))
            .collect()
    };
    let flipped = |p: &Polygon| Polygon {
        outer: upward(&p.outer),
        holes: p.holes.iter().map(upward).collect(),
    };
    Ok(Some(widened.iter().map(flipped).collect()))
}

fn widened(lines: &Curves, width: f64) -> Result<Vec<Polygon>, AreaError> {
    let mut pieces = Vec::new();
    for line in lines.iter() {
        stroke_outlines(
            line.points,
            &Stroke::round(width),
            ROUNDNESS * width,
            &mut pieces,
        );
    }
    fill(&pieces, FillRule::NonZero)
}
