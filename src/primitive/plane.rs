//! The plane of a map spec: its coordinate system, and how inputs in others come into it.

use std::sync::Arc;

use fretwork_action::{Action, ReadLog};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_source::geo::crs::{Crs, CrsError, Transform};

/// The coordinate system of the action's map; none where it has none.
///
/// # Errors
/// When it is not known, or nothing can be drawn in it.
pub fn crs(action: &Action) -> Result<Option<Crs>, Vec<Diagnostic>> {
    let map = action.definition.map.as_ref();
    let Some(text) = map.and_then(|map| map.crs.as_ref()) else {
        return Ok(None);
    };
    let usable = |crs: Crs| crs.check_plane().map(|()| crs);
    match Crs::parse(&text.0).and_then(usable) {
        Ok(crs) => Ok(Some(crs)),
        Err(error) => Err(vec![unusable(&error, action.span())]),
    }
}

fn unusable(error: &CrsError, span: Span) -> Diagnostic {
    let diagnostic = Diagnostic::error(format!(
        "the map cannot be in this coordinate system: {error}"
    ));
    diagnostic.at(span, "its place on the map is needed here").help(
        "take a projected system in metres, such as the UTM zone of the place: `map: { crs: \"EPSG:32616\" }`",
    )
}

/// How an input whose coordinate system is `own` comes into the plane, nothing where it is there already; and warnings.
/// `path` names its file.
///
/// # Errors
/// When the map's system cannot be used, or, where the map says none, the input's own.
pub fn transform(
    action: &Action,
    own: Option<&Crs>,
    path: &str,
) -> Result<(Option<Transform>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let mut warnings = Vec::new();
    let mut warn = |message: String, help: &str| {
        let warning = Diagnostic::warning(message).at(action.span(), "read here");
        warnings.push(warning.help(help));
    };
    let transform = match (crs(action)?, own) {
        (None, None) => None,
        (None, Some(own)) => {
            let error = |error: CrsError| {
                let message = format!("`{path}` cannot be the plane of the map: {error}");
                let diagnostic = Diagnostic::error(message).at(action.span(), "read here");
                vec![diagnostic.help("say in which system the map is: `map: { crs: \"EPSG:…\" }`")]
            };
            own.check_plane().map_err(error)?;
            None
        }
        (Some(_), None) => {
            let message = format!("`{path}` does not say its coordinate system");
            warn(message, "it is taken to be in that of the map");
            None
        }
        (Some(map), Some(own)) if own.is_same(&map) => None,
        (Some(map), Some(own)) => {
            if own.needs_grid() || map.needs_grid() {
                let message = format!(
                    "places of `{path}` may be wrong by some metres: `{}` needs a grid of shifts, which is not at hand",
                    if own.needs_grid() {
                        own.name()
                    } else {
                        map.name()
                    }
                );
                warn(
                    message,
                    "transform the file with a program that has the grid",
                );
            }
            Some(Transform::new(own.clone(), map))
        }
    };
    Ok((transform, warnings))
}

/// The content of a file beside the one at `path`, with another ending; none where there is none.
pub fn beside(action: &Action, path: &str, ending: &str, log: &ReadLog) -> Option<Arc<[u8]>> {
    let name = path.rsplit('/').next().unwrap_or(path);
    let (stem, own) = name.rsplit_once('.')?;
    let is_upper = !own.is_empty() && own.chars().all(|c| !c.is_ascii_lowercase());
    let ending = if is_upper {
        ending.to_ascii_uppercase()
    } else {
        ending.to_string()
    };
    let found = action.files.found(&format!("{stem}.{ending}"), path, log);
    found.ok().map(|(_, bytes)| bytes)
}
