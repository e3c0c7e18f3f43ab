//! Arrangements: functions put together from what they name, and applied to the job's region.

use std::cell::RefCell;
use std::sync::Arc;

use super::host::{ReadLog, ScriptHost};
use super::{Reads, Stage, StageResult};
use crate::value::{Data, Function, Value};
use fretwork_arrangement::Arrangement;
use fretwork_arrangement::from_spec::{self, Context, Inputs, Named};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, Field, Region, planar_map};
use fretwork_language::kinds::arrangements::{Arrangement as Kind, Connect};
use fretwork_language::kinds::fields::{Field as FieldKind, FieldUnit, Operator};
use fretwork_language::scalar::FilePath;
use fretwork_language::value::Target;
use fretwork_language::{Node, Ref, TypeSet, wants};
use fretwork_script::Host;

/// The function itself, or with a region what it gives there.
pub fn arrangement(stage: &Stage<'_>, reads: &mut Reads) -> StageResult {
    let inputs = StageInputs {
        stage,
        logs: RefCell::default(),
        log: ReadLog::default(),
    };
    let context = Context {
        inputs: &inputs,
        seed: stage.definition.seed,
        span: stage.definition.span(),
    };
    let warnings = warnings(stage, &context);
    let made = match &stage.definition.node {
        Node::Partition(kind) => from_spec::partition(kind, &context),
        Node::Arrangement(kind) => from_spec::arrangement(kind, &context),
        other => unreachable!("{} is no arrangement", other.kind_name()),
    };
    let mut logs = inputs.logs.into_inner();
    logs.push(inputs.log);
    // Also of what failed: it is tried again when one of these files changes.
    logs.iter().for_each(|log| reads.note(log));
    let arrangement = made?;
    let Some(region) = &stage.job.region else {
        return Ok((
            Value::Arrangement(Function { arrangement, logs }),
            Vec::new(),
        ));
    };
    let region = stage.value_of(region);
    let region = region
        .region()
        .expect("the graph checks that it is a region");
    let applied = arrangement.apply(
        region,
        planar_map::resolution(region.bounds().longer_side()),
    );
    logs.iter().for_each(|log| reads.note(log));
    let curves = applied?;
    Ok((Value::Data(Data::Curves(curves)), warnings))
}

/// What is doubtful about an arrangement that is applied to the job's region.
fn warnings(stage: &Stage<'_>, context: &Context<'_>) -> Vec<Diagnostic> {
    let (Node::Arrangement(kind), Some(region)) = (&stage.definition.node, &stage.job.region)
    else {
        return Vec::new();
    };
    let region = stage.value_of(region);
    let region = region
        .region()
        .expect("the graph checks that it is a region");
    from_spec::unknown_labels(
        kind,
        context,
        region,
        planar_map::resolution(region.bounds().longer_side()),
    )
}

/// Lines thickened and bridged into a cutout of the drawing plane.
pub fn connect(stage: &Stage<'_>, kind: &Connect) -> StageResult {
    let (input, region) = (
        stage.definition.target(&kind.input),
        stage.definition.target(&kind.region),
    );
    let lines = match stage.value_on(
        input,
        Some(region).filter(|_| stage.job.is_arrangement(stage.db, input)),
    ) {
        Value::Data(Data::Curves(curves)) => curves,
        Value::Data(Data::Region(region)) => Arc::new(region.contour.clone()),
        other => unreachable!("the graph checks types, and {other:?} has no lines"),
    };
    let components = match kind.components {
        Target::Exactly(count) => Some(count as usize),
        Target::Any => None,
    };
    let connected = fretwork_arrangement::connect(
        &lines,
        &stage.region(&kind.region),
        kind.width.0,
        components,
    );
    match connected {
        Ok(cutout) => Ok((Value::Data(Data::Cutout(cutout.into())), Vec::new())),
        Err(error) => Err(vec![
            Diagnostic::error(error.to_string()).at(stage.definition.span(), "in this cutout"),
        ]),
    }
}

/// What is wrong with the scripts of an arrangement, found without evaluating anything.
pub fn check(stage: &Stage<'_>, kind: &Kind) -> Vec<Diagnostic> {
    let inputs = StageInputs {
        stage,
        logs: RefCell::default(),
        log: ReadLog::default(),
    };
    let context = Context {
        inputs: &inputs,
        seed: stage.definition.seed,
        span: stage.definition.span(),
    };
    from_spec::check(kind, &context).err().unwrap_or_default()
}

/// The values of a job's inputs.
struct StageInputs<'a> {
    stage: &'a Stage<'a>,
    /// What the scripts of inputs read, which are run with this one.
    logs: RefCell<Vec<ReadLog>>,
    /// What this node's own script reads.
    log: ReadLog,
}

