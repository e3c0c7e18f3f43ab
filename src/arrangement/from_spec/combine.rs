//! Mapping and merging as a spec declares them.

use std::sync::Arc;

use crate::cells::face_region;
use crate::from_spec::context::{Context, border, failed};
use crate::function::Arrangement;
use crate::mask;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, PlanarMap, Snap};
use fretwork_language::kinds::arrangements::{
    Cells, ExtendedCells, Fill, Masked, Place, Transform,
};
use fretwork_language::{Ref, wants};

/// The curves of all of these, in order.
pub fn union(of: &[Ref<wants::Arrangement>], context: &Context<'_>) -> Arrangement {
    let inputs: Vec<Arrangement> = of
        .iter()
        .map(|name| context.inputs.arrangement(name))
        .collect();
    Arrangement::new(move |region, resolution| {
        let mut all = Curves::new();
        for input in &inputs {
            all.append(&*input.apply(region, resolution)?);
        }
        Ok(Arc::new(all))
    })
}

/// An arrangement drawn inside every bounded face of another.
pub fn fill(kind: &Fill, context: &Context<'_>) -> Arrangement {
    let (faces, with) = (
        context.inputs.arrangement(&kind.faces),
        context.inputs.arrangement(&kind.with),
    );
    let span = context.span.clone();
    Arrangement::new(move |region, resolution| {
        let map = planar_map(&*faces.apply(region, resolution)?, resolution, &span)?;
        let mut all = Curves::new();
        for face in faces.covered(&map) {
            all.append(&*with.apply(&face_region(&map, face, region.tile()), resolution)?);
        }
        Ok(Arc::new(all))
    })
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
    Arrangement::new(move |region, resolution| {
        let map = planar_map(&*input.apply(region, resolution)?, resolution, &span)?;
        let snap = Snap::of(region).in_steps(step);
        crate::place(&map, &kind, &elements, seed, snap)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    })
}

/// The cells of another arrangement, each transformed.
pub fn transform(kind: &Transform, context: &Context<'_>) -> Arrangement {
    let (ExtendedCells::Edges(of) | ExtendedCells::Faces(of)) = &kind.cells;
    let input = context.inputs.arrangement(of);
    let (kind, span) = (kind.clone(), context.span.clone());
    Arrangement::new(move |region, resolution| {
        let map = planar_map(&*input.apply(region, resolution)?, resolution, &span)?;
        crate::transform(&map, &kind, resolution)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    })
}

/// What of an arrangement is inside, or outside, of the bounded faces of another, or of the area of a region.
pub fn masked(kind: &Masked, is_inside: bool, context: &Context<'_>) -> Arrangement {
    let (input, by) = (
        context.inputs.arrangement(&kind.input),
        context.inputs.arrangement(&kind.mask),
    );
    let (border, span) = (border(kind.border), context.span.clone());
    Arrangement::new(move |region, resolution| {
        let input = input.apply(region, resolution)?;
        let masked = match by.area() {
            Some(area) => mask::by_region(&input, area, border, resolution, is_inside),
            None if is_inside => {
                mask::inside(&input, &*by.apply(region, resolution)?, border, resolution)
            }
            None => mask::outside(&input, &*by.apply(region, resolution)?, border, resolution),
        };
        masked.map(Arc::new).map_err(|e| failed(&e, &span))
    })
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
