//! Partitions as a spec declares them.

use std::sync::Arc;

use crate::from_spec::context::{Context, Declared, border, failed, label_set};
use crate::function::Arrangement;
use crate::partition::grid::grid;
use crate::partition::isolines::isolines;
use crate::partition::packed::{PackedProperties, packed};
use crate::partition::properties::StripesProperties;
use crate::partition::stripes::stripes;
use crate::random::cells::{random, uniform};
use crate::random::properties::{Density, IrregularProperties, Weighted};
use crate::tiled::regularity::{Irregular, Regularity};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Curves, Field, LabelSet, Point, Region, polygon};
use fretwork_language::kinds::partitions::{CellAmount, Packed, Partition, Stripes, Voronoi};
use fretwork_language::scalar::{Angle, PositiveLength};
use fretwork_language::value::{LabelCycle, Varying, WeightedLabels};

/// The partition that `kind` declares.
///
/// # Errors
/// When what it names does not fit.
pub fn partition(kind: &Partition, context: &Context<'_>) -> Declared {
    let span = context.span.clone();
    match kind {
        Partition::Stripes(kind) => {
            let mut lines = Lines::new(&kind.lines, context)?;
            lines.anchor = kind.anchor.point().map(Point::from);
            let lines = Arc::new(lines);
            let read = [lines.clone()];
            let regularity = regularity(&read, &span);
            let made = Arrangement::with(regularity, move |region, resolution, _| {
                let Some(lines) = lines.on(region) else {
                    return Ok(Arc::new(region.contour.clone()));
                };
                stripes(&lines, region, resolution)
                    .map(Arc::new)
                    .map_err(|e| failed(&e, &span))
            });
            Ok(lacking(made, read))
        }
        Partition::Grid(kind) => {
            let anchor = kind.anchor.point().map(Point::from);
            let family = |lines: &Stripes| {
                let lines = Lines::new(lines, context)?;
                Ok::<_, Vec<Diagnostic>>(Arc::new(Lines { anchor, ..lines }))
            };
            let (across, along) = (family(&kind.across)?, family(&kind.along)?);
            let read = [across.clone(), along.clone()];
            let border = border(kind.border);
            let regularity = regularity(&read, &span);
            let made = Arrangement::with(regularity, move |region, resolution, _| {
                let (Some(across), Some(along)) = (across.on(region), along.on(region)) else {
                    return Ok(Arc::new(region.contour.clone()));
                };
                grid(&across, &along, border, region, resolution)
                    .map(Arc::new)
                    .map_err(|e| failed(&e, &span))
            });
            Ok(lacking(made, read))
        }
        Partition::Uniform(kind) => irregular(kind, true, context),
        Partition::Random(kind) => irregular(kind, false, context),
        Partition::Packed(kind) => Ok(pack(kind, context)),
        Partition::Isolines(kind) => {
            let (field, every) = (context.inputs.field(&kind.field), kind.every.0);
            let why = Irregular::new("a field says where its lines are").at(&span);
            Ok(Arrangement::with(Err(why), move |region, resolution, _| {
                isolines(&field, every, region, resolution)
                    .map(Arc::new)
                    .map_err(|e| failed(&e, &span))
            }))
        }
    }
}

/// What of a partition by these lines is repeated.
fn regularity<const N: usize>(
    lines: &[Arc<Lines>; N],
    span: &Span,
) -> Result<Regularity, Irregular> {
    let constant: Option<Vec<StripesProperties>> = lines.iter().map(|l| l.constant()).collect();
    let Some(constant) = constant else {
        return Err(Irregular::new("a field says how its lines lie").at(span));
    };
    let is_fixed = constant.iter().any(|lines| lines.anchor.is_some());
    let all: Vec<&StripesProperties> = constant.iter().collect();
    Ok(Regularity::of_lines(&all, is_fixed))
}

/// The arrangement, which tells where fields that `lines` read have no value.
fn lacking<const N: usize>(made: Arrangement, lines: [Arc<Lines>; N]) -> Arrangement {
    if lines.iter().all(|lines| !lines.reads_fields()) {
        return made;
    }
    made.lacking(move |region| {
        let lacks = lines.iter().any(|lines| lines.on(region).is_none());
        lacks.then(|| place_of(region))
    })
}

/// Where the fields of a region are read: at its inner point.
fn place_of(region: &Region) -> Point {
    let at = polygon::inner_point(&region.area);
    region.tile().map_or(at, |tile| tile.wrap(at))
}

fn pack(kind: &Packed, context: &Context<'_>) -> Arrangement {
    let properties = PackedProperties {
        elements: kind
            .elements
            .0
            .iter()
            .map(|name| Curves::clone(&*context.inputs.element(name)))
            .collect(),
        rotate: [kind.rotate.low.0, kind.rotate.high.0],
        scale: [kind.scale.low.0, kind.scale.high.0],
        gap: kind.gap.0,
    };
    let (span, seed) = (context.span.clone(), context.seed);
    let why = Irregular::new("its copies lie at random").at(&span);
    Arrangement::with(Err(why), move |region, _, _| {
        packed(&properties, region, seed)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    })
}

