//! Scripts as modules: files that are read once (`reader`), the functions that they define
//! (`definition`), and runs of them (`script`).

pub(crate) mod definition;
pub(crate) mod reader;
pub(crate) mod script;

pub use script::{Entered, ScriptModule, Supplied};
