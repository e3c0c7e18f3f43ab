//! Wraps against closed forms, and against a slow oracle that unrolls points of the surface.

use std::f64::consts::{PI, TAU};

use fretwork_geometry::mesh::nearest::Nearest;
use fretwork_geometry::polygon::{subtract, unite};
use fretwork_geometry::{
    Bounds, Carrier, Cutout, Imprint, Mesh, Point, Point3, Polygon, Seed, SurfaceMesh,
};

use crate::{Around, Drawn, Laying, WrapError, wrap};

fn rectangle(width: f64, height: f64) -> Polygon {
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    Polygon {
        outer: corners.map(Point::from).to_vec(),
        holes: Vec::new(),
    }
}

fn disc(at: [f64; 2], radius: f64) -> Polygon {
    let place = |i: u32| Point::from(at) + Point::unit(TAU * f64::from(i) / 64.0) * radius;
    Polygon {
        outer: (0..64).map(place).collect(),
        holes: Vec::new(),
    }
}

fn once() -> Laying {
    Laying {
        scale: [1.0, 1.0],
        rotate: 0.0,
        around: Around::Once,
        tolerance: 0.05,
    }
}

fn laid(
    area: &[Polygon],
    surface: &SurfaceMesh,
    at: [f64; 3],
    laying: &Laying,
) -> Result<Cutout, WrapError> {
    let bounds = area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
    wrap(&Drawn { area, bounds }, surface, Some(at.into()), laying)
}

fn turned(profile: &[[f64; 2]], segments: u32) -> SurfaceMesh {
    let profile: Vec<Point> = profile.iter().map(|p| Point::from(*p)).collect();
    SurfaceMesh::turned(&profile, false, segments).unwrap()
}

/// A ball's profile from pole to pole, or a part of it, in degrees of latitude.
fn zone(radius: f64, from: f64, to: f64, pieces: u32) -> Vec<[f64; 2]> {
    let at = |i: u32| {
        let angle = (from + (to - from) * f64::from(i) / f64::from(pieces)).to_radians();
        [
            (radius * libm::cos(angle)).max(0.0),
            radius * libm::sin(angle),
        ]
    };
    (0..=pieces).map(at).collect()
}

fn imprint(cutout: &Cutout) -> &Imprint {
    match &cutout.carrier {
        Carrier::Surface(imprint) => imprint,
        other => panic!("{other:?}"),
    }
}

fn on_surface(cutout: &Cutout) -> f64 {
    cutout.measures.wrapping.as_ref().unwrap().area
}

fn near(found: f64, expected: f64, part: f64) {
    assert!(
        (found / expected - 1.0).abs() < part,
        "{found} is not {expected}"
    );
}

#[test]
fn areas_and_lengths_are_kept_on_cylinders_and_cones() {
    let ring = subtract(&[disc([0.0, 0.0], 12.0)], &[disc([2.0, 0.0], 6.0)]).unwrap();
    let area: f64 = ring.iter().map(Polygon::area).sum();
    let cylinder = turned(&[[30.0, 0.0], [30.0, 60.0]], 720);
    let up = turned(&[[40.0, 0.0], [15.0, 60.0]], 720);
    let down = turned(&[[15.0, 0.0], [40.0, 60.0]], 720);
    for surface in [&cylinder, &up, &down] {
        for at in [[30.0, 0.0, 30.0], [-20.0, -20.0, 30.0], [-30.0, 1e-9, 28.0]] {
            let cutout = laid(&ring, surface, at, &once()).unwrap();
            near(on_surface(&cutout), area, 1e-4);
            assert_eq!((cutout.components, cutout.holes, cutout.around), (1, 1, 0));
            assert_eq!(cutout.measures.wrapping.unwrap().stretch, [1.0; 3]);
        }
    }
    // The border of a strip around a cone at one height is an arc on the unrolled cone; a square's side is straight there.
    let side = laid(&[rectangle(20.0, 1e-3)], &up, [30.0, 0.0, 30.0], &once()).unwrap();
    near(side.measures.area, on_surface(&side), 1e-4);
}

