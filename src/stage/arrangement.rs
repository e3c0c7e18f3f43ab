//! Arrangements: functions put together from what they name, and applied to the action's region.

use std::cell::RefCell;
use std::sync::Arc;

use super::host::ScriptHost;
use fretwork_action::{Action, Data, EngineChoice, Lines, ReadLog, StageResult, Value, Window};
use fretwork_arrangement::from_spec::{self, Context, Inputs, Named};
use fretwork_arrangement::{Arrangement, Chosen};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Bounds, Curves, Field, PlanarMap, Region, planar_map};
use fretwork_language::kinds::arrangements::{Arrangement as Kind, Connect, Registration};
use fretwork_language::kinds::fields::FieldUnit;
use fretwork_language::kinds::regions::Faces;
use fretwork_language::scalar::FilePath;
use fretwork_language::value::Target;
use fretwork_language::{Node, Ref, TypeSet, wants};
use fretwork_primitive::field::{angle_unit, field, length_unit};
use fretwork_primitive::placement::thickness_side;
use fretwork_script::Host;

/// An arrangement that has not been applied yet.
#[derive(Clone, Debug)]
pub(super) struct Function {
    pub arrangement: Arrangement,
    /// Whether it is of a map, where the resolution is the same everywhere.
    pub is_map: bool,
    /// What the scripts in it have read, and will have read when it has been applied.
    logs: Vec<ReadLog>,
}

impl Function {
    /// The curves on `region`, with the resolution of that region; by an engine, and at least what lies in a window.
    fn draw(
        &self,
        region: &Region,
        how: (EngineChoice, Option<Window>),
        log: &ReadLog,
    ) -> Result<Arc<Curves>, Vec<Diagnostic>> {
        let resolution = resolution(self.is_map, region);
        let curves = match how {
            (EngineChoice::General, _) => self.arrangement.apply(region, resolution),
            (EngineChoice::Auto, None) => self.arrangement.draw(region, resolution),
            (EngineChoice::Auto, Some(window)) => {
                let window = Bounds {
                    min: window.low().into(),
                    max: window.high().into(),
                };
                self.arrangement.draw_in(region, resolution, &window)
            }
        };
        self.logs.iter().for_each(|own| log.extend(own));
        curves
    }
}

/// The distance below which points are one on `region`.
pub(super) fn resolution(is_map: bool, region: &Region) -> f64 {
    if is_map {
        planar_map::MAP_RESOLUTION
    } else {
        planar_map::resolution(region.bounds().longer_side())
    }
}

/// The function that an action stands for. What its scripts read is noted in `log`, also of one that
/// cannot be put together: it is tried again when one of these files changes.
///
/// # Errors
/// What is wrong with the node and its scripts.
pub fn function(action: &Action, log: &ReadLog) -> Result<Arrangement, Vec<Diagnostic>> {
    let function = put_together(action, log)?;
    function.logs.iter().for_each(|own| log.extend(own));
    Ok(function.arrangement)
}

pub(super) fn put_together(action: &Action, log: &ReadLog) -> Result<Function, Vec<Diagnostic>> {
    action.memo.get(action.files.revision(), || {
        let inputs = ActionInputs::new(action);
        let context = context(action, &inputs);
        let made = match &action.definition.node {
            Node::Partition(kind) => from_spec::partition(kind, &context),
            Node::Arrangement(kind) => from_spec::arrangement(kind, &context),
            other => {
                let what = format!("`{}` as an arrangement", other.kind_name());
                Err(vec![action.unsupported(&what)])
            }
        };
        let logs = inputs.into_logs();
        logs.iter().for_each(|own| log.extend(own));
        let arrangement = made?;
        Ok(Function {
            arrangement,
            is_map: action.definition.map.is_some(),
            logs,
        })
    })
}

/// What the arrangement of an action gives on the action's region.
///
/// # Errors
/// What is wrong with the node, its scripts or its region.
pub fn applied(action: &Action, log: &ReadLog) -> StageResult {
    let Some(region) = action.region() else {
        return Err(vec![action.unsupported("an arrangement without a region")]);
    };
    let warnings = warnings(action, &region);
    let how = (action.engine, action.window);
    let curves = put_together(action, log)?.draw(&region, how, log)?;
    Ok((Data::Curves(curves), warnings))
}

