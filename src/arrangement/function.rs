//! Arrangements as values: functions from regions to curves (Loi 2015, section 3.1).

use std::fmt;
use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Curves, Region};

/// What applying an arrangement gives.
pub type Applied = Result<Arc<Curves>, Vec<Diagnostic>>;

/// A function from regions to curves. Pure: on the same region it gives the same curves. Cheap to
/// clone.
#[derive(Clone)]
pub struct Arrangement(Arc<dyn Fn(&Region, f64) -> Applied + Send + Sync>);

impl Arrangement {
    /// The arrangement that `function` computes from a region and a resolution, the distance below
    /// which points are one.
    pub fn new(function: impl Fn(&Region, f64) -> Applied + Send + Sync + 'static) -> Arrangement {
        Arrangement(Arc::new(function))
    }

    /// The arrangement that gives `curves` for every region: one that was applied before.
    pub fn given(curves: Arc<Curves>) -> Arrangement {
        Arrangement::new(move |_, _| Ok(curves.clone()))
    }

    /// The curves for `region`. The resolution is that of the outermost region, also for faces.
    ///
    /// # Errors
    /// What the arrangement's own definition, its region or its scripts do wrong.
    pub fn apply(&self, region: &Region, resolution: f64) -> Applied {
        (self.0)(region, resolution)
    }
}

impl fmt::Debug for Arrangement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Arrangement")
    }
}
