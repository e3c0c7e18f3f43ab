//! What is told when a budget does not suffice.

use super::Limits;

/// Why work was not done. The estimates are the same in every run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Exceeded {
    /// A single piece of work is more than the budget, or what was charged in order is.
    #[error("this needs about {} steps, more than {} ({what})", short(.steps), short(.limit))]
    Steps {
        /// What there is too much of.
        what: &'static str,
        /// How many steps it would take.
        steps: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// Work that is charged bit by bit, of which nobody knows how much more there is.
    #[error("this needs more than {} steps ({what})", short(.limit))]
    More {
        /// What there is too much of.
        what: &'static str,
        /// How many steps are allowed.
        limit: u64,
    },
    /// A thing would be too large.
    #[error("this needs about {} of memory, more than {}: {} {what}", size(.bytes), size(.limit), short(.count))]
    Bytes {
        /// What there is too much of.
        what: &'static str,
        /// How many there would be.
        count: u64,
        /// How many bytes they would take.
        bytes: u64,
        /// How many are allowed.
        limit: u64,
    },
    /// All that a node holds would be too large.
    #[error("this needs {}{} of memory in all ({what})", about(.bytes), size(.limit))]
    Together {
        /// What there is one kind too many of.
        what: &'static str,
        /// How many bytes all would take by now; none where that differs from run to run.
        bytes: Option<u64>,
        /// How many are allowed.
        limit: u64,
    },
}

impl Exceeded {
    /// What can be done about it, where a node may use `limits`.
    pub fn help(&self, limits: Limits) -> String {
        let times = match self {
            Exceeded::Steps { steps, limit, .. } => *steps as f64 / *limit as f64,
            Exceeded::Bytes { bytes, limit, .. } => *bytes as f64 / *limit as f64,
            Exceeded::More { .. } | Exceeded::Together { .. } => 2.0,
        };
        let factor = limits.next(times);
        format!(
            "is every length in the right unit, and every count meant? `--budget {factor}` allows for more"
        )
    }
}

/// A number for people: whole up to a million, then in three digits.
pub(super) fn short(n: &u64) -> String {
    let units = [
        (1_000_000_000_000_000_000, "million million million"),
        (1_000_000_000_000, "million million"),
        (1_000_000, "million"),
    ];
    match units.iter().find(|(unit, _)| n >= unit) {
        Some((unit, name)) => format!("{} {name}", digits(*n, *unit)),
        None => n.to_string(),
    }
}

/// A size in memory for people.
pub fn size(bytes: &u64) -> String {
    match bytes {
        0..=0xffff_ffff => format!("{} MiB", bytes >> 20),
        _ => format!("{} GiB", digits(*bytes, 1 << 30)),
    }
}

/// How a sum of sizes goes beyond its limit, where it is known.
fn about(bytes: &Option<u64>) -> String {
    match bytes {
        Some(bytes) => format!("about {}, more than ", size(bytes)),
        None => "more than ".into(),
    }
}

/// How many units there are: with a decimal below ten.
fn digits(n: u64, unit: u64) -> String {
    let tenths = n / (unit / 10);
    if tenths < 100 && !tenths.is_multiple_of(10) {
        format!("{}.{}", tenths / 10, tenths % 10)
    } else {
        (n / unit).to_string()
    }
}