/// What of the arrangement of an action lies in the action's window, drawn without the whole. None where there is no window,
/// or it would take as much as drawing the whole.
///
/// # Errors
/// What is wrong with the node, its scripts or its region.
pub fn near(action: &Action, log: &ReadLog) -> Result<Option<Arc<Curves>>, Vec<Diagnostic>> {
    let (Some(region), Some(window)) = (action.region(), action.window) else {
        return Ok(None);
    };
    let function = put_together(action, log)?;
    let resolution = resolution(function.is_map, &region);
    let window = Bounds {
        min: window.low().into(),
        max: window.high().into(),
    };
    let arrangement = &function.arrangement;
    let curves = match action.engine {
        EngineChoice::Auto => arrangement.draw_near(&region, resolution, &window),
        EngineChoice::General => arrangement.apply_near(&region, resolution, &window),
    };
    function.logs.iter().for_each(|own| log.extend(own));
    curves
}

/// The curves that `lines` are on `region`, with the resolution of that region.
///
/// # Errors
/// What is wrong with the arrangement or its region.
pub fn lines_on(
    lines: &Lines,
    region: &Region,
    log: &ReadLog,
) -> Result<Arc<Curves>, Vec<Diagnostic>> {
    match lines {
        Lines::Applied(curves) => Ok(curves.clone()),
        Lines::Function(action) => {
            let how = (action.engine, None);
            put_together(action, log)?.draw(region, how, log)
        }
        Lines::Outline(region) => Ok(Arc::new(region.contour.clone())),
    }
}

/// What is doubtful about an arrangement that is applied to `region`.
fn warnings(action: &Action, region: &Region) -> Vec<Diagnostic> {
    let inputs = ActionInputs::new(action);
    let context = context(action, &inputs);
    let Node::Arrangement(kind) = &action.definition.node else {
        let made = put_together(action, &ReadLog::default()).ok();
        let name = &*action.definition.id.name;
        let lack = made
            .and_then(|made| from_spec::nothing_drawn(&made.arrangement, name, &context, region));
        return lack.into_iter().collect();
    };
    if action.window.is_some() {
        return Vec::new();
    }
    let resolution = resolution(action.definition.map.is_some(), region);
    let mut warnings = from_spec::unknown_labels(kind, &context, region, resolution);
    warnings.extend(from_spec::without_value(kind, &context, region, resolution));
    warnings.extend(from_spec::torn_faces(kind, &context, region));
    warnings
}

/// Lines that were drawn on a region before, or are an outline.
fn drawn(action: &Action, lines: Lines) -> Result<Arc<Curves>, Vec<Diagnostic>> {
    match lines {
        Lines::Applied(curves) => Ok(curves),
        Lines::Outline(region) => Ok(Arc::new(region.contour.clone())),
        Lines::Function(_) => Err(vec![action.unsupported("an arrangement without a region")]),
    }
}

/// Lines thickened and bridged into a cutout of the drawing plane.
///
/// # Errors
/// When they cannot be joined to as many components as are asked for.
pub fn connect(action: &Action, kind: &Connect) -> StageResult {
    let lines = drawn(action, action.input(&kind.input))?;
    let components = match kind.components {
        Target::Exactly(count) => Some(count as usize),
        Target::Any => None,
    };
    let region = action.input(&kind.region);
    let made =
        fretwork_arrangement::connect(&lines, &region, kind.width.0, kind.frame.0, components);
    match made {
        Ok(mut cutout) => {
            cutout.side = thickness_side(kind.side);
            Ok((Data::Cutout(cutout.into()), Vec::new()))
        }
        Err(error) => {
            let error = Diagnostic::error(error.to_string());
            Err(vec![error.at(action.span(), "in this cutout")])
        }
    }
}

