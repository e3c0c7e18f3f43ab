//! What is found before anything is written.

pub mod model_check;
