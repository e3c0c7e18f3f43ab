//! Meshes: writers, checks, readers, booleans, pictures.

use std::sync::Arc;

use fretwork::fabricate::format::{glb, stl, threemf};
use fretwork::fabricate::picture::solid::{self as solid_picture, View};
use fretwork::geometry::{Affine3, Mesh, Model, Point, Point3, Polygon};
use fretwork::solid::{self, Operation};
use fretwork::source;

use super::super::Bench;

/// Runs the benchmarks of meshes.
pub fn run(bench: &Bench) {
    let million = || Model::of("ball", solid::ball(50.0, 1000).expect("a ball"));
    let size = |bytes: Vec<u8>| format!("{} kB", bytes.len() / 1000);
    bench.run("solid/check 1 M triangles", million, |m| {
        format!("{:?}", m.bodies[0].mesh.check_closed())
    });
    bench.run("solid/stl 1 M triangles", million, |m| {
        size(stl::write(m, 1.0).expect("written"))
    });
    bench.run("solid/3mf 1 M triangles", million, |m| {
        size(threemf::write(m, 1.0).expect("written"))
    });
    bench.run("solid/glb 1 M triangles", million, |m| {
        size(glb::write(m, 1.0).expect("written"))
    });
    let file = || stl::write(&million(), 1.0).expect("written");
    let name: Arc<str> = "ball.stl".into();
    bench.run("solid/read stl 1 M triangles", file, |bytes| {
        let read = source::mesh::read(bytes, &name, 1.0, &mut |_| Err(String::new()));
        format!("{} triangles", read.map_or(0, |(m, _)| m.triangle_count()))
    });
    let view = View {
        width: 1024,
        direction: Point3::new(1.0, -2.0, 1.0),
        background: None,
    };
    bench.run("solid/png 1 M triangles", million, |m| {
        size(solid_picture::write(m, &view).expect("written"))
    });
    bench.run("solid/extrude 2500 holes", perforated, |area| {
        format!(
            "{:?}",
            solid::extrude(area, 0.0, 2.0).map(|mesh| mesh.triangles.len())
        )
    });
    let pair = || {
        let ball = solid::ball(50.0, 256).expect("a ball");
        [
            ball.clone(),
            ball.transformed(&Affine3::translation(Point3::new(30.0, 7.0, 3.0))),
        ]
    };
    bench.run("solid/difference of balls, 64 k each", pair, |pair| {
        note(solid::combine(Operation::Difference, pair))
    });
    let drilled = || {
        let plate = solid::cuboid(Point3::new(52.0, 52.0, 3.0)).expect("a plate");
        let mut drills = Mesh::default();
        for i in 0..400 {
            let at = Point3::new(
                2.0 + 2.5 * f64::from(i % 20),
                2.0 + 2.5 * f64::from(i / 20),
                -1.0,
            );
            drills.append(
                &solid::cylinder(1.0, 5.0, 32)
                    .expect("a drill")
                    .transformed(&Affine3::translation(at)),
            );
        }
        [plate, drills]
    };
    bench.run("solid/400 holes drilled", drilled, |pair| {
        note(solid::combine(Operation::Difference, pair))
    });
}

fn note(mesh: Result<Mesh, solid::SolidError>) -> String {
    mesh.map_or_else(
        |e| e.to_string(),
        |mesh| format!("{} triangles", mesh.triangles.len()),
    )
}

/// A plate with 50 × 50 round holes of 24 corners.
fn perforated() -> Vec<Polygon> {
    let ring = |x: f64, y: f64, r: f64, n: i32| -> Vec<Point> {
        (0..n)
            .map(|i| {
                Point::new(x, y)
                    + Point::unit(std::f64::consts::TAU * f64::from(i) / f64::from(n)) * r
            })
            .collect()
    };
    let outer = [[-26., -26.], [26., -26.], [26., 26.], [-26., 26.]]
        .map(Point::from)
        .to_vec();
    let hole = |i: i32| {
        ring(f64::from(i % 50) - 24.5, f64::from(i / 50) - 24.5, 0.4, 24)
            .into_iter()
            .rev()
            .collect()
    };
    vec![Polygon {
        outer,
        holes: (0..2500).map(hole).collect(),
    }]
}
