//! Facades as scenes: a part for every visible cell, in the group of its layer. Equal cells share a body.

use std::collections::BTreeMap;

use super::bend::Bend;
use super::error::FormError;
use super::moulding;
use super::ridge::ridges;
use super::run::{is_ring, runs};
use super::slab::{face, pictured, slab};
use super::terrace::{Patch, PatchHeight, Terrace};
use fretwork_geometry::facade::Moulding;
use fretwork_geometry::mesh::{Body, Model, Part};
use fretwork_geometry::{Affine3, Facade, FacadeBody, FacadeCell, FacadeShape, Point3, Polygon};

/// The scene of a facade, upright as seen from -y, or along its curve. Parts are named by their symbols
/// and belong to the groups of their layers.
///
/// # Errors
/// The curve does not fit, or no cell is visible.
pub fn scene(facade: &Facade) -> Result<Model, FormError> {
    let areas = facade.visible_areas()?;
    let mut scene = Scene {
        facade,
        bend: Bend::of(facade, Bend::upright(), 0.0)?,
        model: Model {
            images: facade.images.clone(),
            ..Model::default()
        },
        known: BTreeMap::new(),
    };
    for (low, high) in facade.shapes.iter().map(FacadeShape::extent) {
        scene.bend.check([0.0, facade.layout.width], low)?;
        scene.bend.check([0.0, facade.layout.width], high)?;
    }
    let runs = runs(facade, &areas);
    for (number, cell) in facade.layout.cells.iter().enumerate() {
        let Some(shape) = facade.shape(number).filter(|_| !areas[number].is_empty()) else {
            continue;
        };
        let pieces = match (&shape.body, ridges(facade, number, &areas[number])?) {
            (FacadeBody::Moulding(moulding), _) => match runs.get(&number) {
                Some(run) => scene.moulded(number, run, shape, moulding)?,
                None => continue,
            },
            (_, Some(ridges)) => vec![scene.carved(cell, shape, ridges)?],
            (_, None) => scene.shared(number, cell, shape)?,
        };
        let name = [cell.symbol_x, cell.symbol_y].iter().collect::<String>();
        let group = &facade.layout.layers[cell.layer as usize];
        scene
            .model
            .parts
            .extend(pieces.into_iter().map(|piece| Part {
                name: name.as_str().into(),
                group: Some(group.clone()),
                ..piece
            }));
    }
    if scene.model.parts.is_empty() {
        Err(FormError::Empty)
    } else {
        Ok(scene.model)
    }
}

/// What tells bodies apart: the shape and, along a curve, the place and size of the cell along it, its
/// height, and which way it is mirrored.
type Key = (u32, [u64; 3], [bool; 2]);

struct Scene<'a> {
    facade: &'a Facade,
    bend: Bend,
    model: Model,
    /// The parts that stand in cells, before they are named and placed.
    known: BTreeMap<Key, Vec<Part>>,
}

