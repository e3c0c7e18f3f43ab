//! Scenes and solids of whole facades, flat and along curves.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::slab::slab;
use super::{FormError, relief, scene};
use crate::tests::Sketch;
use fretwork_geometry::facade::{Facade, FacadeBody, FacadeShape, Relief};
use fretwork_geometry::mesh::{Material, Mesh, Model};
use fretwork_geometry::{CurveLabels, Curves, Point, Point3, Seed, SpaceCurve};

fn shape(name: &str, body: FacadeBody, offset: f64) -> FacadeShape {
    let material = Some(Material::of(name, [200, 100, 50]));
    FacadeShape {
        name: name.into(),
        body,
        offset,
        material,
        relief: Relief {
            width: 0.1,
            height: 0.05,
        },
    }
}

fn boxed(depth: f64, offset: f64) -> FacadeShape {
    shape("box", FacadeBody::Box { depth }, offset)
}

/// Walls with a window in each second column and a door over the middle.
fn facade(shapes: Vec<FacadeShape>, choose: impl Fn(u32, char) -> Option<u32>) -> Facade {
    let sketch = Sketch::new(10.0)
        .symbols(&["A 2 opaque", "B 1 opaque", "D 1 opaque"])
        .layer("walls", "A(BA)^k")
        .layer("door", "ede; d = D");
    let layout = sketch.solve();
    let shape_of = layout
        .cells
        .iter()
        .map(|cell| choose(cell.layer, cell.symbol_x))
        .collect();
    Facade {
        layout,
        shapes,
        shape_of,
        fills: BTreeMap::new(),
        images: Vec::new(),
        wrap: None,
    }
}

fn plain() -> Facade {
    facade(
        vec![boxed(0.3, 0.0), boxed(0.1, -0.2), boxed(0.5, 0.25)],
        |_, symbol| match symbol {
            'A' => Some(0),
            'B' => Some(1),
            _ => Some(2),
        },
    )
}

#[test]
fn equal_cells_share_a_body_and_hidden_ones_have_none() {
    let facade = plain();
    let model = scene(&facade).unwrap();
    let seen = facade.seen();
    assert_eq!(
        seen.iter().filter(|seen| !**seen).count(),
        1,
        "the window behind the door"
    );
    assert_eq!(model.parts.len(), facade.layout.cells.len() - 1);
    assert_eq!(model.bodies.len(), 3);
    let names: Vec<(&str, Option<&str>)> = model
        .parts
        .iter()
        .map(|p| (&*p.name, p.group.as_deref()))
        .collect();
    assert_eq!(
        (names[0], names[names.len() - 1]),
        (("AP", Some("walls")), ("DP", Some("door")))
    );
    // Upright: the front is at -y, the ground at z = 0.
    let bounds = model.bounds();
    assert!(
        bounds.min.distance(Point3::new(0.0, -0.75, 0.0)) < 1e-9,
        "{bounds:?}"
    );
    assert!(
        bounds.max.distance(Point3::new(10.0, 0.2, 3.0)) < 1e-9,
        "{bounds:?}"
    );
    assert!(
        model
            .parts
            .iter()
            .all(|part| model.mesh(part).check_closed().is_ok())
    );
}

#[test]
fn a_relief_is_one_closed_body_of_the_right_volume() {
    let facade = plain();
    let model = relief(&facade, 0.5).unwrap();
    assert_eq!(model.parts.len(), 1);
    let mesh = &model.bodies[0].mesh;
    assert_eq!(
        mesh.check_closed().map(|t| (t.components, t.genus)),
        Ok((1, Some(0)))
    );
    let widths = |symbol: char| -> f64 {
        facade
            .layout
            .cells
            .iter()
            .filter(|c| c.symbol_x == symbol)
            .map(|c| c.width)
            .sum()
    };
    let windows = widths('B') - widths('D');
    let expected = 3.0 * (widths('A') * 0.9 + windows * 0.5 + widths('D') * 1.35);
    assert!(
        (mesh.volume() - expected).abs() < 1e-6,
        "{} {expected}",
        mesh.volume()
    );
    assert!(mesh.bounds().min.distance(Point3::new(0.0, 0.0, -0.6)) < 1e-9);
}

