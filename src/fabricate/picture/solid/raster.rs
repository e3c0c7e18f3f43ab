//! Which triangle is seen at each sample of a picture.

use std::ops::Range;

use fretwork_geometry::Point3;

/// A triangle as it is seen.
pub struct Facet {
    /// The corners: pixels from the upper left, and how near, in pixels too.
    pub corners: [Point3; 3],
    /// The normals in the frame of the camera: to the right, up, toward the viewer.
    pub normals: [Point3; 3],
    /// Linear light that it throws back.
    pub color: [f32; 3],
}

/// What a sample shows.
#[derive(Clone, Copy)]
pub struct Sample {
    /// How near it is, in pixels.
    pub nearness: f64,
    /// The number of the facet; [`NOTHING`] where nothing is.
    pub facet: u32,
}

/// Samples along each side of a pixel: at three lines are smooth, and more cost as their square.
pub const SAMPLES: u32 = 3;

/// The number of no facet.
pub const NOTHING: u32 = u32::MAX;

const EMPTY: Sample = Sample {
    nearness: f64::NEG_INFINITY,
    facet: NOTHING,
};

/// What a corner's share may fall below zero, so that no sample on a common edge is missed by both
/// triangles.
const SLACK: f64 = -1e-9;

/// Some rows of samples, and one more above and below them.
pub struct Band {
    /// Samples in a row.
    pub width: usize,
    /// The first row that is kept, which may be -1.
    top: i64,
    rows: usize,
    samples: Vec<Sample>,
}

impl Band {
    /// `rows` rows of pixels from `row` on, `width` pixels wide.
    pub fn new(width: u32, row: u32, rows: u32) -> Band {
        let rows = (rows * SAMPLES + 2) as usize;
        let width = (width * SAMPLES) as usize;
        Band {
            width,
            top: i64::from(row * SAMPLES) - 1,
            rows,
            samples: vec![EMPTY; width * rows],
        }
    }

    /// How many rows of samples there are between the first and the last.
    pub fn inner_rows(&self) -> usize {
        self.rows - 2
    }

    /// The samples of a row; 0 is that above the band.
    pub fn row(&self, row: usize) -> &[Sample] {
        &self.samples[row * self.width..(row + 1) * self.width]
    }

    /// The shares of a facet's corners in the sample at `column` in a row as of [`Band::row`].
    pub fn shares(&self, of: Option<&Shares>, column: usize, row: usize) -> [f64; 3] {
        of.map_or([1.0, 0.0, 0.0], |shares| {
            shares.at(column as f64, row as f64 + self.top as f64)
        })
    }

    /// Draws the part of facet `number` that lies in the band.
    pub fn draw(&mut self, number: u32, facet: &Facet) {
        let Some(shares) = Shares::of(facet) else {
            return;
        };
        let rows = range(shares.corners.map(|p| p.y), self.top, self.rows);
        let columns = range(shares.corners.map(|p| p.x), 0, self.width);
        let [near_a, near_b, near_c] = facet.corners.map(|p| p.z);
        let step = shares.along_x;
        for row in rows {
            let y = row as f64 + self.top as f64;
            let samples = &mut self.samples[row * self.width..(row + 1) * self.width];
            let start = shares.at(0.0, y);
            for column in shares.span(start, &columns) {
                let x = column as f64;
                let (u, v) = (start[0] + x * step[0], start[1] + x * step[1]);
                let w = 1.0 - u - v;
                if u < SLACK || v < SLACK || w < SLACK {
                    continue;
                }
                let nearness = near_a * u + near_b * v + near_c * w;
                if nearness > samples[column].nearness {
                    samples[column] = Sample {
                        nearness,
                        facet: number,
                    };
                }
            }
        }
    }
}

/// The whole numbers from the least to the greatest of three, counted from `first`, of `count`.
fn range(of: [f64; 3], first: i64, count: usize) -> Range<usize> {
    let low = of.into_iter().fold(f64::INFINITY, f64::min) - first as f64;
    let high = of.into_iter().fold(f64::NEG_INFINITY, f64::max) - first as f64;
    (low.ceil().max(0.0) as usize)..((high.floor() + 1.0).clamp(0.0, count as f64) as usize)
}

/// The shares that the corners of a triangle have in the points of its plane (barycentric
/// coordinates), as linear functions of the place.
pub struct Shares {
    /// In samples, which stand in the middles of their cells.
    corners: [Point3; 3],
    along_x: [f64; 2],
    along_y: [f64; 2],
}

impl Shares {
    /// None for a triangle that is seen from its edge.
    pub fn of(facet: &Facet) -> Option<Shares> {
        let fine = f64::from(SAMPLES);
        let place = |p: Point3| Point3::new(p.x * fine - 0.5, p.y * fine - 0.5, p.z);
        let corners = facet.corners.map(place);
        let [a, b, c] = corners;
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 || !area.is_finite() {
            return None;
        }
        Some(Shares {
            corners,
            along_x: [(b.y - c.y) / area, (c.y - a.y) / area],
            along_y: [(c.x - b.x) / area, (a.x - c.x) / area],
        })
    }

    /// The columns among some in which a row can be inside, where the shares at its beginning are `start`: so that the
    /// box of a long and thin triangle is not searched. One more on both sides leaves rounding to who looks closer.
    fn span(&self, start: [f64; 3], columns: &Range<usize>) -> Range<usize> {
        let [u, v] = self.along_x;
        let (mut low, mut high) = (columns.start as f64, columns.end as f64);
        for (share, step) in start.into_iter().zip([u, v, -u - v]) {
            let crossing = (SLACK - share) / step;
            if step > 0.0 {
                low = low.max(crossing - 1.0);
            } else if step < 0.0 {
                high = high.min(crossing + 2.0);
            }
        }
        low.ceil() as usize..high.floor() as usize
    }

    fn at(&self, x: f64, y: f64) -> [f64; 3] {
        let [_, _, c] = self.corners;
        let (dx, dy) = (x - c.x, y - c.y);
        let u = dx * self.along_x[0] + dy * self.along_y[0];
        let v = dx * self.along_x[1] + dy * self.along_y[1];
        [u, v, 1.0 - u - v]
    }
}
