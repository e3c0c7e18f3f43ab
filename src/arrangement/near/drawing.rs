//! The curves of an arrangement near a room, as the whole has them.

use std::sync::Arc;

use crate::function::Arrangement;
use crate::near::locality::{Nearby, Room};
use crate::tiled::conversion::LEAST;
use fretwork_geometry::{Bounds, Region};

impl Arrangement {
    /// The curves of [`Arrangement::draw`] that may have points in `window`, and perhaps others, in time and memory of the
    /// window and of how far cells are felt. None where that takes as much as the whole, which is then to be drawn.
    ///
    /// # Errors
    /// Those of [`Arrangement::apply`].
    pub fn draw_near(&self, region: &Region, resolution: f64, window: &Bounds) -> Nearby {
        let room = Room {
            bounds: *window,
            is_drawn: true,
        };
        self.near(region, resolution, room)
    }

    /// The same as [`Arrangement::draw_near`] for what [`Arrangement::apply`] gives.
    ///
    /// # Errors
    /// Those of [`Arrangement::apply`].
    pub fn apply_near(&self, region: &Region, resolution: f64, window: &Bounds) -> Nearby {
        let room = Room {
            bounds: *window,
            is_drawn: false,
        };
        self.near(region, resolution, room)
    }

    /// The curves that come into a room.
    pub(crate) fn near(&self, region: &Region, resolution: f64, room: Room) -> Nearby {
        let Some(local) = self.local() else {
            return Ok(None);
        };
        if region.period.is_some() || region.within.is_some() {
            return Ok(None);
        }
        // Where the whole has copies, so has the part: they differ from what is computed in their last digits.
        if room.is_drawn && self.parts().is_none() {
            let copied = match self.varied() {
                Some(varied) => varied.copied_in(region, resolution, &room.bounds, LEAST),
                None => self.copied_in(region, resolution, &room.bounds, LEAST),
            };
            if let Some(copied) = copied {
                return Ok(Some(Arc::new(copied)));
            }
        }
        (local.near)(region, resolution, room)
    }
}
