//! Curves cut at the border of a region.

use crate::error::ArrangementError;
use crate::mask::overlay::{Overlay, outline};
use crate::mask::region_raster::{RegionRaster, Side};
use fretwork_geometry::{Bounds, Curves, Region};

/// The parts of `curves`, which do not cross one another, in the closed `region`; labels stay. Those that are certainly
/// inside come first, as a raster of so many `tiles` tells.
pub(crate) fn crop(
    curves: &Curves,
    (region, resolution): (&Region, f64),
    tiles: usize,
) -> Result<Curves, ArrangementError> {
    let raster = RegionRaster::new(region, tiles, resolution);
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
