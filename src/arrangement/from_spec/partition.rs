//! Partitions as a spec declares them.

use std::sync::Arc;

use crate::border::Border;
use crate::from_spec::context::{Context, Declared, border, failed, label_set};
use crate::function::{Applied, Arrangement};
use crate::near::locality::{CellSize, Hull, Locality, Room, diagonal, reaching};
use crate::partition::grid::grid_in;
use crate::partition::isolines::{isolines, isolines_in};
use crate::partition::packed::{PackedProperties, packed};
use crate::partition::properties::StripesProperties;
use crate::partition::stripes::stripes_in;
use crate::random::cells::{random_in, uniform_in};
use crate::random::properties::{Density, IrregularProperties, Weighted};
use crate::tiled::regularity::{Irregular, Regularity};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_geometry::{Bounds, Curves, Field, LabelSet, Point, Region, polygon};
use fretwork_language::kinds::partitions::{
    AnchoredStripes, CellAmount, Grid, Isolines, Packed, Partition, Stripes, Voronoi,
};
use fretwork_language::scalar::{Angle, PositiveLength};
use fretwork_language::value::{LabelCycle, Varying, WeightedLabels};

/// The partition that `kind` declares.
///
/// # Errors
/// When what it names does not fit.
pub fn partition(kind: &Partition, context: &Context<'_>) -> Declared {
    match kind {
        Partition::Stripes(kind) => stripes(kind, context),
        Partition::Grid(kind) => grid(kind, context),
        Partition::Uniform(kind) => irregular(kind, true, context),
        Partition::Random(kind) => irregular(kind, false, context),
        Partition::Packed(kind) => Ok(pack(kind, context)),
        Partition::Isolines(kind) => Ok(contours(kind, context)),
    }
}

fn contours(kind: &Isolines, context: &Context<'_>) -> Arrangement {
    let (field, every) = (context.inputs.field(&kind.field), kind.every.0);
    let span = context.span.clone();
    let why = Irregular::new("a field says where its lines are").at(&span);
    let (near_field, near_span) = (field.clone(), span.clone());
    let made = Arrangement::with(Err(why), move |region, resolution, _| {
        isolines(&field, every, region, resolution)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    });
    let near = move |region: &Region, resolution: f64, room: Room| {
        let drawn = isolines_in(&near_field, every, (region, resolution), &room.bounds)
            .map_err(|e| failed(&e, &near_span))?;
        Ok(drawn.map(|drawn| Arc::new(reaching(&drawn, &room.bounds))))
    };
    made.local_by(Some(Locality {
        near: Box::new(near),
        ..whole_within(0.0)
    }))
}

fn stripes(kind: &AnchoredStripes, context: &Context<'_>) -> Declared {
    let span = context.span.clone();
    let mut lines = Lines::new(&kind.lines, context)?;
    lines.anchor = kind.anchor.point().map(Point::from);
    let lines = Arc::new(lines);
    let read = [lines.clone()];
    let regularity = regularity(&read, &span);
    let draw = move |region: &Region, resolution: f64, room: Option<&Bounds>| {
        let Some(lines) = lines.on(region) else {
            return Ok(Arc::new(region.contour.clone()));
        };
        stripes_in(&lines, region, resolution, room)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    };
    let local = Cut {
        extent: Some(Hull::beyond(0.0)),
        cell: None,
    };
    Ok(lacking(cut(regularity, local, draw), read))
}

