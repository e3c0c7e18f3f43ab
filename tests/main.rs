//! The tests of the whole: the binary, the language, the structure of the code. One binary, so
//! that it links once.

// A test that cannot go on has failed.
#![allow(clippy::unwrap_used)]
// Tests read and write files, and work out what to expect with the platform's functions.
#![allow(clippy::disallowed_methods)]

mod actions;
mod artifacts;
mod attacks;
mod bad_input;
mod bands;
mod carving;
mod circles;
mod commands;
mod composing;
mod diff;
mod expected;
mod facades;
mod faults;
mod foretold;
mod formats;
mod layers;
mod machines;
mod maps;
mod mistakes;
mod modules;
mod origin;
mod paper;
mod planar;
mod project;
mod rebuild;
mod serve;
mod sheets;
mod shell_faults;
mod shell_pieces;
mod shells;
mod sides;
mod solids;
mod spec;
mod texts;
mod tiles;
mod walls;
mod windows;
mod wrapping;
