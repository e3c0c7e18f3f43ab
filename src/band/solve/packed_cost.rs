//! A cost and the choice that leads to it in one number, which makes the inner loop of the dynamic
//! program one addition and one comparison.

/// How the cheapest way goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// There is no way.
    None,
    /// The pattern ends.
    End,
    /// It goes on with this step of the state.
    Step(usize),
}

const NONE: u8 = 255;
const END: u8 = 254;

impl Choice {
    /// The choice that is written as this byte.
    pub fn of(byte: u8) -> Choice {
        match byte {
            NONE => Choice::None,
            END => Choice::End,
            step => Choice::Step(step.into()),
        }
    }
}

/// No sum of costs may reach this. A step that costs as much is never taken.
pub const COST_LIMIT: u64 = 1 << 42;

/// The number 256 · cost + choice.
///
/// The choice is the number of a step below 254, 254 for the end of the pattern, or 255 for none.
/// Two such numbers compare first by cost and then by choice. So the smaller of two is the cheaper
/// way, and of equally cheap ways the one that is listed first; a table that is filled in this
/// order is the same on every machine. To go one step back is to add [`PackedCost::step`] to a
/// number whose choice has been removed by [`PackedCost::unpack`].
///
/// Why the arithmetic is exact: a cost below [`COST_LIMIT`] = 2^42 is packed to less than
/// [`PackedCost::NEVER`] = 2^50. The largest sum that is ever made, no way plus a forbidden step
/// plus a choice, is 2^50 + 2^50 + 255, and an `f64` holds whole numbers up to 2^53. A float is
/// taken rather than an integer because the processor compares floats four at a time.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
#[repr(transparent)]
pub struct PackedCost(f64);

impl PackedCost {
    /// No way to the end, without a choice. Whatever is not below it is none either.
    pub const NEVER: PackedCost = PackedCost((COST_LIMIT * 256) as f64);
    /// No way to the end, with the choice that says so.
    pub const IMPOSSIBLE: PackedCost = PackedCost(PackedCost::NEVER.0 + NONE as f64);

    /// What the step with this number, below 254, adds to a way.
    pub fn step(cost: u64, number: usize) -> PackedCost {
        PackedCost((cost * 256 + number as u64) as f64)
    }

    /// The end of a pattern.
    pub fn end(cost: u64) -> PackedCost {
        PackedCost((cost * 256) as f64 + f64::from(END))
    }

    /// A way, whose choice has been removed, after a step.
    #[inline]
    pub fn after(self, step: PackedCost) -> PackedCost {
        PackedCost(self.0 + step.0)
    }

    /// The cheaper of two ways.
    #[inline]
    pub fn or(self, other: PackedCost) -> PackedCost {
        if other.0 < self.0 { other } else { self }
    }

    /// The number without its choice, and the choice as a byte.
    #[inline]
    pub fn unpack(self) -> (PackedCost, u8) {
        // Rounds down to a multiple of 256, because a sum of this size has no smaller digits.
        const ROUND: f64 = 1.5 * (1u64 << 60) as f64;
        let floor = (self.0 - 127.5 + ROUND) - ROUND;
        if floor >= PackedCost::NEVER.0 {
            (PackedCost::NEVER, NONE)
        } else {
            (PackedCost(floor), (self.0 - floor) as u8)
        }
    }

    /// The cost, of a number whose choice has been removed; none where there is no way.
    #[inline]
    pub fn cost(self) -> Option<u64> {
        (self < PackedCost::NEVER).then_some(self.0 as u64 / 256)
    }

    /// The cost rounded to single precision; infinite where there is no way.
    #[inline]
    pub fn rounded_cost(self) -> f32 {
        if self < PackedCost::NEVER {
            (self.0 / 256.0) as f32
        } else {
            f32::INFINITY
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A way that costs nothing and has no choice.
    const NOTHING: PackedCost = PackedCost(0.0);

    #[test]
    fn costs_and_choices_up_to_the_limits_come_apart_again() {
        for cost in [
            0,
            1,
            255,
            256,
            (1 << 20) + 3,
            COST_LIMIT / 2 + 1,
            COST_LIMIT - 1,
        ] {
            for step in [0, 1, 127, 128, 252, 253] {
                let (way, choice) = NOTHING.after(PackedCost::step(cost, step)).unpack();
                assert_eq!(way.cost(), Some(cost));
                assert_eq!(Choice::of(choice), Choice::Step(step));
            }
            let (way, choice) = PackedCost::end(cost).unpack();
            assert_eq!((way.cost(), Choice::of(choice)), (Some(cost), Choice::End));
        }
    }

    #[test]
    fn what_reaches_the_limit_is_no_way() {
        let half = NOTHING
            .after(PackedCost::step(COST_LIMIT / 2, 7))
            .unpack()
            .0;
        for too_much in [
            PackedCost::IMPOSSIBLE,
            NOTHING.after(PackedCost::step(COST_LIMIT, 0)),
            half.after(PackedCost::step(COST_LIMIT / 2, 253)),
            PackedCost::NEVER.after(PackedCost::step(0, 0)),
            PackedCost::NEVER.after(PackedCost::step(COST_LIMIT, 253)),
        ] {
            let (way, choice) = too_much.unpack();
            assert_eq!((way, Choice::of(choice)), (PackedCost::NEVER, Choice::None));
            assert_eq!((way.cost(), way.rounded_cost()), (None, f32::INFINITY));
        }
    }

    #[test]
    fn the_largest_sum_is_exact() {
        let largest = PackedCost::NEVER.after(PackedCost::step(COST_LIMIT, 255));
        assert_eq!(largest.0 as u64, 2 * (COST_LIMIT * 256) + 255);
    }

    #[test]
    fn the_cheaper_way_wins_and_of_equals_the_first_listed() {
        let way = |cost, step| PackedCost::step(cost, step);
        assert_eq!(way(5, 9).or(way(4, 200)), way(4, 200));
        assert_eq!(way(5, 9).or(way(5, 3)), way(5, 3));
        assert_eq!(way(5, 9).or(PackedCost::end(5)), way(5, 9));
        assert_eq!(
            PackedCost::IMPOSSIBLE.or(PackedCost::end(8)),
            PackedCost::end(8)
        );
    }
}
