//! Mapping and merging as a spec declares them.

use std::sync::Arc;

use super::Context;
use crate::arrangement::Arrangement;
use crate::geometry::Curves;
use crate::spec::{Ref, wants};

/// The curves of all of these, in order.
pub fn union(of: &[Ref<wants::Arrangement>], context: &Context<'_>) -> Arrangement {
    let inputs: Vec<Arrangement> = of.iter().map(|name| context.inputs.arrangement(name)).collect();
    Arrangement::new(move |region, resolution| {
        let mut all = Curves::new();
        for input in &inputs {
            all.append(&*input.apply(region, resolution)?);
        }
        Ok(Arc::new(all))
    })
}
