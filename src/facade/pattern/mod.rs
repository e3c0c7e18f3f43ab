//! From the text of patterns to their words (sections 3.2 and 3.3 of the paper), and the mistakes of
//! a description that show before any word is aligned.

pub mod check;
pub mod prepare;
pub mod syntax;
pub mod word;
