//! Greatest common divisor and least common multiple.

/// The greatest common divisor, by Euclid's algorithm; `gcd(a, 0)` is `a`. O(log min(a, b)).
///
/// ```
/// use fretwork_geometry::numeric::gcd;
/// assert_eq!((gcd(12, 18), gcd(5, 0), gcd(0, 0)), (6, 5, 0));
/// ```
pub fn gcd(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// The least common multiple; none where it exceeds 64 bits. It is 0 where either number is.
///
/// ```
/// use fretwork_geometry::numeric::lcm;
/// assert_eq!((lcm(4, 6), lcm(4, 0), lcm(u64::MAX, 2)), (Some(12), Some(0), None));
/// ```
pub fn lcm(a: u64, b: u64) -> Option<u64> {
    if a == 0 || b == 0 {
        return Some(0);
    }
    (a / gcd(a, b)).checked_mul(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_trying_every_number() {
        for a in 0..40u64 {
            for b in 0..40u64 {
                let divides = |d: &u64| a.is_multiple_of(*d) && b.is_multiple_of(*d);
                let slow = (1..=a.max(b)).rev().find(divides).unwrap_or(0);
                assert_eq!(gcd(a, b), slow, "{a} {b}");
                let multiple = |m: &u64| m.is_multiple_of(a) && m.is_multiple_of(b);
                let slow = (1..=a * b).find(multiple).unwrap_or(0);
                assert_eq!(lcm(a, b), Some(slow), "{a} {b}");
            }
        }
    }
}
