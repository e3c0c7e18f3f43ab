//! Facades: laid out by their room, their cells furnished with shapes, pictures, lines and the curve
//! that they are laid along.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::{Reads, Stage, StageResult, surface};
use crate::described::Description;
use crate::value::{Data, Value};
use fretwork_arrangement::Arrangement;
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_facade::{Problem, lay_out, shape};
use fretwork_geometry::facade::{Facade, FacadeBody, FacadeLayout, FacadeShape, Relief};
use fretwork_geometry::mesh::{Image, ImageFormat, Material, Model};
use fretwork_geometry::{Curves, Mesh, Region, planar_map};
use fretwork_language::kinds::facades::{
    Body, Facade as Kind, Fill, Material as Look, Shape, ShapeKey,
};
use fretwork_language::scalar::FilePath;
use fretwork_solid::{Operation, combine};

/// The width of a fill's lines in solids, as a part of the longer side of the canvas.
const LINE: f64 = 1.0 / 400.0;
/// How thick the back of a solid is, as a part of the longer side of the canvas, where it is not said.
const BACK: f64 = 1.0 / 50.0;

/// What of a facade a file shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// All shapes, for viewers.
    Scene,
    /// A solid on a back, to be made.
    Solid,
}

/// A facade in space; `thickness` is that of a solid's back. A solid is one with the meshes in its cells, which are sunk a
/// little into it; where they cannot be united they stay bodies of their own.
///
/// # Errors
/// When it has no form: it does not fit its curve, or nothing stands in it.
pub fn model(
    stage: &Stage<'_>,
    facade: &Facade,
    form: Form,
    thickness: Option<f64>,
) -> Result<Model, Vec<Diagnostic>> {
    let back = thickness.unwrap_or(facade.layout.width.max(facade.layout.height) * BACK);
    let made = match form {
        Form::Scene => fretwork_facade::scene(facade),
        Form::Solid => fretwork_facade::relief(facade, back).map(united),
    };
    made.map_err(|e| {
        vec![Diagnostic::error(e.to_string()).at(stage.definition.span(), "in this artifact")]
    })
}

/// The parts of a model as one, the first united with all others.
fn united(model: Model) -> Model {
    let Some((first, others)) = model
        .parts
        .split_first()
        .filter(|(_, others)| !others.is_empty())
    else {
        return model;
    };
    let mut rest = Mesh::default();
    others
        .iter()
        .for_each(|part| rest.append(&model.mesh(part)));
    match combine(Operation::Union, &[model.mesh(first), rest]) {
        Ok(mesh) => Model::of(first.name.clone(), mesh),
        Err(_) => model,
    }
}

/// Lays the facade out and furnishes its cells.
pub fn facade(stage: &Stage<'_>, kind: &Kind, reads: &mut Reads) -> StageResult {
    let description = Description::new(stage.db, stage.job, stage.definition, kind);
    let told = |problems: Vec<Problem>| {
        problems
            .iter()
            .map(|p| description.tell(p))
            .collect::<Vec<_>>()
    };
    let (layout, warnings) = lay_out(&description.facade).map_err(told)?;
    let mut warnings = told(warnings);
    let facade = furnish(stage, kind, layout, reads)?;
    warnings.extend(bare(stage, &facade));
    Ok((Value::Data(Data::Facade(Arc::new(facade))), warnings))
}

