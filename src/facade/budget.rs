//! A limit of searching. It is counted in steps, not in seconds, so that a result does not depend on the
//! machine.

/// Steps that may still be taken.
#[derive(Clone, Debug)]
pub struct Budget {
    given: u64,
    left: u64,
    /// Whether a step was refused, so that something was left undone.
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

    /// Takes `steps`. If fewer are left, it returns false, now and from then on.
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

    /// A budget of `steps`, or of all that are left if those are fewer.
    pub fn part(&self, steps: u64) -> Budget {
        Budget::new(steps.min(self.left))
    }

    /// A budget of one of so many equal parts of the steps that are left.
    pub fn fraction(&self, parts: u64) -> Budget {
        Budget::new(self.left / parts.max(1))
    }

    /// Takes the steps that a part of this budget used up. The part may be exhausted while this budget
    /// is not.
    pub fn charge(&mut self, part: &Budget) {
        self.left = self.left.saturating_sub(part.given - part.left);
    }
}
