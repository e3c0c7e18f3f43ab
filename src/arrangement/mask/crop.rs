//! Curves cut at the border of a region.

use crate::error::ArrangementError;
use crate::mask::overlay::{Overlay, outline};
use crate::mask::region_raster::{RegionRaster, Side};
use fretwork_geometry::{Bounds, Curves, Region};

/// The parts of `curves`, which do not cross one another, in the closed `region`; labels stay.
pub(crate) fn crop(
    curves: &Curves,
    region: &Region,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    let raster = RegionRaster::new(region, (4 * curves.len()).clamp(256, 1_000_000), resolution);
    let side =
        |points: &[fretwork_geometry::Point]| raster.side(&Bounds::of(points.iter().copied()));
    let mut inside = curves.filtered(|_, curve| side(curve.points) == Side::Inside);
    let cut = curves.filtered(|_, curve| side(curve.points) == Side::Border);
    let overlay = Overlay::new(&cut, &outline(region), resolution)?;
    overlay.add_parts(
        |_, e| overlay.touches_inside(e).then_some(()),
        |labels, ()| labels,
        &mut inside,
    );
    Ok(inside)
}
