//! Tests of the mechanical model and of the loop.

mod case;
mod correlation;
mod criteria;
mod elements;
mod loops;
mod models;
mod speed;
