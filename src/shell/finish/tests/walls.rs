//! Walls of known shapes.

use fretwork_geometry::mesh::Surface;
use fretwork_geometry::voxel::VoxelSurface;
use fretwork_geometry::{Mesh, Point3, Seed, Side};

use super::shapes::turned;
use crate::connect::SurfaceGraph;
use crate::finish as room;
use crate::finish::{FinishError, Finished, Thickness, finish};
use crate::voxelize::voxelize;

/// A ball's surface of this radius.
fn ball(radius: f64) -> Mesh {
    let point = |i: usize| {
        let angle = std::f64::consts::PI * (i as f64 / 48.0 - 0.5);
        let distance = if i == 0 || i == 48 {
            0.0
        } else {
            radius * libm::cos(angle)
        };
        [distance, radius * libm::sin(angle)]
    };
    turned(&(0..=48).map(point).collect::<Vec<_>>(), 96)
}

fn made(mesh: &Mesh, surface: &VoxelSurface, solid: &[bool], side: Side) -> Finished {
    let thickness = Thickness {
        thickness: 2.5,
        side,
    };
    let finished = finish(mesh, surface, solid, thickness).unwrap();
    finished.mesh.check_closed().unwrap();
    assert!(finished.mesh.volume() > 0.0);
    let border = Surface::new(&finished.mesh);
    assert!(!border.overlaps_itself(2e-4), "it passes through itself");
    finished
}

