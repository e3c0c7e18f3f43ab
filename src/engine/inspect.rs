//! The measures of one value.

use std::sync::Arc;

use serde_json::{Map as Fields, Value as Json, json};

use super::compile::{Compiler, Progress, Request, spent};
use super::database::Db as _;
use super::definition::linked;
use super::evaluate::value;
use super::job::{Job, shown};
use super::modules::told;
use super::settings::Settings;
use super::target::targets;
use fretwork_action::{Data, Definition, Input as _, Value, Window};
use fretwork_artifact::{measure, report, table_value, values_at, within};
use fretwork_diagnostic::{Code, Diagnostic, nearest};
use fretwork_geometry::{Bounds, Feature, Point, Region};
use fretwork_graph::NodeId;
use fretwork_language::{Node, Section, ValueType, wants};
use fretwork_stage::tiling::AtPlace;

/// What to measure.
pub struct InspectRequest<'a> {
    /// The spec, as a path from the project root.
    pub spec: &'a str,
    /// The node, as `name` or `section.name`.
    pub node: &'a str,
    /// The region that an arrangement is applied to; that of the node's artifact when not given.
    pub region: Option<&'a str>,
    /// Places at which a field is asked for its value, and what lies in the plane for what is there.
    pub at: &'a [[f64; 2]],
    /// The part of the plane that is measured, if it is not the whole.
    pub window: Option<Window>,
    /// Values for parameters.
    pub settings: Settings,
    /// How many threads may work.
    pub threads: usize,
    /// Who hears of it.
    pub progress: &'a dyn Progress,
}

/// The measures of a value; of a field also its values at places, without which it is measured on a region only.
fn measured(
    value: &Value,
    bounds: Option<Bounds>,
    at: &[[f64; 2]],
    definition: &Definition,
) -> Result<Json, Vec<Diagnostic>> {
    let span = definition.span();
    let mut measures = match value {
        Value::Deferred(_) if bounds.is_none() && !at.is_empty() => Json::Object(Fields::new()),
        value => measure(value, bounds, definition.map.is_some(), &span)?,
    };
    if !at.is_empty() {
        measures["at"] = values_at(value, at, &span)?;
    }
    Ok(measures)
}

/// What an arrangement has at places of a region, as a list of objects.
fn at_places(
    function: Option<&Value>,
    page: Option<&Value>,
    places: &[[f64; 2]],
) -> Result<Json, Vec<Diagnostic>> {
    let region = page.and_then(wants::Region::of);
    let (Some(Value::Deferred(action)), Some(region)) = (function, region) else {
        return Ok(Json::Null);
    };
    let found = fretwork_stage::tiling::at(action, &region, places)?;
    Ok(places.iter().zip(&found).map(at_place).collect())
}

/// What is at a place: the face there, and how far the nearest line is.
fn at_place(([x, y], found): (&[f64; 2], &AtPlace)) -> Json {
    let face = found.face.as_ref();
    json!({
        "x": x,
        "y": y,
        "labels": face.map(|face| face.0.names()),
        "area": face.map(|face| face.1),
        "centroid": face.map(|face| face.2),
        "distance": found.distance,
    })
}

/// A place that is typed is a point of a map where it is no farther from it, in metres.
const NEAR: f64 = 1e-3;

/// What a region has at places, as a list of objects: also what the table says of the first feature there, if it has one.
fn at_region(region: &Region, is_map: bool, places: &[[f64; 2]]) -> Result<Json, Vec<Diagnostic>> {
    let found = fretwork_stage::tiling::at_region(region, is_map, places)?;
    let of_place = |(place, found): (&[f64; 2], &AtPlace)| {
        let mut told = at_place((place, found));
        if !region.features.is_empty() {
            let covers = |feature: &&Feature| {
                let at = Point::from(*place);
                let is_near = |p: &Point| (*p - at).length() <= NEAR;
                feature.points.iter().any(is_near)
                    || feature.area.iter().any(|polygon| polygon.contains(at))
            };
            let feature = region.features.iter().find(covers);
            let value = |column: &Arc<str>, feature: &Feature| {
                (column.to_string(), table_value(feature.attribute(column)))
            };
            let columns = region.columns.iter();
            told["attributes"] = feature.map_or(Json::Null, |feature| {
                Json::Object(columns.map(|column| value(column, feature)).collect())
            });
        }
        told
    };
    Ok(places.iter().zip(&found).map(of_place).collect())
}

