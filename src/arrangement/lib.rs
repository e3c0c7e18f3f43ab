//! Element textures (Loi 2015): partitions of a region, the cells of the planar maps that they give,
//! elements placed in these cells, and masks. Every operation is a plain function from values to
//! [`Curves`], and a planar map is built only where a rule needs one.
//!
//! # The way of an arrangement
//!
//! 1. `from_spec` turns what a spec declares, with the values that it names, into an [`Arrangement`]:
//!    a pure function from regions to curves. Nothing is drawn before a region is known.
//! 2. `partition` and `random` cut a region into cells: [`stripes`], [`grid`], [`isolines`],
//!    [`packed`] copies, and the Voronoi cells of random points ([`uniform`], [`random()`]).
//! 3. `place` puts elements at the cells of a planar map ([`place()`]), or moves the cells themselves
//!    ([`transform`]); [`faces`] chooses some as a region; [`cells`] says what a cell is and what lies beside it.
//! 4. `mask` cuts curves by a region or by the faces of other curves.
//! 5. `script` runs the operators that Starlark code calls, and mappers on every cell.
//! 6. `tiled` draws what is repeated once and copies it; `near` draws what of anything else lies in a window.
//! 7. `connect` makes one sheet of lines: as wide as asked for, held together by bridges. [`registration()`] draws what is
//!    engraved on slices of a body.
//!
//! Files, spans and caches are not here: callers bring values and add places to errors.
//!
//! [`Curves`]: fretwork_geometry::Curves
//!
#![doc = include_str!("SEMANTICS.md")]

mod border;
pub mod cells;
mod chosen;
mod connect;
mod distance;
mod error;
pub mod from_spec;
mod function;
mod limit;
pub mod mask;
mod near;
mod partition;
mod patch;
mod place;
mod random;
mod registration;
mod relabel;
mod repeat;
mod script;
mod tiled;

pub use border::Border;
pub use chosen::{Chosen, face_labels, faces, outline_in};
pub use connect::sheet::{connect, widened};
pub use error::ArrangementError;
pub use function::{Applied, Arrangement};
pub use partition::grid::grid;
pub use partition::isolines::isolines;
pub use partition::packed::{PackedProperties, packed};
pub use partition::properties::StripesProperties;
pub use partition::stripes::stripes;
pub use place::elements::place;
pub use place::similarity;
pub use place::transform::transform;
pub use random::cells::{random, uniform};
pub use random::properties::{Density, IrregularProperties, Weighted};
pub use registration::registration;
pub use relabel::relabel;
pub use script::argument::Argument;
pub use script::program::{Mapper, Script, ScriptArrangement};
pub use script::reference::{Pictured, functions_reference, pictured_functions};
pub use tiled::place::{AtPlace, Engine};
pub use tiled::regularity::Irregular;
