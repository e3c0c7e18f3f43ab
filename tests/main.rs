//! The tests of the whole: the binary, the language, the structure of the code. One binary, so
//! that it links once.

mod formats;
mod layers;
mod spec;