#[test]
fn facades_go_round_circles_and_corners() {
    let mut facade = plain();
    facade.wrap = Some(SpaceCurve::circle(10.0 / std::f64::consts::TAU).unwrap());
    let tower = relief(&facade, 0.2).unwrap();
    let mesh = &tower.bodies[0].mesh;
    assert_eq!(
        mesh.check_closed().map(|t| (t.components, t.genus)),
        Ok((1, Some(1)))
    );
    let bounds = mesh.bounds();
    assert!(
        (bounds.max.z - 3.0).abs() < 1e-9 && bounds.max.x < 10.0 / std::f64::consts::TAU + 0.76,
        "{bounds:?}"
    );
    let model = scene(&facade).unwrap();
    assert!(
        model
            .parts
            .iter()
            .all(|part| model.mesh(part).check_closed().is_ok())
    );
    let square = [[0., 0., 0.], [2.5, 0., 0.], [2.5, 2.5, 0.], [0., 2.5, 0.]].map(Point3::from);
    facade.wrap = Some(SpaceCurve::new(square, true).unwrap());
    let house = relief(&facade, 0.2).unwrap();
    assert_eq!(
        house.bodies[0].mesh.check_closed().map(|t| t.genus),
        Ok(Some(1))
    );
    facade.wrap = Some(SpaceCurve::circle(0.7).unwrap());
    assert!(matches!(relief(&facade, 0.2), Err(FormError::Bend(_))));
    facade.wrap = Some(SpaceCurve::circle(10.0 / std::f64::consts::TAU).unwrap());
    assert!(
        matches!(relief(&facade, 2.0), Err(FormError::Bend(_))),
        "the plate is thicker than the tower"
    );
}

#[test]
fn lines_stand_out_of_their_cells_or_are_grooves() {
    let mut facade = plain();
    let cell = facade
        .layout
        .cells
        .iter()
        .position(|c| c.symbol_x == 'A')
        .unwrap();
    let mut lines = Curves::new();
    for i in 1..6 {
        let y = f64::from(i) * 0.5;
        lines.push(
            [[-1.0, y], [11.0, y]].map(Point::from),
            CurveLabels::default(),
        );
    }
    facade.fills.insert(cell as u32, Arc::new(lines));
    let without = relief(&plain(), 0.5).unwrap().volume();
    let width = facade.layout.cells[cell].width;
    for height in [0.05, -0.05] {
        facade.shapes[0].relief.height = height;
        let solid = relief(&facade, 0.5).unwrap();
        assert!(solid.bodies[0].mesh.check_closed().is_ok());
        let added = solid.volume() - without;
        assert!((added - 5.0 * 0.1 * width * height).abs() < 1e-6, "{added}");
        let model = scene(&facade).unwrap();
        let carved: f64 = model
            .parts
            .iter()
            .map(|part| model.mesh(part).volume())
            .sum();
        let smooth = scene(&plain()).unwrap();
        let smooth: f64 = smooth
            .parts
            .iter()
            .map(|part| smooth.mesh(part).volume())
            .sum();
        assert!((carved - smooth - 5.0 * 0.1 * width * height).abs() < 1e-6);
    }
    facade.wrap = Some(SpaceCurve::circle(10.0 / std::f64::consts::TAU).unwrap());
    let topology = relief(&facade, 0.2).unwrap().bodies[0].mesh.check_closed();
    assert_eq!(topology.map(|t| (t.components, t.genus)), Ok((1, Some(1))));
}

/// A wedge: high at its left and low at its right, its back at y = 2.
fn wedge() -> Mesh {
    let positions = [
        [1., 1., 0.],
        [3., 1., 0.],
        [3., 2., 0.],
        [1., 2., 0.],
        [1., 1., 4.],
        [1., 2., 4.],
    ];
    let triangles = vec![
        [0, 2, 1],
        [0, 3, 2],
        [0, 1, 4],
        [2, 3, 5],
        [1, 2, 5],
        [1, 5, 4],
        [0, 4, 5],
        [0, 5, 3],
    ];
    let mesh = Mesh {
        positions: positions.map(Point3::from).to_vec(),
        triangles,
    };
    assert!(mesh.check_closed().is_ok());
    mesh
}

