//! The files that scripts name while they run.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::world::{World, resolve};
use fretwork_geometry::Curves;
use fretwork_script::Host;
use fretwork_source::svg::{self, SvgOptions};
use fretwork_store::Digest;

/// The paths that scripts have read, and the digests of the bytes they got; none where a file could
/// not be read.
#[derive(Clone, Debug, Default)]
pub struct ReadLog(Arc<Mutex<BTreeMap<Arc<str>, Option<Digest>>>>);

impl ReadLog {
    fn note(&self, path: &Arc<str>, bytes: Option<&[u8]>) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(path.clone(), bytes.map(Digest::of));
    }

    /// What was read so far.
    pub fn entries(&self) -> Vec<(Arc<str>, Option<Digest>)> {
        let log = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        log.iter()
            .map(|(path, digest)| (path.clone(), *digest))
            .collect()
    }
}

/// The project as scripts see it: drawings and other scripts, by paths relative to the script.
pub struct ScriptHost {
    /// The files.
    pub world: Arc<dyn World>,
    /// Millimetres per unit of the spec.
    pub unit_mm: f64,
    /// What was read.
    pub log: ReadLog,
}

impl ScriptHost {
    fn read(&self, path: &str, from: &str) -> Result<(Arc<str>, Vec<u8>), String> {
        let Some(path) = resolve(from, path) else {
            return Err(format!("`{path}` leaves the project root"));
        };
        let bytes = self.world.read(&path);
        self.log.note(&path, bytes.as_deref().ok());
        Ok((
            path.clone(),
            bytes.map_err(|e| format!("cannot read `{path}`: {e}"))?,
        ))
    }
}

impl Host for ScriptHost {
    fn curves(&self, path: &str, from: &str) -> Result<Arc<Curves>, String> {
        let (path, bytes) = self.read(path, from)?;
        let first = |diagnostics: Vec<fretwork_diagnostic::Diagnostic>| {
            let message = diagnostics
                .first()
                .map_or("it cannot be read", |d| &d.message);
            format!("`{path}`: {message}")
        };
        let text = svg::decode(&bytes, &path).map_err(|d| first(vec![d]))?;
        let read = |tolerance| {
            svg::read(
                text,
                &path,
                &SvgOptions {
                    tolerance,
                    unit_mm: self.unit_mm,
                },
            )
        };
        let side = read(1e12).map_err(first)?.0.bounds().longer_side();
        let (drawing, _) = read(if side > 0.0 { side * 1e-3 } else { 1e-3 }).map_err(first)?;
        Ok(Arc::new(drawing.curves()))
    }

    fn script(&self, path: &str, from: &str) -> Result<(Arc<str>, Arc<str>), String> {
        let (path, bytes) = self.read(path, from)?;
        let text = String::from_utf8(bytes).map_err(|_| format!("`{path}` is not UTF-8 text"))?;
        Ok((path, text.into()))
    }
}
