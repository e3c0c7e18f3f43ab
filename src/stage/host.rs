//! The files that scripts name while they run.

use std::sync::Arc;

use fretwork_action::{Files, ReadLog};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine, Curves};
use fretwork_primitive::{LEAST_TOLERANCE_MM, default_tolerance};
use fretwork_script::Host;
use fretwork_source::svg::{self, SvgOptions};

/// The project as scripts see it: drawings and other scripts, by paths relative to the script.
pub struct ScriptHost {
    /// The files.
    pub files: Files,
    /// Millimetres per unit of the file that names the script.
    pub unit_mm: f64,
    /// The length in that unit which nobody sees.
    pub fine: f64,
    /// Whether y goes up in the plane of the spec, so that drawings are mirrored.
    pub is_map: bool,
    /// What was read.
    pub log: ReadLog,
}

impl Host for ScriptHost {
    fn curves(
        &self,
        path: &str,
        from: &str,
        tolerance: Option<f64>,
    ) -> Result<Arc<Curves>, String> {
        let (path, bytes) = self.files.found(path, from, &self.log)?;
        let first = |diagnostics: Vec<Diagnostic>| {
            let message = diagnostics
                .first()
                .map_or("it cannot be read", |d| &d.message);
            format!("`{path}`: {message}")
        };
        let text = svg::decode(&bytes, &path).map_err(|d| first(vec![d]))?;
        let unit_mm = self.unit_mm;
        let read = |tolerance| svg::read(text, &path, &SvgOptions { tolerance, unit_mm });
        let tolerance = match tolerance {
            Some(tolerance) if tolerance * unit_mm < LEAST_TOLERANCE_MM => {
                return Err(format!(
                    "a tolerance of {tolerance} is finer than anything can be made, the least is {LEAST_TOLERANCE_MM} mm"
                ));
            }
            Some(tolerance) => tolerance,
            None => {
                let side = read(1e12).map_err(first)?.0.bounds().longer_side();
                default_tolerance(side, 1e-3, self.fine)
            }
        };
        let (drawing, _) = read(tolerance).map_err(first)?;
        let curves = drawing.curves();
        Ok(Arc::new(if self.is_map {
            curves.transformed(&Affine::scale(1.0, -1.0))
        } else {
            curves
        }))
    }

    fn script(&self, path: &str, from: &str) -> Result<(Arc<str>, Arc<str>), String> {
        let (path, bytes) = self.files.found(path, from, &self.log)?;
        match std::str::from_utf8(&bytes) {
            Ok(text) => Ok((path, text.into())),
            Err(_) => Err(format!("`{path}` is not UTF-8 text")),
        }
    }
}
