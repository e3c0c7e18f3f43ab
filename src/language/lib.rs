//! YAML text → typed nodes.
//!
//! [`parse`] turns a file into a [`Document`] without positions, whose entries are [`Tree`]s that
//! may hold `${…}`. Whoever evaluates expressions replaces them with [`substitute`]; [`decode()`]
//! then gives the typed [`Node`] of an entry, the names and files it uses, and all its errors.
//! Diagnostics name places by paths, which [`locate`](locate()) finds in the text again.
//!
//! What a name refers to, what an expression means and what a node computes is not known here.

mod decode;
mod define;
mod document;
mod entry;
mod expression;
mod head;
mod hint;
pub mod kinds;
mod locate;
mod manual;
mod param;
pub mod placement;
mod read;
mod record;
pub mod scalar;
mod scalar_text;
mod schema;
mod section;
mod tree;
mod types;
pub mod value;

pub use decode::{Decode, DecodeContext, Decoder, FileUse, Reference};
pub use document::{Document, Entry, Include, Parsed, VERSION, parse, parse_bytes};
pub use entry::{Combinations, decode_each, decode_seed};
pub use expression::{Evaluate, Piece, has_expression, split, substitute, substitute_text};
pub use locate::{Places, locate};
pub use manual::reference;
pub use param::{Param, ParamType};
pub use read::{MAX_BYTES, MAX_DEPTH, MAX_NODES, MAX_REPEATED};
pub use scalar::Unit;
pub use schema::schema;
pub use section::{Decoded, Node, Section, decode};
pub use tree::{Float, Tree};
pub use types::{Ref, TypeSet, ValueType, Wanted, wants, with_article};
