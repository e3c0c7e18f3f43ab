//! Values as bodies in space: what files of solids, pictures of them and other solids are made of.

use std::sync::Arc;

use super::stress;
use fretwork_action::{Action, Data, Input as _, Value};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::facade::Facade;
use fretwork_geometry::mesh::Material;
use fretwork_geometry::{Cutout, Mesh, Model};
use fretwork_language::kinds::look::Look;
use fretwork_language::kinds::side::Side;
use fretwork_language::scalar::PositiveLength;
use fretwork_language::{Node, Ref, Wanted, wants};
use fretwork_primitive::placement::thickness_side;
use fretwork_solid::{Operation, Overlap, combine, unite_touching};

/// How thick the back of a facade's solid is, as a part of the longer side of the canvas, where it is
/// not said.
const BACK: f64 = 1.0 / 50.0;

/// The most triangles of a facade that are united in rational numbers, which takes a hundred times as long as
/// floating-point numbers do. What is larger is mostly a facade along a finely divided curve.
const MOST_EXACT: usize = 30_000;

/// What of a facade a file shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// All shapes, for viewers.
    Scene,
    /// A solid on a back, to be made.
    Solid,
}

/// How thick a cutout becomes, and to which side of what it lies on: its own where none is said.
#[derive(Clone, Copy, Debug, Default)]
pub struct Thickness {
    pub amount: Option<f64>,
    pub side: Option<Side>,
}

impl Thickness {
    /// What a spec says.
    pub fn new(amount: Option<PositiveLength>, side: Option<Side>) -> Thickness {
        Thickness {
            amount: amount.map(|amount| amount.0),
            side,
        }
    }

    /// This, and where it says nothing what `other` says.
    pub fn or(self, other: Thickness) -> Thickness {
        Thickness {
            amount: self.amount.or(other.amount),
            side: self.side.or(other.side),
        }
    }
}

