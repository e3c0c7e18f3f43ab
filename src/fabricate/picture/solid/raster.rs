//! Triangles drawn into rows of samples, the nearest on top.

use super::camera::Camera;
use crate::sheet::Color;
use crate::srgb;
use fretwork_geometry::Point3;

/// A triangle as it is seen.
pub struct Facet {
    /// The corners: pixels from the upper left, and how near.
    pub corners: [Point3; 3],
    /// The normals in space.
    pub normals: [Point3; 3],
    /// Linear light that it throws back.
    pub color: [f32; 3],
}

/// What a sample shows.
#[derive(Clone, Copy)]
struct Sample {
    nearness: f64,
    color: [f32; 3],
}

const EMPTY: Sample = Sample {
    nearness: f64::NEG_INFINITY,
    color: [0.0; 3],
};

/// Some rows of a picture.
pub struct Band {
    width: u32,
    rows: u32,
    /// Samples along each side of a pixel.
    fine: u32,
    /// The first row of samples.
    top: u32,
    samples: Vec<Sample>,
}

impl Band {
    /// `rows` empty rows from `row` on.
    pub fn new(width: u32, row: u32, rows: u32, fine: u32) -> Band {
        let count = width as usize * rows as usize * (fine * fine) as usize;
        Band {
            width,
            rows,
            fine,
            top: row * fine,
            samples: vec![EMPTY; count],
        }
    }

    /// Draws the part of a triangle that lies in the band.
    pub fn draw(&mut self, facet: &Facet, camera: &Camera) {
        let fine = f64::from(self.fine);
        // Samples stand in the middles of their cells.
        let [a, b, c] = facet
            .corners
            .map(|p| Point3::new(p.x * fine - 0.5, p.y * fine - 0.5, p.z));
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let range = |low: f64, high: f64, first: u32, count: u32| {
            let (first, end) = (f64::from(first), f64::from(first) + f64::from(count));
            (low.ceil().max(first) as u32)..((high.floor() + 1.0).clamp(0.0, end) as u32)
        };
        let rows = range(
            a.y.min(b.y).min(c.y),
            a.y.max(b.y).max(c.y),
            self.top,
            self.rows * self.fine,
        );
        let columns = range(
            a.x.min(b.x).min(c.x),
            a.x.max(b.x).max(c.x),
            0,
            self.width * self.fine,
        );
        for row in rows {
            for column in columns.clone() {
                let (x, y) = (f64::from(column), f64::from(row));
                let u = ((c.x - b.x) * (y - b.y) - (c.y - b.y) * (x - b.x)) / area;
                let v = ((a.x - c.x) * (y - c.y) - (a.y - c.y) * (x - c.x)) / area;
                let w = 1.0 - u - v;
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let at = ((row - self.top) * self.width * self.fine + column) as usize;
                let nearness = a.z * u + b.z * v + c.z * w;
                if nearness > self.samples[at].nearness {
                    let [p, q, r] = facet.normals;
                    let light = light(p * u + q * v + r * w, camera);
                    self.samples[at] = Sample {
                        nearness,
                        color: facet.color.map(|c| c * light),
                    };
                }
            }
        }
    }

    /// The pixels, four bytes each, premultiplied.
    pub fn pixels(&self, background: Option<Color>) -> Vec<u8> {
        let behind = background.map(|color| color.0.map(|byte| srgb::linear(byte) as f32));
        let mut bytes = Vec::with_capacity(self.width as usize * self.rows as usize * 4);
        let share = 1.0 / (self.fine * self.fine) as f32;
        for row in 0..self.rows {
            for column in 0..self.width {
                let (mut sum, mut covered) = ([0f32; 3], 0f32);
                for i in 0..self.fine * self.fine {
                    let (y, x) = (
                        row * self.fine + i / self.fine,
                        column * self.fine + i % self.fine,
                    );
                    let sample = &self.samples[(y * self.width * self.fine + x) as usize];
                    let is_hit = sample.nearness > f64::NEG_INFINITY;
                    covered += if is_hit || behind.is_some() {
                        share
                    } else {
                        0.0
                    };
                    let color = if is_hit {
                        sample.color
                    } else {
                        behind.unwrap_or_default()
                    };
                    (0..3).for_each(|k| sum[k] += color[k] * share);
                }
                let alpha = (covered.min(1.0) * 255.0).round();
                let whole = if covered > 0.0 { covered } else { 1.0 };
                bytes.extend(
                    sum.map(|v| (srgb::encoded(v / whole) * alpha).round().min(alpha) as u8),
                );
                bytes.push(alpha as u8);
            }
        }
        bytes
    }
}

/// How much light a face with this normal throws toward the viewer: some from everywhere and from above, most from the
/// viewer's upper left. Faces are lit from both sides.
fn light(normal: Point3, camera: &Camera) -> f32 {
    let Some(mut n) = normal.unit() else {
        return 0.5;
    };
    if n.dot(camera.toward) < 0.0 {
        n = -n;
    }
    let (right, up) = (n.dot(camera.right), n.dot(camera.up));
    let key = (-0.45 * right + 0.6 * up + 0.66 * n.dot(camera.toward)).max(0.0);
    let fill = (0.8 * right + 0.6 * n.dot(camera.toward)).max(0.0);
    let sky = 0.5 + 0.5 * n.z;
    (0.16 + 0.12 * sky + 0.14 * fill + 0.68 * key).min(1.0) as f32
}
