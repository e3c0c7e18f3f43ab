//! The one test binary: what the crate promises from outside, a module per subject.

mod spec;
