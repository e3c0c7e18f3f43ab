//! Tests of walls, and of how wide the features of patterns are.

mod features;
mod shapes;
mod walls;
mod widths;
