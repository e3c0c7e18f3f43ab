//! Regions from maps: the features of a file as faces, edges and labels, with the table that belongs to
//! them.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::features::Gathered;
use super::{plane, raster};
use fretwork_action::{Action, ReadLog};
use fretwork_diagnostic::{Diagnostic, nearest};
use fretwork_geometry::polygon::AreaError;
use fretwork_geometry::{Attribute, LabelSet, Region, counted};
use fretwork_language::kinds::regions::Geodata;
use fretwork_language::scalar::Text;
use fretwork_language::value::{OneOrMany, TableValue};
use fretwork_source::geo::{GeoError, Layer, Record, dbf, geojson, geopackage, shapefile};

type Failure = Vec<Diagnostic>;

/// Values of a column that advice names, at most.
const MOST_NAMED: usize = 8;

/// The region of a map's features: polygons are faces with their labels and attributes, lines are edges, points vertices. The area is what
/// the polygons cover, or where there are none what the lines enclose.
///
/// # Errors
/// When the file cannot be read, a column is missing, or a vertex has no place on the map.
pub fn region(
    action: &Action,
    kind: &Geodata,
    log: &ReadLog,
) -> Result<(Region, Vec<Diagnostic>), Failure> {
    let (path, bytes) = action.file(&kind.file.0)?;
    let source = Source { action, kind, path };
    let (layer, mut warnings) = source.layer(&bytes, log)?;
    let (transform, more) = plane::transform(action, layer.crs.as_ref(), &source.path)?;
    warnings.extend(more);
    let columns = source.check_columns(&layer)?;
    let layer = layer
        .placed(transform.as_ref())
        .map_err(|e| source.unreadable(&e))?;
    source.check_taken(&layer)?;
    warnings.extend(source.unlabelled(&layer));
    let mut gathered = Gathered::default();
    let failed = |error: AreaError| source.unreadable(&GeoError::Damaged(error.to_string()));
    for record in layer
        .features
        .iter()
        .filter(|record| source.is_taken(record))
    {
        let name = format!("feature {} of `{}`", record.number, source.path);
        let labels = source.labels(record);
        gathered.add(&name, record, labels).map_err(failed)?;
    }
    let doubts = gathered.warnings.drain(..);
    warnings.extend(doubts.map(|message| source.warning(message)));
    let region = gathered.region(columns).map_err(failed)?;
    Ok((region, warnings))
}

/// A file of features and what is wanted of it.
struct Source<'a> {
    action: &'a Action,
    kind: &'a Geodata,
    path: Arc<str>,
}

