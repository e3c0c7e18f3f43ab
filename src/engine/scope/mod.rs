//! The values that expressions may name: parameters, derived values.

mod expression;
mod lets;
mod map;
mod modules;
mod names;
mod params;
mod values;

pub use expression::{evaluate_lettered, evaluate_tree};
pub use map::map;
pub use modules::{scope, scope_of};
pub use names::unused_params;
pub use params::setting_of;
pub use values::Scope;
