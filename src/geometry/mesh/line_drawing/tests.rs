use super::*;
use crate::mesh::{Affine3, revolve};
use crate::{Point3, Seed};

const WANTED: Wanted = Wanted {
    crease: 0.866,
    hidden: false,
};

fn view(from: [f64; 3]) -> View {
    View::from(from.into()).unwrap()
}

fn cube(at: [f64; 3], size: f64) -> Mesh {
    let from = Point3::from(at);
    Mesh::cuboid(from, from + Point3::new(size, size, size))
}

fn ball(at: [f64; 3], radius: f64) -> Mesh {
    let point = |i: u32| {
        let angle = std::f64::consts::PI * (f64::from(i) / 12.0 - 0.5);
        let x = radius * libm::cos(angle);
        Point::new(
            if i.is_multiple_of(12) { 0.0 } else { x },
            radius * libm::sin(angle),
        )
    };
    let profile: Vec<Point> = (0..=12).map(point).collect();
    let mesh = revolve(&profile, false, 20).unwrap();
    mesh.transformed(&Affine3::translation(at.into()))
}

fn length(lines: &[Line], holds: impl Fn(&Line) -> bool) -> f64 {
    let own = lines.iter().filter(|line| holds(line));
    own.flat_map(|line| line.points.windows(2))
        .map(|w| w[0].distance(w[1]))
        .sum()
}

#[test]
fn a_cube_shows_a_square_from_the_front_and_nine_edges_from_a_corner() {
    let mesh = cube([0.0; 3], 2.0);
    let front = line_drawing(&mesh, &view([0.0, -1.0, 0.0]), WANTED);
    assert_eq!(length(&front, |_| true), 8.0);
    assert!(front.iter().all(|line| line.kind == LineKind::Silhouette));
    assert_eq!(front.len(), 1);
    let all = Wanted {
        hidden: true,
        ..WANTED
    };
    let corner = line_drawing(&mesh, &view([1.0, 1.0, 1.0]), all);
    let edge = 2.0 * (2.0f64 / 3.0).sqrt();
    let of = |kind, is_visible| {
        length(&corner, |line| {
            line.kind == kind && line.is_visible == is_visible
        }) / edge
    };
    assert!((of(LineKind::Silhouette, true) - 6.0).abs() < 1e-9);
    assert!((of(LineKind::Crease, true) - 3.0).abs() < 1e-9);
    assert!((of(LineKind::Crease, false) - 3.0).abs() < 1e-9);
}

#[test]
fn what_stands_before_hides_exactly_what_is_behind() {
    let mut mesh = cube([0.0, 5.0, 0.0], 4.0);
    mesh.append(&cube([1.0, 0.0, 3.0], 2.0));
    let lines = line_drawing(&mesh, &view([0.0, -1.0, 0.0]), WANTED);
    // Of the upper edge of the large cube 2 are hidden; the small one is seen whole.
    assert!((length(&lines, |_| true) - (16.0 - 2.0 + 8.0)).abs() < 1e-5);
    let from_above = line_drawing(&mesh, &view([0.0, 0.0, 1.0]), WANTED);
    assert!((length(&from_above, |_| true) - 24.0).abs() < 1e-5);
}

#[test]
fn what_is_hidden_under_a_line_that_is_seen_is_not_drawn_again() {
    let all = Wanted {
        hidden: true,
        ..WANTED
    };
    // From the front the back of a cube lies under its front.
    let front = line_drawing(&cube([0.0; 3], 2.0), &view([0.0, -1.0, 0.0]), all);
    assert_eq!(length(&front, |line| line.is_visible), 8.0);
    assert_eq!(length(&front, |line| !line.is_visible), 0.0);
    // A larger one behind it is hidden but for what shows beside it, and where it lies under the small one's outline.
    let mut pair = cube([0.0; 3], 2.0);
    pair.append(&cube([-1.0, 5.0, 0.0], 4.0));
    let front = line_drawing(&pair, &view([0.0, -1.0, 0.0]), all);
    assert!((length(&front, |line| line.is_visible) - (8.0 + 16.0 - 2.0)).abs() < 1e-5);
    assert!(length(&front, |line| !line.is_visible) < 1e-5);
}

#[test]
fn flush_faces_of_bodies_that_touch_have_no_joint() {
    let mut mesh = cube([0.0; 3], 2.0);
    mesh.append(&cube([2.0, 0.0, 0.0], 2.0));
    let front = line_drawing(&mesh, &view([0.0, -1.0, 0.0]), WANTED);
    assert_eq!(length(&front, |_| true), 12.0);
    // A step between them is seen.
    let mut mesh = cube([0.0; 3], 2.0);
    mesh.append(&cube([2.0, -1.0, 0.0], 2.0));
    let front = line_drawing(&mesh, &view([0.0, -1.0, 0.0]), WANTED);
    assert!((length(&front, |_| true) - 14.0).abs() < 1e-5);
}

#[test]
fn an_open_surface_hides_from_both_sides_and_has_a_border() {
    let tube = revolve(&[[3.0, 0.0], [3.0, 10.0]].map(Point::from), false, 48).unwrap();
    let lines = line_drawing(&tube, &view([0.0, -1.0, 1.0]), WANTED);
    let border = length(&lines, |line| line.kind == LineKind::Border);
    let around = 0.5 * std::f64::consts::TAU * 3.0;
    // The upper rim is seen whole, of the lower one the front half.
    let whole = length(
        &line_drawing(
            &tube,
            &view([0.0, -1.0, 1.0]),
            Wanted {
                hidden: true,
                ..WANTED
            },
        ),
        |line| line.kind == LineKind::Border,
    );
    assert!((border / whole - 0.75).abs() < 0.01, "{border} of {whole}");
    assert!(border > around);
    assert!(length(&lines, |line| line.kind == LineKind::Silhouette) > 6.0);
}