impl Source<'_> {
    fn failed(&self, message: String) -> Failure {
        let span = self.action.definition.field(&["geodata", "file"]);
        vec![Diagnostic::error(message).at(span, "in this file")]
    }

    fn unreadable(&self, error: &GeoError) -> Failure {
        let failure = self.failed(format!("cannot read `{}`: {error}", self.path));
        let help = match error {
            GeoError::Layers(_) => "name one with `layer:`".to_string(),
            GeoError::View(view) => format!(
                "export `{view}` as a table, in QGIS by \"Export\", in GDAL by `ogr2ogr -f GPKG table.gpkg {} \"{view}\"`, and read that",
                self.path
            ),
            _ => return failure,
        };
        failure.into_iter().map(|d| d.help(&*help)).collect()
    }

    fn warning(&self, message: String) -> Diagnostic {
        let span = self.action.definition.field(&["geodata", "file"]);
        Diagnostic::warning(message).at(span, "in this file")
    }

    fn layer(&self, bytes: &[u8], log: &ReadLog) -> Result<(Layer, Vec<Diagnostic>), Failure> {
        let ending = self.path.rsplit_once('.').map_or("", |(_, ending)| ending);
        let layer = self.kind.layer.as_ref().map(|layer| &*layer.0);
        let ending = ending.to_ascii_lowercase();
        self.check_single(&ending)?;
        let read = match &*ending {
            "shp" => return self.shapefile(bytes, log),
            "geojson" | "json" => geojson::read(bytes),
            "gpkg" => {
                if plane::beside(self.action, &self.path, "gpkg-wal", log)
                    .is_some_and(|b| !b.is_empty())
                {
                    let message = format!(
                        "`{}-wal` holds changes that are not in `{0}` yet",
                        self.path
                    );
                    return Err(self
                        .failed(message)
                        .into_iter()
                        .map(|d| d.help("close the program that has it open, or save a copy"))
                        .collect());
                }
                geopackage::read(bytes, layer)
            }
            _ => {
                let message = format!("`{}` is no map", self.path);
                let failure = self.failed(message).into_iter();
                return Err(failure
                    .map(|d| d.help("maps are read from `.shp`, `.geojson`, `.json` and `.gpkg`"))
                    .collect());
            }
        };
        let read = read.map_err(|error| self.unreadable(&error))?;
        Ok((read, Vec::new()))
    }

    /// That a file whose format has no layers is not asked for one of another name than its own.
    fn check_single(&self, ending: &str) -> Result<(), Failure> {
        let Some(layer) = self.kind.layer.as_ref().filter(|_| ending != "gpkg") else {
            return Ok(());
        };
        let (stem, _) = self.path.rsplit_once('.').unwrap_or((&self.path, ""));
        let stem = stem.rsplit_once('/').map_or(stem, |(_, name)| name);
        if *layer.0 == *stem {
            return Ok(());
        }
        let span = self.action.definition.field(&["geodata", "layer"]);
        let message = format!("`{}` has no layer `{}`", self.path, layer.0);
        let error = Diagnostic::error(message).at(span, "asked for here");
        Err(vec![error.help("it is one layer: leave `layer` out")])
    }

    /// A Shapefile with the files that belong to it. The index is read by nobody, but whoever edits it edits the map.
    fn shapefile(&self, bytes: &[u8], log: &ReadLog) -> Result<(Layer, Vec<Diagnostic>), Failure> {
        let beside = |ending: &str| plane::beside(self.action, &self.path, ending, log);
        beside("shx");
        let mut warnings = Vec::new();
        let page = beside("cpg").map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        let table = match beside("dbf") {
            Some(bytes) => {
                let table = dbf::read(&bytes, page.as_deref());
                Some(
                    table
                        .map_err(|e| self.failed(format!("cannot read `{}`: {e}", self.table())))?,
                )
            }
            None => {
                warnings.push(self.without_table()?);
                None
            }
        };
        let lines = table.as_ref().map(|table| table.lines.len());
        let mut layer = shapefile::read(bytes, table).map_err(|e| self.unreadable(&e))?;
        let count = layer.features.len();
        if let Some(lines) = lines.filter(|lines| *lines > count) {
            let message = format!(
                "`{}` has {}, and its table {}: it may be cut",
                self.path,
                counted(count, "feature", "features"),
                counted(lines, "line", "lines")
            );
            warnings.push(self.warning(message));
        }
        layer.crs = raster::projection(self.action, &self.path, log)?;
        Ok((layer, warnings))
    }

    /// The path of the table of a Shapefile.
    fn table(&self) -> String {
        let stem = self.path.rsplit_once('.').map_or("", |(stem, _)| stem);
        format!("{stem}.dbf")
    }

    /// A warning for a table that is missing, or an error where it is needed.
    fn without_table(&self) -> Result<Diagnostic, Failure> {
        let table = self.table();
        let needed = match (&self.kind.labels, &self.kind.r#where) {
            (Some(_), _) => "labels",
            (_, Some(_)) => "where",
            (None, None) => {
                let message =
                    format!("there is no `{table}`, and so the features have no attributes");
                return Ok(self.warning(message));
            }
        };
        let span = self.action.definition.field_key(&["geodata", needed]);
        let error = Diagnostic::error(format!("there is no `{table}`"));
        Err(vec![error.at(span, "needs the table of the features")])
    }

    /// The layer's columns, among which are all that are asked for.
    fn check_columns(&self, layer: &Layer) -> Result<Vec<Arc<str>>, Failure> {
        let columns = layer.columns.clone().unwrap_or_default();
        let labels = self.kind.labels.iter().flat_map(|names| names.iter());
        let labels = labels.map(|name| (&*name.0, "labels"));
        let wheres = self.kind.r#where.iter().flat_map(|wheres| wheres.iter());
        let wheres = wheres.map(|(name, _)| (&**name, "where"));
        for (name, field) in labels.chain(wheres) {
            if columns.iter().any(|column| &**column == name) {
                continue;
            }
            let span = self.action.definition.field(&["geodata", field]);
            let message = format!("`{}` has no column `{name}`", self.path);
            let error = Diagnostic::error(message).at(span, "asked for here");
            let names = columns.iter().map(|column| &**column);
            return Err(vec![match nearest(name, names.clone()) {
                Some(near) => error.help(format!("did you mean `{near}`?")),
                None if columns.is_empty() => error.help("its features have no columns"),
                None => error.help(format!("it has {}", names.collect::<Vec<_>>().join(", "))),
            }]);
        }
        Ok(columns)
    }

    /// That there are features, and that some of them are taken.
    fn check_taken(&self, layer: &Layer) -> Result<(), Failure> {
        if layer.features.is_empty() {
            return Err(self.failed(format!("`{}` has no features", self.path)));
        }
        if layer.features.iter().any(|record| self.is_taken(record)) {
            return Ok(());
        }
        let span = self.action.definition.field(&["geodata", "where"]);
        let message = format!("no feature of `{}` is like this", self.path);
        let error = Diagnostic::error(message).at(span, "asked for here");
        let wheres = self.kind.r#where.iter().flat_map(|wheres| wheres.iter());
        let known: Vec<String> = wheres
            .map(|(name, _)| {
                let values = layer
                    .features
                    .iter()
                    .filter_map(|record| value(record, name));
                let values: BTreeSet<String> = values.map(text).collect();
                let mut some: Vec<String> = values.into_iter().take(MOST_NAMED).collect();
                if layer
                    .features
                    .iter()
                    .any(|record| value(record, name).is_none())
                {
                    some.push("features without a value, which `null` takes".into());
                }
                format!("`{name}` has {}", some.join(", "))
            })
            .collect();
        Err(vec![error.help(known.join("; "))])
    }

    /// Whether a feature has one of the values that are asked for in each of the columns.
    fn is_taken(&self, record: &Record) -> bool {
        let mut wheres = self.kind.r#where.iter().flat_map(|wheres| wheres.iter());
        wheres.all(|(name, values): &(Arc<str>, OneOrMany<TableValue>)| {
            let own = value(record, name);
            values.iter().any(|wanted| match own {
                Some(own) => is_equal(own, wanted),
                None => *wanted == TableValue::Nothing,
            })
        })
    }

    fn labels(&self, record: &Record) -> LabelSet {
        let names = self.kind.labels.iter().flat_map(|names| names.iter());
        let texts = names.filter_map(|name: &Text| value(record, &name.0).map(label_texts));
        LabelSet::of(texts.flatten().filter(|text| !text.is_empty()))
    }

    /// A warning about features that have no label because a column holds an object, or a list of more than plain values.
    fn unlabelled(&self, layer: &Layer) -> Option<Diagnostic> {
        let names = self.kind.labels.iter().flat_map(|names| names.iter());
        let lacks = |record: &&Record, name: &Text| {
            let own = value(record, &name.0);
            let is_nested = matches!(own, Some(Attribute::Nested { json, names }) if names.is_empty() && **json != *"[]");
            is_nested && self.is_taken(record)
        };
        let (name, records) = names
            .map(|name| {
                let all = layer.features.iter().filter(|record| lacks(record, name));
                (name, all.map(|record| record.number).collect::<Vec<_>>())
            })
            .find(|(_, records)| !records.is_empty())?;
        let message = format!(
            "`{}` is no text in {} of the features, the first of them feature {}: they have no label of it",
            name.0,
            records.len(),
            records[0]
        );
        let span = self.action.definition.field(&["geodata", "labels"]);
        let warning = Diagnostic::warning(message).at(span, "an object or a list of lists");
        Some(warning.help("labels are texts, numbers, or lists of them"))
    }
}

