//! Previews of tiles: what an artifact shows, several times side by side, so that the seams are seen. What a tile
//! is, and how files are made, is not known here.

use std::sync::Arc;

use fretwork_action::Action;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Point, Region};
use fretwork_language::kinds::artifacts::{Artifact, Format};

/// Where the copies of all that is shown stand: once in its place, without a preview.
pub(super) fn shifts(action: &Action, kind: &Artifact) -> Vec<Point> {
    let Some((period, [columns, rows])) = tiles(action, kind) else {
        return vec![Point::ORIGIN];
    };
    let row = |j: u32| (0..columns).map(move |i| [i, j]);
    let cells = (0..rows).flat_map(row);
    cells
        .map(|[i, j]| Point::new(period.x * f64::from(i), period.y * f64::from(j)))
        .collect()
}

/// The region that an artifact shows: its own, or as many of it as its preview shows.
pub(super) fn shown(action: &Action, kind: &Artifact) -> Option<Arc<Region>> {
    let region = kind.region.as_ref().map(|region| action.input(region))?;
    let Some((period, [columns, rows])) = tiles(action, kind) else {
        return Some(region);
    };
    let corner = region.bounds().min;
    let size = Point::new(period.x * f64::from(columns), period.y * f64::from(rows));
    Some(Arc::new(Region::rectangle(corner, corner + size)))
}

/// The period of the region and how many tiles there are along x and along y, where tiles are asked for.
fn tiles(action: &Action, kind: &Artifact) -> Option<(Point, [u32; 2])> {
    let region = action.input(kind.region.as_ref()?);
    Some((region.period?, kind.repeat?.0))
}

/// Whether a preview can be made.
///
/// # Errors
/// Formats of other things than drawings, and a region that is no tile.
pub(super) fn check(
    action: &Action,
    kind: &Artifact,
    format: Format,
) -> Result<(), Vec<Diagnostic>> {
    if kind.repeat.is_none() {
        return Ok(());
    }
    let refused = |message: &str, help: &str| {
        let error = Diagnostic::error(message).at(action.definition.field_key(&["repeat"]), "");
        Err(vec![error.help(help)])
    };
    if !matches!(format, Format::Svg | Format::Dxf | Format::Png) {
        let help = "show it in SVG, DXF or PNG, or repeat what it is made of";
        return refused("a preview of tiles is a drawing or a picture of one", help);
    }
    let period = kind.region.as_ref().and_then(|r| action.input(r).period);
    match period {
        Some(_) => Ok(()),
        None => refused(
            "only what is drawn on a periodic region repeats",
            "name a rectangle with `periodic: true` with `region`",
        ),
    }
}
