//! The exemplar as each level of voxels sees it: a Gaussian stack (Lefebvre, Hoppe 2005) of its colours
//! and of the distance from the edge of what is solid, in small integers.

use fretwork_geometry::Pixels;

use super::distance::{medial_radius, signed_distance};
use super::label::Phase;
use super::picture::{CHANNELS, Picture};

/// Colours and distance of a texel. Their squared differences are exact in 32 bits.
pub(super) type Texel = [i16; CHANNELS];

/// The full range of a distance, and of the three colours together.
const RANGE: f32 = 255.0;

/// The squared difference between the most different texels of one channel.
pub(super) const UNIT: f32 = RANGE * RANGE;

/// The width of a texel in voxels of its level. Texels are read without interpolation: at half a voxel
/// lines bend by a quarter of one at most, and smaller texels would only leave the cache.
const TEXEL: f64 = 0.5;

/// The standard deviation of a level's blur in its voxels.
const BLUR: f64 = 0.4;

/// Texels along a side, at least and at most.
const SIDE: [f64; 2] = [8.0, 1024.0];

/// How far from the border of an exemplar that does not tile a voxel should keep, in voxels: the reach
/// of its neighbours.
const MARGIN: f64 = 2.5;

/// The exemplar on one level.
pub(super) struct Layer {
    size: [u32; 2],
    texels: Vec<Texel>,
    solid: Vec<bool>,
    /// How much a texel is to be avoided, from 0 to 1; empty where the exemplar tiles.
    border: Vec<f32>,
    /// The colours to show.
    colors: Vec<[u8; 3]>,
}

impl Layer {
    /// The number of the texel at a phase.
    #[inline]
    pub(super) fn index(&self, [x, y]: Phase) -> usize {
        let along = |phase: u32, size: u32| (u64::from(phase) * u64::from(size)) >> 32;
        (along(y, self.size[1]) * u64::from(self.size[0]) + along(x, self.size[0])) as usize
    }

    /// The texel at a phase.
    #[inline]
    pub(super) fn texel(&self, phase: Phase) -> Texel {
        self.texels[self.index(phase)]
    }

    /// Whether the exemplar is solid at a phase.
    #[inline]
    pub(super) fn is_solid(&self, phase: Phase) -> bool {
        self.solid[self.index(phase)]
    }

    /// The part of the texels that is solid.
    pub(super) fn solid_fraction(&self) -> f64 {
        let solid = self.solid.iter().filter(|solid| **solid).count();
        solid as f64 / self.solid.len() as f64
    }

    /// How much a phase is to be avoided for the border, from 0 to 1.
    #[inline]
    pub(super) fn border(&self, phase: Phase) -> f32 {
        if self.border.is_empty() {
            return 0.0;
        }
        self.border[self.index(phase)]
    }

    /// The colour at a phase.
    #[inline]
    pub(super) fn color(&self, phase: Phase) -> [u8; 3] {
        self.colors[self.index(phase)]
    }
}

/// The layers of an exemplar for `levels` levels of voxels, the finest of side `pitch`.
pub(super) fn layers(exemplar: &Pixels, pitch: f64, levels: usize) -> Vec<Layer> {
    let pixels = [exemplar.width, exemplar.height()];
    let extent = pixels.map(|n| n as f64 * exemplar.pixel_size / pitch);
    let mut picture = features(exemplar);
    // What the picture has been blurred by so far, as a variance in voxels of the finest level. A pixel
    // is a blur by itself, of a twelfth of its square.
    let mut variance = (exemplar.pixel_size / pitch).powi(2) / 12.0;
    let mut layers = Vec::with_capacity(levels);
    for level in 0..levels {
        let voxel = (1u64 << level.min(40)) as f64;
        let wanted = (BLUR * voxel).powi(2);
        if wanted > variance {
            let sigma = (wanted - variance).sqrt();
            let by = [0, 1].map(|axis| sigma * picture.size[axis] as f64 / extent[axis]);
            picture = picture.blurred(by);
            variance = wanted;
        }
        let side = |e: f64| (e / (TEXEL * voxel)).clamp(SIDE[0], SIDE[1]).round() as usize;
        let sampled = picture.resampled(extent.map(side));
        layers.push(layer(exemplar, &sampled, extent.map(|e| e / voxel)));
        // Coarser levels start from fewer pixels, but never from more than there were.
        if sampled.pixels.len() < picture.pixels.len() {
            picture = sampled;
        }
    }
    layers
}

/// Colours and distance of the exemplar's own pixels, each channel over its range.
fn features(exemplar: &Pixels) -> Picture {
    let depth = signed_distance(exemplar);
    // Beyond the middle of a feature the distance says no more.
    let reach = medial_radius(exemplar, &depth).max(1.0);
    let pixel = |(rgb, depth): (&[u8; 3], &f32)| {
        let [r, g, b] = rgb.map(|c| f32::from(c) / 3f32.sqrt());
        [r, g, b, 0.5 * RANGE * (depth / reach).clamp(-1.0, 1.0)]
    };
    Picture {
        size: [exemplar.width, exemplar.height()],
        pixels: exemplar.rgb.iter().zip(&depth).map(pixel).collect(),
        wraps: exemplar.tileable,
    }
}