fn value<'a>(record: &'a Record, name: &str) -> Option<&'a Attribute> {
    let found = record
        .attributes
        .iter()
        .find(|(column, _)| &**column == name);
    found.map(|(_, value)| value)
}

/// The labels in a value of a table.
fn label_texts(value: &Attribute) -> Vec<String> {
    match value {
        Attribute::Nested { names, .. } => names.iter().map(ToString::to_string).collect(),
        plain => vec![text(plain)],
    }
}

/// A value of a table as text.
fn text(value: &Attribute) -> String {
    match value {
        Attribute::Whole(number) => number.to_string(),
        Attribute::Number(number) => number.to_string(),
        Attribute::Truth(truth) => truth.to_string(),
        Attribute::Text(text) => text.to_string(),
        Attribute::Nested { json, .. } => json.to_string(),
    }
}

fn is_equal(own: &Attribute, wanted: &TableValue) -> bool {
    match (own, wanted) {
        (Attribute::Whole(a), TableValue::Whole(b)) => a == b,
        (Attribute::Truth(a), TableValue::Truth(b)) => a == b,
        (own, TableValue::Text(b)) => text(own) == **b,
        (Attribute::Text(a), TableValue::Whole(b)) => **a == b.to_string(),
        (Attribute::Text(a), TableValue::Number(b)) => **a == b.to_string(),
        (Attribute::Text(a), TableValue::Truth(b)) => **a == b.to_string(),
        (own, wanted) => number(own).is_some_and(|own| Some(own) == wanted_number(wanted)),
    }
}

/// A value of a table as a number; yes is 1 and no is 0.
fn number(value: &Attribute) -> Option<f64> {
    match value {
        Attribute::Whole(number) => Some(*number as f64),
        Attribute::Number(number) => Some(*number),
        Attribute::Truth(truth) => Some(f64::from(u8::from(*truth))),
        Attribute::Text(_) | Attribute::Nested { .. } => None,
    }
}

fn wanted_number(value: &TableValue) -> Option<f64> {
    match value {
        TableValue::Whole(number) => Some(*number as f64),
        TableValue::Number(number) => Some(*number),
        TableValue::Truth(truth) => Some(f64::from(u8::from(*truth))),
        TableValue::Text(_) | TableValue::Nothing => None,
    }
}
