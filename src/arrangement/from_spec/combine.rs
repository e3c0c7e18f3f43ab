//! Mapping and merging as a spec declares them.

use std::sync::Arc;

use crate::cells::{Cell, face_region};
use crate::from_spec::context::{Context, border, failed};
use crate::function::{Arrangement, Manner};
use crate::mask;
use crate::near::locality::Locality;
use crate::near::masked::{self, Masking};
use crate::near::{operators as near, reach};
use crate::patch::Patch;
use crate::place::elements::place_at;
use crate::place::transform::transform_at;
use crate::repeat::Repeat;
use crate::tiled::regularity::{Irregular, Regularity};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, PlanarMap, Region, Snap};
use fretwork_language::kinds::arrangements::{
    Cells, ExtendedCells, Fill, Masked, Place, Relabel, Repeated, Transform,
};
use fretwork_language::{Ref, wants};
use fretwork_script::values::CellKind;

/// The curves of all of these, in order.
pub fn union(of: &[Ref<wants::Arrangement>], context: &Context<'_>) -> Arrangement {
    let inputs: Vec<Arrangement> = of
        .iter()
        .map(|name| context.inputs.arrangement(name))
        .collect();
    let (regularity, parts) = (of_all(&inputs), inputs.clone());
    let made = Arrangement::with(regularity, move |region, resolution, manner| {
        let drawn = inputs.iter();
        let drawn = drawn.map(|input| input.apply_as(region, resolution, manner));
        let drawn: Vec<Arc<Curves>> = drawn.collect::<Result<_, _>>()?;
        Ok(Arc::new(Curves::concatenated(&drawn)))
    });
    let local = near::union(&parts);
    made.united(parts).local_by(local)
}

/// What all inputs have in common.
fn of_all(inputs: &[Arrangement]) -> Result<Regularity, Irregular> {
    let all: Result<Vec<&Regularity>, &Irregular> =
        inputs.iter().map(Arrangement::regularity).collect();
    all.map(Regularity::of_all).map_err(Irregular::clone)
}

/// The regularity of what is drawn in the faces of another arrangement.
fn filled(faces: &Arrangement, with: &Arrangement) -> Result<Regularity, Irregular> {
    let both = faces
        .regularity()
        .and_then(|faces| with.regularity().map(|with| faces.filled_with(with)));
    both.map_err(Irregular::clone)
}

/// The curves of another arrangement with other labels.
pub fn relabel(kind: &Relabel, context: &Context<'_>) -> Arrangement {
    let input = context.inputs.arrangement(&kind.from);
    let labels = kind.labels.clone();
    let own = labels.clone();
    let local = near::changed(&input, move |curves| crate::relabel(curves, &own));
    let made = Arrangement::new(move |region, resolution| {
        let curves = input.apply(region, resolution)?;
        Ok(Arc::new(crate::relabel(&curves, &labels)))
    });
    made.local_by(local)
}

/// Copies of a tile in which another arrangement is drawn, inside of the region.
pub fn repeat(kind: &Repeated, context: &Context<'_>) -> Arrangement {
    let input = context.inputs.arrangement(&kind.from);
    let tile = context.inputs.region(&kind.tile);
    let repeat = Repeat {
        tile: tile.bounds(),
        layout: kind.layout,
    };
    let (border, span) = (border(kind.border), context.span.clone());
    Arrangement::new(move |region, resolution| {
        if let Some(fits) = region.period.and_then(|p| repeat.nearest_period(p)) {
            let message = "the repeat does not close on this periodic region".to_owned();
            let error = Diagnostic::error(message).at(span.clone(), "in this arrangement");
            let (x, y) = (fits.x, fits.y);
            return Err(vec![error.help(format!("{x} by {y} would do"))]);
        }
        let drawing = input.apply(&tile, resolution)?;
        let all = repeat.over(region.bounds(), &drawing);
        mask::by_region(&all, region, border, resolution, true)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    })
}

/// An arrangement drawn inside every bounded face of another.
pub fn fill(kind: &Fill, context: &Context<'_>) -> Arrangement {
    let (faces, with) = (
        context.inputs.arrangement(&kind.faces),
        context.inputs.arrangement(&kind.with),
    );
    let span = context.span.clone();
    let regularity = filled(&faces, &with);
    let local = near::filled(&faces, &with, &span);
    let made = Arrangement::with(regularity, move |region, resolution, manner| {
        let drawn = faces.apply_as(region, resolution, manner)?;
        let map = mapped(&drawn, resolution, manner, &span)?;
        let within = match manner {
            Manner::Free => Manner::Free,
            Manner::Regular(_) => Manner::Regular(Patch::NOWHERE),
        };
        let mut all = Curves::new();
        for face in faces.covered(&map) {
            let face = face_region(&map, face, region.tile());
            all.append(&*with.apply_as(&face, resolution, within)?);
        }
        Ok(Arc::new(all))
    });
    made.local_by(local)
}

