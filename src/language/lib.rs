//! From the text of a spec to typed nodes.
//!
//! 1. [`parse`] turns a file into a [`Document`] without positions. Its entries are [`Tree`]s that may
//!    hold expressions, `${…}`.
//! 2. The caller evaluates the expressions and replaces them with [`substitute`].
//! 3. [`decode()`] gives the typed [`Node`] of an entry, the names and files that it uses, and all of its
//!    errors.
//! 4. Diagnostics name places by paths of keys. [`locate`](locate()) finds a path in the text again, once
//!    somebody wants to see it.
//!
//! The types in [`kinds`] are written with the macros of `macros`, which also describe them: the JSON
//! [`schema`](schema()) and the [`reference`](reference()) page are made from the same definitions. This
//! room does not know what a name refers to, what an expression means, or what a node computes.

mod anchor;
mod decode;
mod document;
mod entry;
mod expression;
mod head;
mod hint;
pub mod kinds;
mod locate;
mod macros;
mod map;
mod modules;
mod param;
pub mod placement;
mod read;
mod record;
mod reference;
pub mod scalar;
mod scalar_text;
mod schema;
mod section;
mod tree;
mod types;
pub mod value;

pub use anchor::Anchor;
pub use decode::{Decode, DecodeContext, Decoder, FileUse, Reference};
pub use document::{Document, Entry, Include, Parsed, Use, VERSION, parse, parse_bytes};
pub use entry::{Combinations, decode_each, decode_seed};
pub use expression::{Evaluate, Piece, has_expression, split, substitute, substitute_text};
pub use locate::{Places, locate};
pub use map::{Map, Tiles, decode_map};
pub use param::{Param, ParamType};
pub use read::{MAX_BYTES, MAX_DEPTH, MAX_NODES, MAX_REPEATED};
pub use reference::reference;
pub use scalar::Unit;
pub use schema::schema;
pub use section::{Decoded, Node, Section, decode};
pub use tree::{Float, Tree};
pub use types::{Ref, TypeSet, ValueType, Wanted, wants, with_article};
