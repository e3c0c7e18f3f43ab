//! The language: its fragments, its schema, its errors.

mod bad;
mod language;
mod pictures;
mod robust;