#[test]
fn the_zone_of_a_ball_has_its_closed_form() {
    let ball = SurfaceMesh::turned(&zone(40.0, -90.0, 90.0, 360).map_points(), false, 720).unwrap();
    let height = 30.0;
    let laying = Laying {
        around: Around::Joined,
        ..once()
    };
    let strip = [rectangle(TAU * 40.0 / 9.0, height)];
    let cutout = laid(&strip, &ball, [40.0, 0.0, 0.0], &laying).unwrap();
    assert_eq!((cutout.components, cutout.holes, cutout.around), (1, 0, 1));
    near(
        on_surface(&cutout),
        TAU * 40.0 * 2.0 * 40.0 * libm::sin(0.5 * height / 40.0),
        1e-4,
    );
    let wrapping = cutout.measures.wrapping.unwrap();
    assert_eq!((wrapping.copies, wrapping.flat.components), (9, 1));
    near(wrapping.stretch[0], libm::cos(0.5 * height / 40.0), 1e-2);
    near(wrapping.stretch[2], 1.0, 1e-3);
}

trait MapPoints {
    fn map_points(&self) -> Vec<Point>;
}

impl MapPoints for Vec<[f64; 2]> {
    fn map_points(&self) -> Vec<Point> {
        self.iter().map(|p| Point::from(*p)).collect()
    }
}

#[test]
fn walls_keep_lengths_around_corners() {
    let plan = [[0.0, 0.0], [50.0, 0.0], [50.0, 30.0], [0.0, 30.0]].map(Point::from);
    let wall = SurfaceMesh::swept(&plan, true, [0.0, 40.0]).unwrap();
    for at in [[50.0, 0.0, 20.0], [0.0, 0.0, 20.0], [25.0, 30.0, 20.0]] {
        let cutout = laid(&[disc([0.0, 0.0], 12.0)], &wall, at, &once()).unwrap();
        near(on_surface(&cutout), cutout.measures.area, 1e-6);
        assert_eq!((cutout.components, cutout.holes), (1, 0));
    }
    let open = SurfaceMesh::swept(&plan[..3], false, [0.0, 40.0]).unwrap();
    let cutout = laid(&[disc([0.0, 0.0], 12.0)], &open, [50.0, 0.0, 20.0], &once()).unwrap();
    near(on_surface(&cutout), cutout.measures.area, 1e-6);
    let over = laid(&[disc([0.0, 0.0], 12.0)], &open, [4.0, 0.0, 20.0], &once());
    assert!(
        matches!(over, Err(WrapError::OverRim { rim: "left", by, .. }) if (by - 8.0).abs() < 0.1),
        "{over:?}"
    );
}

#[test]
fn closed_profiles_have_their_seam_opposite_to_the_drawing() {
    let section: Vec<Point> = (0..48)
        .map(|i| Point::new(40.0, 0.0) + Point::unit(TAU * f64::from(i) / 48.0) * 12.0)
        .collect();
    let ring = SurfaceMesh::turned(&section, true, 90).unwrap();
    for at in [[52.0, 0.0, 0.0], [0.0, 40.0, 12.0], [-40.0, 0.0, -12.0]] {
        let cutout = laid(&[disc([0.0, 0.0], 9.0)], &ring, at, &once()).unwrap();
        assert_eq!((cutout.components, cutout.holes), (1, 0));
        near(on_surface(&cutout), disc([0.0, 0.0], 9.0).area(), 0.06);
        let positions = imprint(&cutout).positions();
        let filled = imprint(&cutout).part(true);
        let far = |c: &u32| positions[*c as usize].distance(at.into());
        let reach = filled.iter().flatten().map(far).fold(0.0, f64::max);
        assert!(reach < 10.0, "{at:?}: {reach}");
    }
}

