//! Voxels of meshes beside a slow oracle, and what must be refused.

mod oracle;
pub(crate) mod shapes;

use fretwork_geometry::{MeshError, Point3};
use proptest::prelude::*;

use super::*;

fn soup(corners: &[[f64; 3]]) -> Mesh {
    Mesh {
        positions: corners.iter().copied().map(Point3::from).collect(),
        triangles: (0..corners.len() as u32 / 3)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect(),
    }
}

#[test]
fn a_voxel_that_is_nearly_touched_may_be_taken() {
    let corners = [
        [0.0, 0.0, 0.0],
        [0.0, -3.8846624967437418, 0.0],
        [-3.6975050857462204, -0.3615154617288626, 0.0],
        [2.482092461475344, 0.0, 0.45026953285664834],
        [-3.077144792470787, 0.8563135879139557, 3.565123818028266],
        [0.0, -0.29565149118086936, 1.5822750198720945],
    ];
    let mesh = soup(&corners);
    let found = voxelize_in_detail(&mesh, 2.47115604228952).unwrap().surface;
    oracle::check(&mesh, &found);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn voxels_are_those_of_the_oracle(
        corners in proptest::collection::vec(proptest::array::uniform3(-4.0..4.0), 3..16),
        pitch in 0.2..3.0,
    ) {
        let mesh = soup(&corners);
        let found = voxelize_in_detail(&mesh, pitch).unwrap().surface;
        oracle::check(&mesh, &found);
    }

    /// Corners on the lattice, where cubes are touched at faces, edges and corners.
    #[test]
    fn touching_counts(
        corners in proptest::collection::vec(proptest::array::uniform3(0i8..5), 3..13),
    ) {
        let corners: Vec<_> = corners.iter().map(|c| c.map(f64::from)).collect();
        let mesh = soup(&corners);
        if let Ok(found) = voxelize_in_detail(&mesh, 0.5) {
            oracle::check(&mesh, &found.surface);
        }
    }
}

#[test]
fn slivers_are_voxelized_as_the_oracle_does() {
    let mesh = soup(&[
        [0.0, 0.0, 0.0],
        [9.0, 7.0, 5.0],
        [9.0, 7.0, 5.0001],
        [0.0, 9.0, 0.0],
        [9.0, 0.0, 0.001],
        [4.5, 4.5, 0.0],
    ]);
    let found = voxelize_in_detail(&mesh, 0.3).unwrap().surface;
    oracle::check(&mesh, &found);
}

/// Open and closed shapes, along the axes and across them.
#[test]
fn shapes_are_voxelized_as_the_oracle_does() {
    for mesh in [
        shapes::square(7.0),
        shapes::cube(6.0),
        shapes::torus(4.0, 2.0, 16),
    ] {
        for mesh in [shapes::turned(&mesh), mesh] {
            oracle::check(&mesh, &voxelize(&mesh, 0.43).unwrap());
        }
    }
}

#[test]
fn a_box_is_one_layer_at_every_resolution() {
    for resolution in [5, 8, 16, 33] {
        let mesh = shapes::cube(1.0);
        let surface = voxelize(&mesh, 1.0 / f64::from(resolution)).unwrap();
        let across = surface.voxels.cells.iter().map(|cell| cell[0]);
        let n = usize::from(across.clone().max().unwrap() - across.min().unwrap()) + 1;
        assert_eq!(
            surface.voxels.len(),
            n.pow(3) - (n - 2).pow(3),
            "{resolution}"
        );
        assert!(surface.voxels.cells.iter().flatten().all(|&c| c > 0));
    }
}

#[test]
fn normals_of_a_sphere_are_its_radii() {
    let surface = voxelize(&shapes::sphere(10.0, 96), 0.25).unwrap();
    let Voxels { lattice, cells } = &surface.voxels;
    for (cell, normal) in cells.iter().zip(&surface.normals) {
        let radius = lattice.center(*cell).unit().unwrap();
        let normal = Point3::from(normal.map(f64::from));
        assert!(radius.dot(normal) > 0.99, "{cell:?}: {normal:?}");
    }
}

