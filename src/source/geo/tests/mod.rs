//! Readers on bytes that are made here, good and bad.

mod systems;
mod tables;
