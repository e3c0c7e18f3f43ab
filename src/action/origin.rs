//! What a file says of where it comes from. How a format writes that is not known here.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// The origin of an artifact: the same for every checkout, run and machine, and after an edit that changes no value.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// The output folder of its spec.
    pub spec: Arc<str>,
    /// Its path below that folder.
    pub artifact: Arc<str>,
    /// 32 hexadecimal digits that stand for its parameters and the values of its inputs.
    pub recipe: Arc<str>,
}