#[test]
fn levels_halve_and_know_their_children() {
    let levels = pyramid(voxelize(&shapes::torus(10.0, 4.0, 64), 0.3).unwrap());
    for pair in levels.windows(2) {
        let (below, above) = (&pair[0], &pair[1]);
        for (child, &parent) in (0u32..).zip(&below.parents) {
            let cell = below.surface.voxels.cells[child as usize];
            assert_eq!(
                cell.map(|n| n / 2),
                above.surface.voxels.cells[parent as usize]
            );
            assert!(above.children.row(parent as usize).contains(&child));
        }
        let lengths = above
            .surface
            .normals
            .iter()
            .map(|n| n.iter().map(|c| c * c).sum::<f32>());
        assert!(lengths.into_iter().all(|l| (l - 1.0).abs() < 1e-5));
    }
    let across = |level: &Level| level.surface.voxels.cells.iter().flatten().max().copied();
    assert!(levels.len() > 3 && across(&levels[levels.len() - 1]) <= Some(9));
}

#[test]
fn threads_do_not_show() {
    let mesh = shapes::torus(10.0, 4.0, 128);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap()
            .install(|| voxelize_in_detail(&mesh, 0.1).unwrap())
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(7));
}

#[test]
fn estimates_are_near_and_not_below() {
    for (mesh, pitch) in [
        (shapes::sphere(10.0, 64), 0.2),
        (shapes::torus(10.0, 4.0, 200), 0.5),
        (shapes::cube(8.0), 0.1),
    ] {
        let real = voxelize(&mesh, pitch).unwrap().voxels.len() as f64;
        let told = estimate(&mesh, pitch).voxels as f64;
        assert!(told >= real && told < 2.0 * real, "{told} {real}");
    }
}

#[test]
fn what_has_no_voxels_is_told() {
    let flat = soup(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    assert_eq!(
        voxelize(&flat, 0.1),
        Err(VoxelizeError::NoArea { triangles: 1 })
    );
    let nan = soup(&[[0.0; 3], [f64::NAN, 0.0, 0.0], [2.0, 1.0, 0.0]]);
    let error = VoxelizeError::Mesh(MeshError::NotFinite { corner: 1 });
    assert_eq!(voxelize(&nan, 0.1), Err(error));
    let empty = Err(VoxelizeError::Mesh(MeshError::Empty));
    assert_eq!(voxelize(&Mesh::default(), 0.1), empty);
    let cube = shapes::cube(1.0);
    for pitch in [0.0, -1.0, f64::INFINITY] {
        assert_eq!(voxelize(&cube, pitch), Err(VoxelizeError::Pitch { pitch }));
    }
    assert!(matches!(
        voxelize(&cube, 1e-6),
        Err(VoxelizeError::OutOfRange { .. })
    ));
    assert!(matches!(
        voxelize(&cube, 1e-4),
        Err(VoxelizeError::TooLarge { .. })
    ));
}

#[test]
fn a_sheet_thinner_than_a_voxel_is_told() {
    let mut sheet = shapes::cube(8.0);
    for corner in &mut sheet.positions {
        corner.z *= 0.01;
    }
    assert!(matches!(
        voxelize(&sheet, 0.5),
        Err(VoxelizeError::TooThin { .. })
    ));
    assert!(voxelize(&sheet, 0.02).is_ok());
    assert!(
        voxelize_in_detail(&shapes::cube(8.0), 0.5)
            .unwrap()
            .thin
            .is_empty()
    );
}

#[test]
fn triangles_without_area_are_passed_over() {
    let mut mesh = shapes::cube(1.0);
    let plain = voxelize(&mesh, 0.1).unwrap();
    mesh.triangles.push([0, 0, 1]);
    let detail = voxelize_in_detail(&mesh, 0.1).unwrap();
    assert_eq!((detail.skipped, detail.surface), (1, plain));
}

/// Seventy thousand triangles at 256.
#[test]
#[ignore = "a measurement"]
fn speed() {
    let mesh = shapes::torus(10.0, 4.0, 264);
    let start = std::time::Instant::now();
    let surface = voxelize(&mesh, 28.0 / 256.0).unwrap();
    let voxels = start.elapsed();
    let count = surface.voxels.len();
    let levels = pyramid(surface).len();
    let all = start.elapsed();
    println!(
        "{} triangles, {count} voxels, {levels} levels: {voxels:?}, {all:?}",
        mesh.triangles.len()
    );
}