/// The bounded faces of an arrangement, those with some labels or all, as one region.
///
/// # Errors
/// When there are none, or none is left.
pub fn faces(action: &Action, kind: &Faces) -> StageResult {
    let failed = |error: &dyn std::error::Error| {
        vec![Diagnostic::error(error.to_string()).at(action.span(), "in this region")]
    };
    let region = action.input(&kind.region);
    let resolution = planar_map::resolution(region.bounds().longer_side());
    let (lines, of) = match action.input(&kind.of) {
        Lines::Outline(of) => {
            let lines = fretwork_arrangement::outline_in(&of, &region, resolution);
            (Arc::new(lines.map_err(|e| failed(&e))?), Some(of))
        }
        lines => (drawn(action, lines)?, None),
    };
    let map = PlanarMap::build(&lines, resolution).map_err(|e| failed(&e))?;
    let chosen = Chosen {
        labels: kind.r#where.as_ref().map(|labels| &labels.0[..]),
        of: of.as_ref(),
    };
    let made = fretwork_arrangement::faces(&map, &chosen, kind.inset.0, resolution)
        .map_err(|e| failed(&e))?;
    let mut unknown = unknown_faces(action, kind, &map);
    if !made.area.is_empty() {
        if from_spec::is_torn(&lines, &region) {
            unknown.push(from_spec::torn(&kind.of, action.span()));
        }
        return Ok((Data::Region(made.into()), unknown));
    }
    let empty = if map.face_count() == 0 {
        format!("`{}` has no faces here", kind.of.name)
    } else if unknown.is_empty() {
        "no face is as wide as the inset needs".to_owned()
    } else {
        "none of the faces is chosen".to_owned()
    };
    let empty = Diagnostic::error(empty).at(action.span(), "the region is empty");
    Err([vec![empty], unknown].concat())
}

/// What is engraved on slices.
///
/// # Errors
/// When the region has none.
pub fn registration(action: &Action, kind: &Registration) -> StageResult {
    let slices = action.input(&kind.slices);
    match fretwork_arrangement::registration(&slices, kind.size.map(|size| size.0)) {
        Ok(curves) => Ok((Data::Curves(curves.into()), Vec::new())),
        Err(error) => {
            let at = action.definition.field(&["registration", "slices"]);
            Err(vec![Diagnostic::error(error.to_string()).at(at, "")])
        }
    }
}

/// Warnings about the labels under `where` that no face has, each with the nearest that one has.
fn unknown_faces(action: &Action, kind: &Faces, map: &PlanarMap) -> Vec<Diagnostic> {
    let known = fretwork_arrangement::face_labels(map);
    let at = action.definition.field_key(&["faces", "where"]);
    let wanted = kind.r#where.iter().flat_map(|labels| &labels.0);
    let unknown = wanted.filter(|label| !known.contains(&label.0));
    let what = format!("no face of `{}`", kind.of.name);
    let warn = |label| from_spec::unknown_label(&what, label, &known).at(at.clone(), "");
    unknown.map(|label| warn(&label.0)).collect()
}

/// What is wrong with the scripts of an arrangement, found without evaluating anything.
pub fn check(action: &Action, kind: &Kind) -> Vec<Diagnostic> {
    let inputs = ActionInputs::new(action);
    from_spec::check(kind, &context(action, &inputs))
        .err()
        .unwrap_or_default()
}

fn context<'a>(action: &Action, inputs: &'a ActionInputs<'a>) -> Context<'a> {
    Context {
        inputs,
        seed: action.definition.seed,
        span: action.span(),
        step: action.definition.map.as_ref().map(|map| map.resolution.0),
        unit: action.definition.own_unit(),
    }
}

/// The inputs of an action, as arrangements take them.
struct ActionInputs<'a> {
    action: &'a Action,
    /// What the scripts of inputs read, which are run with this one.
    logs: RefCell<Vec<ReadLog>>,
    /// What this node's own script reads.
    log: ReadLog,
}