/// The facade with what stands in its cells.
fn furnish(
    stage: &Stage<'_>,
    kind: &Kind,
    layout: FacadeLayout,
    reads: &mut Reads,
) -> Result<Facade, Vec<Diagnostic>> {
    let keys: Vec<Option<usize>> = layout
        .cells
        .iter()
        .map(|cell| {
            shape(
                &kind.shapes,
                &layout.layers[cell.layer as usize],
                cell.symbol_x,
                cell.symbol_y,
            )
        })
        .collect();
    let used: BTreeSet<usize> = keys.iter().flatten().copied().collect();
    let numbers: BTreeMap<usize, u32> = used.iter().copied().zip(0..).collect();
    let shape_of = keys
        .iter()
        .map(|key| key.map(|key| numbers[&key]))
        .collect();
    let wrap = kind.wrap.as_ref().map(|curve| match stage.input(curve) {
        Value::Data(Data::Curve(curve)) => (*curve).clone(),
        other => unreachable!("the graph checks types, and {other:?} is no curve"),
    });
    let mut furnisher = Furnisher {
        stage,
        images: Vec::new(),
        known: BTreeMap::new(),
    };
    let line = layout.width.max(layout.height) * LINE;
    let mut shapes = Vec::with_capacity(used.len());
    for key in &used {
        shapes.push(furnisher.shape(&kind.shapes.0[*key], line, reads)?);
    }
    let fills = fills(stage, kind, &layout, &keys, reads)?;
    Ok(Facade {
        layout,
        shapes,
        shape_of,
        fills,
        images: furnisher.images,
        wrap,
    })
}

/// Reads what shapes name.
struct Furnisher<'a> {
    stage: &'a Stage<'a>,
    images: Vec<Image>,
    known: BTreeMap<Arc<str>, u32>,
}

impl Furnisher<'_> {
    fn shape(
        &mut self,
        (key, shape): &(ShapeKey, Shape),
        line: f64,
        reads: &mut Reads,
    ) -> Result<FacadeShape, Vec<Diagnostic>> {
        let name = key.to_string();
        let body = match &shape.body {
            Body::Box(cell) => FacadeBody::Box {
                depth: cell.depth.0,
            },
            Body::Plane(_) => FacadeBody::Plane,
            Body::Mesh(file) => FacadeBody::Mesh(Arc::new(self.mesh(&name, file, reads)?)),
        };
        let material = shape
            .material
            .as_ref()
            .map(|look| self.material(&name, look))
            .transpose()?;
        let fill = shape.fill.as_ref();
        let width = fill
            .and_then(|fill| fill.width)
            .map_or(line, |width| width.0);
        let height = fill
            .and_then(|fill| fill.height)
            .map_or(width / 2.0, |height| height.0);
        let relief = Relief { width, height };
        Ok(FacadeShape {
            name: name.into(),
            body,
            offset: shape.offset.0,
            material,
            relief,
        })
    }

    /// The meshes of a file, which must have a width and a height.
    fn mesh(
        &self,
        key: &str,
        file: &FilePath,
        reads: &mut Reads,
    ) -> Result<Model, Vec<Diagnostic>> {
        let model = surface::load(self.stage, file, reads)?;
        let extent = model.bounds().size();
        if extent.x > 0.0 && extent.z > 0.0 {
            return Ok(model);
        }
        let message = format!(
            "`{}` has no width along x or no height along z to be scaled to a cell",
            file.0
        );
        Err(vec![
            Diagnostic::error(message).at(self.place(key, &["mesh"]), ""),
        ])
    }

    /// The place of a field of a shape.
    fn place(&self, key: &str, steps: &[&str]) -> Span {
        let own = &self.stage.definition.id;
        let path = [own.section.name(), &*own.name, "shapes", key]
            .into_iter()
            .chain(steps.iter().copied());
        Span::value(
            &self.stage.definition.file,
            &path.map(Arc::from).collect::<Vec<_>>(),
        )
    }

    fn material(&mut self, name: &str, look: &Look) -> Result<Material, Vec<Diagnostic>> {
        let [red, green, blue, alpha] = look.color.0;
        let image = look
            .texture
            .as_ref()
            .map(|file| self.image(name, file))
            .transpose()?;
        Ok(Material {
            name: name.into(),
            color: [red, green, blue],
            opacity: f64::from(alpha) / 255.0,
            metallic: look.metallic.0,
            roughness: look.roughness.0,
            image,
        })
    }

    fn image(&mut self, key: &str, file: &FilePath) -> Result<u32, Vec<Diagnostic>> {
        let (path, bytes) = self.stage.file(&file.0)?;
        if let Some(known) = self.known.get(&path) {
            return Ok(*known);
        }
        let format = match &*bytes {
            [0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a, ..] => ImageFormat::Png,
            [0xff, 0xd8, 0xff, ..] => ImageFormat::Jpeg,
            _ => {
                let place = self.place(key, &["material", "texture"]);
                return Err(vec![
                    Diagnostic::error(format!("`{}` is no PNG or JPEG picture", file.0))
                        .at(place, ""),
                ]);
            }
        };
        let number = self.images.len() as u32;
        self.images.push(Image { format, bytes });
        self.known.insert(path, number);
        Ok(number)
    }
}

