//! Facades: laid out by their room, their cells furnished with shapes, pictures, lines and the curve
//! that they are laid along.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::arrangement::lines_on;
use super::description::Description;
use super::model::{Form, Thickness, model};
use fretwork_action::{Action, Data, ReadLog, StageResult};
use fretwork_diagnostic::{Diagnostic, Span};
use fretwork_facade::{Problem, lay_out, shape};
use fretwork_geometry::facade::{
    Facade, FacadeBody, FacadeLayout, FacadeShape, Moulding, Relief, Run,
};
use fretwork_geometry::mesh::{Image, ImageFormat, Material, Model};
use fretwork_geometry::{Curves, Region};
use fretwork_language::kinds::facades::{
    Body, Facade as Kind, Material as Look, Moulding as MouldingKind, MouldingRun, Shape, ShapeKey,
};
use fretwork_language::scalar::FilePath;
use fretwork_language::{Ref, Wanted};
use fretwork_primitive::surface;
use fretwork_source::image;

/// The width of a fill's lines in solids, as a part of the longer side of the canvas.
const LINE: f64 = 1.0 / 400.0;

/// Lays the facade out and furnishes its cells.
pub fn facade(action: &Action, kind: &Kind, log: &ReadLog) -> StageResult {
    let description = Description::new(action, kind);
    let told = |problems: Vec<Problem>| {
        problems
            .iter()
            .map(|p| description.tell(p))
            .collect::<Vec<_>>()
    };
    let (layout, warnings) = lay_out(&description.facade).map_err(told)?;
    let mut warnings = told(warnings);
    let (facade, unread) = furnish(action, kind, layout, log)?;
    warnings.extend(unread);
    warnings.extend(bare(action, &facade));
    Ok((Data::Facade(Arc::new(facade)), warnings))
}

/// The facade with what stands in its cells, and warnings about files that it reads.
fn furnish(
    action: &Action,
    kind: &Kind,
    layout: FacadeLayout,
    log: &ReadLog,
) -> Result<(Facade, Vec<Diagnostic>), Vec<Diagnostic>> {
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
    let wrap = kind
        .wrap
        .as_ref()
        .map(|curve| (*action.input(curve)).clone());
    let mut furnisher = Furnisher {
        action,
        images: Vec::new(),
        known: BTreeMap::new(),
        warnings: Vec::new(),
    };
    let line = layout.width.max(layout.height) * LINE;
    let mut shapes = Vec::with_capacity(used.len());
    for key in &used {
        shapes.push(furnisher.shape(&kind.shapes.0[*key], line, log)?);
    }
    let shape_at = |key: usize| &shapes[numbers[&key] as usize];
    frames_fit(action, kind, (&layout, &keys), shape_at)?;
    let fills = fills(action, kind, &layout, &keys, log)?;
    let facade = Facade {
        layout,
        shapes,
        shape_of,
        fills,
        images: furnisher.images,
        wrap,
    };
    Ok((facade, furnisher.warnings))
}

/// Checks that the mouldings that go around cells leave them an opening.
fn frames_fit<'a>(
    action: &Action,
    kind: &Kind,
    (layout, keys): (&FacadeLayout, &[Option<usize>]),
    shape: impl Fn(usize) -> &'a FacadeShape,
) -> Result<(), Vec<Diagnostic>> {
    for (cell, key) in layout.cells.iter().zip(keys) {
        let Some((key, FacadeBody::Moulding(moulding))) = key.map(|key| (key, &shape(key).body))
        else {
            continue;
        };
        let sides = [cell.width, cell.height];
        if moulding.run == Run::Frame && !moulding.leaves_opening(sides) {
            let message = format!(
                "the moulding is {} high: around a cell of {:.3} x {:.3} it leaves no opening",
                moulding.height, sides[0], sides[1],
            );
            let name = kind.shapes.0[key].0.to_string();
            let place = action.definition.field(&["shapes", &name, "moulding"]);
            return Err(vec![
                Diagnostic::error(message)
                    .at(place, "")
                    .help("draw its profile lower, or make the cells larger"),
            ]);
        }
    }
    Ok(())
}

/// Reads what shapes name.
struct Furnisher<'a> {
    action: &'a Action,
    images: Vec<Image>,
    known: BTreeMap<Arc<str>, u32>,
    warnings: Vec<Diagnostic>,
}

