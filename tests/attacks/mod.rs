//! What hostile projects, foreign caches and small machines must not bring about: that a file is
//! written, removed or believed that is not fretwork's own.

mod budget;
mod cache;
mod limits;
mod links;
mod lock;
mod messages;
mod output;
