//! Shadows of hollows: how much of what is around a pixel stands nearer to the viewer than it.
//!
//! For a pixel and two others at opposite sides of it, what the mean of their depths is nearer than
//! its own is how deep it lies between them; on a flat face, however it leans, this is nothing
//! (paired samples, as in Loos and Sloan, Volumetric Obscurance, 2010). The mean over rings of
//! pairs darkens grooves, inner corners, and what is engraved, also where all faces have one
//! normal.

use rayon::prelude::*;

use super::shading::Pixel;

/// The radii of the rings, as shares of the width of the picture. Small ones show fine engravings,
/// large ones how bodies stand to one another; much larger ones would darken whole fronts.
const RADII: [f64; 3] = [0.003, 0.008, 0.02];
/// One direction of each pair, in 1/1000 of the radius.
const DIRECTIONS: [(i64, i64); 8] = [
    (1000, 0),
    (924, 383),
    (707, 707),
    (383, 924),
    (0, 1000),
    (-383, 924),
    (-707, 707),
    (-924, 383),
];
/// How much light the deepest hollow loses.
const DARKEST: f32 = 0.6;
/// Beyond so many radii two pixels have nothing to do with each other: one is far behind the other.
const FARTHEST: f32 = 4.0;

/// The share of its light that each pixel keeps, row by row. The same for any number of threads.
pub fn kept_light(pixels: &[Pixel], width: usize) -> Vec<f32> {
    let rings = RADII.map(|share| (share * width as f64).max(1.0));
    let pairs: Vec<((i64, i64), f32)> = rings
        .into_iter()
        .flat_map(|radius| DIRECTIONS.map(|direction| (scaled(direction, radius), radius as f32)))
        .collect();
    let kept = |index: usize| {
        let here = &pixels[index];
        if here.cover == 0.0 {
            return 1.0;
        }
        let at = ((index % width) as i64, (index / width) as i64);
        let depths = pairs.iter().map(|&(offset, radius)| {
            let there = |sign: i64| {
                let x = usize::try_from(at.0 + sign * offset.0).ok()?;
                let y = usize::try_from(at.1 + sign * offset.1).ok()?;
                let pixel = pixels.get(y * width + x).filter(|_| x < width)?;
                if pixel.cover == 0.0 {
                    return None;
                }
                let rise = pixel.nearness - here.nearness;
                (rise.abs() <= FARTHEST * radius).then_some(rise)
            };
            let depth = there(1).zip(there(-1)).map_or(0.0, |(a, b)| 0.5 * (a + b));
            (depth / radius).clamp(0.0, 1.0)
        });
        let deep = depths.sum::<f32>() / pairs.len() as f32;
        1.0 - DARKEST * (2.5 * deep).min(1.0)
    };
    (0..pixels.len()).into_par_iter().map(kept).collect()
}

fn scaled((x, y): (i64, i64), radius: f64) -> (i64, i64) {
    let scale = |v: i64| (v as f64 * radius / 1000.0).round() as i64;
    (scale(x), scale(y))
}