/// An element at every cell of another arrangement.
pub fn place(kind: &Place, context: &Context<'_>) -> Arrangement {
    let (Cells::Vertices(of) | Cells::Edges(of) | Cells::Faces(of)) = &kind.cells;
    let input = context.inputs.arrangement(of);
    let elements: Vec<Arc<Curves>> = kind
        .element
        .0
        .iter()
        .map(|name| context.inputs.element(name))
        .collect();
    let (kind, seed, span) = (kind.clone(), context.seed, context.span.clone());
    let step = context.step;
    let regularity = if crate::place::elements::is_random(&kind, elements.len()) {
        Err(Irregular::new("it draws at random").at(&span))
    } else {
        input.regularity().cloned().map_err(Irregular::clone)
    };
    let local = near_elements(&kind, &elements, &input, context);
    let made = Arrangement::with(regularity, move |region, resolution, manner| {
        let drawn = input.apply_as(region, resolution, manner)?;
        let map = mapped(&drawn, resolution, manner, &span)?;
        let snap = Snap::of(region).in_steps(step);
        crate::place(&map, &kind, &elements, seed, snap)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    });
    made.local_by(local)
}

/// The elements at the cells of `input` near a room.
fn near_elements(
    kind: &Place,
    elements: &[Arc<Curves>],
    input: &Arrangement,
    context: &Context<'_>,
) -> Option<Locality> {
    let spread = reach::of_elements(kind, elements)?;
    let cells = match kind.cells {
        Cells::Vertices(_) => CellKind::Vertex,
        Cells::Edges(_) => CellKind::Edge,
        Cells::Faces(_) => CellKind::Face,
    };
    let (kind, elements) = (kind.clone(), elements.to_vec());
    let (seed, step) = (context.seed, context.step);
    let draw = move |map: &PlanarMap, cells: &[Cell], region: &Region, _: f64| {
        let snap = Snap::of(region).in_steps(step);
        place_at(map, &kind, &elements, (seed, snap), cells)
    };
    near::at_cells((input, cells), spread, &context.span, Box::new(draw))
}

/// The cells of another arrangement, each transformed.
pub fn transform(kind: &Transform, context: &Context<'_>) -> Arrangement {
    let (ExtendedCells::Edges(of) | ExtendedCells::Faces(of)) = &kind.cells;
    let input = context.inputs.arrangement(of);
    let (kind, span) = (kind.clone(), context.span.clone());
    let regularity = input.regularity().cloned().map_err(Irregular::clone);
    let local = near_cells(&kind, &input, &span);
    let made = Arrangement::with(regularity, move |region, resolution, manner| {
        let drawn = input.apply_as(region, resolution, manner)?;
        let map = mapped(&drawn, resolution, manner, &span)?;
        crate::transform(&map, &kind, resolution)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    });
    made.local_by(local)
}

/// The cells of `input` near a room, transformed.
fn near_cells(kind: &Transform, input: &Arrangement, span: &Span) -> Option<Locality> {
    let cells = match kind.cells {
        ExtendedCells::Edges(_) => CellKind::Edge,
        ExtendedCells::Faces(_) => CellKind::Face,
    };
    let (spread, kind) = (reach::of_transform(kind), kind.clone());
    let draw = move |map: &PlanarMap, cells: &[Cell], _: &Region, resolution: f64| {
        transform_at(map, &kind, resolution, cells)
    };
    near::at_cells((input, cells), spread, span, Box::new(draw))
}

/// What of an arrangement is inside, or outside, of the bounded faces of another, or of the area of a region.
pub fn masked(kind: &Masked, is_inside: bool, context: &Context<'_>) -> Arrangement {
    let inputs = [
        context.inputs.arrangement(&kind.input),
        context.inputs.arrangement(&kind.mask),
    ];
    let (border, span) = (border(kind.border), context.span.clone());
    let regularity = of_all(&inputs);
    let [input, by] = inputs.clone();
    let local = masked::masked(Masking {
        input,
        mask: by,
        border,
        is_inside,
        span: span.clone(),
    });
    let made = Arrangement::with(regularity, move |region, resolution, manner| {
        let [input, by] = &inputs;
        let input = input.apply_as(region, resolution, manner)?;
        let faces = || by.apply_as(region, resolution, manner);
        let masked = match by.area() {
            Some(area) => mask::by_region(&input, area, border, resolution, is_inside),
            None if is_inside => mask::inside(&input, &*faces()?, border, resolution),
            None => mask::outside(&input, &*faces()?, border, resolution),
        };
        masked.map(Arc::new).map_err(|e| failed(&e, &span))
    });
    made.local_by(local)
}

/// The planar map of `curves`, whose cells are mapped in a manner.
///
/// # Errors
/// When their coordinates are out of range, and where the manner does not allow for its cells.
pub fn mapped(
    curves: &Curves,
    resolution: f64,
    manner: Manner,
    span: &Span,
) -> Result<PlanarMap, Vec<Diagnostic>> {
    let map = planar_map(curves, resolution, span)?;
    if let Manner::Regular(patch) = manner {
        patch
            .check(&map)
            .map_err(|why| vec![Diagnostic::error(why).at(span.clone(), "")])?;
    }
    Ok(map)
}

/// The planar map of `curves`.
///
/// # Errors
/// When their coordinates are out of range, at the entry whose place is `span`.
pub fn planar_map(
    curves: &Curves,
    resolution: f64,
    span: &Span,
) -> Result<PlanarMap, Vec<Diagnostic>> {
    PlanarMap::build(curves, resolution)
        .map_err(|e| vec![Diagnostic::error(e.to_string()).at(span.clone(), "in this arrangement")])
}
