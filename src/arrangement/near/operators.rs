//! What operators make of cells near a room: the locality of each, from that of its inputs.

use std::sync::Arc;

use crate::cells::{Cell, face_region};
use crate::error::ArrangementError;
use crate::from_spec::context::failed;
use crate::function::Arrangement;
use crate::near::cells::{Found, Request};
use crate::near::locality::{Hull, Locality, Nearby, Room, Spread, reaching};
use crate::script::mapping::{Items, Reach};
use crate::script::program::{Mapper, Task};
use crate::script::seeds::plain;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::planar_map::FaceId;
use fretwork_geometry::{Curves, PlanarMap, Region};
use fretwork_script::values::{self, CellKind};

/// The union of arrangements that are all local.
pub(crate) fn union(inputs: &[Arrangement]) -> Option<Locality> {
    let locals: Vec<_> = inputs.iter().map(Arrangement::local).collect();
    let cells = locals.iter().map(|local| local.and_then(|l| l.cell));
    let cell = cells.reduce(|a, b| Some(a?.union(b?))).flatten();
    let extents = locals.iter().map(|local| local.and_then(|l| l.extent));
    let extent = extents.reduce(|a, b| Some(a?.union(b?))).flatten();
    locals.iter().all(Option::is_some).then(|| {
        let inputs = inputs.to_vec();
        let near = move |region: &Region, resolution: f64, room: Room| {
            let drawn = inputs.iter();
            let drawn = drawn.map(|input| input.near(region, resolution, room));
            let drawn: Option<Vec<Arc<Curves>>> = drawn.collect::<Result<_, _>>()?;
            Ok(drawn.map(|drawn| Arc::new(Curves::concatenated(&drawn))))
        };
        Locality {
            near: Box::new(near),
            extent,
            cell,
            is_noded: false,
        }
    })
}

/// An arrangement with other labels.
pub(crate) fn changed(
    input: &Arrangement,
    change: impl Fn(&Curves) -> Curves + Send + Sync + 'static,
) -> Option<Locality> {
    let local = input.local()?;
    let (extent, cell, is_noded) = (local.extent, local.cell, local.is_noded);
    let input = input.clone();
    let near = move |region: &Region, resolution: f64, room: Room| {
        let drawn = input.near(region, resolution, room)?;
        Ok(drawn.map(|drawn| Arc::new(change(&drawn))))
    };
    Some(Locality {
        near: Box::new(near),
        extent,
        cell,
        is_noded,
    })
}

/// The faces that are filled, and with what.
pub(crate) fn filled(faces: &Arrangement, with: &Arrangement, span: &Span) -> Option<Locality> {
    let (outer, cell) = (faces.local()?.extent, faces.local()?.cell);
    let beyond = with.local()?.extent.filter(|own| own.fixed.is_empty())?;
    let length = beyond.beyond.unwrap_or(0.0);
    let spread = Spread {
        length,
        share: 0.0,
        is_inside: length == 0.0,
    };
    let (faces, with, span) = (faces.clone(), with.clone(), span.clone());
    let near = move |region: &Region, resolution: f64, room: Room| {
        let request = Request {
            input: &faces,
            region,
            resolution,
            room,
            spread,
            kind: CellKind::Face,
            span: &span,
        };
        request.answer(|found| fill(found, &faces, &with, &request).map(Some))
    };
    Some(Locality {
        near: Box::new(near),
        extent: outer.map(|outer| outer.grown(length)),
        cell: cell.map(|cell| cell.spread(spread)),
        is_noded: false,
    })
}

/// What is drawn in the faces that were found, near the room.
fn fill(
    found: &Found,
    faces: &Arrangement,
    with: &Arrangement,
    request: &Request<'_>,
) -> Result<Curves, Vec<Diagnostic>> {
    let map: &PlanarMap = &found.map;
    let within = Room {
        is_drawn: false,
        ..request.room
    };
    let mut all = Curves::new();
    let chosen = found.cells.iter().map(|id| FaceId(*id));
    for face in faces.covered_among(map, chosen) {
        let face = face_region(map, face, request.region.tile());
        let drawn = match with.near(&face, request.resolution, within)? {
            Some(drawn) => drawn,
            None => with.apply(&face, request.resolution)?,
        };
        all.append(&reaching(&drawn, &request.room.bounds));
    }
    Ok(all)
}

