//! Properties of partitions (table 3.2). They may be changed until the script has run; a partition
//! takes them as they are when it is constructed.

use std::sync::{Arc, Mutex, MutexGuard};

use starlark::environment::GlobalsBuilder;
use starlark::starlark_module;
use starlark::values::tuple::UnpackTuple;
use starlark::values::{Value, ValueLike};

use crate::partition::properties::StripesProperties;
use crate::random::properties::{Density, IrregularProperties, Weighted};
use crate::script::argument::Scalar;
use crate::script::operators::arguments::{flat, kind, label, number};
use fretwork_geometry::LabelSet;
use fretwork_script::session::refuse;
use fretwork_script::values::{Callable, Content, Properties};

pub(crate) fn register(builder: &mut GlobalsBuilder) {
    regular(builder);
    irregular(builder);
}

/// How many widths or labels a cycle may have.
const CYCLE: usize = 100_000;

#[derive(Debug)]
struct Regular(Mutex<StripesProperties>);

#[derive(Debug)]
struct Irregular(Mutex<IrregularProperties>);

impl Content for Regular {
    fn kind(&self) -> &'static str {
        "stripes properties"
    }
}

impl Content for Irregular {
    fn kind(&self) -> &'static str {
        "irregular properties"
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex
        .lock()
        .expect("no code panics while it holds properties")
}

/// The properties of type `T` that `value` is.
fn content<'v, T: Content>(
    value: Value<'v>,
    operator: &str,
    wanted: &str,
) -> starlark::Result<&'v T> {
    let found = value.downcast_ref::<Properties>().map(|p| &*p.0);
    let found = found.and_then(|content| (content as &dyn std::any::Any).downcast_ref());
    found.ok_or_else(|| {
        let what = value
            .downcast_ref::<Properties>()
            .map_or_else(|| kind(value), |p| p.0.kind().to_owned());
        refuse(format!("`{operator}` takes {wanted}, not {what}"))
    })
}

/// Stripes as they are now.
pub(crate) fn stripes_of(value: Value<'_>, operator: &str) -> starlark::Result<StripesProperties> {
    Ok(locked(&content::<Regular>(value, operator, "stripes_properties(…)")?.0).clone())
}

/// Irregular properties as they are now.
pub(crate) fn irregular_of(
    value: Value<'_>,
    operator: &str,
) -> starlark::Result<IrregularProperties> {
    Ok(locked(&content::<Irregular>(value, operator, "irregular_properties(…)")?.0).clone())
}

/// Refuses to change what is frozen: mappers must not depend on the order of their calls.
fn changeable(value: Value<'_>, operator: &str) -> starlark::Result<()> {
    if value.unpack_frozen().is_none() {
        return Ok(());
    }
    Err(refuse(format!(
        "`{operator}` cannot change properties that are made outside of the mapper"
    )))
}

fn labels(values: &UnpackTuple<Value<'_>>, operator: &str) -> starlark::Result<Vec<LabelSet>> {
    let labels = flat(&values.items);
    if labels.is_empty() || labels.len() > CYCLE {
        return Err(refuse(format!(
            "`{operator}` takes 1 to {CYCLE} labels, {} given",
            labels.len()
        )));
    }
    labels
        .into_iter()
        .map(|value| label(value, operator))
        .collect()
}

#[starlark_module]
fn regular(builder: &mut GlobalsBuilder) {
    /// Parallel stripes: lines that run at `angle` (radians, from +x toward +y) with these widths between them, in turn (lengths above 0). Both may be fields, which are read at the centroid of the region.
    ///
    /// Fails without a width.
    ///
    /// Example: `courses = stripes_properties(0, 12, 8)`
    fn stripes_properties<'v>(
        #[starlark(require = pos)] angle: Value<'v>,
        #[starlark(args)] widths: UnpackTuple<Value<'v>>,
    ) -> starlark::Result<Properties> {
        let operator = "stripes_properties";
        let widths = flat(&widths.items);
        if widths.is_empty() || widths.len() > CYCLE {
            return Err(refuse(format!(
                "`{operator}` takes an angle and 1 to {CYCLE} widths, {} given",
                widths.len()
            )));
        }
        let spacing = widths
            .into_iter()
            .map(|w| positive(w, operator))
            .collect::<starlark::Result<_>>()?;
        let properties = StripesProperties::new(number(angle, operator)?, spacing);
        Ok(Properties(Arc::new(Regular(Mutex::new(properties)))))
    }

    /// Gives the lines of stripes labels in turn; a list stands for several labels of one line. Gives the properties back.
    ///
    /// Fails on anything but the properties of stripes.
    ///
    /// Example: `set_edge_labels(courses, 'bed', ['bed', 'thick'])`
    fn set_edge_labels<'v>(
        #[starlark(require = pos)] properties: Value<'v>,
        #[starlark(args)] names: UnpackTuple<Value<'v>>,
    ) -> starlark::Result<Value<'v>> {
        let operator = "set_edge_labels";
        let stripes: &Regular = content(properties, operator, "stripes_properties(…)")?;
        changeable(properties, operator)?;
        locked(&stripes.0).edge_labels = labels(&names, operator)?;
        Ok(properties)
    }

    /// Gives stripes labels in turn; a list stands for several labels of one stripe. Gives the properties back.
    ///
    /// Fails on anything but the properties of stripes.
    ///
    /// Example: `set_face_labels(courses, 'odd', 'even')`
    fn set_face_labels<'v>(
        #[starlark(require = pos)] properties: Value<'v>,
        #[starlark(args)] names: UnpackTuple<Value<'v>>,
    ) -> starlark::Result<Value<'v>> {
        let operator = "set_face_labels";
        let stripes: &Regular = content(properties, operator, "stripes_properties(…)")?;
        changeable(properties, operator)?;
        locked(&stripes.0).face_labels = labels(&names, operator)?;
        Ok(properties)
    }
}

