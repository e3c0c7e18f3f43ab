//! Which parts of solids meet. Exact work is done for those only.

use fretwork_geometry::budget;
use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::mesh::Surface;
use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::{Bounds3, Mesh};

/// The bodies of some meshes, one after the other. A mesh with cavities is taken as it is, for a cavity is no body.
pub(super) fn parts(meshes: &[Mesh]) -> Vec<Mesh> {
    let mut parts = Vec::new();
    for mesh in meshes {
        let bodies = mesh.components();
        if bodies.iter().all(|body| body.volume() > 0.0) {
            parts.extend(bodies);
        } else {
            parts.push(mesh.clone());
        }
    }
    parts
}

/// The numbers of the parts in groups: parts of different groups are apart. Groups and their members are ascending.
///
/// Boxes are compared first, then the surfaces of those whose boxes meet. Where the surfaces are apart one part may still
/// be inside of another; only a part whose box holds that of the other can be round it, and such pairs are left together.
pub(super) fn groups(parts: &[Mesh]) -> Vec<Vec<usize>> {
    let boxes: Vec<Bounds3> = parts.iter().map(Mesh::bounds).collect();
    let extents: Vec<Extent<3>> = boxes.iter().map(|b| (*b).into()).collect();
    let pairs = BoxTree::new(&extents).meeting_pairs();
    let surfaces: Vec<Surface> = if pairs.is_empty() {
        Vec::new()
    } else {
        parts.iter().map(Surface::new).collect()
    };
    let mut sets = UnionFind::new(parts.len());
    for [a, b] in pairs {
        // Two that are together through others need not be compared.
        if sets.find(a) == sets.find(b) {
            continue;
        }
        let (i, j) = (a as usize, b as usize);
        budget::spend("parts that may meet", 200);
        let is_inside = holds(&boxes[i], &boxes[j]) || holds(&boxes[j], &boxes[i]);
        if is_inside || surfaces[i].may_touch(&surfaces[j]) {
            sets.unite(a, b);
        }
    }
    let labels = sets.labels();
    let mut groups = vec![Vec::new(); sets.count()];
    for (part, group) in labels.into_iter().enumerate() {
        groups[group as usize].push(part);
    }
    groups
}

/// Whether a box is around another one.
fn holds(outer: &Bounds3, inner: &Bounds3) -> bool {
    let both = outer.union(*inner);
    both == *outer
}

#[cfg(test)]
mod tests {
    use super::super::{cuboid, cylinder};
    use super::*;
    use fretwork_geometry::{Affine3, Point3};

    #[test]
    fn only_parts_that_meet_are_together() {
        let bar = cuboid(Point3::new(10.0, 1.0, 1.0)).unwrap();
        let up = Point3::new(0.0, 0.0, 1.0);
        let turned = |degrees: f64, x: f64| {
            let turn = Affine3::rotation(up, degrees.to_radians());
            bar.transformed(&turn.then(&Affine3::translation(Point3::new(x, 0.0, 0.0))))
        };
        // The boxes of the first two overlap, and the bars do not; the third lies across the first.
        let parts = [turned(45.0, 0.0), turned(45.0, 3.0), turned(135.0, 4.0)];
        assert_eq!(groups(&parts[..2]), [[0], [1]]);
        assert_eq!(groups(&parts), [vec![0, 1, 2]]);
        assert_eq!(groups(&[]), Vec::<Vec<usize>>::new());
    }

    #[test]
    fn what_is_inside_of_another_part_is_with_it() {
        let outer = cuboid(Point3::new(9.0, 9.0, 9.0)).unwrap();
        let inner = cylinder(1.0, 2.0, 12).unwrap();
        let inner = inner.transformed(&Affine3::translation(Point3::new(4.0, 4.0, 4.0)));
        assert_eq!(groups(&[outer, inner]), [[0, 1]]);
    }
}