/// Draws something at the cells of a planar map, on a region with a resolution.
pub(crate) type AtCells =
    dyn Fn(&PlanarMap, &[Cell], &Region, f64) -> Result<Curves, ArrangementError> + Send + Sync;

/// Something drawn at every cell of a kind, no farther from it than `spread`.
pub(crate) fn at_cells(
    (input, kind): (&Arrangement, CellKind),
    spread: Spread,
    span: &Span,
    draw: Box<AtCells>,
) -> Option<Locality> {
    let extent = extent(input, spread)?;
    let cell = input.local()?.cell.map(|cell| cell.spread(spread));
    let (input, span) = (input.clone(), span.clone());
    let near = move |region: &Region, resolution: f64, room: Room| {
        let request = Request {
            input: &input,
            region,
            resolution,
            room,
            spread,
            kind,
            span: &span,
        };
        request.answer(|found| {
            let cell = |id: &u32| {
                plain(values::Cell {
                    kind,
                    map: 0,
                    id: *id,
                })
            };
            let cells: Vec<Cell> = found.cells.iter().map(cell).collect();
            let drawn = draw(&found.map, &cells, region, resolution);
            let drawn = drawn.map_err(|error| failed(&error, &span))?;
            Ok(Some(reaching(&drawn, &room.bounds)))
        })
    };
    Some(Locality {
        near: Box::new(near),
        extent,
        cell,
        is_noded: false,
    })
}

/// Where what is drawn for cells lies; none where that is not known. None outside where the input is not local.
fn extent(input: &Arrangement, spread: Spread) -> Option<Option<Hull>> {
    let local = input.local()?;
    let by = match (spread.share > 0.0, local.cell) {
        (true, None) => None,
        (true, Some(cell)) => Some(spread.of(cell.most)),
        (false, _) => Some(spread.length),
    };
    Some(local.extent.zip(by).map(|(extent, by)| extent.grown(by)))
}

/// A mapper that was promised not to reach too far, and where it stands.
#[derive(Clone)]
pub(crate) struct Mapped {
    pub input: Arrangement,
    pub kind: CellKind,
    pub mapper: Mapper,
    pub span: Span,
    /// Puts diagnostics of the mapper in their place.
    pub place: Arc<dyn Fn(&[Diagnostic]) -> Vec<Diagnostic> + Send + Sync>,
}

/// Every cell replaced by what a script makes of it.
pub(crate) fn mapped(mapped: Mapped) -> Option<Locality> {
    let spread = match mapped.mapper.reach() {
        Reach::Any => return None,
        Reach::Length(length) => Spread {
            length,
            ..Spread::default()
        },
        Reach::Diagonal => Spread {
            share: 1.0,
            ..Spread::default()
        },
    };
    let extent = extent(&mapped.input, spread)?;
    let cell = mapped.input.local()?.cell.map(|cell| cell.spread(spread));
    let near = move |region: &Region, resolution: f64, room: Room| -> Nearby {
        let request = Request {
            input: &mapped.input,
            region,
            resolution,
            room,
            spread,
            kind: mapped.kind,
            span: &mapped.span,
        };
        request.answer(|found| {
            let task = Task {
                kind: mapped.kind,
                map: found.map.clone(),
                items: Items::Some(found.cells.clone()),
                watch: None,
                known: Some(found.known.clone()),
            };
            let curves = mapped.mapper.map_cells(task, region, resolution);
            if found.known.was_missed() {
                return Ok(None);
            }
            let curves = curves.map_err(|diagnostics| (mapped.place)(&diagnostics))?;
            Ok(Some(reaching(&curves, &room.bounds)))
        })
    };
    Some(Locality {
        near: Box::new(near),
        extent,
        cell,
        is_noded: false,
    })
}