/// Bars upright and level, so that one goes over each seam and sides of the outline lie on sides of triangles.
fn lattice(columns: u32, width: f64, height: f64) -> Vec<Polygon> {
    let step = width / f64::from(columns);
    let bar = |x: f64, y: f64, w: f64, h: f64| {
        let p = rectangle(w, h);
        let outer = p.outer.iter().map(|p| *p + Point::new(x, y)).collect();
        Polygon {
            outer,
            holes: vec![],
        }
    };
    let mut bars: Vec<Polygon> = (0..=columns)
        .map(|i| f64::from(i) * step)
        .map(|x| (x - 0.2 * step, x + 0.2 * step))
        .map(|(a, b)| (a.max(0.0), b.min(width)))
        .map(|(a, b)| bar(a, 0.0, b - a, height))
        .collect();
    bars.push(bar(0.0, 0.0, width, 2.0));
    bars.push(bar(0.0, height - 2.0, width, 2.0));
    unite(&bars).unwrap()
}

#[test]
fn a_ring_closes_without_a_seam_wherever_it_begins() {
    let tube = turned(&[[30.0, 0.0], [30.0, 25.0], [30.0, 50.0]], 48);
    let width = TAU * 30.0 / 6.0;
    let laying = Laying {
        around: Around::Joined,
        ..once()
    };
    let mut areas = Vec::new();
    for angle in [0.0f64, 7.5, 45.0, 77.7, 180.0, 299.0] {
        let (sin, cos) = libm::sincos(angle.to_radians());
        let at = [30.0 * cos, 30.0 * sin, 25.0];
        let cutout = laid(&lattice(4, width, 50.0), &tube, at, &laying).unwrap();
        // Six copies of four openings, and none of them is cut by a seam.
        assert_eq!(
            (cutout.components, cutout.holes, cutout.around),
            (1, 24, 1),
            "at {angle}"
        );
        assert_eq!(cutout.measures.wrapping.as_ref().unwrap().copies, 6);
        let divided = imprint(&cutout);
        near(divided.area(), on_surface(&cutout), 1e-9);
        areas.push(on_surface(&cutout));
        // Every side of the divided surface belongs to two triangles, or to a rim of the surface.
        let mesh = Mesh {
            positions: divided.positions(),
            triangles: divided.triangles.clone(),
        };
        let topology = mesh.topology();
        assert_eq!((topology.components, topology.bad_edges), (1, 0));
        near(mesh.area(), tube.area(), 1e-9);
    }
    for area in &areas {
        near(*area, areas[0], 1e-3);
    }
}

#[test]
fn spaced_copies_stay_apart_and_keep_their_shape() {
    let cone = turned(&[[40.0, 0.0], [20.0, 60.0]], 360);
    let laying = Laying {
        around: Around::Spaced(7),
        ..once()
    };
    let cutout = laid(&[disc([0.0, 0.0], 8.0)], &cone, [30.0, 0.0, 30.0], &laying).unwrap();
    assert_eq!((cutout.components, cutout.holes, cutout.around), (7, 0, 0));
    near(
        on_surface(&cutout),
        7.0 * disc([0.0, 0.0], 8.0).area(),
        1e-3,
    );
    let crowded = Laying {
        around: Around::Spaced(13),
        ..once()
    };
    let error = laid(&[disc([0.0, 0.0], 8.0)], &cone, [30.0, 0.0, 30.0], &crowded);
    assert!(matches!(error, Err(WrapError::TooWide { .. })), "{error:?}");
}

/// Whether the pattern is at a place of the surface, by the triangles.
fn is_filled(divided: &Imprint, nearest: &Nearest, p: Point3) -> bool {
    let foot = nearest.foot(p).unwrap();
    divided.inside[foot.triangle as usize]
}