#[test]
fn the_outline_of_a_ball_is_one_closed_line() {
    let lines = line_drawing(&ball([0.0; 3], 5.0), &view([1.0, -2.0, 0.7]), WANTED);
    assert_eq!(lines.len(), 1);
    assert_eq!(lines[0].points.first(), lines[0].points.last());
    let around = length(&lines, |_| true);
    assert!((around / (10.0 * std::f64::consts::PI) - 1.0).abs() < 0.02);
    assert!(line_drawing(&Mesh::default(), &view([1.0, 0.0, 0.0]), WANTED).is_empty());
}

/// By how much the nearest triangle before `p` lies before it, if one does, by a ray to the viewer.
fn before(mesh: &Mesh, view: &View, p: Point3, beside: [u32; 2]) -> f64 {
    let mut most = f64::NEG_INFINITY;
    for (t, number) in mesh.triangles.iter().zip(0..) {
        let [a, b, c] = mesh.corners(*t);
        let (u, v) = (b - a, c - a);
        let across = view.toward().cross(v);
        let det = u.dot(across);
        if beside.contains(&number) || det.abs() < 1e-9 {
            continue;
        }
        let s = (p - a).dot(across) / det;
        let q = (p - a).cross(u);
        let r = view.toward().dot(q) / det;
        if s > 0.0 && r > 0.0 && s + r < 1.0 {
            most = most.max(v.dot(q) / det);
        }
    }
    most
}

#[test]
fn hidden_lines_are_those_that_rays_do_not_reach() {
    for case in 0..12 {
        let seed = Seed::root(case);
        let mut mesh = Mesh::default();
        for i in 0..7 {
            let own = seed.number(i);
            let at = [0, 1, 2].map(|k| own.range(k, 0.0, 8.0));
            let size = own.range(3, 1.0, 4.0);
            let turned = Affine3::rotation(Point3::new(0.0, 0.0, 1.0), own.range(4, 0.0, 6.0));
            let body = match i % 3 {
                0 => ball(at, size),
                1 => cube(at, size).transformed(&turned),
                _ => cube(at, size),
            };
            mesh.append(&body);
        }
        let from = [0, 1, 2].map(|k| seed.name("view").range(k, -1.0, 1.0));
        let view = view(from);
        let (edges, is_closed) = edges(&mesh, &view, WANTED.crease);
        assert!(is_closed);
        let occluders = Occluders::new(&mesh, &view, is_closed);
        let mut asked = 0;
        for (edge, number) in edges.iter().zip(0..) {
            let hidden = occluders.hidden(edge);
            let ends = edge.corners.map(|c| mesh.positions[c as usize]);
            for i in 0..8 {
                let t = seed.unit(8 * number + i);
                if hidden.iter().flatten().any(|end| (t - end).abs() < 1e-4) {
                    continue;
                }
                let depth = before(&mesh, &view, ends[0].lerp(ends[1], t), edge.beside);
                // What touches is neither before nor behind.
                if depth.abs() < 1e-5 {
                    continue;
                }
                asked += 1;
                let is_hidden = hidden.iter().any(|[from, to]| (*from..*to).contains(&t));
                assert_eq!(
                    is_hidden,
                    depth > 0.0,
                    "case {case} edge {edge:?} at {t}: {depth}"
                );
            }
        }
        assert!(asked > 500, "{asked}");
    }
}

#[test]
#[ignore = "a measurement"]
fn two_hundred_thousand_triangles_take_two_seconds() {
    let mut mesh = Mesh::default();
    for i in 0..10 {
        let wave = |k: u32| {
            let z = f64::from(k) / 10.0;
            Point::new(4.0 + libm::sin(z * 2.0 + f64::from(i)), z)
        };
        let profile: Vec<Point> = (0..=100).map(wave).collect();
        let vase = revolve(&profile, false, 100).unwrap();
        let at = Point3::new(f64::from(i % 4) * 7.0, f64::from(i / 4) * 7.0, 0.0);
        mesh.append(&vase.transformed(&Affine3::translation(at)));
    }
    let begin = std::time::Instant::now();
    let lines = line_drawing(&mesh, &view([1.0, -2.0, 1.2]), WANTED);
    println!(
        "{} triangles, {} lines in {:?}",
        mesh.triangles.len(),
        lines.len(),
        begin.elapsed()
    );
}

#[test]
fn boxes_on_one_another_have_no_line_across_the_face_that_they_share() {
    let mut mesh = cube([0.0; 3], 2.0);
    mesh.append(&cube([0.0, 0.0, 2.0], 2.0));
    let all = Wanted {
        hidden: true,
        ..WANTED
    };
    let mut tower = cube([0.0; 3], 2.0);
    for p in &mut tower.positions {
        p.z *= 2.0;
    }
    for from in [[1.0, -1.5, 1.0], [1.0, 1.0, 0.3]] {
        let drawn = |mesh: &Mesh| {
            let lines = line_drawing(mesh, &view(from), all);
            [true, false].map(|seen| length(&lines, |line| line.is_visible == seen))
        };
        let (stacked, whole) = (drawn(&mesh), drawn(&tower));
        for (a, b) in stacked.into_iter().zip(whole) {
            assert!((a - b).abs() < 1e-9, "{from:?}: {stacked:?} {whole:?}");
        }
    }
}
