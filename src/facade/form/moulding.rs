//! The bodies of mouldings: a cross-section swept along a cell, or around its border.

use super::error::FormError;
use fretwork_geometry::facade::{Moulding, Run};
use fretwork_geometry::mesh::{Mesh, TriangulationError, open_sides, triangulate};
use fretwork_geometry::{FacadeCell, FacadeShape, Point, Point3, Polygon};

/// The body of a moulding in a cell, in the coordinates of the facade: u to the right, v up, w out of its
/// plane. Along a row the cross-section is scaled to the cell's height, along a column to its width. Around
/// a cell it has the size that it is drawn with, and its corners are mitred. `columns` are the sides of the
/// cell and the bends between them. A row that is a ring has no ends.
///
/// # Errors
/// The cross-section cannot be filled, or is too high to go around the cell.
pub fn body(
    shape: &FacadeShape,
    moulding: &Moulding,
    cell: &FacadeCell,
    columns: &[f64],
    is_ring: bool,
) -> Result<Mesh, FormError> {
    let sweep = Sweep {
        stations: stations(shape, moulding, cell, columns)?,
        out: moulding.scale(cell),
        offset: shape.offset,
        is_loop: moulding.run == Run::Frame,
        has_ends: moulding.run != Run::Frame && !(is_ring && moulding.run == Run::Row),
    };
    let mut mesh = Mesh::default();
    for polygon in &moulding.profile {
        sweep
            .push(&mut mesh, polygon)
            .map_err(|error| FormError::Profile {
                shape: shape.name.to_string(),
                error,
            })?;
    }
    // A sweep faces outward where its cross-section, seen on its way, turns from out to up to the right.
    let is_turned = match moulding.run {
        Run::Row => cell.mirrored_y,
        Run::Column => !cell.mirrored_x,
        Run::Frame => true,
    };
    Ok(if is_turned { mesh.reversed() } else { mesh })
}

/// Where a cross-section stands: the place of its lower edge in the facade's plane, and the way from there
/// for one unit of its height.
struct Station {
    foot: Point,
    across: Point,
}

fn stations(
    shape: &FacadeShape,
    moulding: &Moulding,
    cell: &FacadeCell,
    columns: &[f64],
) -> Result<Vec<Station>, FormError> {
    let low = Point::new(cell.x, cell.y);
    let high = Point::new(cell.x + cell.width, cell.y + cell.height);
    let scale = moulding.scale(cell);
    let across = |mirrored: bool, low: f64, high: f64| match mirrored {
        false => (low, scale),
        true => (high, -scale),
    };
    Ok(match moulding.run {
        Run::Row => {
            let (v, up) = across(cell.mirrored_y, low.y, high.y);
            let station = |u: &f64| Station {
                foot: Point::new(*u, v),
                across: Point::new(0.0, up),
            };
            columns.iter().map(station).collect()
        }
        Run::Column => {
            let (u, right) = across(cell.mirrored_x, low.x, high.x);
            let station = |v: f64| Station {
                foot: Point::new(u, v),
                across: Point::new(right, 0.0),
            };
            vec![station(low.y), station(high.y)]
        }
        Run::Frame => {
            if !moulding.leaves_opening([cell.width, cell.height]) {
                return Err(FormError::Frame {
                    shape: shape.name.to_string(),
                    height: moulding.height,
                    cell: [cell.width, cell.height],
                });
            }
            let corner = |right: bool, up: bool| {
                let outward = |positive: bool| if positive { 1.0 } else { -1.0 };
                let across = Point::new(outward(right), outward(up));
                let at = Point::new(
                    if right { high.x } else { low.x },
                    if up { high.y } else { low.y },
                );
                Station {
                    foot: at - across * moulding.height,
                    across,
                }
            };
            let around = [(false, false), (true, false), (true, true), (false, true)];
            around.map(|(right, up)| corner(right, up)).into()
        }
    })
}

/// A cross-section's way.
struct Sweep {
    stations: Vec<Station>,
    out: f64,
    offset: f64,
    /// Whether the way comes back to its first station.
    is_loop: bool,
    has_ends: bool,
}