#[test]
fn a_whole_ball_is_two_spheres() {
    let mesh = ball(20.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let solid = vec![true; surface.voxels.len()];
    let shell =
        |inner: f64, outer: f64| 4.0 / 3.0 * std::f64::consts::PI * (outer.powi(3) - inner.powi(3));
    for (side, inner) in [
        (Side::Center, 18.75),
        (Side::Inside, 17.5),
        (Side::Outside, 20.0),
    ] {
        let finished = made(&mesh, &surface, &solid, side);
        let volume = finished.mesh.volume();
        let expected = shell(inner, inner + 2.5);
        assert!(
            (volume / expected - 1.0).abs() < 0.01,
            "{side:?}: {volume} of {expected}"
        );
        assert_eq!((finished.pieces, finished.filled), (1, 0));
        for p in &finished.mesh.positions {
            let r = p.distance(Point3::ORIGIN);
            let off = (r - inner).abs().min((r - inner - 2.5).abs());
            assert!(off < 0.06, "{side:?}: {r}");
        }
        let cube = finished.voxels.lattice.pitch.powi(3);
        assert!((finished.voxels.len() as f64 * cube / expected - 1.0).abs() < 0.03);
    }
}

#[test]
fn an_open_wall_ends_flat_at_its_rims() {
    let mesh = turned(&[[15.0, 0.0], [15.0, 30.0]], 128);
    let surface = voxelize(&mesh, 0.8).unwrap();
    let solid = vec![true; surface.voxels.len()];
    let finished = made(&mesh, &surface, &solid, Side::Center);
    let bounds = finished.mesh.bounds();
    assert!(
        bounds.min.z.abs() < 0.05 && (bounds.max.z - 30.0).abs() < 0.05,
        "{bounds:?}"
    );
    let expected = std::f64::consts::PI * 30.0 * 30.0 * 2.5;
    assert!((finished.mesh.volume() / expected - 1.0).abs() < 0.02);
}

#[test]
fn a_striped_wall_has_the_volume_of_its_stripes() {
    let mesh = turned(&[[15.0, 0.0], [15.0, 40.0]], 128);
    let surface = voxelize(&mesh, 0.5).unwrap();
    let solid: Vec<bool> = surface
        .voxels
        .cells
        .iter()
        .map(|cell| (surface.voxels.lattice.center(*cell).z / 5.0 - 0.5).rem_euclid(2.0) < 1.0)
        .collect();
    let finished = made(&mesh, &surface, &solid, Side::Center);
    assert_eq!(finished.pieces, 4);
    assert_eq!(finished.loose.len(), 3);
    let expected = std::f64::consts::PI * 30.0 * 20.0 * 2.5;
    let ratio = finished.mesh.volume() / expected;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

#[test]
fn random_patterns_give_closed_meshes_that_meet_nowhere_by_an_edge() {
    let mesh = ball(10.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    for n in 0..20 {
        let seed = Seed::root(n);
        let solid: Vec<bool> = (0..surface.voxels.len())
            .map(|v| seed.unit(v as u64) < 0.6)
            .collect();
        let finished = made(&mesh, &surface, &solid, Side::Center);
        let components = finished.mesh.components();
        let outer = components
            .iter()
            .filter(|piece| piece.volume() > 0.0)
            .count();
        assert_eq!(outer, finished.pieces, "seed {n}");
    }
}

#[test]
fn nothing_solid_is_an_error() {
    let mesh = ball(5.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let solid = vec![false; surface.voxels.len()];
    let thickness = Thickness {
        thickness: 1.0,
        side: Side::Center,
    };
    assert!(finish(&mesh, &surface, &solid, thickness).is_err());
}

#[test]
fn a_wall_too_thin_for_its_size_is_refused_before_it_is_made() {
    let mesh = ball(20.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let solid = vec![true; surface.voxels.len()];
    let thickness = Thickness {
        thickness: 1e-4,
        side: Side::Center,
    };
    let refused = finish(&mesh, &surface, &solid, thickness).err();
    assert!(matches!(refused, Some(FinishError::TooLarge { .. })));
}

/// A diagonal line of single voxels vanishes under the smooth border; the body is joined again along it.
#[test]
fn what_the_smooth_border_has_parted_is_joined_again() {
    let mesh = crate::voxelize::tests::shapes::square(40.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let graph = SurfaceGraph::new(&surface);
    let low = surface.voxels.cells[0];
    let is_solid = |cell: &[u16; 3]| {
        let [x, y] = [cell[0] - low[0], cell[1] - low[1]];
        x.max(y) < 12 || x.min(y) > 27 || (x == y && x % 3 > 0)
    };
    let mut solid: Vec<bool> = surface.voxels.cells.iter().map(is_solid).collect();
    let thickness = Thickness {
        thickness: 2.5,
        side: Side::Outside,
    };
    let before = finish(&mesh, &surface, &solid, thickness).unwrap();
    assert!(before.pieces > 1);
    solid = room::rejoined(&graph, &surface, &solid, (&before, thickness), 1.0).unwrap();
    let after = finish(&mesh, &surface, &solid, thickness).unwrap();
    assert_eq!(after.pieces, 1);
    assert!(room::rejoined(&graph, &surface, &solid, (&after, thickness), 1.0).is_none());
}

/// Of triangles the sines of the least angles, ascending, and how many edges have their triangles facing apart by more than
/// 150 degrees.
fn shape(mesh: &Mesh) -> (Vec<f64>, usize) {
    let mut sines: Vec<f64> = mesh
        .triangles
        .iter()
        .map(|t| room::slivers::sine(mesh.corners(*t)))
        .collect();
    sines.sort_by(f64::total_cmp);
    let mut sides: Vec<([u32; 2], usize)> = Vec::new();
    for (number, t) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            sides.push(([a.min(b), a.max(b)], number));
        }
    }
    sides.sort_unstable();
    let normal = |number: usize| {
        fretwork_geometry::mesh::doubled_normal(mesh.corners(mesh.triangles[number])).unit()
    };
    let is_folded = |pair: &&[([u32; 2], usize)]| {
        let normals = [0, 1].map(|side| normal(pair[side].1).unwrap_or_default());
        normals[0].dot(normals[1]) < -0.87
    };
    (sines, sides.chunks_exact(2).filter(is_folded).count())
}

/// S9: smooth walls, triangles without slivers, edges that are not chipped, on round and flat surfaces with a pattern of
/// slanted stripes.
#[test]
fn walls_have_no_slivers_and_no_chipped_edges() {
    let cube = crate::voxelize::tests::shapes::cube(30.0);
    let tube = turned(&[[15.0, 0.0], [15.0, 30.0]], 128);
    // The sines of the least angle and of the thousandth: some triangles along the ends of a tube stay narrow.
    for (name, mesh, least) in [
        ("ball", ball(15.0), [0.03, 0.17]),
        ("tube", tube, [0.01, 0.06]),
        ("cube", cube, [0.03, 0.17]),
    ] {
        for voxel in [0.9, 0.55] {
            let surface = voxelize(&mesh, voxel).unwrap();
            let stripe = |p: Point3| (0.3 * p.x + 0.2 * p.y + 0.9 * p.z).rem_euclid(8.0) < 4.5;
            let solid: Vec<bool> = surface
                .voxels
                .cells
                .iter()
                .map(|cell| stripe(surface.voxels.lattice.center(*cell)))
                .collect();
            let finished = made(&mesh, &surface, &solid, Side::Center);
            let (sines, folded) = shape(&finished.mesh);
            let quantile = |part: f64| sines[(part * sines.len() as f64) as usize];
            let worst = [sines[0], quantile(0.001), quantile(0.01)];
            println!(
                "{name} {voxel}: {worst:?}, {folded} folded of {}",
                sines.len()
            );
            assert!(
                worst[0] > least[0] && worst[1] > least[1] && worst[2] > 0.2,
                "{name}: {worst:?}"
            );
            assert!(
                folded * 1000 <= sines.len(),
                "{name}: {folded} edges are folded"
            );
        }
    }
}

/// A closed void of a few samples, which rounding of a pattern's border leaves in a wall, is filled.
#[test]
fn bubbles_are_filled() {
    let mesh = ball(10.0);
    let whole = mesh.clone();
    let mut bubbly = whole.clone();
    let scale = |by: f64| fretwork_geometry::Affine3::scale(Point3::new(by, by, by));
    bubbly.append(&ball(10.0).transformed(&scale(0.02)).reversed());
    let mut hollow = whole.clone();
    hollow.append(&ball(10.0).transformed(&scale(0.5)).reversed());
    assert_eq!(room::without_bubbles(bubbly, 1.0).components().len(), 1);
    assert_eq!(room::without_bubbles(hollow, 1.0).components().len(), 2);
}
