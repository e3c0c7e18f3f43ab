//! Mapping and merging as a spec declares them.

use std::sync::Arc;

use crate::border::Border;
use crate::cells::face_region;
use crate::error::ArrangementError;
use crate::from_spec::context::{Context, border, failed};
use crate::function::Arrangement;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, PlanarMap, Snap};
use fretwork_language::kinds::arrangements::{
    Cells, ExtendedCells, Fill, Masked, Place, Relabel, Transform,
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

/// The curves of another arrangement with other labels.
pub fn relabel(kind: &Relabel, context: &Context<'_>) -> Arrangement {
    let input = context.inputs.arrangement(&kind.from);
    let labels = kind.labels.clone();
    Arrangement::new(move |region, resolution| {
        let curves = input.apply(region, resolution)?;
        Ok(Arc::new(crate::relabel(&curves, &labels)))
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
        for face in map.bounded_faces() {
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
    Arrangement::new(move |region, resolution| {
        let map = planar_map(&*input.apply(region, resolution)?, resolution, &span)?;
        crate::place(&map, &kind, &elements, seed, Snap::of(region))
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

/// What a mask leaves of an arrangement.
type Mask = fn(&Curves, &Curves, Border, f64) -> Result<Curves, ArrangementError>;

/// An arrangement cut by the bounded faces of another.
pub fn masked(kind: &Masked, mask: Mask, context: &Context<'_>) -> Arrangement {
    let (input, by) = (
        context.inputs.arrangement(&kind.input),
        context.inputs.arrangement(&kind.mask),
    );
    let (border, span) = (border(kind.border), context.span.clone());
    Arrangement::new(move |region, resolution| {
        let (input, by) = (
            input.apply(region, resolution)?,
            by.apply(region, resolution)?,
        );
        mask(&input, &by, border, resolution)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
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
