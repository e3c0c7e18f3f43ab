//! What a local synthesis may change, and what it must keep (Dumas et al. 2015, section 4.4).

use crate::voxelize::Level;

/// How many levels a synthesis of features of some radius in voxels goes back: the logarithm of it, at
/// least one, so that there is room around what is forced, and at most to the coarsest.
pub(super) fn levels_back(radius: f64, levels: usize) -> usize {
    let back = libm::ceil(libm::log2(radius.max(1.0))) as usize;
    back.max(1).min(levels - 1)
}

/// Which voxels of the first `levels` levels hold one of the finest that is marked; no marks at all where none
/// is given.
pub(super) fn raised(pyramid: &[Level], marked: &[bool], levels: usize) -> Vec<Vec<bool>> {
    let mut all = vec![marked.to_vec()];
    for level in 1..levels {
        let below = &all[level - 1];
        let mut marks = Vec::new();
        if !below.is_empty() {
            marks = vec![false; pyramid[level].surface.voxels.len()];
            for (child, &parent) in pyramid[level - 1].parents.iter().enumerate() {
                marks[parent as usize] |= below[child];
            }
        }
        all.push(marks);
    }
    all
}

/// Which voxels of each level up to `back` lie below a voxel of level `back` that holds a marked one.
pub(super) fn below(pyramid: &[Level], marked: &[bool], back: usize) -> Vec<Vec<bool>> {
    let mut all = raised(pyramid, marked, back + 1);
    for level in (0..back).rev() {
        let parents = &pyramid[level].parents;
        all[level] = parents
            .iter()
            .map(|&p| all[level + 1][p as usize])
            .collect();
    }
    all
}