#[test]
fn what_is_filled_agrees_with_unrolling_points() {
    let tube = turned(&[[30.0, 0.0], [30.0, 20.0], [30.0, 50.0]], 96);
    let holes: Vec<Polygon> = (0..40u64)
        .map(|i| {
            let seed = Seed::root(i);
            let at = [seed.range(0, 4.0, 156.0), seed.range(1, 4.0, 36.0)];
            disc(at, seed.range(2, 1.0, 3.5))
        })
        .collect();
    let area = subtract(&[rectangle(160.0, 40.0)], &unite(&holes).unwrap()).unwrap();
    let cutout = laid(&area, &tube, [-30.0, 0.0, 25.0], &once()).unwrap();
    let divided = imprint(&cutout);
    let mesh = Mesh {
        positions: divided.positions(),
        triangles: divided.triangles.clone(),
    };
    let nearest = Nearest::new(&mesh);
    let mut filled = 0;
    for i in 0..2000u64 {
        let seed = Seed::root(1000 + i);
        let (angle, z) = (seed.range(0, -PI, PI), seed.range(1, 0.0, 50.0));
        let p = Point::new(30.0 * angle + 80.0, 25.0 - z + 20.0);
        let slack = 0.02;
        let is_inside = |dx: f64, dy: f64| {
            let p = p + Point::new(dx, dy);
            area.iter().any(|polygon| polygon.contains(p))
        };
        let around = [
            is_inside(slack, slack),
            is_inside(-slack, slack),
            is_inside(slack, -slack),
            is_inside(-slack, -slack),
        ];
        // Nearer to the outline than the facets are to the circle nothing is told.
        if around.iter().any(|inside| *inside != around[0]) {
            continue;
        }
        // The middle is at -x, which is half a turn on.
        let at = Point3::new(-30.0 * libm::cos(angle), -30.0 * libm::sin(angle), z);
        assert_eq!(is_filled(divided, &nearest, at), around[0], "{angle} {z}");
        filled += usize::from(around[0]);
    }
    assert!(filled > 500);
}

/// A sheet that is bent along one axis, with bumps of this height across.
fn sheet(bump: f64) -> SurfaceMesh {
    let (columns, rows) = (60u32, 40u32);
    let corner = |n: u32| {
        let (i, j) = (f64::from(n % (columns + 1)), f64::from(n / (columns + 1)));
        let (x, y) = (i - 30.0, j - 20.0);
        let angle = x / 25.0;
        let out = 25.0 + bump * libm::cos(x / 5.0) * libm::cos(y / 5.0);
        Point3::new(out * libm::sin(angle), y, out * libm::cos(angle))
    };
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let at = |i: u32, j: u32| j * (columns + 1) + i;
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Mesh {
        positions: (0..(columns + 1) * (rows + 1)).map(corner).collect(),
        triangles,
    }
    .into()
}

#[test]
fn patches_of_what_can_be_unrolled_are_not_stretched() {
    let cutout = laid(
        &[disc([0.0, 0.0], 8.0)],
        &sheet(0.0),
        [0.0, 0.0, 25.0],
        &once(),
    )
    .unwrap();
    let [least, mean, most] = cutout.measures.wrapping.as_ref().unwrap().stretch;
    assert!(least > 0.999 && most < 1.001, "{least} {mean} {most}");
    near(on_surface(&cutout), disc([0.0, 0.0], 8.0).area(), 1e-3);
    let bumpy = laid(
        &[disc([0.0, 0.0], 8.0)],
        &sheet(0.6),
        [0.0, 0.0, 25.0],
        &once(),
    )
    .unwrap();
    let [least, mean, most] = bumpy.measures.wrapping.unwrap().stretch;
    assert!(least < 0.999 && least > 0.9 && most > 1.001 && most < 1.1);
    assert!((mean - 1.0).abs() < 0.02, "{mean}");
}

