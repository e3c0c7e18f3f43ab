//! The language: its fragments, its schema, its errors.

mod language;