fn grid(kind: &Grid, context: &Context<'_>) -> Declared {
    let span = context.span.clone();
    let anchor = kind.anchor.point().map(Point::from);
    let family = |lines: &Stripes| {
        let lines = Lines::new(lines, context)?;
        Ok::<_, Vec<Diagnostic>>(Arc::new(Lines { anchor, ..lines }))
    };
    let (across, along) = (family(&kind.across)?, family(&kind.along)?);
    let read = [across.clone(), along.clone()];
    let border = border(kind.border);
    let regularity = regularity(&read, &span);
    let cell = across.constant().zip(along.constant());
    let cell = cell.map(|(across, along)| largest_cell(&across, &along));
    let draw = move |region: &Region, resolution: f64, room: Option<&Bounds>| {
        let (Some(across), Some(along)) = (across.on(region), along.on(region)) else {
            return Ok(Arc::new(region.contour.clone()));
        };
        grid_in([&across, &along], border, (region, resolution), room)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    };
    let local = Cut {
        extent: extent(border, cell),
        cell,
    };
    Ok(lacking(cut(regularity, local, draw), read))
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
        anchor: kind.anchor.point().map(Point::from),
    };
    let scale = properties.scale[1];
    let extents = properties.elements.iter().map(|e| e.bounds());
    let largest = extents.map(|b| scale * diagonal(&b)).fold(0.0, f64::max);
    let beyond = properties.anchor.map_or(0.0, |_| largest);
    let (span, seed) = (context.span.clone(), context.seed);
    let why = Irregular::new("its copies lie at random").at(&span);
    let made = Arrangement::with(Err(why), move |region, _, _| {
        packed(&properties, region, seed)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    });
    made.local_by(Some(whole_within(beyond)))
}

/// What is not drawn room by room, but goes no farther beyond the region.
fn whole_within(beyond: f64) -> Locality {
    Locality {
        near: Box::new(|_, _, _| Ok(None)),
        extent: Some(Hull::beyond(beyond)),
        cell: None,
        is_noded: false,
    }
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
    let partition = if is_uniform { uniform_in } else { random_in };
    let why = Irregular::new("its cells are random").at(&span);
    let cell = match properties.density {
        Density::Constant(density) => Some(largest_random_cell(density, is_uniform)),
        Density::Field(_) => None,
    };
    let local = Cut {
        extent: extent(border, cell),
        cell,
    };
    let draw = move |region: &Region, resolution: f64, room: Option<&Bounds>| {
        partition(&properties, border, (region, resolution), seed, room)
            .map(Arc::new)
            .map_err(|e| failed(&e, &span))
    };
    Ok(cut(Err(why), local, draw))
}

/// What is known of where the curves of a partition lie.
struct Cut {
    extent: Option<Hull>,
    cell: Option<CellSize>,
}

/// The partition that `draw` gives for a region and a resolution, all of it or what comes into a room.
fn cut(
    regularity: Result<Regularity, Irregular>,
    local: Cut,
    draw: impl Fn(&Region, f64, Option<&Bounds>) -> Applied + Send + Sync + 'static,
) -> Arrangement {
    let draw = Arc::new(draw);
    let part = draw.clone();
    let near = move |region: &Region, resolution: f64, room: Room| {
        let drawn = part(region, resolution, Some(&room.bounds))?;
        Ok(Some(Arc::new(reaching(&drawn, &room.bounds))))
    };
    let local = Locality {
        near: Box::new(near),
        extent: local.extent,
        cell: local.cell,
        is_noded: true,
    };
    let made = Arrangement::with(regularity, move |region, resolution, _| {
        draw(region, resolution, None)
    });
    made.local_by(Some(local))
}

/// Where the cells of a partition lie that are no larger than `cell`.
fn extent(border: Border, cell: Option<CellSize>) -> Option<Hull> {
    match border {
        Border::KeepOutside => cell.map(|cell| Hull::beyond(cell.most)),
        Border::Crop | Border::CropAddBoundary | Border::KeepInside => Some(Hull::beyond(0.0)),
    }
}

/// The diagonal of the largest cell of a grid, or a little more.
fn largest_cell(across: &StripesProperties, along: &StripesProperties) -> CellSize {
    let widest = |lines: &StripesProperties| lines.spacing.iter().fold(0.0, |a: f64, b| a.max(*b));
    let turn = libm::sin(along.angle - across.angle).abs();
    // The sides of the cell are as long as the stripes across them are wide, over the sine of the angle between.
    let most = ((widest(across) + widest(along)) / turn).min(f64::MAX);
    CellSize { most }
}

/// What no cell of random points is larger than, in any practical case: a circle of half this radius without a point is
/// needed for it. In a Poisson-disk set, whose gaps are filled, it would take a gap of several times the usual one; in a
/// Poisson process its probability is below 1e-20.
fn largest_random_cell(density: f64, is_uniform: bool) -> CellSize {
    let width = 1.0 / density.sqrt();
    let most = if is_uniform { 4.0 } else { 8.0 };
    CellSize { most: most * width }
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
