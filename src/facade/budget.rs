//! How much searching is allowed: counted in steps, so that a result does not depend on the machine.

/// Steps that may still be taken.
#[derive(Clone, Debug)]
pub struct Budget {
    given: u64,
    left: u64,
    /// Whether something was left undone.
    pub exhausted: bool,
}

impl Budget {
    /// A budget of so many steps.
    pub fn new(steps: u64) -> Budget {
        Budget {
            given: steps,
            left: steps,
            exhausted: false,
        }
    }

    /// Takes `steps`; false, from then on, when there were fewer.
    pub fn spend(&mut self, steps: u64) -> bool {
        match self.left.checked_sub(steps) {
            Some(left) => self.left = left,
            None => {
                self.left = 0;
                self.exhausted = true;
            }
        }
        !self.exhausted
    }

    /// A budget of at most `steps` of this one's.
    pub fn part(&self, steps: u64) -> Budget {
        Budget::new(steps.min(self.left))
    }

    /// A budget of one of so many parts of this one's steps.
    pub fn fraction(&self, parts: u64) -> Budget {
        Budget::new(self.left / parts.max(1))
    }

    /// Takes what a part of this budget used up; the part may be exhausted without this one being so.
    pub fn charge(&mut self, part: &Budget) {
        self.left = self.left.saturating_sub(part.given - part.left);
    }
}