impl Sweep {
    /// Adds the body of one polygon of the cross-section. O(n log n) in its corners.
    fn push(&self, mesh: &mut Mesh, polygon: &Polygon) -> Result<(), TriangulationError> {
        let base = triangulate(polygon)?;
        let first = mesh.positions.len() as u32;
        let count = polygon.rings().map(Vec::len).sum::<usize>() as u32;
        for station in &self.stations {
            mesh.positions.extend(polygon.rings().flatten().map(|p| {
                let foot = station.foot + station.across * p.y;
                Point3::new(foot.x, foot.y, self.offset + p.x * self.out)
            }));
        }
        let stations = self.stations.len() as u32;
        let steps = if self.is_loop { stations } else { stations - 1 };
        for [a, b] in open_sides(&base) {
            for step in 0..steps {
                let (from, to) = (first + step * count, first + (step + 1) % stations * count);
                mesh.triangles.push([from + b, from + a, to + a]);
                mesh.triangles.push([from + b, to + a, to + b]);
            }
        }
        if self.has_ends {
            let last = first + (stations - 1) * count;
            for [a, b, c] in base {
                mesh.triangles.push([first + a, first + b, first + c]);
                mesh.triangles.push([last + a, last + c, last + b]);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{relief, scene};
    use super::*;
    use crate::tests::Sketch;
    use fretwork_geometry::facade::Relief;
    use fretwork_geometry::{Facade, FacadeBody, SpaceCurve};
    use std::sync::Arc;

    /// A cross-section 2 deep and 1 high, of area 1.5, with a chamfer above.
    fn shape(run: Run) -> FacadeShape {
        let corners = [[5.0, 3.0], [6.0, 3.0], [7.0, 4.0], [5.0, 4.0]];
        let area = Polygon {
            outer: corners.map(Point::from).to_vec(),
            holes: Vec::new(),
        };
        FacadeShape {
            name: "cornice".into(),
            body: FacadeBody::Moulding(Arc::new(Moulding::of(&[area], run).unwrap())),
            offset: 0.25,
            material: None,
            relief: Relief {
                width: 0.1,
                height: 0.1,
            },
        }
    }

    /// Four cells of 3 beside one another, 3 high, of which `empty` hold nothing.
    fn row(run: Run, empty: &[usize], wrap: Option<SpaceCurve>) -> Facade {
        let sketch = Sketch::new(12.0)
            .symbols(&["A 3 opaque"])
            .layer("all", "AAAA");
        let layout = sketch.solve();
        let filled = |cell| (!empty.contains(&cell)).then_some(0);
        Facade {
            shape_of: (0..layout.cells.len()).map(filled).collect(),
            layout,
            shapes: vec![shape(run)],
            fills: Default::default(),
            images: Vec::new(),
            wrap,
        }
    }

    fn square() -> SpaceCurve {
        let corners = [[0., 0., 0.], [3., 0., 0.], [3., 3., 0.], [0., 3., 0.]];
        SpaceCurve::new(corners.map(Point3::from), true).unwrap()
    }

    #[test]
    fn a_moulding_runs_through_the_cells_of_a_row_and_stops_where_none_is() {
        let model = scene(&row(Run::Row, &[2], None)).unwrap();
        assert_eq!((model.parts.len(), model.bodies.len()), (2, 2));
        let volumes: Vec<f64> = model.parts.iter().map(|p| model.mesh(p).volume()).collect();
        // The cross-section is three times as large as it is drawn.
        for (volume, length) in volumes.iter().zip([6.0, 3.0]) {
            assert!((volume - 9.0 * 1.5 * length).abs() < 1e-9, "{volume}");
        }
        let bounds = model.bounds();
        assert!(
            bounds.min.distance(Point3::new(0.0, -6.25, 0.0)) < 1e-9,
            "{bounds:?}"
        );
        assert!(
            bounds.max.distance(Point3::new(12.0, -0.25, 3.0)) < 1e-9,
            "{bounds:?}"
        );
        // Below, it is deeper than above.
        let deepest = model.mesh(&model.parts[0]);
        let mut front = deepest.positions.iter().filter(|p| p.y < -6.0);
        assert!(front.all(|p| p.z < 1e-9));
        assert_eq!(scene(&row(Run::Column, &[], None)).unwrap().parts.len(), 4);
    }

    #[test]
    fn a_moulding_around_a_house_is_mitred_and_has_no_ends() {
        let model = scene(&row(Run::Row, &[], Some(square()))).unwrap();
        let mesh = model.mesh(&model.parts[0]);
        assert_eq!(model.parts.len(), 1);
        let topology = mesh.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(1)));
        // Along the walls the whole cross-section, and in each corner of the square what is twice its moment
        // about the wall.
        let (area, moment) = (
            9.0 * 1.5,
            27.0 * (0.5 + (0.5 + 1.0 / 6.0)) + 0.25 * 9.0 * 1.5,
        );
        assert!(
            (mesh.volume() - (12.0 * area + 8.0 * moment)).abs() < 1e-6,
            "{}",
            mesh.volume()
        );
        let solid = relief(&row(Run::Row, &[], Some(square())), 0.5).unwrap();
        assert_eq!(solid.parts.len(), 2);
        assert!(
            solid
                .parts
                .iter()
                .all(|part| solid.mesh(part).check_closed().is_ok())
        );
    }

    #[test]
    fn frames_are_mitred_and_must_leave_an_opening() {
        let facade = row(Run::Frame, &[1, 2, 3], None);
        let mesh = scene(&facade).unwrap().merged();
        let topology = mesh.check_closed().unwrap();
        assert_eq!((topology.components, topology.genus), (1, Some(1)));
        // Pappus: the length around at the height of the centroid, which is 0.444 up.
        let around = 4.0 * (3.0 - 2.0 * (1.0 - 4.0 / 9.0));
        assert!(
            (mesh.volume() - 1.5 * around).abs() < 1e-9,
            "{}",
            mesh.volume()
        );
        let mut narrow = facade;
        narrow.layout.cells[0].width = 2.0;
        assert!(matches!(scene(&narrow), Err(FormError::Frame { .. })));
    }

    #[test]
    fn mirrored_mouldings_still_face_outward() {
        for run in [Run::Row, Run::Column, Run::Frame] {
            for turn in 0..4 {
                let mut facade = row(run, &[], None);
                for cell in &mut facade.layout.cells {
                    (cell.mirrored_x, cell.mirrored_y) = (turn & 1 == 1, turn & 2 == 2);
                }
                let model = scene(&facade).unwrap();
                assert!(model.parts.iter().all(|part| {
                    let mesh = model.mesh(part);
                    mesh.check_closed().is_ok() && mesh.volume() > 0.0
                }));
            }
        }
    }
}
