//! The least width of a pattern beside that of the wall made of it, taken from its mesh.

use fretwork_geometry::{Mesh, Point3, Side};

use crate::connect::SurfaceGraph;
use crate::finish::{Thickness, finish, least_width, rim, wide_enough};
use crate::voxelize::tests::shapes::square;
use crate::voxelize::voxelize;

/// A level plate with a strip of this width in voxels, at an angle to x.
fn strip(width: f64, degrees: f64) -> (Mesh, fretwork_geometry::voxel::VoxelSurface, Vec<bool>) {
    let mesh = square(40.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let middle = mesh.bounds().center();
    let (sine, cosine) = (
        libm::sin(degrees.to_radians()),
        libm::cos(degrees.to_radians()),
    );
    let is_solid = |cell: &[u16; 3]| {
        let away = surface.voxels.lattice.center(*cell) - middle;
        // Off the middle of a voxel by as much for all angles, so that no border runs along voxels' middles.
        ((away.y + 0.07) * cosine - (away.x + 0.11) * sine).abs() < width / 2.0
    };
    let solid = surface.voxels.cells.iter().map(is_solid).collect();
    (mesh, surface, solid)
}

/// The least width of a strip's body half way up its wall: from each place of one side to the nearest of the other one,
/// over all pieces of the cut. Ends at the border of the plate are left out.
fn cut_width(body: &Mesh, degrees: f64) -> f64 {
    let middle = body.bounds().center();
    let (sine, cosine) = (
        libm::sin(degrees.to_radians()),
        libm::cos(degrees.to_radians()),
    );
    let height = middle.z + 1e-6;
    let mut sides: [Vec<Point3>; 2] = Default::default();
    for triangle in &body.triangles {
        let corners = body.corners(*triangle);
        for side in 0..3 {
            let (p, q) = (corners[side], corners[(side + 1) % 3]);
            if (p.z < height) != (q.z < height) {
                let at = p.lerp(q, (height - p.z) / (q.z - p.z));
                let away = at - middle;
                let (along, across) = (
                    away.x * cosine + away.y * sine,
                    away.y * cosine - away.x * sine,
                );
                if along.abs() < 12.0 {
                    sides[usize::from(across > 0.0)].push(at);
                }
            }
        }
    }
    let distances = sides[0]
        .iter()
        .flat_map(|p| sides[1].iter().map(|q| p.distance(*q)));
    distances.fold(f64::INFINITY, f64::min)
}

/// S8: what is told of a strip at any angle is the width of its finished wall, and near to that which it was drawn with.
#[test]
fn widths_are_those_of_the_finished_wall() {
    for width in [2.6, 3.4, 4.5, 7.0] {
        for degrees in [0.0, 7.0, 18.0, 26.6, 33.0, 45.0, 71.0, 90.0] {
            let (mesh, surface, solid) = strip(width, degrees);
            let graph = SurfaceGraph::new(&surface);
            let rim = vec![false; graph.len()];
            let told = least_width((&mesh, &graph), (&solid, &rim), (1.0, 16.0)).0;
            let thickness = Thickness {
                thickness: 2.0,
                side: Side::Center,
            };
            let body = finish(&mesh, &surface, &solid, thickness).unwrap();
            let cut = cut_width(&body.mesh, degrees);
            println!("{width} at {degrees}: told {told:.3}, cut {cut:.3}");
            assert!(
                (told - cut).abs() < 0.2,
                "{width} at {degrees}: {told}, the wall has {cut}"
            );
            assert!((told - width).abs() < 0.9, "{width} at {degrees}: {told}");
        }
    }
}

/// Strips that are as wide as asked by their voxels and narrower where the wall ends become so wide, and hardly wider.
#[test]
fn narrow_walls_become_as_wide_as_asked() {
    for asked in [3.0, 4.0, 5.3] {
        for degrees in [0.0, 18.0, 26.6, 45.0, 60.0] {
            let (mesh, surface, mut solid) = strip(asked - 1.0, degrees);
            let graph = SurfaceGraph::new(&surface);
            let rim = vec![false; graph.len()];
            let of = (&mesh, &graph);
            solid = wide_enough(of, (&solid, &rim), asked);
            assert_eq!(wide_enough(of, (&solid, &rim), asked), solid, "once more");
            let width = least_width(of, (&solid, &rim), (asked, 16.0)).0;
            println!("{asked} at {degrees}: {width:.3}");
            assert!(
                (asked - 0.051..asked + 1.1).contains(&width),
                "{asked} at {degrees}: {width}"
            );
        }
    }
}

/// Where a plate is solid all over, and in a single large figure, nothing is narrow; a notch from the side is no strip.
#[test]
fn what_has_no_features_has_no_width() {
    let mesh = square(40.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let graph = SurfaceGraph::new(&surface);
    let rim = vec![false; graph.len()];
    let least = |is_solid: &dyn Fn(Point3) -> bool| {
        let lattice = &surface.voxels.lattice;
        let middle = mesh.bounds().center();
        let cells = surface.voxels.cells.iter();
        let solid: Vec<bool> = cells
            .map(|c| is_solid(lattice.center(*c) - middle))
            .collect();
        least_width((&mesh, &graph), (&solid, &rim), (2.0, 12.0)).0
    };
    assert_eq!(least(&|_| true), 12.0);
    assert_eq!(least(&|p| p.x.abs().max(p.y.abs()) < 9.0), 12.0);
    assert_eq!(least(&|p| p.x.abs() > 1.2 || p.y < 0.0), 12.0);
    let disc = least(&|p| p.x * p.x + p.y * p.y < 16.0);
    assert!((6.9..8.5).contains(&disc), "{disc}");
    let neck = least(&|p| p.x.abs() > 4.0 || p.y.abs() < 1.5);
    assert!((neck - 3.0).abs() < 0.4, "{neck}");
}

/// Waving strips stay as they are where less is asked for than they have, whatever it is beside a voxel, and what is added grows
/// with what is asked for (S4).
#[test]
fn strips_that_are_wide_enough_stay() {
    let mesh = square(60.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let graph = SurfaceGraph::new(&surface);
    let rim = vec![false; graph.len()];
    let middle = mesh.bounds().center();
    let is_solid = |cell: &[u16; 3]| {
        let away = surface.voxels.lattice.center(*cell) - middle;
        let around = libm::atan2(away.y, away.x);
        let waving = away.length() + 0.7 * libm::sin(5.0 * around);
        away.length() < 27.0 && (waving - 2.0).rem_euclid(8.0) < 3.7
    };
    let drawn: Vec<bool> = surface.voxels.cells.iter().map(is_solid).collect();
    let of = (&mesh, &graph);
    let solid = wide_enough(of, (&drawn, &rim), 0.0);
    let least = least_width(of, (&solid, &rim), (2.0, 12.0)).0;
    let count = |solid: &[bool]| solid.iter().filter(|solid| **solid).count();
    let mut before = count(&solid);
    println!("{least:.2} wide, {before} of {}", solid.len());
    let steps = [-1.5, -1.0, -0.5, -0.2, 0.0, 0.3, 0.6, 1.0, 1.5, 2.0];
    for more in steps {
        let asked = least + more;
        let wide = wide_enough(of, (&drawn, &rim), asked);
        let now = count(&wide);
        let found = least_width(of, (&wide, &rim), (asked, 16.0)).0;
        println!("{asked:.2}: {now}, {found:.2}");
        assert!(found >= asked - 0.1, "{asked}: {found}");
        if more <= 0.0 {
            assert_eq!(wide, solid, "{asked}");
        }
        assert!(now >= before, "{asked}: {now} after {before}");
        let part = (now - count(&solid)) as f64 / solid.len() as f64;
        assert!(part <= 0.02 + 0.2 * more.max(0.0), "{asked}: {part}");
        before = now;
    }
}

/// S8: a rim that is kept is widened away from where the surface ends, at both ends of it.
#[test]
fn rims_become_as_wide_as_asked() {
    let mesh = super::shapes::turned(&[[20.0, 0.0], [20.0, 24.0]], 96);
    for (voxel, asked, kept) in [(0.6, 3.0, 1.2), (1.0, 4.0, 1.5)] {
        let surface = voxelize(&mesh, voxel).unwrap();
        let graph = SurfaceGraph::new(&surface);
        let ends = rim(&mesh, &surface);
        let height = |cell: &[u16; 3]| surface.voxels.lattice.center(*cell).z;
        let cells = surface.voxels.cells.iter();
        let solid: Vec<bool> = cells
            .map(|cell| height(cell) < kept || height(cell) > 24.0 - kept)
            .collect();
        let of = (&mesh, &graph);
        let wide = wide_enough(of, (&solid, &ends), asked);
        let width = least_width(of, (&wide, &ends), (asked, 12.0)).0;
        println!("{asked} by {voxel}: {width:.3}");
        assert!(
            (asked - 0.05 * voxel..asked + 1.6 * voxel).contains(&width),
            "{width}"
        );
    }
}