impl<'a> ActionInputs<'a> {
    fn new(action: &'a Action) -> ActionInputs<'a> {
        ActionInputs {
            action,
            logs: RefCell::default(),
            log: ReadLog::default(),
        }
    }

    fn into_logs(self) -> Vec<ReadLog> {
        let mut logs = self.logs.into_inner();
        logs.push(self.log);
        logs
    }

    /// The lines as an arrangement. A function whose own node has errors is never asked for.
    fn arrangement_of(&self, lines: Lines) -> Arrangement {
        match lines {
            Lines::Applied(curves) => Arrangement::given(curves),
            Lines::Outline(region) => Arrangement::outline(region),
            Lines::Function(action) => match put_together(&action, &self.log) {
                Ok(function) => {
                    self.logs.borrow_mut().extend(function.logs);
                    function.arrangement
                }
                Err(errors) => Arrangement::new(move |_, _| Err(errors.clone())),
            },
        }
    }

    fn used_as(&self, name: &str, problem: &str) -> Diagnostic {
        Diagnostic::error(format!("`{name}` is used as {problem}"))
            .at(self.action.span(), "used here")
    }
}

impl Inputs for ActionInputs<'_> {
    /// What is applied to the action's own region has been applied to it already, as an action of its
    /// own.
    fn arrangement(&self, name: &Ref<wants::Arrangement>) -> Arrangement {
        self.arrangement_of(self.action.input(name))
    }

    fn argument(&self, text: &Arc<str>, wants: TypeSet) -> Option<Named> {
        match self.action.named(text, wants)? {
            Value::Data(Data::Drawing(drawing)) => Some(Named::Element(Arc::new(drawing.curves()))),
            Value::Deferred(action) if matches!(action.definition.node, Node::Field(_)) => {
                field(action).ok().map(Named::Field)
            }
            value => Some(Named::Arrangement(self.arrangement_of(Lines::of(value)?))),
        }
    }

    fn script(&self, file: &FilePath) -> Result<(Arc<str>, Arc<str>), Vec<Diagnostic>> {
        let (path, bytes) = self.action.file(&file.0)?;
        match std::str::from_utf8(&bytes) {
            Ok(text) => Ok((path, text.into())),
            Err(error) => {
                let at = error.valid_up_to();
                let span = Span::Bytes {
                    file: path.clone(),
                    start: at,
                    end: at,
                };
                let error = Diagnostic::error(format!("`{path}` is not UTF-8 text"));
                Err(vec![error.at(span, "here")])
            }
        }
    }

    fn host(&self) -> Arc<dyn Host> {
        let definition = &self.action.definition;
        Arc::new(ScriptHost {
            files: self.action.files.clone(),
            unit_mm: definition.own_units.millimetres(),
            fine: fretwork_primitive::fine_in_plane(definition, definition.own_units),
            is_map: definition.map.is_some(),
            log: self.log.clone(),
        })
    }

    fn element(&self, name: &Ref<wants::VectorExemplar>) -> Arc<Curves> {
        Arc::new(self.action.input(name).curves())
    }

    fn region(&self, name: &Ref<wants::Region>) -> Arc<Region> {
        self.action.input(name)
    }

    fn field(&self, name: &Ref<wants::Field>) -> Field {
        // A field whose own node has errors is never asked for.
        field(&self.action.input(name)).unwrap_or_else(|_| Field::constant(f64::NAN))
    }

    fn angles(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic> {
        let factor = match angle_unit(&self.action.input(name)) {
            Some(FieldUnit::Radian) => 1.0,
            Some(FieldUnit::Degree) => 1f64.to_radians(),
            Some(FieldUnit::Turn) => std::f64::consts::TAU,
            Some(
                FieldUnit::Millimetre | FieldUnit::Centimetre | FieldUnit::Metre | FieldUnit::Inch,
            )
            | None => {
                let problem = "an angle, but does not say in which unit its angles are";
                let help = "add `unit: rad`, `unit: deg` or `unit: turn` to the field";
                return Err(self.used_as(&name.name, problem).help(help));
            }
        };
        Ok(self.field(name).map("angles", move |value| value * factor))
    }

    fn lengths(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic> {
        let Some(millimetres) = length_unit(&self.action.input(name)) else {
            return Err(self.used_as(&name.name, "a length, but its values are angles"));
        };
        let unit = self.action.definition.units.millimetres();
        if millimetres == unit {
            return Ok(self.field(name));
        }
        let factor = millimetres / unit;
        Ok(self.field(name).map("lengths", move |value| value * factor))
    }

    fn densities(&self, name: &Ref<wants::Field>) -> Field {
        let unit = self.action.input(name).definition.own_unit();
        if unit == 1.0 {
            return self.field(name);
        }
        let per_area = move |value: f64| value / (unit * unit);
        self.field(name).map("densities", per_area)
    }
}
