//! Light on what is seen, and the lines at which it ends: from samples to pixels.

use super::raster::{Band, Facet, NOTHING, SAMPLES, Sample, Shares};
use fretwork_geometry::Point3;

/// How far apart two neighbouring samples must be in depth, beyond what the slopes of their faces
/// explain, to lie on two sides of an edge; in pixels. Less would draw lines on coarse meshes, more
/// would lose engravings.
const STEP: f64 = 0.7;
/// The cosine of the angle between normals from which on faces meet in an edge that is drawn, 30
/// degrees.
const CREASE: f64 = 0.866;
/// How dark the lines are where something ends before something else or before nothing.
const STEP_LINE: f32 = 0.75;
/// How dark the lines are where two faces meet.
const CREASE_LINE: f32 = 0.4;
/// Faces that are seen at a flatter angle than this (its sine) say nothing on the depth beside
/// them.
const FLATTEST: f64 = 0.08;

/// What a pixel shows before shadows.
#[derive(Clone, Copy, Default)]
pub struct Pixel {
    /// Linear light of what is seen, for a whole pixel of it.
    pub color: [f32; 3],
    /// The share of the pixel that it covers.
    pub cover: f32,
    /// How near it is on average, in pixels; not a number where nothing is.
    pub nearness: f32,
}

/// The pixels of a band. `up` is up in space in the frame of the camera.
pub fn pixels(band: &Band, facets: &[Facet], up: Point3) -> Vec<Pixel> {
    let fine = SAMPLES as usize;
    let width = band.width / fine;
    let mut pixels = vec![Pixel::default(); width * (band.inner_rows() / fine)];
    let mut shaded = vec![Shaded::default(); band.width];
    let mut before = vec![Shaded::default(); band.width];
    shade_row(band, facets, 0, &mut before);
    shade_row(band, facets, 1, &mut shaded);
    let mut after = vec![Shaded::default(); band.width];
    for row in 1..=band.inner_rows() {
        shade_row(band, facets, row + 1, &mut after);
        for (column, here) in shaded.iter().enumerate().filter(|(_, s)| s.is_hit) {
            let pixel = &mut pixels[(row - 1) / fine * width + column / fine];
            let beside = [
                column.checked_sub(1).map(|left| &shaded[left]),
                shaded.get(column + 1),
                Some(&before[column]),
                Some(&after[column]),
            ];
            let dark = edge(here, beside);
            let light = light(here.normal, up) * (1.0 - dark);
            let color = facets[here.facet as usize].color;
            (0..3).for_each(|k| pixel.color[k] += color[k] * light);
            pixel.cover += 1.0;
            pixel.nearness += here.nearness as f32;
        }
        std::mem::swap(&mut before, &mut shaded);
        std::mem::swap(&mut shaded, &mut after);
    }
    let all = (fine * fine) as f32;
    for pixel in &mut pixels {
        let count = pixel.cover;
        pixel.color = pixel
            .color
            .map(|v| if count > 0.0 { v / count } else { 0.0 });
        pixel.nearness /= count;
        pixel.cover = count / all;
    }
    pixels
}

/// A sample with what shading asks of it.
#[derive(Clone, Copy, Default)]
struct Shaded {
    is_hit: bool,
    facet: u32,
    nearness: f64,
    /// The normal toward the viewer.
    normal: Point3,
}

impl Shaded {
    /// How nearness changes per pixel to the right and up, as far as the normal tells.
    fn slope(&self) -> Option<(f64, f64)> {
        let Point3 { x, y, z } = self.normal;
        (z > FLATTEST).then_some((-x / z, -y / z))
    }
}

fn shade_row(band: &Band, facets: &[Facet], row: usize, out: &mut [Shaded]) {
    let mut last = (NOTHING, None);
    for (column, sample) in band.row(row).iter().enumerate() {
        out[column] = if sample.facet == NOTHING {
            Shaded::default()
        } else {
            let facet = &facets[sample.facet as usize];
            // Neighbours mostly show the same facet.
            if last.0 != sample.facet {
                last = (sample.facet, Shares::of(facet));
            }
            let shares = band.shares(last.1.as_ref(), column, row);
            shade(facet, shares, sample)
        };
    }
}

fn shade(facet: &Facet, [u, v, w]: [f64; 3], sample: &Sample) -> Shaded {
    let [p, q, r] = facet.normals;
    let toward = Point3::new(0.0, 0.0, 1.0);
    let normal = (p * u + q * v + r * w).unit().unwrap_or(toward);
    let normal = if normal.z < 0.0 { -normal } else { normal };
    Shaded {
        is_hit: true,
        facet: sample.facet,
        nearness: sample.nearness,
        normal,
    }
}

/// How dark a sample is for the edges between it and the samples to its left and right, above and
/// below. Of two sides of a step the nearer is dark, so that lines are as wide before nothing as
/// before something.
fn edge(here: &Shaded, beside: [Option<&Shaded>; 4]) -> f32 {
    let offsets = [(-1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
    let mut dark: f32 = 0.0;
    for (there, offset) in beside.into_iter().zip(offsets) {
        let Some(there) = there else { continue };
        if !there.is_hit {
            dark = dark.max(STEP_LINE);
        } else if there.facet != here.facet {
            let is_step = is_step(here, there, offset) && here.nearness >= there.nearness;
            if is_step {
                dark = dark.max(STEP_LINE);
            } else if here.normal.dot(there.normal) < CREASE {
                dark = dark.max(CREASE_LINE);
            }
        }
    }
    dark
}

/// Whether neither face goes on to where the other is.
fn is_step(here: &Shaded, there: &Shaded, (dx, dy): (f64, f64)) -> bool {
    let rise = there.nearness - here.nearness;
    let misses = |slope: Option<(f64, f64)>| {
        slope.is_none_or(|(x, y)| (rise - (x * dx + y * dy) / f64::from(SAMPLES)).abs() > STEP)
    };
    rise.abs() > STEP && misses(here.slope()) && misses(there.slope())
}

/// How much light a face with this normal throws toward the viewer: some from everywhere and from
/// above, most from the viewer's upper left.
fn light(normal: Point3, up: Point3) -> f32 {
    let key = (-0.45 * normal.x + 0.6 * normal.y + 0.66 * normal.z).max(0.0);
    let fill = (0.8 * normal.x + 0.6 * normal.z).max(0.0);
    let sky = 0.5 + 0.5 * normal.dot(up);
    (0.16 + 0.12 * sky + 0.14 * fill + 0.68 * key).min(1.0) as f32
}