#[test]
fn meshes_are_fitted_to_their_cells() {
    let mut facade = plain();
    facade.shapes[2] = shape(
        "wedge",
        FacadeBody::Mesh(Arc::new(Model::of("wedge", wedge()))),
        0.25,
    );
    let door = facade
        .layout
        .cells
        .iter()
        .find(|c| c.symbol_x == 'D')
        .cloned()
        .unwrap();
    let model = scene(&facade).unwrap();
    let part = model.parts.last().unwrap();
    let bounds = model.mesh(part).bounds();
    let depth = 1.0 * (door.width / 2.0).min(door.height / 4.0);
    assert!(
        bounds.min.distance(Point3::new(door.x, -0.25 - depth, 0.0)) < 1e-9,
        "{bounds:?}"
    );
    assert!(
        bounds
            .max
            .distance(Point3::new(door.x + door.width, -0.25, 3.0))
            < 1e-9,
        "{bounds:?}"
    );
    let solid = relief(&facade, 0.5).unwrap();
    assert_eq!(solid.parts.len(), 2);
    assert!(
        solid
            .parts
            .iter()
            .all(|part| solid.mesh(part).check_closed().is_ok())
    );
    let lying = solid.mesh(&solid.parts[1]).bounds();
    assert!(
        lying
            .min
            .distance(Point3::new(door.x, 0.0, 0.25 - 0.05 * 0.5))
            < 1e-9,
        "{lying:?}"
    );
    let mut open = wedge();
    open.triangles.pop();
    facade.shapes[2].body = FacadeBody::Mesh(Arc::new(Model::of("open", open)));
    assert!(matches!(relief(&facade, 0.5), Err(FormError::Mesh { .. })));
    assert!(scene(&facade).is_ok());
}

#[test]
fn bodies_of_a_mesh_that_touch_along_an_edge_are_a_solid() {
    let mut facade = plain();
    let mut pair = slab(&[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]).mesh;
    pair.append(&slab(&[1.0, 2.0], [1.0, 2.0], [0.0, 1.0]).mesh);
    assert!(pair.check_closed().is_ok() && pair.welded().check_closed().is_err());
    facade.shapes[2].body = FacadeBody::Mesh(Arc::new(Model::of("pair", pair)));
    let model = relief(&facade, 0.5).unwrap();
    assert!(model.parts.len() == 2 && model.mesh(&model.parts[1]).check_closed().is_ok());
}

#[test]
fn nothing_to_see_is_an_error() {
    let facade = facade(Vec::new(), |_, _| None);
    assert_eq!(scene(&facade).err(), Some(FormError::Empty));
    assert_eq!(relief(&facade, 1.0).err(), Some(FormError::Empty));
}

#[test]
fn reliefs_of_random_depths_are_closed() {
    for round in 0..60 {
        let seed = Seed::root(round).name("relief");
        let pick = |n: u64, most: u64| (seed.unit(n) * most as f64) as u64;
        let sketch = Sketch::new(9.0).symbols(&[
            "A 2 opaque",
            "B 1 opaque",
            "C 1.5",
            "P 2 opaque",
            "S 1 opaque",
        ]);
        let mut sketch = sketch;
        sketch.0.canvas[1] = 6.0;
        let sketch = sketch
            .grid("low", "A(BA)^k", "PSPS")
            .grid("high", "ecfce; c = C", "PSPS");
        let mut facade = Facade {
            layout: sketch.solve(),
            shapes: (0..4)
                .map(|i| {
                    boxed(
                        0.25 + 0.25 * pick(i, 4) as f64,
                        0.25 * pick(10 + i, 3) as f64 - 0.25,
                    )
                })
                .collect(),
            shape_of: Vec::new(),
            fills: BTreeMap::new(),
            images: Vec::new(),
            wrap: (round % 3 == 0)
                .then(|| SpaceCurve::circle(9.0 / std::f64::consts::TAU).unwrap()),
        };
        facade.shape_of = (0..facade.layout.cells.len() as u64)
            .map(|n| Some(pick(100 + n, 5) as u32).filter(|s| *s < 4))
            .collect();
        if facade.seen().contains(&true) {
            let model = relief(&facade, 0.25).unwrap();
            let mesh = &model.bodies[0].mesh;
            assert_eq!(mesh.check_closed().map(|t| t.components), Ok(1), "{round}");
        }
    }
}
