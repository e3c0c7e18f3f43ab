//! What belongs to one evaluation and not to the script: natives find it through the evaluator.

use starlark::eval::Evaluator;

use super::guard::{Budget, Limits};
pub(super) use super::values::Session;

impl Session {
    /// A session that may use `limits`.
    pub(super) fn new(limits: Limits) -> Session {
        Session { budget: Budget::new(limits) }
    }

    /// What natives have used and may use.
    pub(super) fn budget(&self) -> &Budget {
        &self.budget
    }
}

/// Gives a new evaluator its session and the limits of it.
pub(super) fn prepare<'a>(eval: &mut Evaluator<'_, 'a, '_>, session: &'a Session) {
    let limits = session.budget.limits();
    let unset = "a limit of a new evaluator is not set and not zero";
    eval.set_max_tick_count(limits.steps).expect(unset);
    eval.set_max_heap_size(limits.heap).expect(unset);
    eval.set_max_callstack_size(limits.calls).expect(unset);
    eval.extra = Some(session);
}

/// The session of the evaluation that `eval` does.
pub(super) fn session<'a>(eval: &Evaluator<'_, 'a, '_>) -> &'a Session {
    eval.extra.and_then(|extra| extra.downcast_ref()).expect("every evaluation is given a session")
}
