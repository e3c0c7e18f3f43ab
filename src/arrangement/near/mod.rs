//! Windows of arrangements that are not repeated (rule W3): what of them lies in a room is drawn in time and memory of the
//! room and of how far cells are felt, and is, bit for bit, what the whole has there.
//!
//! 1. `locality` is what a definition tells of where an arrangement's curves lie, and how those near a room are drawn.
//! 2. Partitions draw the lines and cells that come near the room, each with the ends that it has in the whole; so crossings
//!    are computed from the same numbers.
//! 3. `cells` draws the input of a mapper, or of another operator, on a larger room, and finds the cells that are as they are
//!    in the whole: those that lie in the larger room, away from its border. Where one is missing the room is enlarged.
//!    `border` closes what the border of the larger room cuts off, so that it is not taken for the outside; `corridor` proves
//!    that a face is the one around everything.
//! 4. `operators` are the operators on such cells.
//!
//! Nothing of this changes a region: anchors, seeds, fields that are read once a region, and rounding are the whole's.
//! When an arrangement is not local, or the room would have to be almost as large as the whole, there is no answer, and
//! callers draw the whole.

pub(crate) mod at;
pub(crate) mod border;
pub(crate) mod cells;
pub(crate) mod corridor;
pub(crate) mod drawing;
pub(crate) mod locality;
pub(crate) mod masked;
pub(crate) mod operators;
pub(crate) mod reach;