/// What the node `reference` means in space: cutouts are made `thickness` thick, and surfaces where one is given, facades stand
/// on a back of that thickness. The part of a value that is one body has the node's name. Where a cutout is
/// bent too sharply for its thickness is told in `warnings`.
///
/// # Errors
/// When the value has no volume.
pub fn model<T: Wanted>(
    action: &Action,
    reference: &Ref<T>,
    form: Form,
    thickness: Thickness,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Model, Vec<Diagnostic>> {
    let target = action.definition.target(reference);
    let name = &target.name;
    let failed =
        |message: String, here: &str| Diagnostic::error(message).at(action.span(), here.to_owned());
    match action.value(reference) {
        Value::Data(Data::Solid(model)) => Ok((**model).clone()),
        Value::Data(Data::Shell(shell)) => Ok(stress::colored(name, shell)),
        Value::Data(Data::Analysis(body)) => Ok(stress::colored_analysis(name, body)),
        Value::Data(Data::Surface(surface)) => {
            let Some(amount) = thickness.amount else {
                return Ok(Model::of(name.clone(), surface.mesh.clone()));
            };
            let side = thickness_side(thickness.side.unwrap_or(Side::Inside));
            let mesh = fretwork_solid::shell(surface, amount, side).map_err(|error| {
                let told = failed(
                    format!("`{target}` cannot be made thick: {error}"),
                    "in this solid",
                );
                vec![error.help().into_iter().fold(told, Diagnostic::help)]
            })?;
            Ok(Model::of(name.clone(), mesh))
        }
        Value::Data(value @ (Data::Cutout(_) | Data::Region(_))) => {
            let Some(amount) = thickness.amount else {
                let error = failed(
                    format!("`{target}` is flat and has no thickness"),
                    "needed here",
                );
                let beside = match action.definition.node {
                    Node::Analysis(_) => "of",
                    _ => "from",
                };
                let help = format!("add `thickness: 2` beside `{beside}`");
                return Err(vec![error.help(help)]);
            };
            let cutout = match value {
                Data::Region(region) => Cutout::planar(region.area.clone())
                    .map(Arc::new)
                    .map_err(|e| vec![failed(e.to_string(), "in this solid")])?,
                _ => wants::Cutout::of(action.value(reference)).expect("it is no region"),
            };
            let side = thickness.side.map_or(cutout.side, thickness_side);
            let (mesh, fold) = fretwork_solid::thicken(&cutout, amount, side)
                .map_err(|e| vec![failed(e.to_string(), "in this solid")])?;
            warnings.extend(fold.map(|found| overlap(action, name, found)));
            Ok(Model::of(name.clone(), mesh))
        }
        Value::Data(Data::Facade(facade)) => of_facade(facade, form, thickness.amount)
            .map_err(|e| vec![failed(e, "in this artifact")]),
        _ => Err(vec![action.unsupported(&format!("`{target}` as a solid"))]),
    }
}

/// Gives all parts of a model a look, where it says something.
pub fn give_look(model: &mut Model, look: &Look) {
    let Look { color, material } = look;
    let Some(color) = color.or(material.as_ref().map(|material| material.color)) else {
        return;
    };
    let [red, green, blue, alpha] = color.0;
    let plain = Material::of(
        format!("#{red:02x}{green:02x}{blue:02x}"),
        [red, green, blue],
    );
    let (metallic, roughness) = match material {
        Some(material) => (material.metallic.0, material.roughness.0),
        None => (plain.metallic, plain.roughness),
    };
    let number = model.add_material(Material {
        opacity: f64::from(alpha) / 255.0,
        metallic,
        roughness,
        ..plain
    });
    for part in &mut model.parts {
        part.material = Some(number);
    }
}

/// A facade in space. A solid is one with the meshes in its cells, which are sunk a little into it;
/// where they cannot be united they stay bodies of their own.
fn of_facade(facade: &Facade, form: Form, thickness: Option<f64>) -> Result<Model, String> {
    let back = thickness.unwrap_or(facade.layout.width.max(facade.layout.height) * BACK);
    let made = match form {
        Form::Scene => fretwork_facade::scene(facade),
        Form::Solid => fretwork_facade::relief(facade, back).map(united),
    };
    made.map_err(|e| e.to_string())
}

/// The parts of a model as one, the first united with all others.
fn united(model: Model) -> Model {
    let Some((first, others)) = model.parts.split_first() else {
        return model;
    };
    if others.is_empty() {
        return model;
    }
    let first_mesh = model.mesh(first);
    let united = if model.triangle_count() <= MOST_EXACT {
        let mut rest = Mesh::default();
        others
            .iter()
            .for_each(|part| rest.append(&model.mesh(part)));
        unite_touching(&[first_mesh, rest])
    } else {
        let rest = others.iter().map(|part| model.mesh(part));
        let meshes: Vec<Mesh> = std::iter::once(first_mesh).chain(rest).collect();
        combine(Operation::Union, &meshes)
    };
    match united {
        Ok(mesh) => Model::of(first.name.clone(), mesh),
        Err(_) => model,
    }
}

/// What is told of a mesh that is not closed, with help where it is that of a surface.
pub fn open_surface(value: &Value, told: Diagnostic, help: &str) -> Diagnostic {
    match value {
        Value::Data(Data::Surface(_)) => told.help(help),
        _ => told,
    }
}

/// The warning that a thickened cutout meets itself.
pub fn overlap(action: &Action, name: &str, overlap: Overlap) -> Diagnostic {
    let (at, why, help) = match overlap {
        Overlap::Fold(at) => (
            at,
            "it is bent too sharply for its height and thickness",
            "make it thinner or lower, or smooth the curve",
        ),
        Overlap::Crossing(at) => (
            at,
            "parts of its curve pass nearer to each other than its height and thickness allow",
            "make it thinner or lower, or lead the curve farther round itself",
        ),
    };
    let place = format!("near ({:.3}, {:.3}, {:.3})", at.x, at.y, at.z);
    Diagnostic::warning(format!("`{name}` overlaps itself {place}: {why}"))
        .at(action.span(), "in this solid")
        .help(help)
}