fn irregular(kind: &Voronoi, is_uniform: bool, context: &Context<'_>) -> Declared {
    let (span, seed, border) = (context.span.clone(), context.seed, border(kind.border));
    let weighted = |labels: &WeightedLabels| {
        let labels = labels
            .0
            .iter()
            .map(|(label, weight)| (LabelSet::one(&label.0), *weight))
            .collect();
        Weighted::new(labels).map_err(|e| failed(&e, &span))
    };
    let properties = IrregularProperties {
        density: density(&kind.amount, context)?,
        vertex_labels: weighted(&kind.vertex_labels)?,
        edge_labels: weighted(&kind.edge_labels)?,
        face_labels: weighted(&kind.face_labels)?,
    };
    let partition = if is_uniform { uniform } else { random };
    let why = Irregular::new("its cells are random").at(&span);
    Ok(Arrangement::with(Err(why), move |region, resolution, _| {
        partition(&properties, border, region, seed, resolution)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    }))
}

/// Cells per unit of area; a cell's size is the side of a square of its mean area.
fn density(amount: &CellAmount, context: &Context<'_>) -> Result<Density, Vec<Diagnostic>> {
    Ok(match amount {
        CellAmount::Density(Varying::Constant(density)) => Density::Constant(density.0),
        CellAmount::Density(Varying::Field(field)) => {
            Density::Field(context.inputs.densities(field))
        }
        CellAmount::CellSize(Varying::Constant(size)) => Density::Constant(1.0 / (size.0 * size.0)),
        CellAmount::CellSize(Varying::Field(field)) => {
            let size = context.inputs.lengths(field).map_err(|d| vec![d])?;
            Density::Field(size.map_falling("cells of this size", |size| 1.0 / (size * size)))
        }
    })
}

/// The properties of stripes, some of which may be fields.
struct Lines {
    /// The middle of the first stripe, where it is not the corner of the region.
    anchor: Option<Point>,
    angle: Number,
    spacing: Vec<Number>,
    edge_labels: Vec<LabelSet>,
    face_labels: Vec<LabelSet>,
}

enum Number {
    Constant(f64),
    Field(Field),
}

impl Number {
    fn at(&self, p: Point) -> f64 {
        match self {
            Number::Constant(value) => *value,
            Number::Field(field) => field.value(p),
        }
    }
}

impl Lines {
    fn new(kind: &Stripes, context: &Context<'_>) -> Result<Lines, Vec<Diagnostic>> {
        let angle = match &kind.angle {
            Varying::Constant(Angle(angle)) => Number::Constant(*angle),
            Varying::Field(field) => {
                Number::Field(context.inputs.angles(field).map_err(|d| vec![d])?)
            }
        };
        let spacing = |spacing: &Varying<PositiveLength>| match spacing {
            Varying::Constant(PositiveLength(spacing)) => Ok(Number::Constant(*spacing)),
            Varying::Field(field) => context
                .inputs
                .lengths(field)
                .map(Number::Field)
                .map_err(|d| vec![d]),
        };
        let labels = |cycle: &LabelCycle| cycle.0.iter().map(|labels| label_set(labels)).collect();
        Ok(Lines {
            anchor: None,
            angle,
            spacing: kind.spacing.iter().map(spacing).collect::<Result<_, _>>()?,
            edge_labels: labels(&kind.edge_labels),
            face_labels: labels(&kind.face_labels),
        })
    }

    fn reads_fields(&self) -> bool {
        let mut all = self.spacing.iter().chain([&self.angle]);
        all.any(|number| matches!(number, Number::Field(_)))
    }

    /// The properties, where they are the same on every region.
    fn constant(&self) -> Option<StripesProperties> {
        (!self.reads_fields()).then(|| self.at(Point::ORIGIN))
    }

    /// The properties on a region: fields are read at its inner point. None where a field has no value there, and so
    /// nothing is drawn.
    fn on(&self, region: &Region) -> Option<StripesProperties> {
        let lines = self.at(place_of(region));
        let is_known = !lines.angle.is_nan() && lines.spacing.iter().all(|s| !s.is_nan());
        is_known.then_some(lines)
    }

    /// The properties where fields are read at a place.
    fn at(&self, place: Point) -> StripesProperties {
        StripesProperties {
            anchor: self.anchor,
            angle: self.angle.at(place),
            spacing: self.spacing.iter().map(|s| s.at(place)).collect(),
            edge_labels: self.edge_labels.clone(),
            face_labels: self.face_labels.clone(),
        }
    }
}
