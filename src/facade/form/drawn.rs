//! What stands in the cells of a facade, as it is drawn in its elevation.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::error::FormError;
use super::moulding;
use super::scene::in_facade;
use fretwork_geometry::mesh::{Mesh, Wanted, line_drawing};
use fretwork_geometry::{
    CurveLabels, Curves, Facade, FacadeBody, FacadeCell, FacadeShape, Point, Point3, View,
};

/// The cosine of the angle at which an edge of a shape is drawn: 30°, as of projections.
const CREASE: f64 = 0.866;
/// What is nearer to a side of its cell than this part of the cell's longer side lies on it.
const ON_SIDE: f64 = 1e-6;

/// The edges that are seen of the meshes and mouldings in some cells, by the number of the cell, in the plane
/// of the elevation. What lies on the sides of a cell is left out: they are drawn themselves.
///
/// # Errors
/// A moulding that does not fit.
pub fn drawn(
    facade: &Facade,
    cells: impl IntoIterator<Item = usize>,
) -> Result<BTreeMap<usize, Curves>, FormError> {
    let mut known: BTreeMap<_, Vec<Vec<Point>>> = BTreeMap::new();
    let mut all = BTreeMap::new();
    for number in cells {
        let cell = &facade.layout.cells[number];
        let Some(shape) = facade.shape(number) else {
            continue;
        };
        let sizes = [cell.width, cell.height].map(f64::to_bits);
        let turn = [cell.mirrored_x, cell.mirrored_y];
        let key = (facade.shape_of[number], sizes, turn);
        let lines = match known.entry(key) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => match in_cell(shape, &at_origin(cell))? {
                Some(mesh) => place.insert(edges(&mesh, cell)),
                None => continue,
            },
        };
        let bottom = facade.layout.height - cell.y;
        let mut curves = Curves::new();
        for line in &*lines {
            let moved = line.iter().map(|p| *p + Point::new(cell.x, bottom));
            curves.push(moved, CurveLabels::default());
        }
        all.insert(number, curves);
    }
    Ok(all)
}

fn at_origin(cell: &FacadeCell) -> FacadeCell {
    FacadeCell {
        x: 0.0,
        y: 0.0,
        ..cell.clone()
    }
}

/// The mesh of a shape in a cell, in the coordinates of the facade; none of a box or a plane, which are
/// as their cells.
fn in_cell(shape: &FacadeShape, cell: &FacadeCell) -> Result<Option<Mesh>, FormError> {
    match &shape.body {
        FacadeBody::Mesh(model) => Ok(Some(model.merged().transformed(&in_facade(shape, cell)))),
        FacadeBody::Moulding(own) => {
            let columns = [cell.x, cell.x + cell.width];
            moulding::body(shape, own, cell, &columns, false).map(Some)
        }
        FacadeBody::Plane | FacadeBody::Box { .. } => Ok(None),
    }
}

/// The edges that are seen of a mesh in a cell with its lower left corner at the origin, y down.
fn edges(mesh: &Mesh, cell: &FacadeCell) -> Vec<Vec<Point>> {
    let front = View::from(Point3::new(0.0, 0.0, 1.0)).expect("the direction has a length");
    let wanted = Wanted {
        crease: CREASE,
        hidden: false,
    };
    let slack = ON_SIDE * cell.width.max(cell.height);
    let on_side = |a: Point, b: Point| {
        let both = |v: fn(Point) -> f64, side: f64| {
            (v(a) - side).abs() <= slack && (v(b) - side).abs() <= slack
        };
        [0.0, cell.width].iter().any(|side| both(|p| p.x, *side))
            || [0.0, -cell.height].iter().any(|side| both(|p| p.y, *side))
    };
    let drawing = line_drawing(mesh, &front, wanted);
    let parts = drawing.iter().flat_map(|line| {
        let runs = line.points.chunk_by(move |a, b| !on_side(*a, *b));
        runs.map(<[Point]>::to_vec)
    });
    parts.filter(|part| part.len() > 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::Sketch;
    use fretwork_geometry::facade::Relief;
    use fretwork_geometry::{Affine3, Model};
    use std::sync::Arc;

    /// A box with a smaller one before it, both in a cell of 4 x 2 at (4, 0).
    #[test]
    fn the_edges_of_a_mesh_lie_in_its_cell_and_not_on_its_sides() {
        let block = |size: f64, depth: f64, at: [f64; 3]| {
            let unit = super::super::slab::slab(&[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]).mesh;
            // From the facade's coordinates to those of a mesh: z up, seen from -y.
            let upright = Affine3 {
                x: Point3::new(size, 0.0, 0.0),
                y: Point3::new(0.0, 0.0, size),
                z: Point3::new(0.0, -depth, 0.0),
                origin: at.into(),
            };
            unit.transformed(&upright)
        };
        let mut mesh = block(4.0, 1.0, [0.0; 3]);
        mesh.append(&block(2.0, 1.0, [1.0, -1.0, 1.0]));
        let sketch = Sketch::new(8.0).symbols(&["A 4 opaque"]).layer("all", "AA");
        let layout = sketch.solve();
        let height = layout.height;
        let facade = Facade {
            shape_of: vec![None, Some(0)],
            layout,
            shapes: vec![FacadeShape {
                name: "A".into(),
                body: FacadeBody::Mesh(Arc::new(Model::of("block", mesh))),
                offset: 0.0,
                material: None,
                relief: Relief {
                    width: 0.1,
                    height: 0.1,
                },
            }],
            fills: BTreeMap::new(),
            images: Vec::new(),
            wrap: None,
        };
        let drawn = drawn(&facade, 0..2).unwrap();
        assert_eq!(drawn.keys().copied().collect::<Vec<_>>(), [1]);
        let curves = &drawn[&1];
        let sides = curves.iter().flat_map(|line| line.points.windows(2));
        let length: f64 = sides.map(|side| side[0].distance(side[1])).sum();
        let (wide, high) = (4.0 / 2.0, height / 2.0);
        assert!((length - 2.0 * (wide + high)).abs() < 1e-9, "{length}");
        let bounds = fretwork_geometry::Bounds::of(curves.points().iter().copied());
        assert!(
            bounds.min.distance(Point::new(5.0, 0.25 * height)) < 1e-9,
            "{bounds:?}"
        );
        assert!(
            bounds.max.distance(Point::new(7.0, 0.75 * height)) < 1e-9,
            "{bounds:?}"
        );
    }
}