#[test]
fn up_in_a_drawing_is_up_on_a_mesh_and_right_is_to_the_right() {
    let wall = SurfaceMesh::swept(
        &[Point::new(0.0, -30.0), Point::new(0.0, 30.0)],
        false,
        [0.0, 60.0],
    )
    .unwrap()
    .mesh;
    // One seen from +x: right is +y there.
    assert!(fretwork_geometry::mesh::doubled_normal(wall.corners(wall.triangles[0])).x > 0.0);
    let surface = SurfaceMesh::from(wall);
    let corner = [rectangle(10.0, 10.0), {
        let mut p = rectangle(5.0, 5.0);
        p.outer
            .iter_mut()
            .for_each(|p| *p = *p + Point::new(15.0, -10.0));
        p
    }];
    let cutout = laid(&corner, &surface, [0.0, 0.0, 30.0], &once()).unwrap();
    let positions = imprint(&cutout).positions();
    let filled = imprint(&cutout).part(true);
    let corners = filled.iter().flatten().map(|c| positions[*c as usize]);
    // The small square lies to the right and, with y down in the drawing, above.
    let right = corners.fold(Point3::new(0.0, -99.0, 0.0), |best, p| {
        if p.y > best.y { p } else { best }
    });
    assert!(right.y > 9.9 && right.z > 34.0, "{right:?}");
}

#[test]
fn what_does_not_fit_is_told_by_how_much() {
    let tube = turned(&[[30.0, 0.0], [30.0, 50.0]], 96);
    let wide = laid(&[rectangle(200.0, 10.0)], &tube, [30.0, 0.0, 25.0], &once()).unwrap_err();
    assert!(wide.to_string().contains("11.538 too much"), "{wide}");
    let high = laid(&[rectangle(20.0, 60.0)], &tube, [30.0, 0.0, 25.0], &once()).unwrap_err();
    assert!(
        high.to_string()
            .contains("reaches 5.000 over the upper rim"),
        "{high}"
    );
    let laying = Laying {
        around: Around::Joined,
        ..once()
    };
    let seam = laid(&[rectangle(120.0, 10.0)], &tube, [30.0, 0.0, 25.0], &laying).unwrap_err();
    assert!(
        seam.to_string()
            .contains("2 times 120.0000 is not the 188.4619"),
        "{seam}"
    );
    let tip = turned(&[[0.0, 0.0], [40.0, 60.0]], 60);
    let none = laid(&[rectangle(20.0, 5.0)], &tip, [20.0, 0.0, 30.0], &laying);
    assert_eq!(none, Err(WrapError::OnAxis));
    let alone = laid(&[rectangle(20.0, 5.0)], &tip, [20.0, 0.0, 30.0], &once()).unwrap();
    near(on_surface(&alone), 100.0, 1e-2);
    let over = laid(&[rectangle(20.0, 5.0)], &tip, [0.0, 0.0, 0.0], &once());
    assert_eq!(over, Err(WrapError::OverTip));
    let dust = laid(&[rectangle(1e-7, 1e-7)], &tube, [30.0, 0.0, 25.0], &laying);
    assert!(matches!(dust, Err(WrapError::TooMany(_))), "{dust:?}");
    let help = seam.help([1.0; 2]).unwrap();
    assert!(
        help.contains("188.4619 (1 around) or 94.2310 (2 around)"),
        "{help}"
    );
    let ball = SurfaceMesh::from(
        SurfaceMesh::turned(&zone(20.0, -90.0, 90.0, 40).map_points(), false, 60)
            .unwrap()
            .mesh,
    );
    let none = wrap(
        &Drawn {
            area: &[rectangle(4.0, 4.0)],
            bounds: rectangle(4.0, 4.0).bounds(),
        },
        &ball,
        None,
        &once(),
    );
    assert_eq!(none, Err(WrapError::NoPlace));
    let around = laid(&[rectangle(4.0, 4.0)], &ball, [20.0, 0.0, 0.0], &laying);
    assert_eq!(around, Err(WrapError::NoWayAround));
    let huge = laid(&[rectangle(90.0, 90.0)], &ball, [20.0, 0.0, 0.0], &once());
    assert!(
        matches!(
            huge,
            Err(WrapError::TurnsBack { .. } | WrapError::TooLarge { .. })
        ),
        "{huge:?}"
    );
    let nothing = wrap(
        &Drawn {
            area: &[],
            bounds: Bounds::EMPTY,
        },
        &tube,
        None,
        &once(),
    );
    assert_eq!(nothing, Err(WrapError::Empty));
}