impl Scene<'_> {
    /// The parts that stand in a cell, with bodies shared by cells that are alike.
    fn shared(
        &mut self,
        number: usize,
        cell: &FacadeCell,
        shape: &FacadeShape,
    ) -> Result<Vec<Part>, FormError> {
        let id = self.facade.shape_of[number].expect("the cell has a shape");
        let sizes = [cell.x, cell.width, cell.height].map(f64::to_bits);
        let (key, place) = match &self.bend {
            Bend::Flat(_) => ((id, [0; 3], [false; 2]), fitted(shape, cell)),
            Bend::Along(_) => {
                let place = Affine3::translation(self.bend.up() * cell.y);
                ((id, sizes, [cell.mirrored_x, cell.mirrored_y]), place)
            }
        };
        if !self.known.contains_key(&key) {
            let made = match (&shape.body, &self.bend) {
                (FacadeBody::Mesh(own), Bend::Flat(_)) => self.adopt(own, shape),
                (FacadeBody::Mesh(own), Bend::Along(_)) => self.bent(id, own, shape, cell)?,
                (_, Bend::Flat(_)) => vec![self.piece(unit(shape), shape)],
                (_, Bend::Along(_)) => {
                    let body = bent(shape, &on_ground(cell), &self.bend);
                    vec![self.piece(body, shape)]
                }
            };
            self.known.insert(key, made);
        }
        Ok(self.standing(&key, &place))
    }

    /// The parts that are known under a key, moved by `place`.
    fn standing(&self, key: &Key, place: &Affine3) -> Vec<Part> {
        let moved = |part: &Part| Part {
            place: part.place.then(place),
            ..part.clone()
        };
        self.known[key].iter().map(moved).collect()
    }

    /// The part of a moulding that begins in a cell; those of one length share a body.
    fn moulded(
        &mut self,
        number: usize,
        run: &FacadeCell,
        shape: &FacadeShape,
        moulding: &Moulding,
    ) -> Result<Vec<Part>, FormError> {
        let id = self.facade.shape_of[number].expect("the cell has a shape");
        let mut ground = on_ground(run);
        let mut place = self.bend.up() * run.y;
        if let Bend::Flat(_) = self.bend {
            ground.x = 0.0;
            place.x = run.x;
        }
        let sizes = [ground.x, run.width, run.height].map(f64::to_bits);
        let key = (id, sizes, [run.mirrored_x, run.mirrored_y]);
        if !self.known.contains_key(&key) {
            let is_ring = is_ring(self.facade, &self.bend, run);
            let columns = self.bend.columns(&ground);
            let mesh = moulding::body(shape, moulding, &ground, &columns, is_ring)?;
            let mut body = self.bend.bent(Body::plain(mesh))?;
            if is_ring {
                body.mesh = body.mesh.welded();
            }
            let made = vec![self.piece(body, shape)];
            self.known.insert(key, made);
        }
        Ok(self.standing(&key, &Affine3::translation(place)))
    }

    /// The parts of a mesh in a cell along a curve, as if the cell stood on the ground.
    fn bent(
        &mut self,
        id: u32,
        own: &Model,
        shape: &FacadeShape,
        cell: &FacadeCell,
    ) -> Result<Vec<Part>, FormError> {
        // Materials and pictures are the same for all cells.
        let key = (id, [0; 3], [false; 2]);
        if !self.known.contains_key(&key) {
            let adopted = self.adopt(own, shape);
            self.known.insert(key, adopted);
        }
        let fitted = in_facade(shape, &on_ground(cell));
        let mut parts = self.known[&key].clone();
        for (part, source) in parts.iter_mut().zip(&own.parts) {
            let body = &own.bodies[source.body as usize];
            let body = body.transformed(&source.place.then(&fitted));
            part.body = self.model.add_body(self.bend.bent(body)?);
            part.place = Affine3::IDENTITY;
        }
        Ok(parts)
    }

    /// A new body in the material of a shape.
    fn piece(&mut self, body: Body, shape: &FacadeShape) -> Part {
        let body = self.model.add_body(body);
        let material = shape
            .material
            .clone()
            .unwrap_or_else(|| shape.default_material());
        let material = Some(self.model.add_material(material));
        Part {
            name: "".into(),
            group: None,
            body,
            material,
            place: Affine3::IDENTITY,
        }
    }

    /// The parts of a mesh, after its bodies and materials were added to the model.
    fn adopt(&mut self, own: &Model, shape: &FacadeShape) -> Vec<Part> {
        let first = self.model.parts.len();
        self.model.append(own, &Affine3::IDENTITY);
        let mut parts = self.model.parts.split_off(first);
        let default = shape
            .material
            .clone()
            .unwrap_or_else(|| shape.default_material());
        for part in parts
            .iter_mut()
            .filter(|part| part.material.is_none() || shape.material.is_some())
        {
            part.material = Some(self.model.add_material(default.clone()));
        }
        parts
    }

    /// The body of a cell with lines on its front.
    fn carved(
        &mut self,
        cell: &FacadeCell,
        shape: &FacadeShape,
        area: Vec<Polygon>,
    ) -> Result<Part, FormError> {
        let (back, front) = match shape.body {
            FacadeBody::Box { depth } => (shape.offset, shape.offset + depth),
            _ => (shape.offset - shape.relief.width, shape.offset),
        };
        let us = self.bend.columns(cell);
        let columns = us.len() - 1;
        let vs = [cell.y, cell.y + cell.height];
        let patch = Patch {
            area,
            within: vec![[0..columns, 0..1]],
            height: PatchHeight::Over(shape.relief.height),
        };
        let terrace = Terrace {
            x: us.clone(),
            y: vs.to_vec(),
            heights: vec![front; columns],
            patches: vec![patch],
            base: back.min(front + shape.relief.height - shape.relief.width),
            is_around: false,
        };
        let body = self.bend.moved(pictured(terrace.solid()?, &us, vs));
        Ok(self.piece(body, shape))
    }
}