/// A layer of a picture whose extent is in voxels.
fn layer(exemplar: &Pixels, picture: &Picture, extent: [f64; 2]) -> Layer {
    let edge = edge(exemplar.solid_fraction(), picture);
    let rounded = |c: f32| (c + 0.5).floor() as i16;
    let shown = |c: f32| (c * 3f32.sqrt() + 0.5).clamp(0.0, 255.0) as u8;
    let border = if exemplar.tileable {
        Vec::new()
    } else {
        border(picture.size, extent)
    };
    Layer {
        size: picture.size.map(|n| n as u32),
        texels: picture.pixels.iter().map(|p| p.map(rounded)).collect(),
        solid: picture.pixels.iter().map(|p| p[3] > edge).collect(),
        border,
        colors: picture
            .pixels
            .iter()
            .map(|p| [p[0], p[1], p[2]].map(shown))
            .collect(),
    }
}

/// Above which distance texels are solid, so that the part of them is the exemplar's: blurring and
/// sampling move the level zero of features as thin as a voxel (S4).
fn edge(fraction: f64, picture: &Picture) -> f32 {
    let mut depths: Vec<f32> = picture.pixels.iter().map(|p| p[3]).collect();
    depths.sort_by(f32::total_cmp);
    let wanted = depths.len() as f64 * (1.0 - fraction);
    // Zero is right wherever it is as good: many texels may have the same distance.
    let empty = |edge: f32| depths.partition_point(|d| *d <= edge) as f64;
    let at = (wanted as usize).clamp(1, depths.len() - 1);
    let middle = 0.5 * (depths[at - 1] + depths[at]);
    let off = |edge: f32| (empty(edge) - wanted).abs();
    if off(middle) < off(0.0) { middle } else { 0.0 }
}

/// How much each texel is to be avoided: 1 at the border, 0 from the reach of a neighbourhood on, which
/// is not let grow beyond an eighth of the exemplar.
fn border(size: [usize; 2], extent: [f64; 2]) -> Vec<f32> {
    let near = |axis: usize, n: usize| {
        let at = (n as f64 + 0.5) / size[axis] as f64;
        let from_side = at.min(1.0 - at) * extent[axis];
        (1.0 - from_side / MARGIN.min(extent[axis] / 8.0)).max(0.0) as f32
    };
    let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    texels.map(|(x, y)| near(0, x).max(near(1, y))).collect()
}

/// The squared difference of two texels.
#[inline]
pub(super) fn difference(a: Texel, b: Texel) -> u32 {
    let mut sum = 0i32;
    for (a, b) in a.iter().zip(b) {
        let d = i32::from(a - b);
        sum += d * d;
    }
    sum as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stripes(tileable: bool) -> Pixels {
        let solid: Vec<bool> = (0..40 * 20).map(|n| n % 10 < 3).collect();
        let shade = |s: &bool| if *s { [0; 3] } else { [255; 3] };
        Pixels {
            width: 40,
            rgb: solid.iter().map(shade).collect(),
            solid,
            pixel_size: 0.5,
            feature_radius: None,
            tileable,
        }
    }

    #[test]
    fn every_layer_is_as_solid_as_the_exemplar() {
        for pitch in [0.2, 0.5, 0.9, 2.0] {
            let layers = layers(&stripes(true), pitch, 3);
            for layer in &layers[..2] {
                let solid = layer.solid.iter().filter(|s| **s).count() as f64;
                let fraction = solid / layer.solid.len() as f64;
                assert!((fraction - 0.3).abs() < 0.1, "{pitch}: {fraction}");
            }
        }
    }

    #[test]
    fn coarse_layers_are_flat_and_fine_ones_are_the_exemplar() {
        let layers = layers(&stripes(true), 0.25, 8);
        let spread = |layer: &Layer| {
            let along = || layer.texels.iter().map(|t| t[3]);
            along().max().unwrap() - along().min().unwrap()
        };
        assert!(spread(&layers[0]) > 200 && spread(&layers[7]) < 3);
        assert!(layers[0].is_solid([1 << 20, 0]) && !layers[0].is_solid([1 << 29, 0]));
    }

    #[test]
    fn borders_are_avoided_where_exemplars_do_not_tile() {
        let layer = &layers(&stripes(false), 0.5, 1)[0];
        assert!(layer.border([0, 1 << 31]) > 0.8 && layer.border([1 << 31, u32::MAX]) > 0.8);
        assert_eq!(layer.border([1 << 31, 1 << 31]), 0.0);
        assert!(layers(&stripes(true), 0.5, 1)[0].border.is_empty());
    }
}
