//! An arrangement on a region: the walk from the root down to the partitions.

use std::rc::Rc;
use std::sync::Arc;

use starlark::eval::Evaluator;
use starlark::values::{Value, ValueLike};

use crate::mask;
use crate::partition::grid::grid;
use crate::partition::stripes::stripes;
use crate::random::cells::{random, uniform};
use crate::script::construction::{Construction, Operator};
use crate::script::mapping::{self, Collected, Items, Mapping, Reach};
use crate::script::memo::{Made, Memo, identity};
use crate::script::parallel::{self, Job};
use crate::script::place::Place;
use crate::script::seeds::settled;
use fretwork_geometry::Curves;
use fretwork_script::Limits;
use fretwork_script::fault::Note;
use fretwork_script::session::{CurvesValue, refuse, session};

/// What is refused of partitions where somebody watches.
const RANDOM: &str = "it makes a random partition";

/// How many operators may follow one another.
const CHAIN: usize = 200;

/// The curves of the arrangement `value` on `place`. Of an operator that occurs more than once
/// below `value` curves and planar map are made once.
pub(crate) fn evaluate<'v>(
    value: Value<'v>,
    place: &Place<'v>,
    eval: &mut Evaluator<'v, '_, '_>,
) -> starlark::Result<Arc<Curves>> {
    session(eval).deeper(|| {
        let mut evaluation = Evaluation {
            place,
            memo: Memo::of(value),
            chain: 0,
        };
        Ok(evaluation.made(value, eval)?.curves.clone())
    })
}

struct Evaluation<'p, 'v> {
    place: &'p Place<'v>,
    memo: Memo,
    chain: usize,
}

impl<'v> Evaluation<'_, 'v> {
    fn made(
        &mut self,
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Rc<Made>> {
        if let Some(made) = self.memo.take(value) {
            return Ok(made);
        }
        self.chain += 1;
        if self.chain > CHAIN {
            return Err(refuse(format!(
                "more than {CHAIN} operators follow one another"
            )));
        }
        let curves = match Construction::of(value) {
            Some((node, operands)) => self.node(node, value, operands, eval),
            None => self.function(value, eval),
        }?;
        self.chain -= 1;
        session(eval).draw(&curves)?;
        let made = Rc::new(Made::new(curves));
        self.memo.keep(value, &made);
        Ok(made)
    }

    /// A function of the script, applied as an arrangement.
    fn function(
        &mut self,
        value: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Arc<Curves>> {
        let region = self.place.value(eval)?;
        let session = session(eval);
        let scope = settled(session, |scope| scope.apply(identity(value)))?;
        let result = session.within(scope, || eval.eval_function(value, &[region], &[]))?;
        match result.downcast_ref::<CurvesValue>() {
            Some(curves) => {
                mapping::check_weight(curves, session)?;
                Ok(curves.curves.clone())
            }
            None => {
                let name = value.function_name().unwrap_or("the function");
                let what = mapping::described(result);
                Err(refuse(format!(
                    "`{name}` is used as an arrangement but gives {what}, not curves"
                )))
            }
        }
    }

    fn node(
        &mut self,
        node: &'v Construction,
        value: Value<'v>,
        operands: &'v [Value<'v>],
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Arc<Curves>> {
        let resolution = session(eval).scale().resolution;
        let made = match (&node.what, operands) {
            (Operator::Map(kind), [mapper, input]) => {
                let input = self.made(*input, eval)?;
                let map = input.map(resolution).map_err(|e| failed(node, e, eval))?;
                // The curves are not needed beside their map, unless they are used again.
                drop(input);
                if let Some(job) = session(eval).job::<Job>()
                    && let Some(patch) = job.patch
                {
                    patch.check(&map).map_err(refuse)?;
                }
                let mapping = Mapping {
                    kind: *kind,
                    map,
                    items: Items::All,
                    seed: node.seed,
                    site: node.site.clone(),
                    reach: Reach::Any,
                };
                return parallel::map_cells(&mapping, *mapper, eval).map(Arc::new);
            }
            (Operator::Union, _) => return self.union(value, eval).map(Arc::new),
            (Operator::Inside(border), [a, b]) => {
                let (a, b) = (self.made(*a, eval)?, self.made(*b, eval)?);
                mask::inside(&a.curves, &b.curves, *border, resolution)
            }
            (Operator::Outside(border), [a, b]) => {
                let (a, b) = (self.made(*a, eval)?, self.made(*b, eval)?);
                mask::outside(&a.curves, &b.curves, *border, resolution)
            }
            (what, _) => {
                let region = self.place.region(eval)?;
                match what {
                    Operator::Stripes(p) => stripes(p, &region, resolution),
                    Operator::Grid(across, along, border) => {
                        grid(across, along, *border, &region, resolution)
                    }
                    Operator::Uniform(p, border) => {
                        session(eval).unwatched(RANDOM)?;
                        uniform(p, *border, &region, node.seed, resolution)
                    }
                    Operator::Random(p, border) => {
                        session(eval).unwatched(RANDOM)?;
                        random(p, *border, &region, node.seed, resolution)
                    }
                    _ => return Err(refuse(format!("`{}` has lost its operands", what.name()))),
                }
            }
        };
        made.map(Arc::new).map_err(|e| failed(node, e, eval))
    }

    /// The curves of all arrangements that are united below `root`, from left to right. Long chains
    /// of unions are common, so they are not descended into one by one.
    fn union(
        &mut self,
        root: Value<'v>,
        eval: &mut Evaluator<'v, '_, '_>,
    ) -> starlark::Result<Curves> {
        let mut all = Collected::up_to(Limits::RESULT);
        let mut open = vec![(root, true)];
        while let Some((value, is_root)) = open.pop() {
            match Construction::of(value) {
                Some((
                    Construction {
                        what: Operator::Union,
                        ..
                    },
                    operands,
                )) if is_root || !self.memo.shares(value) => {
                    open.extend(operands.iter().rev().map(|operand| (*operand, false)));
                }
                _ => {
                    let made = self.made(value, eval)?;
                    all.append(&made.curves)?;
                }
            }
        }
        Ok(all.curves)
    }
}

/// An operator's refusal, with the place where it was constructed.
fn failed(
    node: &Construction,
    error: impl std::error::Error + Send + Sync + 'static,
    eval: &Evaluator<'_, '_, '_>,
) -> starlark::Error {
    session(eval).note(Note {
        text: format!("`{}`", node.what.name()),
        site: node.site.clone(),
    });
    starlark::Error::new_other(error)
}