/// The lines of the cells that are filled.
fn fills(
    stage: &Stage<'_>,
    kind: &Kind,
    layout: &FacadeLayout,
    keys: &[Option<usize>],
    reads: &mut Reads,
) -> Result<BTreeMap<u32, Arc<Curves>>, Vec<Diagnostic>> {
    let mut fills = BTreeMap::new();
    let mut functions: BTreeMap<usize, Arrangement> = BTreeMap::new();
    let mut logs = Vec::new();
    for (number, key) in keys.iter().enumerate() {
        let Some((key, fill)) =
            key.and_then(|key| Some((key, kind.shapes.0[key].1.fill.as_ref()?)))
        else {
            continue;
        };
        let function = functions
            .entry(key)
            .or_insert_with(|| function(stage, fill, &mut logs));
        let cell = &layout.cells[number];
        let bottom = layout.height - cell.y;
        let region = Region::rectangle(
            [cell.x, bottom - cell.height].into(),
            [cell.x + cell.width, bottom].into(),
        );
        let curves = function.apply(
            &region,
            planar_map::resolution(region.bounds().longer_side()),
        );
        logs.iter().for_each(|log| reads.note(log));
        fills.insert(number as u32, curves?);
    }
    Ok(fills)
}

fn function(stage: &Stage<'_>, fill: &Fill, logs: &mut Vec<super::ReadLog>) -> Arrangement {
    match stage.input(&fill.with) {
        Value::Arrangement(function) => {
            logs.extend(function.logs);
            function.arrangement
        }
        Value::Data(Data::Curves(curves)) => Arrangement::given(curves),
        Value::Data(Data::Region(region)) => Arrangement::given(Arc::new(region.contour.clone())),
        other => unreachable!("the graph checks types, and {other:?} is no arrangement"),
    }
}

/// A warning about the cells that hold nothing.
fn bare(stage: &Stage<'_>, facade: &Facade) -> Option<Diagnostic> {
    let cells = facade
        .layout
        .cells
        .iter()
        .zip(&facade.shape_of)
        .filter(|(_, shape)| shape.is_none());
    let names: BTreeSet<String> = cells
        .map(|(cell, _)| {
            let layer = &facade.layout.layers[cell.layer as usize];
            format!("`{layer}.{}{}`", cell.symbol_x, cell.symbol_y)
        })
        .collect();
    let listed: Vec<&str> = names.iter().take(4).map(String::as_str).collect();
    let more = if names.len() > listed.len() {
        format!(" and {} more", names.len() - listed.len())
    } else {
        String::new()
    };
    let own = &stage.definition.id;
    let steps = [own.section.name(), &*own.name, "shapes"].map(Arc::from);
    let place = Span::key(&stage.definition.file, &steps);
    (!names.is_empty()).then(|| {
        Diagnostic::warning(format!("nothing stands in the cells {}{more}", listed.join(", ")))
            .at(place, "no key here fits them")
            .help("add a shape for them, or one under `*` for all others; what is not to be seen is left out of `visible`")
    })
}
