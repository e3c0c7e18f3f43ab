//! The same bits for any number of threads.

use fretwork_geometry::voxel::Voxel;

use super::super::{Analysis, Case, MemoryLimit, Model, Sweep};
use super::{ABS, cells, millimetres, set};

/// A ball's shell with a window, some 4,600 voxels: several slabs, chunks and patches.
fn shell() -> Vec<Voxel> {
    let inside = |[x, y, z]: &Voxel| {
        let [x, y, z] = [x, y, z].map(|n| f64::from(*n) - 14.5);
        let square = x * x + y * y + z * z;
        (130.0..215.0).contains(&square) && !(x > 6.0 && y.abs() < 5.0)
    };
    cells([0; 3], [30; 3]).into_iter().filter(inside).collect()
}

#[test]
fn results_do_not_depend_on_threads() {
    let voxels = set(shell());
    let lowest = millimetres(&voxels).bounds().min.z + 2.0;
    let is_low = move |p: fretwork_geometry::Point3| p.z <= lowest;
    let run = || -> (Analysis, (Analysis, Sweep)) {
        let model = Model::new(&millimetres(&voxels), &ABS, &is_low, MemoryLimit::default());
        let model = model.unwrap();
        let case = Case {
            gravity: [3.0, 1.0, -9.81],
            loads: Vec::new(),
        };
        (model.analyse(&case).unwrap(), model.sweep(&case).unwrap())
    };
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(run)
    };
    let expected = with(1);
    assert!(voxels.len() > 4000 && expected.0.summary.iterations < 40);
    assert_eq!(
        expected.0.summary.iterations,
        expected.1.0.summary.iterations
    );
    for threads in [2, 7] {
        let found = with(threads);
        assert!(found == expected, "{threads} threads");
        let bits = |found: &(Analysis, (Analysis, Sweep))| -> Vec<u64> {
            let (alone, (swept, _)) = found;
            let all = alone.stresses.iter().chain(&swept.stresses).flatten();
            all.map(|x| x.to_bits()).collect()
        };
        assert_eq!(bits(&found), bits(&expected));
    }
}

/// Slabs share nodes only with their neighbours, whatever gaps the body has.
#[test]
fn slabs_never_overlap_beyond_their_neighbours() {
    let mut cells = cells([0; 3], [90, 2, 2]);
    cells.retain(|cell| cell[0] % 9 != 4);
    let mesh = super::super::mesh::Mesh::new(&set(cells).cells, |_| false);
    assert!(mesh.slabs.len() > 30);
    for pair in mesh.slabs.windows(3) {
        assert!(pair[0].nodes.1 <= pair[2].nodes.0);
    }
    let covered: usize = mesh.slabs.iter().map(|s| s.elements.1 - s.elements.0).sum();
    assert_eq!(covered, mesh.elements.len());
}