fn positive(value: Value<'_>, operator: &str) -> starlark::Result<f64> {
    let number = number(value, operator)?;
    if number > 0.0 {
        Ok(number)
    } else {
        Err(refuse(format!(
            "`{operator}` takes positive widths, not {number}"
        )))
    }
}

/// Changes one kind of labels to those in `pairs`: label, weight, label, weight, …
fn weigh<'v>(
    properties: Value<'v>,
    pairs: &UnpackTuple<Value<'v>>,
    operator: &str,
    kind: impl FnOnce(&mut IrregularProperties) -> &mut Weighted,
) -> starlark::Result<Value<'v>> {
    let irregular: &Irregular = content(properties, operator, "irregular_properties(…)")?;
    changeable(properties, operator)?;
    let pairs = flat(&pairs.items);
    if pairs.is_empty() || pairs.len() % 2 == 1 || pairs.len() > 2 * CYCLE {
        return Err(refuse(format!(
            "`{operator}` takes labels, each followed by its weight"
        )));
    }
    let weighted = pairs
        .chunks_exact(2)
        .map(|pair| Ok((label(pair[0], operator)?, number(pair[1], operator)?)));
    let weighted = Weighted::new(weighted.collect::<starlark::Result<_>>()?)
        .map_err(starlark::Error::new_other)?;
    *kind(&mut locked(&irregular.0)) = weighted;
    Ok(properties)
}

#[starlark_module]
fn irregular(builder: &mut GlobalsBuilder) {
    /// Random points, `density` of them on a square of side 1 on average, as a number above 0 or a field.
    ///
    /// Fails on a density that is not above 0.
    ///
    /// Example: `cells = irregular_properties(0.002)`
    fn irregular_properties<'v>(
        #[starlark(require = pos)] density: Value<'v>,
    ) -> starlark::Result<Properties> {
        let operator = "irregular_properties";
        let field =
            Callable::from_value(density).and_then(|c| c.operation().downcast_ref::<Scalar>());
        let density = match field {
            Some(field) => Density::Field(field.0.clone()),
            None => {
                let number = number(density, operator)?;
                if number <= 0.0 {
                    return Err(refuse(format!(
                        "`{operator}` takes a positive density, not {number}"
                    )));
                }
                Density::Constant(number)
            }
        };
        Ok(Properties(Arc::new(Irregular(Mutex::new(
            IrregularProperties::new(density),
        )))))
    }

    /// Gives every vertex of random cells one of these labels, drawn with the weight that follows each label. Gives the properties back.
    ///
    /// Fails on weights below 0, or all 0.
    ///
    /// Example: `set_weighted_vertex_labels(cells, 'knot', 1, 'plain', 3)`
    fn set_weighted_vertex_labels<'v>(
        #[starlark(require = pos)] properties: Value<'v>,
        #[starlark(args)] pairs: UnpackTuple<Value<'v>>,
    ) -> starlark::Result<Value<'v>> {
        weigh(properties, &pairs, "set_weighted_vertex_labels", |p| {
            &mut p.vertex_labels
        })
    }

    /// Gives every edge of random cells one of these labels, drawn with the weight that follows each label. Gives the properties back.
    ///
    /// Fails on weights below 0, or all 0.
    ///
    /// Example: `set_weighted_edge_labels(cells, 'seam', 1, 'plain', 4)`
    fn set_weighted_edge_labels<'v>(
        #[starlark(require = pos)] properties: Value<'v>,
        #[starlark(args)] pairs: UnpackTuple<Value<'v>>,
    ) -> starlark::Result<Value<'v>> {
        weigh(properties, &pairs, "set_weighted_edge_labels", |p| {
            &mut p.edge_labels
        })
    }

    /// Gives every random cell one of these labels, drawn with the weight that follows each label. Gives the properties back.
    ///
    /// Fails on weights below 0, or all 0.
    ///
    /// Example: `set_weighted_face_labels(cells, 'big', 1, 'small', 2)`
    fn set_weighted_face_labels<'v>(
        #[starlark(require = pos)] properties: Value<'v>,
        #[starlark(args)] pairs: UnpackTuple<Value<'v>>,
    ) -> starlark::Result<Value<'v>> {
        weigh(properties, &pairs, "set_weighted_face_labels", |p| {
            &mut p.face_labels
        })
    }
}
