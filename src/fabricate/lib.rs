//! Geometry to bytes: the files that machines and people take. It goes in three steps. A sheet
//! holds what is drawn and is prepared for a machine ([`sheet`]); what cannot be written is found
//! ([`check`]); and sheets and models become files ([`format`](mod@format), a file per format) or pictures
//! ([`picture`]). Lengths in files are millimetres, in GLB metres.

pub mod check;
pub mod format;
pub mod origin;
pub mod picture;
pub mod sheet;
mod srgb;

pub use check::model_check::check as check_model;
pub use origin::Origin;
pub use sheet::clip::clip;
pub use sheet::edges::left as uncovered;
pub use sheet::inside_first::inside_first;
pub use sheet::prepare::{Preparation, prepare};
pub use sheet::rounding::rounded;
pub use sheet::window::Window;
pub use sheet::{Color, Item, Layer, Pen, Role, Sheet, Style};
