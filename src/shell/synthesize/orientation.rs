//! Where the exemplar's up points on each level.

use super::Options;
use crate::voxelize::Level;

/// For each level the vectors of its voxels: on the finest what was given, or `up` as it lies in the tangent
/// plane, shorter where the surface is level and up says little. On coarser levels the mean of the children.
pub(super) fn levels(pyramid: &[Level], options: &Options) -> Vec<Vec<[f32; 3]>> {
    let normals = &pyramid[0].surface.normals;
    let finest: Vec<[f32; 3]> = match &options.orientation {
        Some(given) => normals
            .iter()
            .zip(given)
            .map(|(n, v)| tangent(*v, *n))
            .collect(),
        None => normals.iter().map(|n| tangent(options.up, *n)).collect(),
    };
    let mut levels = vec![finest];
    for (level, below) in pyramid[1..].iter().zip(0..) {
        let mean = |parent: usize| {
            let children = level.children.row(parent);
            let sum = sum(&levels[below], children, options.is_axial);
            let sum = sum.map(|c| c / children.len() as f32);
            tangent(sum, level.surface.normals[parent])
        };
        let above = (0..level.surface.voxels.len()).map(mean).collect();
        levels.push(above);
    }
    levels
}

/// The part of a vector at a right angle to a unit normal, no longer than one.
fn tangent(vector: [f32; 3], normal: [f32; 3]) -> [f32; 3] {
    let lean = dot(vector, normal);
    let flat = [0, 1, 2].map(|i| vector[i] - lean * normal[i]);
    let length = dot(flat, flat).sqrt();
    flat.map(|c| c / length.max(1.0))
}

/// The sum of some vectors; of those without a sign each is taken the way round that makes it longer.
fn sum(vectors: &[[f32; 3]], of: &[u32], is_axial: bool) -> [f32; 3] {
    let mut sum = [0f32; 3];
    for &number in of {
        let vector = vectors[number as usize];
        let sign = if is_axial && dot(sum, vector) < 0.0 {
            -1.0
        } else {
            1.0
        };
        for (s, v) in sum.iter_mut().zip(vector) {
            *s += sign * v;
        }
    }
    sum
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
