//! Features that are thinner than can be made, made wide enough on the surface (Dumas 2015, 6.2.1). What is thin says
//! `thin`; how wide the result is measures `width`.
//!
//! The middle of a feature is where no neighbour's largest disc holds the whole of its own largest
//! disc: the centres of maximal discs, the geodesic skeleton. What no disc of the asked radius fits
//! into is thin. A thin part that leads from one place of the pattern to another, or stands alone, is
//! widened about its skeleton; one that only ends, as the corner of any shape does, is left: it is a
//! leaf of the skeleton, and widening it would put a knob on every corner.

use fretwork_geometry::Point3;
use fretwork_geometry::voxel::VoxelSurface;

use crate::connect::{Forest, NOBODY, SurfaceGraph, Touch, UNIT};

use super::thin::{Thin, fits_between, leaf, units};
use super::width::Narrow;

/// Rounds of widening, at most.
const ROUNDS: usize = 6;
/// A width is a quotient of lengths: so much more than a whole number of voxels is none.
const ROUNDING: f64 = 1e-6;

/// The solid voxels with those that features of less than the `width`, in pitches, lack. What is filled can
/// leave a narrow place beside it, so that there are rounds, as many as it takes but for a limit.
///
/// `rim` are the voxels in which the surface ends: a feature ends there too, and is widened away from it.
pub fn widened(graph: &SurfaceGraph, (solid, rim): (&[bool], &[bool]), width: f64) -> Vec<bool> {
    let mut solid = solid.to_vec();
    for _ in 0..ROUNDS {
        let thin = Thin::of(graph, (&solid, rim), width / 2.0, leaf(width));
        let is_middle = |v: &u32| thin.is_kept(*v) && thin.is_middle(graph, *v);
        let middle: Vec<u32> = (0..graph.len() as u32).filter(is_middle).collect();
        if middle.is_empty() {
            break;
        }
        let count = (width - ROUNDING).ceil();
        let [single, paired] = by_parity(graph, &thin, middle, count % 2.0 == 1.0);
        // A voxel with so many on each side is at least as wide as asked; of a pair each has one side.
        let beside = [((count - 1.0) / 2.0).ceil(), (count / 2.0).ceil() - 1.0];
        for (middle, beside) in [single, paired].into_iter().zip(beside) {
            let mut reach = Forest::new(graph.len());
            middle.into_iter().for_each(|v| reach.plant(v, 0));
            reach.grow(graph, Touch::Corner, units(beside), |_| true);
            for (solid, distance) in solid.iter_mut().zip(&reach.distances) {
                *solid |= *distance != u32::MAX;
            }
        }
    }
    solid
}

/// Middles that are widened on both sides, and such that are so in pairs, each on its side. Of the voxels of a strip of an
/// even number two are a pair: between them there is room for a disc that is half a pitch larger than those about
/// either. Where a strip is to become of an odd number, the first of a pair counts by itself and the other one as
/// none; where one of an odd number is to become of an even one, its middle and a voxel on one side are a pair.
fn by_parity(graph: &SurfaceGraph, thin: &Thin, middle: Vec<u32>, is_odd: bool) -> [Vec<u32>; 2] {
    let depth = |v: u32| thin.empty.distances[v as usize];
    let [mut single, mut paired] = [Vec::new(), Vec::new()];
    for v in middle {
        let wide = f64::from(depth(v)) / f64::from(UNIT) + 0.5 - ROUNDING;
        // Where the surface ends, it does so in the middle of a voxel.
        let is_rim = match thin.empty.owners[v as usize] {
            NOBODY => false,
            nearest => depth(nearest) > 0,
        };
        let beside = graph.touching(v, Touch::Face);
        let beside = beside.filter(|w| !is_rim && depth(*w) > 0);
        let partner = beside
            .filter(|w| fits_between(graph, &thin.empty, (v, *w), wide))
            .max();
        match partner {
            Some(_) if !is_odd => paired.push(v),
            Some(w) if v < w => single.push(v),
            Some(_) => {}
            None if is_odd || is_rim => single.push(v),
            None => {
                // Along a strip the last of the voxels is always on the same side.
                let across = graph
                    .touching(v, Touch::Face)
                    .filter(|w| depth(*w) < depth(v));
                paired.extend([v].into_iter().chain(across.max()));
            }
        }
    }
    [single, paired]
}

/// Where a disc is about which voxels are filled, beside the middle of a narrow place, in pitches: of two voxels that are
/// equally far from the middle one is nearer, so that a strip becomes wider by one voxel before it does so by two.
const ASIDE: Point3 = Point3 {
    x: 0.13,
    y: 0.09,
    z: 0.05,
};

/// The solid voxels with those no farther than `radius`, a length, from the middles of narrow `places`: what is a strip of voxels
/// wide enough may not be so for the smooth border that its wall ends at.
pub fn stamped(
    surface: &VoxelSurface,
    solid: &[bool],
    places: &[Narrow],
    radius: f64,
) -> Vec<bool> {
    let voxels = &surface.voxels;
    let mut stamped = solid.to_vec();
    for place in places {
        let middle = place.middle + ASIDE * voxels.lattice.pitch;
        let far = Point3::new(radius, radius, radius);
        let cell = |p: Point3| voxels.lattice.place(p).map(|c| c.max(0.0) as u16);
        let (low, high) = (cell(middle - far), cell(middle + far));
        let range = |axis: usize| low[axis]..=high[axis];
        let all =
            range(0).flat_map(|x| range(1).flat_map(move |y| range(2).map(move |z| [x, y, z])));
        let near = all.filter(|cell| voxels.lattice.center(*cell).distance(middle) <= radius);
        for voxel in near.filter_map(|cell| voxels.find(cell)) {
            let normal = Point3::from(surface.normals[voxel].map(f64::from));
            // Those that face away may be of another sheet.
            stamped[voxel] |= normal.dot(place.normal) > -0.5;
        }
    }
    stamped
}
