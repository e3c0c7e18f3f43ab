//! The sizes of symbols for an alignment (section 5.3 of the paper): what the columns demand of them,
//! and the least change that meets it.

pub mod least_squares;
pub mod size_equations;
