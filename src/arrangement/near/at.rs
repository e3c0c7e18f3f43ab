//! What an arrangement has at a place, told by what is around the place.

use std::cell::RefCell;

use crate::function::Arrangement;
use crate::near::cells::{Found, Request};
use crate::near::locality::{Room, Spread};
use crate::tiled::place::AtPlace;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::planar_map::FaceId;
use fretwork_geometry::{Bounds, Curves, Point, Region};
use fretwork_script::values::CellKind;

/// The first room is so many times smaller than the page where nothing is known of the size of cells.
const PART: f64 = 256.0;

impl Arrangement {
    /// What is at a place of `region`. None where what is around the place does not tell.
    ///
    /// # Errors
    /// Those of [`Arrangement::apply`].
    pub(crate) fn at_near(
        &self,
        region: &Region,
        resolution: f64,
        at: Point,
    ) -> Result<Option<AtPlace>, Vec<Diagnostic>> {
        let Some(local) = self.local() else {
            return Ok(None);
        };
        let size = local
            .cell
            .map_or(region.page().longer_side() / PART, |cell| cell.most / 2.0);
        let request = Request {
            input: self,
            region,
            resolution,
            room: Room {
                bounds: Bounds::of([at]).grown(size),
                is_drawn: true,
            },
            spread: Spread {
                is_inside: true,
                ..Spread::default()
            },
            kind: CellKind::Face,
            span: &Span::File("".into()),
        };
        let found = RefCell::new(None);
        let told = request.answer(|around| {
            Ok(found_at(around, at).map(|place| {
                *found.borrow_mut() = Some(place);
                Curves::new()
            }))
        })?;
        Ok(told.and_then(|_| found.into_inner()))
    }
}

/// What is at a place, if the face and the nearest curve are known.
fn found_at(around: &Found, at: Point) -> Option<AtPlace> {
    let map = &around.map;
    let face = map.face_at(at);
    if face != FaceId::UNBOUNDED && !around.known.faces[face.0 as usize] {
        return None;
    }
    let found = AtPlace::in_map(map, &map.to_curves(), at);
    let inner = &around.inner;
    let gaps = [
        at.x - inner.min.x,
        inner.max.x - at.x,
        at.y - inner.min.y,
        inner.max.y - at.y,
    ];
    let nearest = gaps.into_iter().fold(f64::INFINITY, f64::min);
    found.distance.is_some_and(|d| d < nearest).then_some(found)
}
