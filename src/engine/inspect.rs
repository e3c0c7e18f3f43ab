//! The measures of one value.

use serde_json::{Map as Fields, Value as Json, json};

use super::compile::{Compiler, Progress, Request, spent};
use super::database::Db as _;
use super::definition::linked;
use super::evaluate::{evaluate, value};
use super::job::{Job, shown};
use super::settings::Settings;
use super::target::targets;
use fretwork_action::{Definition, Input as _, Value};
use fretwork_artifact::{measure, report, values_at};
use fretwork_diagnostic::{Code, Diagnostic, nearest};
use fretwork_geometry::Bounds;
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
    /// Places at which a field is asked for its value.
    pub at: &'a [[f64; 2]],
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
    let of_place = |([x, y], found): (&[f64; 2], AtPlace)| {
        let face = found.face.as_ref();
        json!({
            "x": x,
            "y": y,
            "labels": face.map(|face| face.0.names()),
            "area": face.map(|face| face.1),
            "centroid": face.map(|face| face.2),
            "distance": found.distance,
        })
    };
    Ok(places.iter().zip(found).map(of_place).collect())
}

impl Compiler {
    /// The measures of a node's value as a JSON object, in the spec's units, or why there are none.
    pub fn inspect(&self, request: &InspectRequest<'_>) -> (Option<Json>, Vec<Diagnostic>) {
        let root = self.root(request.spec);
        let mut diagnostics = self.check(request.spec, &request.settings);
        if diagnostics.iter().any(Diagnostic::is_error) {
            return (None, diagnostics);
        }
        let (node, region) = match self.inspected(request) {
            Ok(found) => found,
            Err(diagnostic) => {
                diagnostics.push(*diagnostic);
                return (None, diagnostics);
            }
        };
        let mut job = Job {
            root,
            settings: request.settings.clone(),
            node,
            region: None,
            window: None,
        };
        let page = region.as_ref().map(|r| job.of(r, None));
        let is_arrangement = job.is_arrangement(&self.database, &job.node);
        let is_asked = is_arrangement && !request.at.is_empty();
        let function = job.clone();
        job.region = region.filter(|_| is_arrangement);
        // A place costs only the place where it can be told without drawing all.
        if is_asked && job.is_tiled(&self.database) {
            job = function.clone();
        }
        let (jobs, plan) = self.plan(page.iter().cloned().chain([job.clone()]));
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
            diagnostics.extend(evaluate(&self.database, job).diagnostics.iter().cloned());
        }
        if diagnostics.iter().any(Diagnostic::is_error) {
            return (None, diagnostics);
        }
        let Some(definition) = job.definition(&self.database) else {
            return (None, diagnostics);
        };
        let page = page.and_then(|page| value(&self.database, &page));
        let bounds = page
            .as_ref()
            .and_then(wants::Region::of)
            .map(|r| r.bounds());
        let measures = value(&self.database, &job);
        let mut measures = measures.map(|value| match is_asked {
            true if job.region.is_none() => Ok(Json::Object(Fields::new())),
            true => measured(&value, bounds, &[], &definition),
            false => measured(&value, bounds, request.at, &definition),
        });
        if is_asked && let Some(Ok(measures)) = &mut measures {
            let function = value(&self.database, &function);
            match at_places(function.as_ref(), page.as_ref(), request.at) {
                Ok(places) => measures["at"] = places,
                Err(more) => {
                    diagnostics.extend(more);
                    return (None, diagnostics);
                }
            }
        }
        match measures {
            Some(Ok(measures)) => (Some(report(measures, definition.units)), diagnostics),
            Some(Err(more)) => {
                diagnostics.extend(more);
                (None, diagnostics)
            }
            None => (None, diagnostics),
        }
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
