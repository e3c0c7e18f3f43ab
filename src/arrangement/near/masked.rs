//! What of an arrangement lies inside, or outside, of the faces of another, near a room.
//!
//! Edges of the input are wanted as they are in the whole, because where the mask cuts them is computed from their ends. The
//! mask is wanted where they are cut; the mask that is a region is there as a whole.

use std::sync::Arc;

use crate::border::Border;
use crate::from_spec::combine::planar_map;
use crate::from_spec::context::failed;
use crate::function::Arrangement;
use crate::mask;
use crate::near::cells::{Found, Request};
use crate::near::locality::{Locality, Nearby, Room, Spread, reaching};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::planar_map::{EdgeId, FaceId, PlanarMap};
use fretwork_geometry::{Bounds, Curve, Curves, Region};
use fretwork_script::values::CellKind;

/// An input, a mask and what is kept.
#[derive(Clone)]
pub(crate) struct Masking {
    pub input: Arrangement,
    pub mask: Arrangement,
    pub border: Border,
    pub is_inside: bool,
    pub span: Span,
}

/// The input cut by the mask.
pub(crate) fn masked(masking: Masking) -> Option<Locality> {
    let (of_input, of_mask) = (masking.input.local()?.extent, masking.mask.local()?.extent);
    let has_rim = masking.border == Border::CropAddBoundary;
    let extent = match has_rim {
        true => of_input.zip(of_mask).map(|(a, b)| a.union(b)),
        false => of_input,
    };
    let cells = (masking.input.local()?.cell, masking.mask.local()?.cell);
    let cell = match (masking.mask.area(), cells) {
        (Some(_), (cell, _)) if !has_rim => cell,
        (None, (Some(a), Some(b))) => Some(a.union(b)),
        _ => None,
    };
    let near = move |region: &Region, resolution: f64, room: Room| {
        let place = Place {
            region,
            resolution,
            room,
        };
        masking.near(&place)
    };
    Some(Locality {
        near: Box::new(near),
        extent,
        cell,
        is_noded: !has_rim,
    })
}

/// Where curves are wanted.
struct Place<'a> {
    region: &'a Region,
    resolution: f64,
    room: Room,
}

impl Masking {
    fn near(&self, at: &Place<'_>) -> Nearby {
        let Some(edges) = self.edges(at)? else {
            return Ok(None);
        };
        if let Some(area) = self.mask.area() {
            let cut = mask::by_region(&edges, area, self.border, at.resolution, self.is_inside);
            let cut = cut.map_err(|error| failed(&error, &self.span))?;
            return Ok(Some(Arc::new(reaching(&cut, &at.room.bounds))));
        }
        // Whole edges are kept, or none of them: then the mask matters along all of each.
        let wanted = match self.border {
            Border::Crop | Border::CropAddBoundary => at.room.bounds,
            Border::KeepInside | Border::KeepOutside => at.room.bounds.union(edges.bounds()),
        };
        let request = Request {
            input: &self.mask,
            region: at.region,
            resolution: at.resolution,
            room: at.room.with(wanted),
            spread: Spread {
                is_inside: true,
                ..Spread::default()
            },
            kind: CellKind::Face,
            span: &self.span,
        };
        request.answer(|found| self.cut(&edges, found, at))
    }

    /// The edges of the input that come into the room.
    fn edges(&self, at: &Place<'_>) -> Nearby {
        let room = &at.room.bounds;
        if self.input.local().is_some_and(|local| local.is_noded) {
            let drawn = self.input.near(at.region, at.resolution, at.room)?;
            let Some(drawn) = drawn else { return Ok(None) };
            let map = planar_map(&drawn, at.resolution, &self.span)?;
            return Ok(Some(Arc::new(reaching(&map.to_curves(), room))));
        }
        let request = Request {
            input: &self.input,
            region: at.region,
            resolution: at.resolution,
            room: at.room,
            spread: Spread {
                is_inside: true,
                ..Spread::default()
            },
            kind: CellKind::Edge,
            span: &self.span,
        };
        request.answer(|found| {
            let mut edges = Curves::new();
            for e in found.cells.iter().map(|id| EdgeId(*id)) {
                edges.push(found.map.points(e), found.map.labels(e));
            }
            Ok(Some(edges))
        })
    }

    /// The edges cut where the mask is known. None where a part goes on to where it is not.
    fn cut(
        &self,
        edges: &Curves,
        found: &Found,
        at: &Place<'_>,
    ) -> Result<Option<Curves>, Vec<Diagnostic>> {
        let map: &PlanarMap = &found.map;
        let is_rim = |e: &EdgeId| {
            (map.left(*e) == FaceId::UNBOUNDED) != (map.right(*e) == FaceId::UNBOUNDED)
        };
        let (mut rim, mut known) = (Curves::new(), Curves::new());
        for e in map.edges().filter(is_rim) {
            rim.push(map.points(e), map.labels(e));
            if found.known.edges[e.0 as usize] {
                known.push(map.points(e), map.labels(e));
            }
        }
        // The rim is added below, as far as it is known.
        let border = match self.border {
            Border::CropAddBoundary => Border::Crop,
            border => border,
        };
        let cut = mask::by_rim(edges, &rim, border, at.resolution, self.is_inside);
        let cut = cut.map_err(|error| failed(&error, &self.span))?;
        let mut cut = reaching(&cut, &at.room.bounds);
        let lies = |curve: Curve<'_>| {
            let bounds = Bounds::of(curve.points.iter().copied());
            found.inner.contains(bounds.min) && found.inner.contains(bounds.max)
        };
        if !cut.iter().all(lies) {
            return Ok(None);
        }
        if self.border == Border::CropAddBoundary {
            cut.append(&reaching(&known, &at.room.bounds));
        }
        Ok(Some(cut))
    }
}
