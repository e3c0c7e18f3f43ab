//! Spatial indices: which of many things are near a place. They hold numbers, never the things themselves, and
//! every answer is the same for any order of construction that their pages do not exclude.
//!
//! | index | holds | answers | changes |
//! | --- | --- | --- | --- |
//! | [`BucketGrid`] | segments or boxes of the plane, of about one size | what may meet a rectangle | insert |
//! | [`BoxTree`] | boxes of any sizes, in N dimensions | what meets a box, what is nearest by any lower bound | – |
//! | [`SegmentTree`] | segments of the plane in groups | the nearest of another group | regroup |
//! | [`KdTree`] | points, in N dimensions | the nearest one | remove |
//!
//! Points that meet exactly or within a tolerance are no question for an index: `Mesh::welded` and the planar map
//! decide that, for it changes topology. The planar map keeps cells of its own on whole numbers, because there
//! every site must have exactly one owner; it shares [`Rows`] with the rest.

mod box_tree;
mod bucket_grid;
mod extent;
mod kd_tree;
mod rows;
mod segment_tree;

pub use box_tree::BoxTree;
pub use bucket_grid::{BucketGrid, Squares};
pub use extent::Extent;
pub use kd_tree::KdTree;
pub use rows::{Filler, Rows};
pub use segment_tree::SegmentTree;
