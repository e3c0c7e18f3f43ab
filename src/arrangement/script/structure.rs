//! What the operators that a script has put together tell of repetitions, before anything is drawn.

use std::collections::BTreeSet;

use starlark::values::Value;

use crate::script::construction::{Construction, Operator};
use crate::script::memo::identity;
use crate::tiled::regularity::{Irregular, Regularity};

/// What is repeated in the arrangement `root`: what all partitions below it have in common, for no operator adds anything
/// to that.
///
/// # Errors
/// Why nothing is.
pub(crate) fn regularity(root: Value<'_>) -> Result<Regularity, Irregular> {
    let (mut leaves, mut seen) = (Vec::new(), BTreeSet::new());
    let mut open = vec![root];
    while let Some(value) = open.pop() {
        if !seen.insert(identity(value)) {
            continue;
        }
        let Some((node, operands)) = Construction::of(value) else {
            return Err(Irregular::new(
                "a function of its script draws on the region",
            ));
        };
        match &node.what {
            Operator::Stripes(lines) => leaves.push(Regularity::of_lines(&[lines], false)),
            Operator::Grid(across, along, _) => {
                leaves.push(Regularity::of_lines(&[across, along], false));
            }
            Operator::Uniform(..) | Operator::Random(..) => {
                return Err(Irregular::new("its script makes a random partition"));
            }
            what => open.extend(what.inputs(operands)),
        }
    }
    Ok(Regularity::of_all(&leaves))
}
