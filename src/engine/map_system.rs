//! The coordinate system of a map that does not say it: the one that all its inputs share.

use std::sync::Arc;

use super::database::{Db, SourceFile};
use super::definition::{basis, read};
use super::program::program;
use super::settings::Settings;
use fretwork_action::{is_read_by_parts, resolve, spellings};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_language::Node;
use fretwork_language::kinds::fields::Field;
use fretwork_language::kinds::regions::Region;
use fretwork_language::scalar::FilePath;
use fretwork_source::geo::crs::Crs;
use fretwork_source::geo::system;

/// What the inputs of a map say of its coordinate system.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shared {
    /// The system that they share; none where none of them says one, or the map says it itself.
    pub crs: Option<Arc<str>>,
    /// Why none can be taken.
    pub diagnostics: Vec<Diagnostic>,
}

/// The coordinate system that the georeferenced inputs of the spec share, if it is a map and does not say its own.
#[salsa::tracked(returns(clone))]
pub fn shared(db: &dyn Db, root: SourceFile, settings: Settings) -> Arc<Shared> {
    let basis = basis(db, root, settings.clone());
    if basis.map.as_ref().is_none_or(|map| map.crs.is_some()) {
        return Arc::default();
    }
    let mut first: Option<(Crs, Arc<str>)> = None;
    for id in program(db, root).entries.keys() {
        let Some(reading) = read(db, root, settings.clone(), id.clone()) else {
            continue;
        };
        let Some((file, layer)) = reading.decoded.node.as_ref().and_then(georeferenced) else {
            continue;
        };
        let Some(path) = resolve(&reading.file, &file.0) else {
            continue;
        };
        let Some(crs) = of_file(db, &path, layer.as_deref()) else {
            continue;
        };
        let place = Span::key(
            &reading.file,
            &[Arc::from(id.section.name()), Arc::from(id.own_name())],
        );
        if let Err(error) = crs.check_plane() {
            let message = format!("`{path}` cannot be the plane of the map: {error}");
            return needed(message, place);
        }
        match &first {
            None => first = Some((crs, path)),
            Some((other, of)) if !other.is_same(&crs) => {
                let message = format!(
                    "`{of}` is in `{}` and `{path}` in `{}`: the map could be in either",
                    other.name(),
                    crs.name()
                );
                return needed(message, place);
            }
            Some(_) => {}
        }
    }
    Arc::new(Shared {
        crs: first.map(|(crs, _)| crs.text().into()),
        diagnostics: Vec::new(),
    })
}

fn needed(message: String, place: Span) -> Arc<Shared> {
    let error = Diagnostic::error(message).at(place, "read here");
    let error = error.help("say in which coordinate system the map is: `map: { crs: \"EPSG:…\" }`");
    Arc::new(Shared {
        crs: None,
        diagnostics: vec![error],
    })
}

/// The file of a node that lies somewhere on Earth, and its layer.
fn georeferenced(node: &Node) -> Option<(&FilePath, Option<Arc<str>>)> {
    match node {
        Node::Region(Region::Geodata(kind)) => {
            Some((&kind.file, kind.layer.as_ref().map(|layer| layer.0.clone())))
        }
        Node::Field(Field::Raster(kind)) if kind.region.is_none() => Some((&kind.file, None)),
        _ => None,
    }
}

fn of_file(db: &dyn Db, path: &str, layer: Option<&str>) -> Option<Crs> {
    let content = |path: &str| {
        let content = db.file(&Arc::from(path)).content(db).as_ref().ok()?;
        Some(content.content.clone())
    };
    let own = content(path)?;
    let (stem, own_ending) = path.rsplit_once('.')?;
    let mut beside = |ending: &str| {
        let endings = spellings(ending, own_ending);
        let mut found = endings.iter();
        let found = found.find_map(|ending| content(&format!("{stem}.{ending}")));
        found?.whole().ok()
    };
    if is_read_by_parts(path) {
        return system::of_raster(own.source(), &mut beside);
    }
    system::of_file(path, &own.whole().ok()?, layer, &mut beside)
}
