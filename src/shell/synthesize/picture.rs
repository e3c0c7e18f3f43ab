//! Pictures of several channels: blurred, and sampled anew.

/// Channels: red, green, blue, and the distance from the edge of what is solid.
pub(super) const CHANNELS: usize = 4;

/// The values of a pixel.
pub(super) type Pixel = [f32; CHANNELS];

/// A picture, row by row from the top left.
#[derive(Clone)]
pub(super) struct Picture {
    pub(super) size: [usize; 2],
    pub(super) pixels: Vec<Pixel>,
    /// Whether opposite sides join; otherwise the outermost pixels go on beyond them.
    pub(super) wraps: bool,
}

impl Picture {
    /// The picture blurred by a Gaussian of a standard deviation in pixels along each axis.
    pub(super) fn blurred(&self, sigma: [f64; 2]) -> Picture {
        let mut picture = self.clone();
        for (axis, sigma) in sigma.into_iter().enumerate() {
            // Beyond twice its size a picture is one colour already.
            let sigma = sigma.min(2.0 * self.size[axis] as f64);
            if sigma > 0.05 {
                picture = picture.blurred_along(axis, &kernel(sigma));
            }
        }
        picture
    }

    fn blurred_along(&self, axis: usize, kernel: &[f32]) -> Picture {
        let [width, height] = self.size;
        let radius = (kernel.len() / 2) as i64;
        let sum = |x: usize, y: usize| {
            let mut sum = [0.0; CHANNELS];
            for (by, weight) in (-radius..).zip(kernel) {
                let mut at = [x as i64, y as i64];
                at[axis] += by;
                add(&mut sum, self.at(at), *weight);
            }
            sum
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Picture {
            pixels: pixels.map(|(x, y)| sum(x, y)).collect(),
            ..*self
        }
    }

    /// The picture in `size` pixels, each the bilinear value at its middle.
    pub(super) fn resampled(&self, size: [usize; 2]) -> Picture {
        if size == self.size {
            return self.clone();
        }
        let along = |axis: usize, n: usize| {
            let at = (n as f64 + 0.5) * self.size[axis] as f64 / size[axis] as f64 - 0.5;
            (at.floor() as i64, (at - at.floor()) as f32)
        };
        let value = |x: usize, y: usize| {
            let (x, along_x) = along(0, x);
            let (y, along_y) = along(1, y);
            let mut sum = [0.0; CHANNELS];
            for (dy, weight_y) in [(0, 1.0 - along_y), (1, along_y)] {
                for (dx, weight_x) in [(0, 1.0 - along_x), (1, along_x)] {
                    add(&mut sum, self.at([x + dx, y + dy]), weight_x * weight_y);
                }
            }
            sum
        };
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        Picture {
            pixels: pixels.map(|(x, y)| value(x, y)).collect(),
            size,
            wraps: self.wraps,
        }
    }

    /// The pixel at a place, which may be beyond the border.
    fn at(&self, at: [i64; 2]) -> &Pixel {
        let [x, y] = [0, 1].map(|axis| {
            let size = self.size[axis] as i64;
            if self.wraps {
                at[axis].rem_euclid(size) as usize
            } else {
                at[axis].clamp(0, size - 1) as usize
            }
        });
        &self.pixels[y * self.size[0] + x]
    }
}

fn add(sum: &mut Pixel, pixel: &Pixel, weight: f32) {
    for (s, p) in sum.iter_mut().zip(pixel) {
        *s += weight * p;
    }
}

/// The weights of a Gaussian out to three standard deviations; they add up to one.
fn kernel(sigma: f64) -> Vec<f32> {
    let radius = (3.0 * sigma).ceil() as i64;
    let weight = |n: i64| libm::exp(-0.5 * (n as f64 / sigma) * (n as f64 / sigma));
    let total: f64 = (-radius..=radius).map(weight).sum();
    (-radius..=radius)
        .map(|n| (weight(n) / total) as f32)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blurring_and_sampling_keep_the_mean() {
        let pixels = (0..96)
            .map(|n| [(n * n % 31) as f32, 1.0, 0.0, n as f32])
            .collect();
        let picture = Picture {
            size: [12, 8],
            pixels,
            wraps: true,
        };
        let mean = |p: &Picture| {
            let sum: f32 = p.pixels.iter().map(|p| p[0]).sum();
            sum / p.pixels.len() as f32
        };
        let blurred = picture.blurred([1.5, 0.7]);
        assert!((mean(&picture) - mean(&blurred)).abs() < 1e-3);
        assert!((mean(&picture) - mean(&picture.resampled([24, 16]))).abs() < 1e-3);
        assert!(blurred.pixels.iter().all(|p| (p[1] - 1.0).abs() < 1e-5));
        let flat = picture.blurred([100.0, 100.0]);
        assert!(
            flat.pixels
                .iter()
                .all(|p| (p[0] - mean(&picture)).abs() < 0.1)
        );
    }
}
