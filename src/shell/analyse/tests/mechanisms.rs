//! Parts that can move without strain are named before anything is solved.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::Voxel;

use super::super::{AnalysisError, Hold, LoosePart, MemoryLimit, Model};
use super::{ABS, cells, millimetres, on_floor, set};

/// What is loose in a body.
fn loose(cells: Vec<Voxel>, supports: impl Fn(Point3) -> bool + Sync) -> Vec<LoosePart> {
    let voxels = set(cells);
    match Model::new(
        &millimetres(&voxels),
        &ABS,
        &supports,
        MemoryLimit::default(),
    ) {
        Ok(_) => Vec::new(),
        Err(AnalysisError::Loose(parts)) => parts,
        Err(other) => panic!("{other}"),
    }
}

fn part(at: [f64; 3], hold: Hold, voxels: usize) -> LoosePart {
    let at = Point3::from(at);
    LoosePart { at, hold, voxels }
}

#[test]
fn an_edge_is_a_hinge() {
    let two = [cells([0, 0, 0], [2, 3, 2]), cells([2, 0, 2], [4, 3, 4])].concat();
    let found = loose(two.clone(), on_floor);
    assert_eq!(found, [part([2.0, 1.5, 2.0], Hold::Edge, 12)]);
    assert_eq!(
        AnalysisError::Loose(found).to_string(),
        "a part of 12 voxels at (2.000, 1.500, 2.000) hangs by one edge, about which it can swing"
    );
    // One voxel more makes faces of it.
    assert_eq!(loose([two, vec![[2, 1, 1]]].concat(), on_floor), []);
}

#[test]
fn a_corner_is_a_joint() {
    let two = [cells([0; 3], [2; 3]), cells([2; 3], [4; 3])].concat();
    let found = loose(two, on_floor);
    assert_eq!(found, [part([2.0; 3], Hold::Corner, 8)]);
}

#[test]
fn a_floating_piece_hangs_by_nothing() {
    // The two floating blocks share an edge: they are told as one.
    let three = [
        cells([0; 3], [2; 3]),
        cells([5, 0, 4], [6, 2, 6]),
        cells([6, 0, 6], [7, 2, 7]),
    ];
    let found = loose(three.concat(), on_floor);
    assert_eq!(found, [part([5.5, 0.5, 4.5], Hold::Nothing, 6)]);
}

#[test]
fn a_body_held_along_a_line_swings() {
    let line = |p: Point3| p.x == 0.0 && p.z == 0.0;
    let found = loose(cells([0; 3], [3; 3]), line);
    assert_eq!(found, [part([0.0, 1.5, 0.0], Hold::Edge, 27)]);
    let point = |p: Point3| p == Point3::ORIGIN;
    let found = loose(cells([0; 3], [3; 3]), point);
    assert_eq!(found, [part([0.0; 3], Hold::Corner, 27)]);
    // Three nodes of one face are enough.
    let three = |p: Point3| p.z == 0.0 && p.x + p.y <= 1.0;
    assert_eq!(loose(cells([0; 3], [3; 3]), three), []);
}

/// Four blocks, each of which shares an edge with the next. The three edges lie in no plane.
pub(super) fn links() -> Vec<Voxel> {
    [
        cells([0, 0, 0], [2, 3, 2]),
        cells([2, 0, 2], [4, 3, 4]),
        cells([4, 0, 4], [6, 3, 6]),
        cells([6, 0, 2], [8, 3, 4]),
    ]
    .concat()
}

/// The first block's foot, and the far side of the last.
pub(super) fn is_at_the_ends(p: Point3) -> bool {
    p.z == 0.0 || p.x == 8.0
}

#[test]
fn a_chain_of_hinges_is_loose() {
    let chain = [
        cells([0, 0, 0], [2, 3, 2]),
        cells([2, 0, 2], [4, 3, 4]),
        cells([4, 0, 4], [6, 3, 6]),
    ];
    let found = loose(chain.concat(), on_floor);
    assert_eq!(
        found,
        [
            part([2.0, 0.0, 2.0], Hold::Chain, 12),
            part([4.0, 1.5, 4.0], Hold::Edge, 12)
        ]
    );
    assert!(
        AnalysisError::Loose(found)
            .to_string()
            .ends_with("and 1 more such parts")
    );
}

/// Two links between two blocks that are held: loose while the three hinges lie in one plane, and only
/// then.
#[test]
fn hinges_that_hold_one_another_are_no_mechanism() {
    let straight = [
        cells([0, 0, 0], [2, 3, 2]),
        cells([2, 0, 2], [4, 3, 4]),
        cells([4, 0, 4], [6, 3, 6]),
        cells([6, 0, 6], [8, 3, 8]),
    ];
    let found = loose(straight.concat(), is_at_the_ends);
    assert_eq!(found.len(), 2);
    assert!(found.iter().all(|part| part.hold == Hold::Chain));
    assert_eq!(loose(links(), is_at_the_ends), []);
}

/// Blocks that share three nodes with two others, which share only an edge with one another.
#[test]
fn parts_are_merged_until_none_is_left() {
    // The upper block lies on the corners of three pillars, one node each.
    let pillars = [
        cells([0, 0, 0], [2, 2, 2]),
        cells([4, 0, 0], [6, 2, 2]),
        cells([2, 4, 0], [4, 6, 2]),
    ];
    let lid = cells([2, 2, 2], [4, 4, 3]);
    assert_eq!(loose([pillars.concat(), lid].concat(), on_floor), []);
}
