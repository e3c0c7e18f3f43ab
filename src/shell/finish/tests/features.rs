//! Thin features made wide enough, and no others.

use fretwork_geometry::Point3;

use super::shapes::turned;
use crate::connect::SurfaceGraph;
use crate::finish::{least_width, rim, widened};
use crate::voxelize::voxelize;

#[test]
fn thin_strands_are_widened_and_corners_are_left() {
    let mesh = turned(&[[20.0, 0.0], [20.0, 30.0]], 128);
    let surface = voxelize(&mesh, 0.5).unwrap();
    let graph = SurfaceGraph::new(&surface);
    let center = |v: u32| graph.center(v);
    // Two broad rings and a strand of one voxel from one to the other, beside a corner of a broad patch.
    let is_broad = |p: Point3| p.z < 8.0 || p.z > 22.0 || (p.y < -17.0 && p.z < 14.0);
    let is_strand = |p: Point3| p.y > 0.0 && p.x > 0.0 && p.x <= 0.5;
    let count = |width: f64| {
        let solid: Vec<bool> = (0..graph.len() as u32)
            .map(|v| is_broad(center(v)) || is_strand(center(v)))
            .collect();
        let wide = widened(&graph, (&solid, &vec![false; graph.len()]), width);
        assert!(
            solid
                .iter()
                .zip(&wide)
                .all(|(before, after)| after >= before)
        );
        let at = |low: f64| {
            let level = (0..graph.len() as u32).filter(|v| {
                wide[*v as usize] && (center(*v).z - low).abs() < 0.3 && center(*v).y > 0.0
            });
            let xs: Vec<f64> = level.map(|v| center(v).x).collect();
            let least = xs.iter().copied().fold(f64::INFINITY, f64::min);
            xs.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least + 0.5
        };
        (
            at(15.0),
            least_width(
                (&mesh, &graph),
                (&wide, &vec![false; graph.len()]),
                (0.5 * width, 6.0),
            )
            .0,
            wide,
        )
    };
    let (strand, least, wide) = count(5.0);
    assert!((2.5..=3.5).contains(&strand), "{strand}");
    assert!(least >= 2.4, "{least}");
    let knobs = (0..graph.len() as u32)
        .filter(|v| wide[*v as usize] && !is_broad(center(*v)) && center(*v).y < 0.0)
        .count();
    assert_eq!(knobs, 0);
    let (strand, least, _) = count(1.0);
    assert!(strand <= 1.0 && least < 0.9, "{strand} {least}");
}

/// S4: a strip is widened to the next whole number of voxels and no more, whatever it has been.
#[test]
fn strips_become_as_wide_as_asked_and_no_wider() {
    let surface = crate::connect::tests::shapes::plane(60, 60);
    let graph = SurfaceGraph::new(&surface);
    for given in 1u16..5 {
        let is_solid =
            |cell: &[u16; 3]| (20..20 + given).contains(&(cell[1] - surface.voxels.cells[0][1]));
        let solid: Vec<bool> = surface.voxels.cells.iter().map(is_solid).collect();
        for width in [1.0, 2.0, 2.1, 3.0, 3.7, 4.0, 5.2, 6.0] {
            let wide = widened(&graph, (&solid, &vec![false; graph.len()]), width);
            let column = |cell: &&[u16; 3]| cell[0] == surface.voxels.cells[0][0] + 30;
            let count = surface.voxels.cells.iter().zip(&wide);
            let count = count.filter(|(cell, wide)| column(cell) && **wide).count() as f64;
            let least = f64::from(given).max((width - 1e-6f64).ceil());
            assert_eq!(count, least, "{given} voxels, {width} asked");
        }
    }
}

/// A strip along the end of an open surface is as wide as it is, not twice, and is widened away from the end.
#[test]
fn strips_along_a_rim_are_widened_and_measured() {
    let mesh = crate::voxelize::tests::shapes::square(40.0);
    let surface = voxelize(&mesh, 1.0).unwrap();
    let graph = SurfaceGraph::new(&surface);
    let rim = rim(&mesh, &surface);
    let low = surface.voxels.cells[0];
    let is_solid = |cell: &[u16; 3]| {
        let [x, y] = [cell[0] - low[0], cell[1] - low[1]];
        y < 2 || (y < 20 && !(10..=30).contains(&x))
    };
    let solid: Vec<bool> = surface.voxels.cells.iter().map(is_solid).collect();
    let width = |solid: &[bool]| least_width((&mesh, &graph), (solid, &rim), (4.0, 16.0)).0;
    assert!(width(&solid) <= 2.5, "{}", width(&solid));
    let wide = widened(&graph, (&solid, &rim), 4.0);
    assert!((3.5..=5.5).contains(&width(&wide)), "{}", width(&wide));
    let column = |cell: &[u16; 3]| cell[0] == low[0] + 20;
    let count = surface.voxels.cells.iter().zip(&wide);
    let count = count.filter(|(cell, wide)| column(cell) && **wide).count();
    assert!((4..=6).contains(&count), "{count}");
}
