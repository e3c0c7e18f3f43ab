//! What is drawn of the meshes in a facade's cells: their visible lines as they are seen from the front, fitted to the cells.
//! What covers a cell is known to the facade, and which layer lines come to to `elevation`.

use std::collections::BTreeMap;

use fretwork_geometry::facade::{Facade, FacadeBody};
use fretwork_geometry::mesh::{Wanted, line_drawing};
use fretwork_geometry::{Affine, Bounds, CurveLabels, Curves, Point3, View};

/// The cosine of the angle between two faces, from which on their edge is drawn: 30°.
const CREASE: f64 = 0.866_025_403_784_438_6;

/// The lines of the shapes that are meshes.
pub struct MeshLines<'a> {
    facade: &'a Facade,
    /// By the numbers of shapes: the lines, and the box that is fitted to a cell.
    drawn: BTreeMap<u32, (Curves, Bounds)>,
}

impl<'a> MeshLines<'a> {
    /// The lines of all shapes of a facade that stand in a cell.
    pub fn new(facade: &'a Facade) -> MeshLines<'a> {
        let front = View::from(Point3::new(0.0, -1.0, 0.0)).expect("the direction has a length");
        let wanted = Wanted {
            crease: CREASE,
            hidden: false,
        };
        let mut drawn = BTreeMap::new();
        for number in facade.shape_of.iter().flatten() {
            let FacadeBody::Mesh(model) = &facade.shapes[*number as usize].body else {
                continue;
            };
            drawn.entry(*number).or_insert_with(|| {
                let mut curves = Curves::new();
                for line in line_drawing(&model.merged(), &front, wanted) {
                    curves.push(line.points, CurveLabels::default());
                }
                let space = model.bounds();
                let corners = [space.min, space.max].map(|corner| front.flat(corner));
                (curves, Bounds::of(corners))
            });
        }
        MeshLines { facade, drawn }
    }

    /// The lines in a cell, in the elevation's plane; none where no mesh stands in it.
    pub fn in_cell(&self, number: usize) -> Option<Curves> {
        let (curves, from) = self.drawn.get(&self.facade.shape_of[number]?)?;
        let cell = &self.facade.layout.cells[number];
        let top = self.facade.layout.height - cell.y - cell.height;
        let along = |mirrored: bool, low: f64, size: f64, to: f64, length: f64| {
            let factor = length / size;
            if mirrored {
                (-factor, to + length + low * factor)
            } else {
                (factor, to - low * factor)
            }
        };
        let (x, left) = along(
            cell.mirrored_x,
            from.min.x,
            from.width(),
            cell.x,
            cell.width,
        );
        let (y, down) = along(cell.mirrored_y, from.min.y, from.height(), top, cell.height);
        let map = Affine([x, 0.0, 0.0, y, left, down]);
        let is_flat = !(x.is_finite() && y.is_finite());
        (!is_flat).then(|| curves.transformed(&map))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use fretwork_geometry::facade::{FacadeCell, FacadeLayout, FacadeShape, Relief};
    use fretwork_geometry::{Mesh, Model};

    /// A roof of two sides whose ridge runs up at a quarter of its width.
    fn roof() -> Mesh {
        let corners = [
            [0., 0., 0.],
            [1., -2., 0.],
            [4., 0., 0.],
            [0., 0., 2.],
            [1., -2., 2.],
            [4., 0., 2.],
        ];
        Mesh {
            positions: corners.map(Point3::from).to_vec(),
            triangles: vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]],
        }
    }

    #[test]
    fn lines_of_a_mesh_are_fitted_to_its_cell_and_mirrored_with_it() {
        let cell = |x: f64, mirrored_x: bool| FacadeCell {
            layer: 0,
            symbol_x: 'A',
            symbol_y: 'A',
            x,
            y: 1.0,
            width: 2.0,
            height: 3.0,
            opaque: true,
            mirrored_x,
            mirrored_y: false,
        };
        let facade = Facade {
            layout: FacadeLayout {
                width: 4.0,
                height: 5.0,
                x: vec![0.0, 2.0, 4.0],
                y: vec![0.0, 5.0],
                layers: vec!["wall".into()],
                cells: vec![cell(0.0, false), cell(2.0, true)],
                alignment_error: 0.0,
                size_error: 0.0,
            },
            shapes: vec![FacadeShape {
                name: "roof".into(),
                body: FacadeBody::Mesh(Arc::new(Model::of("roof", roof()))),
                offset: 0.0,
                material: None,
                relief: Relief {
                    width: 0.1,
                    height: 0.1,
                },
            }],
            shape_of: vec![Some(0), Some(0)],
            fills: BTreeMap::new(),
            images: Vec::new(),
            wrap: None,
        };
        let lines = MeshLines::new(&facade);
        for (number, ridge, from) in [(0, 0.5, 0.0), (1, 3.5, 2.0)] {
            let curves = lines.in_cell(number).unwrap();
            let bounds = curves.bounds();
            assert_eq!((bounds.min.x, bounds.max.x), (from, from + 2.0));
            assert_eq!((bounds.min.y, bounds.max.y), (1.0, 4.0));
            let upright = curves.iter().flat_map(|c| c.points.windows(2));
            let is_ridge = |w: &&[fretwork_geometry::Point]| {
                (w[0].x - ridge).abs() < 1e-9 && (w[1].x - ridge).abs() < 1e-9
            };
            assert_eq!(upright.filter(is_ridge).count(), 1);
        }
    }
}
