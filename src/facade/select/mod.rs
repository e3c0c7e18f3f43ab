//! The choice of one layout among all candidates, and the tolerance at which there is one (rules R8
//! and R9).
//!
//! `tolerance` tries one tolerance after another. At each, `selection` finds the candidates with the
//! least alignment error, and `tie_break` decides between them by their sizes. Where the first
//! alignment of a candidate is not clearly the best, `co_optimal` lists all that are as good.
//! `fallback` and `sizable` find a good layout in few steps when the exact search was cut short or
//! when the best alignments cannot be sized. `positions` tells where the letters of the chosen layout
//! lie.

pub mod co_optimal;
pub mod contest;
pub mod fallback;
pub mod groups;
pub mod positions;
pub mod selection;
pub mod sizable;
pub mod tie_break;
pub mod tolerance;
