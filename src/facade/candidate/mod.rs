//! From patterns to candidates (section 5.1 of the paper): the words that may fit the canvas, and
//! the choices of one word a layer that may be aligned. The alignment itself is made in `align`.

pub mod axis_task;
pub mod choice;
pub mod grid;
pub mod letter;
pub mod words;