/// What of a value is measured, and the box that it is measured on.
///
/// # Errors
/// When there is a window, and the value does not lie in the plane.
fn in_window(
    whole: Value,
    window: Option<Window>,
    bounds: Option<Bounds>,
) -> Result<(Value, Option<Bounds>), Diagnostic> {
    let Some(window) = window else {
        return Ok((whole, bounds));
    };
    let window = Bounds {
        min: window.low().into(),
        max: window.high().into(),
    };
    if let Value::Deferred(_) = whole {
        return Ok((whole, Some(window)));
    }
    match within(&whole, window, bounds) {
        Some(part) => Ok((part, bounds)),
        None => Err(Diagnostic::error("only what lies in the plane has windows")),
    }
}

/// The jobs whose values tell what is asked.
struct Asked {
    /// What is measured.
    job: Job,
    /// The region that it is measured on.
    page: Option<Job>,
    /// The arrangement as a function, if it is asked what it has at places.
    function: Option<Job>,
}

impl Compiler {
    /// The measures of a node's value as a JSON object, in the spec's units, or why there are none.
    pub fn inspect(&self, request: &InspectRequest<'_>) -> (Option<Json>, Vec<Diagnostic>) {
        let mut diagnostics = self.check(request.spec, &request.settings);
        if diagnostics.iter().any(Diagnostic::is_error) {
            return (None, diagnostics);
        }
        let asked = match self.asked(request) {
            Ok(asked) => asked,
            Err(diagnostic) => {
                diagnostics.push(*diagnostic);
                return (None, diagnostics);
            }
        };
        let (jobs, plan) = self.plan(asked.page.iter().cloned().chain([asked.job.clone()]));
        let build = Request {
            specs: Vec::new(),
            settings: request.settings.clone(),
            only: Vec::new(),
            windows: Vec::new(),
            threads: request.threads,
            progress: request.progress,
        };
        self.database.budget().begin(1);
        self.run(&jobs, &plan, &build);
        diagnostics.extend(spent(self.database.budget(), &[request.spec.to_string()]));
        for job in &jobs {
            diagnostics.extend(told(&self.database, job));
        }
        if diagnostics.iter().any(Diagnostic::is_error) {
            return (None, diagnostics);
        }
        match self.told(&asked, request) {
            Ok(measures) => (measures, diagnostics),
            Err(more) => {
                diagnostics.extend(more);
                (None, diagnostics)
            }
        }
    }

    /// What has to be evaluated.
    fn asked(&self, request: &InspectRequest<'_>) -> Result<Asked, Box<Diagnostic>> {
        let (node, region) = self.inspected(request)?;
        let mut job = Job {
            root: self.root(request.spec),
            settings: request.settings.clone(),
            node,
            region: None,
            window: None,
        };
        let page = region.as_ref().map(|r| job.of(r, None));
        let is_arrangement = job.is_arrangement(&self.database, &job.node);
        let function = (is_arrangement && !request.at.is_empty()).then(|| job.clone());
        job.region = region.filter(|_| is_arrangement);
        if job.is_near(&self.database) {
            job.window = request.window;
        }
        if job.is_tiled(&self.database) {
            job.window = request.window;
            // A place costs only the place where it can be told without drawing all.
            job = function.clone().unwrap_or(job);
        }
        Ok(Asked {
            job,
            page,
            function,
        })
    }

