//! Small algorithms on numbers that know nothing of geometry: disjoint sets, common divisors.

mod divisor;
mod union_find;
mod weighted_union_find;

pub use divisor::{gcd, lcm};
pub use union_find::UnionFind;
pub use weighted_union_find::WeightedUnionFind;
