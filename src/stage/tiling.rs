//! Which engine draws an arrangement, and what it has at places.

use super::arrangement::{put_together, resolution};
use fretwork_action::{Action, EngineChoice, ReadLog};
pub use fretwork_arrangement::{AtPlace, Engine};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Point, Region, planar_map};

/// How the arrangement that an action stands for is drawn on large regions. None where it cannot be put together.
pub fn engine(action: &Action) -> Option<Engine> {
    let work = || {
        let function = put_together(action, &ReadLog::default())?;
        let resolution = function.is_map.then_some(planar_map::MAP_RESOLUTION);
        Ok(function.arrangement.engine_anywhere(resolution))
    };
    action.within_budget(work).ok()
}

/// What the arrangement that an action stands for has at places of a region.
///
/// # Errors
/// What is wrong with the node and its scripts.
pub fn at(
    action: &Action,
    region: &Region,
    places: &[[f64; 2]],
) -> Result<Vec<AtPlace>, Vec<Diagnostic>> {
    let function = put_together(action, &ReadLog::default())?;
    let resolution = resolution(function.is_map, region);
    let at = |place: &[f64; 2]| {
        let place = Point::from(*place);
        match action.engine {
            EngineChoice::Auto => function.arrangement.at(region, resolution, place),
            EngineChoice::General => {
                let curves = function.arrangement.apply(region, resolution)?;
                AtPlace::of(&curves, resolution, place)
                    .map_err(|error| vec![Diagnostic::error(error.to_string())])
            }
        }
    };
    action.within_budget(|| places.iter().map(at).collect())
}

/// What a region has at places: its faces and the lines around them.
///
/// # Errors
/// When its lines form no planar map.
pub fn at_region(
    region: &Region,
    is_map: bool,
    places: &[[f64; 2]],
) -> Result<Vec<AtPlace>, Vec<Diagnostic>> {
    let resolution = resolution(is_map, region);
    let at = |place: &[f64; 2]| {
        AtPlace::of(&region.contour, resolution, Point::from(*place))
            .map_err(|error| vec![Diagnostic::error(error.to_string())])
    };
    places.iter().map(at).collect()
}
