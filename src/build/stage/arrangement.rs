//! Arrangements: functions put together from what they name, and applied to the job's region.

use std::sync::Arc;

use super::{Reads, Stage, StageResult};
use crate::arrangement::Arrangement;
use crate::arrangement::declare::{self, Context, Inputs};
use crate::build::value::{Data, Value};
use crate::diagnostic::Diagnostic;
use crate::geometry::{Curves, Field, Region, planar_map};
use crate::spec::kinds::fields::{Field as FieldKind, FieldUnit, Operator};
use crate::spec::{Node, Ref, wants};

/// The function itself, or with a region what it gives there.
pub fn arrangement(stage: &Stage<'_>, _reads: &mut Reads) -> StageResult {
    let inputs = StageInputs { stage };
    let context = Context { inputs: &inputs, seed: stage.definition.seed, span: stage.definition.span() };
    let arrangement = match &stage.definition.node {
        Node::Partition(kind) => declare::partition(kind, &context)?,
        Node::Arrangement(kind) => declare::arrangement(kind, &context)?,
        other => unreachable!("{} is no arrangement", other.kind_name()),
    };
    let Some(region) = &stage.job.region else { return Ok((Value::Arrangement(arrangement), Vec::new())) };
    let region = stage.value_of(region);
    let region = region.region().expect("the graph checks that it is a region");
    let curves = arrangement.apply(region, planar_map::resolution(region.bounds().longer_side()))?;
    Ok((Value::Data(Data::Curves(curves)), Vec::new()))
}

/// The values of a job's inputs.
struct StageInputs<'a> {
    stage: &'a Stage<'a>,
}

impl Inputs for StageInputs<'_> {
    /// What is applied to the job's own region has been applied to it already, as a job of its own.
    fn arrangement(&self, name: &Ref<wants::Arrangement>) -> Arrangement {
        let need = self.stage.job.applied(self.stage.db, self.stage.definition, self.stage.definition.target(name));
        match self.stage.value_on(&need.node, need.region.as_ref()) {
            Value::Arrangement(arrangement) => arrangement,
            Value::Data(Data::Curves(curves)) => Arrangement::given(curves),
            Value::Data(Data::Region(region)) => Arrangement::given(Arc::new(region.contour.clone())),
            other => unreachable!("the graph checks types, and {other:?} is no arrangement"),
        }
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
            Some(FieldUnit::Millimetre | FieldUnit::Centimetre | FieldUnit::Metre | FieldUnit::Inch) | None => {
                let message =
                    format!("`{}` is used as an angle, but does not say in which unit its angles are", name.name);
                let diagnostic = Diagnostic::error(message).at(self.stage.definition.span(), "used here");
                return Err(diagnostic.help("add `unit: rad`, `unit: deg` or `unit: turn` to the field"));
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
                let message = format!("`{}` is used as a length, but its values are angles", name.name);
                return Err(Diagnostic::error(message).at(self.stage.definition.span(), "used here"));
            }
        };
        let factor = millimetres / self.stage.definition.units.millimetres();
        Ok(self.field(name).map("lengths", move |value| value * factor))
    }
}

impl StageInputs<'_> {
    /// What the numbers of a field are measured in, if it says so.
    fn unit(&self, name: &Ref<wants::Field>) -> Option<FieldUnit> {
        let field = self.stage.job.of(self.stage.definition.target(name), None).definition(self.stage.db)?;
        match &field.node {
            Node::Field(FieldKind::Expression(formula)) => formula.unit,
            Node::Field(FieldKind::Derive(derive)) if derive.operator != Operator::Roughness => Some(FieldUnit::Degree),
            _ => None,
        }
    }
}