impl Inputs for StageInputs<'_> {
    /// What is applied to the job's own region has been applied to it already, as a job of its own.
    fn arrangement(&self, name: &Ref<wants::Arrangement>) -> Arrangement {
        let need = self.stage.job.applied(
            self.stage.db,
            self.stage.definition,
            self.stage.definition.target(name),
        );
        match self.function(self.stage.value_on(&need.node, need.region.as_ref())) {
            Some(arrangement) => arrangement,
            None => unreachable!("the graph checks that `{}` is an arrangement", name.name),
        }
    }

    fn argument(&self, text: &Arc<str>, wants: TypeSet) -> Option<Named> {
        match self
            .stage
            .value_of(self.stage.definition.named(text, wants)?)
        {
            Value::Data(Data::Drawing(drawing)) => Some(Named::Element(Arc::new(drawing.curves()))),
            Value::Field(field) => Some(Named::Field(field)),
            value => self.function(value).map(Named::Arrangement),
        }
    }

    fn script(&self, file: &FilePath) -> Result<(Arc<str>, Arc<str>), Vec<Diagnostic>> {
        let (path, bytes) = self.stage.file(&file.0)?;
        match std::str::from_utf8(&bytes) {
            Ok(text) => Ok((path, text.into())),
            Err(error) => {
                let at = error.valid_up_to();
                let span = Span::Bytes {
                    file: path.clone(),
                    start: at,
                    end: at,
                };
                Err(vec![
                    Diagnostic::error(format!("`{path}` is not UTF-8 text")).at(span, "here"),
                ])
            }
        }
    }

    fn host(&self) -> Arc<dyn Host> {
        let unit_mm = self.stage.definition.units.millimetres();
        Arc::new(ScriptHost {
            world: self.stage.db.world(),
            unit_mm,
            log: self.log.clone(),
        })
    }

    fn element(&self, name: &Ref<wants::VectorExemplar>) -> Arc<Curves> {
        Arc::new(self.stage.drawing(name).curves())
    }

    fn region(&self, name: &Ref<wants::Region>) -> Arc<Region> {
        self.stage.region(name)
    }

    fn field(&self, name: &Ref<wants::Field>) -> Field {
        match self.stage.input(name) {
            Value::Field(field) => field,
            other => unreachable!("the graph checks types, and {other:?} is no field"),
        }
    }

    fn angles(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic> {
        let factor = match self.unit(name) {
            Some(FieldUnit::Radian) => 1.0,
            Some(FieldUnit::Degree) => 1f64.to_radians(),
            Some(FieldUnit::Turn) => std::f64::consts::TAU,
            Some(
                FieldUnit::Millimetre | FieldUnit::Centimetre | FieldUnit::Metre | FieldUnit::Inch,
            )
            | None => {
                let message = format!(
                    "`{}` is used as an angle, but does not say in which unit its angles are",
                    name.name
                );
                let diagnostic =
                    Diagnostic::error(message).at(self.stage.definition.span(), "used here");
                return Err(
                    diagnostic.help("add `unit: rad`, `unit: deg` or `unit: turn` to the field")
                );
            }
        };
        Ok(self.field(name).map("angles", move |value| value * factor))
    }

    fn lengths(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic> {
        let millimetres = match self.unit(name) {
            None => return Ok(self.field(name)),
            Some(FieldUnit::Millimetre) => 1.0,
            Some(FieldUnit::Centimetre) => 10.0,
            Some(FieldUnit::Metre) => 1000.0,
            Some(FieldUnit::Inch) => 25.4,
            Some(FieldUnit::Degree | FieldUnit::Radian | FieldUnit::Turn) => {
                let message = format!(
                    "`{}` is used as a length, but its values are angles",
                    name.name
                );
                return Err(
                    Diagnostic::error(message).at(self.stage.definition.span(), "used here")
                );
            }
        };
        let factor = millimetres / self.stage.definition.units.millimetres();
        Ok(self.field(name).map("lengths", move |value| value * factor))
    }
}

impl StageInputs<'_> {
    /// The value as an arrangement, if it is one or stands for one.
    fn function(&self, value: Value) -> Option<Arrangement> {
        match value {
            Value::Arrangement(function) => {
                self.logs.borrow_mut().extend(function.logs);
                Some(function.arrangement)
            }
            Value::Data(Data::Curves(curves)) => Some(Arrangement::given(curves)),
            Value::Data(Data::Region(region)) => {
                Some(Arrangement::given(Arc::new(region.contour.clone())))
            }
            _ => None,
        }
    }

    /// What the numbers of a field are measured in, if it says so.
    fn unit(&self, name: &Ref<wants::Field>) -> Option<FieldUnit> {
        let field = self
            .stage
            .job
            .of(self.stage.definition.target(name), None)
            .definition(self.stage.db)?;
        match &field.node {
            Node::Field(FieldKind::Expression(formula)) => formula.unit,
            Node::Field(FieldKind::Derive(derive)) if derive.operator != Operator::Roughness => {
                Some(FieldUnit::Degree)
            }
            _ => None,
        }
    }
}