    /// The measures of what was evaluated; none where it has no value.
    fn told(
        &self,
        asked: &Asked,
        request: &InspectRequest<'_>,
    ) -> Result<Option<Json>, Vec<Diagnostic>> {
        let value = |job: &Job| value(&self.database, job);
        let (Some(definition), Some(whole)) =
            (asked.job.definition(&self.database), value(&asked.job))
        else {
            return Ok(None);
        };
        let page = asked.page.as_ref().and_then(value);
        let bounds = page.as_ref().and_then(wants::Region::of);
        let bounds = bounds.map(|region| region.bounds());
        let (part, bounds) = in_window(whole, request.window, bounds)
            .map_err(|error| vec![error.at(definition.span(), "measured here")])?;
        let is_region = !request.at.is_empty() && matches!(part, Value::Data(Data::Region(_)));
        let mut measures = match &asked.function {
            Some(_) if asked.job.region.is_none() => Json::Object(Fields::new()),
            Some(_) => measured(&part, bounds, &[], &definition)?,
            None if is_region => measured(&part, bounds, &[], &definition)?,
            None => measured(&part, bounds, request.at, &definition)?,
        };
        if is_region && let Some(region) = wants::Region::of(&part) {
            measures["at"] = at_region(&region, definition.map.is_some(), request.at)?;
        }
        if let Some(function) = &asked.function {
            measures["at"] = at_places(value(function).as_ref(), page.as_ref(), request.at)?;
        }
        Ok(Some(report(measures, definition.units)))
    }

    /// The node that is meant and the region to apply it to.
    fn inspected(
        &self,
        request: &InspectRequest<'_>,
    ) -> Result<(NodeId, Option<NodeId>), Box<Diagnostic>> {
        let root = self.root(request.spec);
        let node = self.find(request, request.node, |_| true)?;
        let job = Job {
            root,
            settings: request.settings.clone(),
            node: node.clone(),
            region: None,
            window: None,
        };
        let is_field = job
            .definition(&self.database)
            .is_some_and(|d| d.node.provides() == ValueType::Field);
        if !is_field && !job.is_arrangement(&self.database, &node) {
            return Ok((node, None));
        }
        if let Some(region) = request.region {
            return Ok((
                node,
                Some(self.find(request, region, |id| id.section == Section::Regions)?),
            ));
        }
        match self.region_of(&job) {
            Some(region) => Ok((node, Some(region))),
            None if is_field && !request.at.is_empty() => Ok((node, None)),
            None => Err(Box::new(
                Diagnostic::error(format!(
                    "`{}` is a function{}, and no artifact shows it on a region",
                    node.name,
                    if is_field { "" } else { " of regions" }
                ))
                .help("name one with `--region`"),
            )),
        }
    }

    /// The region of the first artifact that draws the node, or else of the first that needs it.
    fn region_of(&self, job: &Job) -> Option<NodeId> {
        let mut needed = None;
        for target in targets(&self.database, job.root, &job.settings).0 {
            let definition = target.job.definition(&self.database)?;
            let Node::Artifact(artifact) = &definition.node else {
                continue;
            };
            let Some(region) = artifact.region.as_ref().map(|r| definition.target(r)) else {
                continue;
            };
            if shown(artifact)
                .into_iter()
                .any(|from| *definition.target(from) == job.node)
            {
                return Some(region.clone());
            }
            if self
                .plan([target.job.clone()])
                .0
                .iter()
                .any(|j| j.node == job.node)
            {
                needed.get_or_insert(region.clone());
            }
        }
        needed
    }

    fn find(
        &self,
        request: &InspectRequest<'_>,
        name: &str,
        fits: impl Fn(&NodeId) -> bool,
    ) -> Result<NodeId, Box<Diagnostic>> {
        let linked = linked(
            &self.database,
            self.root(request.spec),
            request.settings.clone(),
        );
        let ids: Vec<&NodeId> = linked.targets.keys().filter(|id| fits(id)).collect();
        let found: Vec<&NodeId> = ids
            .iter()
            .copied()
            .filter(|id| *id.name == *name || id.to_string() == name)
            .collect();
        match found[..] {
            [id] => Ok(id.clone()),
            [] => {
                let unknown = Diagnostic::error(format!("the spec has no node `{name}`"))
                    .about(Code::Reference);
                let near = nearest(name, ids.iter().map(|id| &*id.name)).map(str::to_string);
                Err(Box::new(near.into_iter().fold(unknown, |d, n| {
                    d.help(format!("did you mean `{n}`?"))
                })))
            }
            [..] => {
                let options: Vec<String> = found.iter().map(|id| format!("`{id}`")).collect();
                let several = Diagnostic::error(format!("`{name}` is defined in several sections"));
                Err(Box::new(
                    several.help(format!("write {}", options.join(" or "))),
                ))
            }
        }
    }
}
