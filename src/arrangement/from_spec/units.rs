//! Scripts of a file with units of its own: what they are handed is brought into these units, and what they make out of
//! them, so that a number in a script is what it is where the file stands alone.

use std::sync::Arc;

use crate::from_spec::context::{Context, Declared, Inputs};
use crate::from_spec::named::Named;
use crate::function::Arrangement;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Affine, Curves, Field, Point, Region};
use fretwork_language::scalar::FilePath;
use fretwork_language::{Ref, TypeSet, wants};
use fretwork_script::Host;

/// What `declare` makes in the units of the node's file, in those of the spec. A file in the spec's units is left as it is,
/// and what is repeated in its arrangements stays known.
///
/// # Errors
/// Those of `declare`.
pub(crate) fn in_own_units(
    context: &Context<'_>,
    declare: impl FnOnce(&Context<'_>) -> Declared,
) -> Declared {
    let unit = context.unit;
    if unit == 1.0 {
        return declare(context);
    }
    let inputs = OwnUnits {
        inputs: context.inputs,
        unit,
    };
    let own = Context {
        inputs: &inputs,
        seed: context.seed,
        span: context.span.clone(),
        step: context.step.map(|step| step / unit),
        unit,
    };
    Ok(magnified(declare(&own)?, unit))
}

/// `inner` as it looks where each of its units is `by` long: its curves on a region are those of the smaller region,
/// magnified.
fn magnified(inner: Arrangement, by: f64) -> Arrangement {
    let (lack, of_lack) = (inner.may_lack(), inner.clone());
    let made = Arrangement::new(move |region, resolution| {
        let drawn = inner.apply(&scaled(region, 1.0 / by), step(resolution / by))?;
        Ok(Arc::new(drawn.transformed(&Affine::scale(by, by))))
    });
    if !lack {
        return made;
    }
    made.lacking(move |region| Some(of_lack.lack(&scaled(region, 1.0 / by))? * by))
}

/// The resolution of a planar map, a power of two, that is nearest to a length. Going there and back gives the same.
fn step(length: f64) -> f64 {
    libm::exp2(libm::round(libm::log2(length)))
}

/// A region and its period.
fn scaled(region: &Region, by: f64) -> Region {
    let mut scaled = region.transformed(&Affine::scale(by, by));
    scaled.period = region.period.map(|period: Point| period * by);
    scaled
}

/// Inputs in units of `unit` each.
struct OwnUnits<'a> {
    inputs: &'a dyn Inputs,
    unit: f64,
}

impl OwnUnits<'_> {
    fn curves(&self, curves: &Curves) -> Arc<Curves> {
        let factor = 1.0 / self.unit;
        Arc::new(curves.transformed(&Affine::scale(factor, factor)))
    }

    fn of_field(&self, field: &Field) -> Field {
        field.magnified(1.0 / self.unit)
    }
}

impl Inputs for OwnUnits<'_> {
    fn arrangement(&self, name: &Ref<wants::Arrangement>) -> Arrangement {
        magnified(self.inputs.arrangement(name), 1.0 / self.unit)
    }

    fn element(&self, name: &Ref<wants::VectorExemplar>) -> Arc<Curves> {
        self.curves(&self.inputs.element(name))
    }

    fn region(&self, name: &Ref<wants::Region>) -> Arc<Region> {
        Arc::new(scaled(&self.inputs.region(name), 1.0 / self.unit))
    }

    fn argument(&self, text: &Arc<str>, wants: TypeSet) -> Option<Named> {
        Some(match self.inputs.argument(text, wants)? {
            Named::Element(curves) => Named::Element(self.curves(&curves)),
            Named::Field(field) => Named::Field(self.of_field(&field)),
            Named::Arrangement(arrangement) => {
                Named::Arrangement(magnified(arrangement, 1.0 / self.unit))
            }
        })
    }

    fn script(&self, file: &FilePath) -> Result<(Arc<str>, Arc<str>), Vec<Diagnostic>> {
        self.inputs.script(file)
    }

    fn host(&self) -> Arc<dyn Host> {
        self.inputs.host()
    }

    fn field(&self, name: &Ref<wants::Field>) -> Field {
        self.of_field(&self.inputs.field(name))
    }

    fn angles(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic> {
        Ok(self.of_field(&self.inputs.angles(name)?))
    }

    fn lengths(&self, name: &Ref<wants::Field>) -> Result<Field, Diagnostic> {
        let unit = self.unit;
        let lengths = self.of_field(&self.inputs.lengths(name)?);
        Ok(lengths.map("in other units", move |length| length / unit))
    }

    fn densities(&self, name: &Ref<wants::Field>) -> Field {
        let unit = self.unit;
        let densities = self.of_field(&self.inputs.densities(name));
        densities.map("in other units", move |value| value * unit * unit)
    }
}
