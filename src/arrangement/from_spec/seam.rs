//! Faces that a tile loses at its sides: cells that a partition cuts off there are open, so that nothing is put into them,
//! and the seam shows when tiles are laid side by side.

use crate::from_spec::context::Context;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::planar_map::resolution as usual;
use fretwork_geometry::{Curves, PlanarMap, Point, Region, Tile};
use fretwork_language::kinds::arrangements::{Arrangement as Kind, Cells, ExtendedCells};
use fretwork_language::{Ref, wants};

/// A warning where `kind` takes faces of an arrangement whose lines end at the sides of a periodic region.
pub fn torn_faces(kind: &Kind, context: &Context<'_>, region: &Region) -> Option<Diagnostic> {
    region.tile()?;
    let of = faces_of(kind)?;
    let resolution = usual(region.bounds().longer_side());
    // What is wrong with the input itself has been said where it was applied.
    let drawn = context
        .inputs
        .arrangement(of)
        .draw(region, resolution)
        .ok()?;
    let span = context.span.clone();
    is_torn(&drawn, region).then(|| torn(of, span))
}

/// The warning that faces of what `of` names are missing at the sides of a periodic region.
pub fn torn(of: &Ref<wants::Arrangement>, at: Span) -> Diagnostic {
    let message = format!(
        "faces of `{}` that cross the sides of the periodic region are cut open there and left out",
        of.name
    );
    Diagnostic::warning(message)
        .at(at, "a seam shows between tiles")
        .help("with `border: keep_outside` in the partition they are whole, once each")
}

/// The arrangement whose faces a node takes.
fn faces_of(kind: &Kind) -> Option<&Ref<wants::Arrangement>> {
    let cells = match kind {
        Kind::Map(map) | Kind::Vary(map) => &map.cells,
        Kind::Place(place) => &place.cells,
        Kind::Fill(fill) => return Some(&fill.faces),
        Kind::Transform(transform) => {
            return match &transform.cells {
                ExtendedCells::Faces(of) => Some(of),
                ExtendedCells::Edges(_) => None,
            };
        }
        _ => return None,
    };
    match cells {
        Cells::Faces(of) => Some(of),
        Cells::Vertices(_) | Cells::Edges(_) => None,
    }
}

/// Whether some of the lines that bound faces end on the sides of a periodic region.
pub fn is_torn(drawn: &Curves, region: &Region) -> bool {
    let Some(tile) = region.tile() else {
        return false;
    };
    let resolution = usual(region.bounds().longer_side());
    let Ok(map) = PlanarMap::build(drawn, resolution) else {
        return false;
    };
    let near = 4.0 * resolution;
    let is_open = |v| map.outgoing(v).count() == 1 && is_on_side(map.location(v), &tile, near);
    map.bounded_faces().next().is_some() && map.vertices().any(is_open)
}

fn is_on_side(p: Point, tile: &Tile, near: f64) -> bool {
    let far = tile.corner + tile.period;
    let off = [
        p.x - tile.corner.x,
        p.x - far.x,
        p.y - tile.corner.y,
        p.y - far.y,
    ];
    off.iter().any(|off| off.abs() <= near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::CurveLabels;

    #[test]
    fn lines_that_end_on_a_side_tear_faces() {
        let mut tile = Region::rectangle(Point::ORIGIN, Point::new(10.0, 10.0));
        tile.period = Some(Point::new(10.0, 10.0));
        let mut lines = Curves::new();
        let square = [[2.0, 2.0], [8.0, 2.0], [8.0, 8.0], [2.0, 8.0], [2.0, 2.0]];
        lines.push(square.map(Point::from), CurveLabels::default());
        assert!(!is_torn(&lines, &tile));
        lines.push(
            [[8.0, 5.0], [9.0, 5.0]].map(Point::from),
            CurveLabels::default(),
        );
        assert!(!is_torn(&lines, &tile));
        lines.push(
            [[8.0, 6.0], [10.0, 6.0]].map(Point::from),
            CurveLabels::default(),
        );
        assert!(is_torn(&lines, &tile));
        let page = Region {
            period: None,
            ..tile
        };
        assert!(!is_torn(&lines, &page));
    }
}
