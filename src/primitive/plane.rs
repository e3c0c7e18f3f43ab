//! The plane of a map spec: its coordinate system, and how inputs in others come into it.

use std::sync::Arc;

use fretwork_action::{Action, ReadLog, spellings};
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
    match of_map(&text.0) {
        Ok(crs) => Ok(Some(crs)),
        Err(error) => Err(vec![unusable(&error, action.span())]),
    }
}

/// The coordinate system that a map names.
///
/// # Errors
/// When it is not known, or nothing can be drawn in it.
pub fn of_map(text: &str) -> Result<Crs, CrsError> {
    let crs = Crs::parse(text)?;
    crs.check_plane().map(|()| crs)
}

/// The error about a coordinate system that a map cannot be in, which is named or needed at `span`.
pub fn unusable(error: &CrsError, span: Span) -> Diagnostic {
    let diagnostic = Diagnostic::error(format!(
        "the map cannot be in this coordinate system: {error}"
    ));
    diagnostic.at(span, "its place on Earth is told here").help(
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
            if let Some(doubt) = own.doubt().or_else(|| map.doubt()) {
                let message = format!("places of `{path}` may be wrong by some metres: {doubt}");
                warn(
                    message,
                    "transform the file with a program that knows the shift",
                );
            }
            Some(Transform::new(own.clone(), map))
        }
    };
    Ok((transform, warnings))
}

/// The content of a file beside the one at `path`, with another ending in whatever letters; none where there is none.
pub fn beside(action: &Action, path: &str, ending: &str, log: &ReadLog) -> Option<Arc<[u8]>> {
    let name = path.rsplit('/').next().unwrap_or(path);
    let (stem, own) = name.rsplit_once('.')?;
    let found = |ending: &String| action.files.found(&format!("{stem}.{ending}"), path, log);
    let endings = spellings(ending, own);
    let bytes = endings.iter().find_map(|ending| found(ending).ok());
    bytes.map(|(_, bytes)| bytes)
}
