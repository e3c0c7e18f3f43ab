//! The value through which natives find what belongs to the evaluation.

use starlark::any::ProvidesStaticType;

use crate::script::guard::Budget;

/// What belongs to one evaluation; see [`session`](crate::script::session).
#[derive(Debug, ProvidesStaticType)]
pub(in crate::script) struct Session {
    pub(in crate::script) budget: Budget,
}
