//! Meshes: writers, checks, readers, booleans, pictures.

use std::sync::Arc;

use fretwork::fabricate::format::{glb, stl, threemf};
use fretwork::fabricate::picture::solid::{self as solid_picture, View};
use fretwork::geometry::mesh::{Surface, Wanted, line_drawing};
use fretwork::geometry::{Across, Affine3, Carrier, Cutout, Mesh, Model, Point, Point3, Polygon};
use fretwork::geometry::{Ribbon, Side, SpaceCurve, SurfaceMesh};
use fretwork::solid::{self, Operation};
use fretwork::source;
use fretwork::wrap::{Around, Drawn, Laying, wrap};

use super::super::Bench;

/// Two balls that cross in a circle.
fn half_million() -> Mesh {
    let mut mesh = solid::ball(50.0, 500).expect("a ball");
    let other = Affine3::translation(Point3::new(30.0, 7.0, 3.0));
    mesh.append(&mesh.transformed(&other));
    mesh
}

/// Runs the benchmarks of meshes.
pub fn run(bench: &Bench) {
    let million = || Model::of("ball", solid::ball(50.0, 1000).expect("a ball"));
    let size = |bytes: Vec<u8>| format!("{} kB", bytes.len() / 1000);
    bench.run("solid/check 1 M triangles", million, |m| {
        format!("{:?}", m.bodies[0].mesh.check_closed())
    });
    bench.run("solid/crossings of 500 k triangles", half_million, |mesh| {
        format!("{} pairs", Surface::new(mesh).overlaps(1e-4).len())
    });
    bench.run("solid/stl 1 M triangles", million, |m| {
        size(stl::write(m, 1.0, None).expect("written"))
    });
    bench.run("solid/3mf 1 M triangles", million, |m| {
        size(threemf::write(m, 1.0, None).expect("written"))
    });
    bench.run("solid/glb 1 M triangles", million, |m| {
        size(glb::write(m, 1.0, None).expect("written"))
    });
    let file = || stl::write(&million(), 1.0, None).expect("written");
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
    bench.run("solid/projection of 200 k triangles", vases, |mesh| {
        let view = fretwork::geometry::View::from(Point3::new(1.0, -2.0, 1.2)).expect("a view");
        let wanted = Wanted {
            crease: 0.866,
            hidden: false,
        };
        format!("{} lines", line_drawing(mesh, &view, wanted).len())
    });
    bench.run("solid/200 slices of 200 k triangles", vases, |mesh| {
        let slicing = solid::Slicing {
            view: fretwork::geometry::View::from(Point3::new(0.0, 0.0, 1.0)).expect("a view"),
            every: 10.0 / 200.0,
            gap: 2.0,
            columns: None,
            pins: 0.0,
        };
        let sliced = solid::slices(mesh, &slicing);
        format!("{:?} parts", sliced.map(|region| region.area.len()))
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
    bench.run("solid/64 leaves out of a shell", leaves, |operands| {
        note(solid::combine(Operation::Difference, operands))
    });
    bench.run(
        "solid/carve one ring",
        || ring(20.0),
        |cutout| note(cut_through(cutout).map(|made| made.mesh)),
    );
    bench.run(
        "solid/5,000 openings around a vase, carved",
        openings,
        |net| note(wrapped(net)),
    );
    let carved = || [20.0, 50.0, 80.0].map(|height| carved(height).expect("a ring"));
    bench.run("solid/three carved rings", carved, |rings| {
        note(solid::combine(Operation::Intersection, rings))
    });
}

/// Ten fluted vases beside and behind one another, of 20,000 triangles each.
fn vases() -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..10u32 {
        let wave = |k: u32| {
            let z = 0.1 * f64::from(k);
            let on_axis = k == 0 || k == 100;
            Point::new(
                if on_axis {
                    0.0
                } else {
                    4.0 + (2.0 * z + f64::from(i)).sin()
                },
                z,
            )
        };
        let profile: Vec<Point> = (0..=100).map(wave).collect();
        let vase = fretwork::geometry::mesh::revolve(&profile, false, 102).expect("a vase");
        let at = Point3::new(f64::from(i % 4) * 7.0, f64::from(i / 4) * 7.0, 0.0);
        mesh.append(&vase.transformed(&Affine3::translation(at)));
    }
    mesh
}

/// A turned shell, and four rings of 16 leaves that go through its wall.
fn leaves() -> Vec<Mesh> {
    let profile = |inset: f64, low: f64, high: f64| {
        let radii = [
            (0.0, low),
            (45.0 - inset, low),
            (58.0 - inset, 30.0),
            (62.0 - inset, 60.0),
        ];
        let upper = [(56.0 - inset, 100.0), (34.0 - inset, high), (0.0, high)];
        let points: Vec<Point> = radii
            .into_iter()
            .chain(upper)
            .map(|p| Point::new(p.0, p.1))
            .collect();
        fretwork::geometry::mesh::revolve(&points, false, 128).expect("a body")
    };
    let leaf: Vec<Point> = (0..40)
        .map(|i| Point::unit(std::f64::consts::TAU * f64::from(i) / 40.0))
        .map(|p| Point::new(3.0 * p.x, 10.0 * p.y))
        .collect();
    let leaf = Polygon {
        outer: leaf,
        holes: vec![],
    };
    let upright = solid::extrude(&[leaf], 0.0, 40.0)
        .expect("a leaf")
        .transformed(&Affine3::rotation(
            Point3::new(0.0, 1.0, 0.0),
            std::f64::consts::FRAC_PI_2,
        ));
    let mut operands = vec![profile(0.0, 0.0, 160.0), profile(2.0, -1.0, 161.0)];
    for ring in 0..4 {
        let mut all = Mesh::default();
        for i in 0..16 {
            let out = Affine3::translation(Point3::new(28.0, 0.0, 25.0 + 26.0 * f64::from(ring)));
            let angle = std::f64::consts::TAU * (f64::from(i) + 0.5 * f64::from(ring % 2)) / 16.0;
            let turn = Affine3::rotation(Point3::new(0.0, 0.0, 1.0), angle);
            all.append(&upright.transformed(&out.then(&turn)));
        }
        operands.push(all);
    }
    operands
}

/// An open tube.
fn tube() -> Mesh {
    let profile = [Point::new(40.0, 0.0), Point::new(40.0, 100.0)];
    fretwork::geometry::mesh::revolve(&profile, false, 240).expect("a tube")
}

/// A tube with a ring of windows cut through it.
fn carved(height: f64) -> Result<Mesh, solid::SolidError> {
    cut_through(&ring(height)).map(|made| made.mesh)
}

fn cut_through(cutout: &Cutout) -> Result<solid::Carved, solid::SolidError> {
    let carving = carving(solid::Keep::Ground);
    solid::carve(&tube().into(), &[cutout], &carving).map_err(|failed| failed.error)
}

fn carving(keep: solid::Keep) -> solid::Carving {
    solid::Carving {
        keep,
        thickness: 2.0,
        side: Side::Inside,
        depth: None,
    }
}

/// A tile of openings that repeats four times around, 5,000 in all.
fn openings() -> Vec<Polygon> {
    let (columns, rows) = (25, 50);
    let hole = |i: i32, j: i32| {
        let at = Point::new(2.0 + 4.0 * f64::from(i), 1.6 + 2.38 * f64::from(j));
        let corner = |k: i32| at + Point::unit(-std::f64::consts::TAU * f64::from(k) / 12.0) * 1.0;
        (0..12).map(corner).collect::<Vec<_>>()
    };
    let holes = (0..columns).flat_map(|i| (0..rows).map(move |j| hole(i, j)));
    let corners = [[0.0, 0.0], [100.0, 0.0], [100.0, 120.0], [0.0, 120.0]];
    vec![Polygon {
        outer: corners.map(Point::from).to_vec(),
        holes: holes.collect(),
    }]
}

/// The openings laid around a turned vase, whose wall keeps what is between them.
fn wrapped(net: &[Polygon]) -> Result<Mesh, solid::SolidError> {
    let profile: Vec<Point> = (0..=40)
        .map(|i| 3.4 * f64::from(i))
        .map(|z| Point::new(64.0 + 6.0 * (z / 40.0).sin(), z))
        .collect();
    let vase = SurfaceMesh::turned(&profile, false, 128).expect("a vase");
    let laying = Laying {
        scale: [1.0, 1.0],
        rotate: 0.0,
        around: Around::Joined,
        tolerance: 0.15,
    };
    let drawn = Drawn {
        area: net,
        bounds: net[0].bounds(),
    };
    let cutout = wrap(&drawn, &vase, None, &laying).expect("a cutout");
    assert_eq!((cutout.components, cutout.holes), (1, 5000));
    let Carrier::Surface(imprint) = &cutout.carrier else {
        return Err(solid::SolidError::Nothing);
    };
    let keep = solid::Keep::Pattern { frame: 6.0 };
    solid::carve_imprint(&vase, imprint, &carving(keep))
}

/// Windows on the way round the tube.
fn ring(height: f64) -> Cutout {
    let circle = SpaceCurve::circle(40.0).expect("a circle");
    let circle = circle
        .mapped(|p| p + Point3::new(0.0, 0.0, height))
        .expect("a curve");
    let ribbon = Ribbon::new(circle, Across::Normal, false).expect("a strip");
    let joints = ribbon.joints().to_vec();
    let windows = joints
        .chunks(12)
        .filter(|window| window.len() > 8)
        .map(|window| {
            let side = |v: f64| window[..8].iter().map(move |&u| Point::new(u, v));
            let upper: Vec<Point> = side(9.0).collect();
            Polygon {
                outer: side(-9.0).chain(upper.into_iter().rev()).collect(),
                holes: vec![],
            }
        });
    Cutout {
        carrier: Carrier::Strip(Arc::new(ribbon)),
        ..Cutout::planar(windows.collect()).expect("windows")
    }
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