/// The body of a shape in the unit cube.
fn unit(shape: &FacadeShape) -> Body {
    let body = match &shape.body {
        FacadeBody::Box { .. } => slab(&[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]),
        _ => face(&[0.0, 1.0], [0.0, 1.0], 0.0),
    };
    Bend::upright().moved(body)
}

/// The map from the unit body of a shape to its cell in a flat, upright facade.
fn fitted(shape: &FacadeShape, cell: &FacadeCell) -> Affine3 {
    let (low, size) = match &shape.body {
        FacadeBody::Box { depth } => (Point3::ORIGIN, Point3::new(1.0, 1.0 / depth, 1.0)),
        FacadeBody::Mesh(model) => {
            let bounds = model.bounds();
            (
                Point3::new(bounds.min.x, bounds.max.y, bounds.min.z),
                bounds.max - bounds.min,
            )
        }
        _ => (Point3::ORIGIN, Point3::new(1.0, 1.0, 1.0)),
    };
    let (width, height) = (cell.width / size.x, cell.height / size.z);
    let depth = match shape.body {
        FacadeBody::Box { depth } => depth,
        FacadeBody::Mesh(_) => width.min(height),
        _ => 1.0,
    };
    let turn = |mirrored: bool, scale: f64, at: f64, size: f64| {
        if mirrored {
            (-scale, at + size)
        } else {
            (scale, at)
        }
    };
    let (x, left) = turn(cell.mirrored_x, width, cell.x, cell.width);
    let (z, bottom) = turn(cell.mirrored_y, height, cell.y, cell.height);
    let scale = Affine3::scale(Point3::new(x, depth, z));
    let origin = Point3::new(left, -shape.offset, bottom) - scale.apply_vector(low);
    Affine3 { origin, ..scale }
}

/// The body of a shape in a cell along a curve.
fn bent(shape: &FacadeShape, cell: &FacadeCell, bend: &Bend) -> Body {
    let us = bend.columns(cell);
    let vs = [cell.y, cell.y + cell.height];
    let body = match &shape.body {
        FacadeBody::Box { depth } => slab(&us, vs, [shape.offset, shape.offset + depth]),
        _ => face(&us, vs, shape.offset),
    };
    let uv = body.uv.map(|uv| {
        let turn = |t: f32, mirrored: bool| if mirrored { 1.0 - t } else { t };
        let turned = |[u, v]: [f32; 2]| [turn(u, cell.mirrored_x), turn(v, cell.mirrored_y)];
        uv.into_iter().map(|corners| corners.map(turned)).collect()
    });
    bend.moved(Body { uv, ..body })
}

/// The map from a mesh's own coordinates to its cell in the facade's: u to the right, v up, w out of its
/// plane.
pub fn in_facade(shape: &FacadeShape, cell: &FacadeCell) -> Affine3 {
    let upright = Affine3 {
        x: Point3::new(1.0, 0.0, 0.0),
        y: Point3::new(0.0, 0.0, -1.0),
        z: Point3::new(0.0, 1.0, 0.0),
        origin: Point3::ORIGIN,
    };
    fitted(shape, cell).then(&upright)
}

/// A cell as if it were in the lowest row.
fn on_ground(cell: &FacadeCell) -> FacadeCell {
    FacadeCell {
        y: 0.0,
        ..cell.clone()
    }
}
