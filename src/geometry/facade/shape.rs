//! A facade as it is seen: a layout, and what stands in its cells.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{Cover, FacadeCell, FacadeLayout, Moulding};
use crate::mesh::{Image, Material, Model};
use crate::polygon::{AreaError, unite};
use crate::{Curves, Point, Polygon, SpaceCurve};

/// A laid out facade with its shapes. Its elevation is the drawing plane (y down) with the canvas at
/// (0, 0): y = 0 is the upper side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Facade {
    /// Which cells there are.
    pub layout: FacadeLayout,
    /// What can stand in a cell.
    pub shapes: Vec<FacadeShape>,
    /// The number of the shape of each cell; none where nothing stands.
    pub shape_of: Vec<Option<u32>>,
    /// Lines on the fronts of cells, by the number of the cell, in the elevation's plane; they may leave the cell.
    pub fills: BTreeMap<u32, Arc<Curves>>,
    /// The pictures that materials name.
    pub images: Vec<Image>,
    /// The curve that the facade is laid along; flat without one.
    pub wrap: Option<SpaceCurve>,
}

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FacadeShape {
    /// What it is called.
    pub name: Arc<str>,
    /// Its form.
    pub body: FacadeBody,
    /// How far its back is out of the facade's plane.
    pub offset: f64,
    /// How it looks; without one grey, or as the mesh says.
    pub material: Option<Material>,
    /// How the lines of fills stand out.
    pub relief: Relief,
}

/// The form of what stands in a cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FacadeBody {
    /// A flat face.
    Plane,
    /// A box.
    Box {
        /// Its extent out of the facade's plane.
        depth: f64,
    },
    /// Meshes, which are scaled to the cell together: x runs along its width, z up, and they are seen from -y.
    Mesh(Arc<Model>),
    /// A cross-section that runs along cells, or around one.
    Moulding(Arc<Moulding>),
}

/// How lines stand out of a face.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Relief {
    /// How wide they are.
    pub width: f64,
    /// How far they stand out; below 0 they are grooves.
    pub height: f64,
}

/// The colour of shapes that have none.
const GREY: [u8; 3] = [0xcc, 0xcc, 0xcc];

impl FacadeShape {
    /// Its sRGB colour: that of its material, or the first of its meshes.
    pub fn color(&self) -> [u8; 3] {
        let inner = match &self.body {
            FacadeBody::Mesh(model) => model.materials.first(),
            FacadeBody::Plane | FacadeBody::Box { .. } | FacadeBody::Moulding(_) => None,
        };
        self.material
            .as_ref()
            .or(inner)
            .map_or(GREY, |material| material.color)
    }

    /// The material that it has if nothing else is said.
    pub fn default_material(&self) -> Material {
        Material::of(self.name.clone(), GREY)
    }

    /// How far its back and its front are out of the facade's plane; a mesh or a moulding counts as flat.
    pub fn extent(&self) -> (f64, f64) {
        match self.body {
            FacadeBody::Box { depth } => (self.offset, self.offset + depth),
            _ => (self.offset, self.offset),
        }
    }
}

impl Facade {
    /// How far what stands in cells is out of the facade's plane at most, and how far behind it.
    pub fn reach(&self) -> [f64; 2] {
        let cells = self.layout.cells.iter().zip(&self.shape_of);
        let of_cell = |(cell, number): (&FacadeCell, &Option<u32>)| {
            let shape = &self.shapes[(*number)? as usize];
            let beyond = match &shape.body {
                FacadeBody::Mesh(model) => {
                    let bounds = model.bounds();
                    let size = bounds.max - bounds.min;
                    size.y * (cell.width / size.x).min(cell.height / size.z)
                }
                FacadeBody::Moulding(moulding) => {
                    let rings = moulding.profile.iter().flat_map(|part| &part.outer);
                    rings.fold(0.0, |out, p| p.x.max(out)) * moulding.scale(cell)
                }
                FacadeBody::Plane | FacadeBody::Box { .. } => 0.0,
            };
            let (low, high) = shape.extent();
            Some([high + beyond + shape.relief.height.max(0.0), -low])
        };
        let greater = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.max(c), b.max(d)];
        cells.filter_map(of_cell).fold([0.0; 2], greater)
    }

    /// The shape in a cell.
    pub fn shape(&self, cell: usize) -> Option<&FacadeShape> {
        self.shape_of[cell].map(|number| &self.shapes[number as usize])
    }

    /// Whether something stands in a cell and is not wholly covered by opaque shapes of the layers above it, per cell.
    pub fn seen(&self) -> Vec<bool> {
        let cover = Cover::new(&self.layout, |cell| self.hides(cell));
        let cells = self.layout.cells.iter().enumerate();
        cells
            .map(|(number, cell)| self.shape_of[number].is_some() && !cover.hides(cell))
            .collect()
    }

    /// What is seen of each cell in the elevation's plane: nothing of those that are hidden or empty.
    ///
    /// # Errors
    /// When the areas cannot be computed.
    pub fn visible_areas(&self) -> Result<Vec<Vec<Polygon>>, AreaError> {
        let cover = Cover::new(&self.layout, |cell| self.hides(cell));
        let area = |(number, cell): (usize, &super::FacadeCell)| {
            if self.shape_of[number].is_none() {
                return Ok(Vec::new());
            }
            match cover.uncovered(cell) {
                None => Ok(vec![self.rectangle(
                    [cell.x, cell.y],
                    [cell.x + cell.width, cell.y + cell.height],
                )]),
                Some(parts) => unite(
                    &parts
                        .iter()
                        .map(|(low, high)| self.rectangle(*low, *high))
                        .collect::<Vec<_>>(),
                ),
            }
        };
        self.layout.cells.iter().enumerate().map(area).collect()
    }

    /// A rectangle of the canvas in the elevation's plane.
    pub fn rectangle(&self, low: [f64; 2], high: [f64; 2]) -> Polygon {
        let (bottom, top) = (self.layout.height - low[1], self.layout.height - high[1]);
        let corners = [
            [low[0], top],
            [high[0], top],
            [high[0], bottom],
            [low[0], bottom],
        ];
        Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: Vec::new(),
        }
    }

    /// Whether a cell hides what is below it: it is opaque, and something stands in it that is not seen through.
    fn hides(&self, cell: usize) -> bool {
        self.layout.cells[cell].opaque
            && self.shape(cell).is_some_and(|shape| {
                shape
                    .material
                    .as_ref()
                    .is_none_or(|look| look.opacity >= 1.0)
            })
    }
}
