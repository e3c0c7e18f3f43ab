//! The repair of an exemplar whose outlines cross, touch, or hang together by a thread: what
//! overlaps is united, and a slight growing and shrinking closes slits and joins what touches.

use fretwork_geometry::drawing::Join;
use fretwork_geometry::polygon::{offset, unite};
use fretwork_geometry::{Bounds, Point, Polygon, TopologyError, neck, topology};

use super::error::{ExemplarError, ExemplarWarning};

/// The reach of a repair, as a part of the drawing's longer side: parts that are nearer become one.
/// The first closes what rounding has torn and changes nothing that anyone could see. The second,
/// 0.1 mm on 100 mm, is taken only where the first leaves parts hanging by a thread, and is told.
const REACHES: [f64; 2] = [2e-6, 1e-3];
/// What a repair leaves added to all outlines, as a part of its reach. With 0 parts that touched
/// would touch again; with 1 nothing would be taken back, and the shape would be fatter.
const GROWN: f64 = 0.4;
/// Necks and gaps below this many reaches are threads. A smaller number takes the joints that a
/// repair itself makes, which are about one reach wide, for sound.
const THREAD: f64 = 20.0;
/// Unions whose area differs by less than this part were not overlapping.
const SAME_AREA: f64 = 1e-6;

/// A repaired area with what is to be told about it.
type Mended = (Vec<Polygon>, Vec<ExemplarWarning>);

/// The repaired area, or none where `area` is sound as it is.
///
/// # Errors
/// Outlines that cross or touch and that no repair makes simple. An area that is simple but frail
/// stays as it is where it cannot be mended.
pub fn mend_if_needed(
    area: &[Polygon],
) -> Result<(Option<Vec<Polygon>>, Vec<ExemplarWarning>), ExemplarError> {
    let mended = match topology::count(area) {
        Ok(_) if !is_frail(area, THREAD * REACHES[0] * longer_side(area)) => None,
        Ok(_) => mend(area, None).ok(),
        Err(error) => Some(mend(area, Some(error))?),
    };
    Ok(mended.map_or((None, Vec::new()), |(area, warnings)| {
        (Some(area), warnings)
    }))
}

fn longer_side(area: &[Polygon]) -> f64 {
    area.iter()
        .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
        .longer_side()
}

/// Whether parts hang together by less than `width`, or are less than that apart.
fn is_frail(area: &[Polygon], width: f64) -> bool {
    !neck::below(area, width).is_empty()
}

/// What lies in any polygon, as simple rings that do not touch: slits are closed, and what touches
/// is joined.
fn mend(area: &[Polygon], error: Option<TopologyError>) -> Result<Mended, ExemplarError> {
    let place = error.and_then(|e| e.place());
    let total = |area: &[Polygon]| area.iter().map(Polygon::area).sum::<f64>();
    let united = unite(area)?;
    let mut warnings = Vec::new();
    // Where only outlines touch, nothing is told: that is how areas come out of unions.
    if (total(area) - total(&united)).abs() > SAME_AREA * total(&united) {
        warnings.push(ExemplarWarning::Crossing(place));
    }
    let side = longer_side(&united);
    let [gentle, firm] = REACHES.map(|part| part * side);
    if topology::count(&united).is_ok() && !is_frail(&united, THREAD * gentle) {
        return Ok((united, warnings));
    }
    let closed = close(&united, gentle)?;
    let is_simple = topology::count(&closed).is_ok();
    if is_simple && !is_frail(&closed, THREAD * gentle) {
        return Ok((closed, warnings));
    }
    mend_firmly(&united, firm, place, warnings, is_simple.then_some(closed))
}

/// The second repair, of a longer reach. Where it fails, `gentle`, the frail result of the first
/// one, is taken.
fn mend_firmly(
    united: &[Polygon],
    reach: f64,
    place: Option<Point>,
    mut warnings: Vec<ExemplarWarning>,
    gentle: Option<Vec<Polygon>>,
) -> Result<Mended, ExemplarError> {
    let closed = close(united, reach)?;
    if topology::count(&closed).is_ok() {
        warnings.push(ExemplarWarning::Joined(place));
        return Ok((closed, warnings));
    }
    let area = gentle.ok_or(ExemplarError::Touching(place))?;
    Ok((area, warnings))
}

/// Grows an area by `reach` and takes most of it back, which closes slits narrower than twice that.
fn close(area: &[Polygon], reach: f64) -> Result<Vec<Polygon>, ExemplarError> {
    let mut closed = area.to_vec();
    for by in [reach, (GROWN - 1.0) * reach] {
        closed = offset(&closed, by, Join::Miter(4.0), 0.1 * reach)?;
    }
    Ok(closed)
}
