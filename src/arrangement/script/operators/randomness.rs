//! Random values (table 3.4; rule R14).

use starlark::environment::GlobalsBuilder;
use starlark::eval::Evaluator;
use starlark::starlark_module;
use starlark::values::{Value, ValueLike};

use crate::script::operators::arguments::{Area, number};
use crate::script::operators::measures::center_of;
use crate::script::seeds::{cell_seed, settled};
use fretwork_script::scope::Scope;
use fretwork_script::session::{refuse, session};
use fretwork_script::values::{Cell, CellKind, RegionValue};

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    operators(builder);
}

/// The number of a value: a whole number itself, any other by its bits.
fn ordinal(n: f64) -> u64 {
    let whole = n as i64;
    if whole as f64 == n {
        whole as u64
    } else {
        n.to_bits()
    }
}

#[starlark_module]
fn operators(builder: &mut GlobalsBuilder) {
    /// `random(cell, lo, hi, n = 0)`: a number between `lo` and `hi` that is always the same for a cell and `n`. `random(lo, hi)`: the next of a stream.
    ///
    /// Fails on numbers that are not finite.
    ///
    /// Example: `angle = random(face, 0, 2 * pi)`
    fn random<'v>(
        #[starlark(require = pos)] first: Value<'v>,
        #[starlark(require = pos)] second: Value<'v>,
        #[starlark(require = pos)] third: Option<Value<'v>>,
        n: Option<Value<'v>>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<f64> {
        let session = session(eval);
        session.allow_random()?;
        let seed = if let Some(cell) = first.downcast_ref::<Cell>() {
            Some(cell_seed(session, *cell)?)
        } else if let Some(region) = first.downcast_ref::<RegionValue>() {
            let at = center_of(&Area::Region(region.0.clone()), eval)? + session.shift();
            Some(session.scope(|scope| scope.position(CellKind::Face, at, session.scale().snap)))
        } else {
            None
        };
        let (lo, hi, unit) = match (seed, third) {
            (Some(seed), Some(third)) => {
                let n = n.map_or(Ok(0.0), |n| number(n, "random"))?;
                (
                    number(second, "random")?,
                    number(third, "random")?,
                    seed.unit(ordinal(n)),
                )
            }
            (None, None) if n.is_none() => (
                number(first, "random")?,
                number(second, "random")?,
                settled(session, Scope::draw)?,
            ),
            _ => return Err(refuse("`random` takes (lo, hi) or (cell, lo, hi, n)")),
        };
        Ok(lo + (hi - lo) * unit)
    }
}