impl Furnisher<'_> {
    fn shape(
        &mut self,
        (key, shape): &(ShapeKey, Shape),
        line: f64,
        log: &ReadLog,
    ) -> Result<FacadeShape, Vec<Diagnostic>> {
        let name = key.to_string();
        let body = match &shape.body {
            Body::Box(cell) => FacadeBody::Box {
                depth: cell.depth.0,
            },
            Body::Plane(_) => FacadeBody::Plane,
            Body::Mesh(file) => FacadeBody::Mesh(Arc::new(self.mesh(&name, file, log)?)),
            Body::Solid(solid) => FacadeBody::Mesh(Arc::new(self.solid(&name, solid)?)),
            Body::Moulding(kind) => FacadeBody::Moulding(Arc::new(self.moulding(&name, kind)?)),
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

    /// The meshes of a file.
    fn mesh(
        &mut self,
        key: &str,
        file: &FilePath,
        log: &ReadLog,
    ) -> Result<Model, Vec<Diagnostic>> {
        let (model, warnings) = surface::load(self.action, file, log)?;
        self.warnings.extend(warnings);
        self.scalable(&file.0, model, key, "mesh")
    }

    /// A solid of the spec.
    fn solid<T: Wanted>(&mut self, key: &str, solid: &Ref<T>) -> Result<Model, Vec<Diagnostic>> {
        let thickness = Thickness::default();
        let warnings = &mut self.warnings;
        let model = model(self.action, solid, Form::Scene, thickness, warnings)?;
        self.scalable(&solid.name, model, key, "solid")
    }

    /// A model that has a width and a height to be scaled to a cell.
    fn scalable(
        &self,
        name: &str,
        model: Model,
        key: &str,
        field: &str,
    ) -> Result<Model, Vec<Diagnostic>> {
        let extent = model.bounds().size();
        if extent.x > 0.0 && extent.z > 0.0 {
            return Ok(model);
        }
        let message =
            format!("`{name}` has no width along x or no height along z to be scaled to a cell");
        Err(vec![
            Diagnostic::error(message).at(self.place(key, &[field]), ""),
        ])
    }

    fn moulding(&self, key: &str, kind: &MouldingKind) -> Result<Moulding, Vec<Diagnostic>> {
        let run = match kind.along {
            MouldingRun::Row => Run::Row,
            MouldingRun::Column => Run::Column,
            MouldingRun::Frame => Run::Frame,
        };
        let region = self.action.input(&kind.profile);
        Moulding::of(&region.area, run).ok_or_else(|| {
            let message = format!("the profile `{}` encloses nothing", kind.profile.name);
            let place = self.place(key, &["moulding", "profile"]);
            vec![Diagnostic::error(message).at(place, "")]
        })
    }

    /// The place of a field of a shape.
    fn place(&self, key: &str, steps: &[&str]) -> Span {
        let path = [&["shapes", key], steps].concat();
        self.action.definition.field(&path)
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
        let (path, bytes) = self.action.file(&file.0)?;
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
        if let Err(error) = image::check(&bytes) {
            let place = self.place(key, &["material", "texture"]);
            let message = format!("`{}` cannot be a texture: {error}", file.0);
            return Err(vec![Diagnostic::error(message).at(place, "")]);
        }
        let number = self.images.len() as u32;
        self.images.push(Image { format, bytes });
        self.known.insert(path, number);
        Ok(number)
    }
}

/// The lines of the cells that are filled.
fn fills(
    action: &Action,
    kind: &Kind,
    layout: &FacadeLayout,
    keys: &[Option<usize>],
    log: &ReadLog,
) -> Result<BTreeMap<u32, Arc<Curves>>, Vec<Diagnostic>> {
    let mut fills = BTreeMap::new();
    for (number, key) in keys.iter().enumerate() {
        let Some(fill) = key.and_then(|key| kind.shapes.0[key].1.fill.as_ref()) else {
            continue;
        };
        let cell = &layout.cells[number];
        let bottom = layout.height - cell.y;
        let region = Region::rectangle(
            [cell.x, bottom - cell.height].into(),
            [cell.x + cell.width, bottom].into(),
        );
        let curves = lines_on(&action.input(&fill.with), &region, log)?;
        fills.insert(number as u32, curves);
    }
    Ok(fills)
}

/// A warning about the cells that hold nothing.
fn bare(action: &Action, facade: &Facade) -> Option<Diagnostic> {
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
    let place = action.definition.field_key(&["shapes"]);
    (!names.is_empty()).then(|| {
        Diagnostic::warning(format!("nothing stands in the cells {}{more}", listed.join(", ")))
            .at(place, "no key here fits them")
            .help("add a shape for them, or one under `*` for all others; what is not to be seen is left out of `visible`")
    })
}
