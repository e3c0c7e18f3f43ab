//! What an arrangement is applied to.

use std::cell::OnceCell;
use std::sync::Arc;

use starlark::eval::Evaluator;
use starlark::values::{Value, ValueLike};

use crate::cells;
use crate::script::operators::arguments::kind;
use fretwork_geometry::{FaceId, PlanarMap, Polygon, Region};
use fretwork_script::session::{cell_value, refuse, session};
use fretwork_script::values::{Cell, CellKind, RegionValue};

/// A region as the operators see it and as the script does; each is made when it is asked for.
pub(crate) struct Place<'v> {
    region: OnceCell<Arc<Region>>,
    value: OnceCell<Value<'v>>,
    face: Option<Cell>,
}

impl<'v> Place<'v> {
    /// The region that `value` is: a bounded face, or a region of several pieces.
    pub fn of(value: Value<'v>, eval: &Evaluator<'v, '_, '_>) -> starlark::Result<Place<'v>> {
        if let Some(region) = value.downcast_ref::<RegionValue>() {
            return Ok(Place {
                region: region.0.clone().into(),
                value: value.into(),
                face: None,
            });
        }
        match value.downcast_ref::<Cell>() {
            Some(cell) if cell.kind == CellKind::Face && cell.id != FaceId::UNBOUNDED.0 => {
                session(eval).map(*cell)?;
                Ok(Place {
                    region: OnceCell::new(),
                    value: value.into(),
                    face: Some(*cell),
                })
            }
            Some(cell) if cell.kind == CellKind::Face => Err(refuse(
                "an arrangement cannot be applied to the unbounded face",
            )),
            _ => Err(refuse(format!(
                "an arrangement is applied to a face, not to {}",
                kind(value)
            ))),
        }
    }

    /// A region from outside.
    pub fn region_of(region: Arc<Region>) -> Place<'v> {
        Place {
            region: region.into(),
            value: OnceCell::new(),
            face: None,
        }
    }

    /// For operators.
    pub fn region(&self, eval: &Evaluator<'v, '_, '_>) -> starlark::Result<Arc<Region>> {
        if let Some(region) = self.region.get() {
            return Ok(region.clone());
        }
        let face = self
            .face
            .ok_or_else(|| refuse("this face is of a finished evaluation"))?;
        let tile = session(eval).scale().snap.tile();
        let region = session(eval).with_map(face, |map| {
            Arc::new(cells::face_region(map, FaceId(face.id), tile))
        })?;
        Ok(self.region.get_or_init(|| region).clone())
    }

    /// For the script: a region of one piece is a face of the planar map of its contour.
    pub fn value(&self, eval: &Evaluator<'v, '_, '_>) -> starlark::Result<Value<'v>> {
        if let Some(value) = self.value.get() {
            return Ok(*value);
        }
        let region = self.region(eval)?;
        let resolution = session(eval).scale().resolution;
        let map =
            PlanarMap::build(&region.contour, resolution).map_err(starlark::Error::new_other)?;
        let area: f64 = region.area.iter().map(Polygon::area).sum();
        let face = map
            .bounded_faces()
            .find(|f| (map.face_area(*f) - area).abs() <= 1e-6 * area.abs());
        let value = match face {
            Some(face) => cell_value(
                CellKind::Face,
                session(eval).add_map(Arc::new(map)),
                face.0,
                eval,
            ),
            None => eval.heap().alloc(RegionValue(region)),
        };
        Ok(*self.value.get_or_init(|| value))
    }
}
