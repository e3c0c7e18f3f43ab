//! The signed distance from the edge of the solid pixels of an exemplar, and the size of its features.

use fretwork_geometry::Pixels;

/// Farther than any pixel is from another, squared; small enough to be added to.
const FAR: f64 = 1e18;

/// The part of the places farthest inside their features that are thinner than the feature radius.
const QUANTILE: f64 = 0.7;

/// For each pixel how far its middle is from the edge of the solid ones, in pixels, negative outside.
/// The middle of a pixel beside an edge is half a pixel from it. Exact (Felzenszwalb, Huttenlocher
/// 2012); distances go across the borders of a tile. O(n).
pub(super) fn signed_distance(exemplar: &Pixels) -> Vec<f32> {
    let size = [exemplar.width, exemplar.height()];
    let to = |wanted: bool| {
        let holds = |n: usize| exemplar.solid[n] == wanted;
        squared_distance(size, exemplar.tileable, &holds)
    };
    let (to_solid, to_empty) = (to(true), to(false));
    let depth = |n: usize| {
        let outside = to_solid[n].sqrt() - 0.5;
        let inside = to_empty[n].sqrt() - 0.5;
        (if exemplar.solid[n] { inside } else { -outside }) as f32
    };
    (0..exemplar.solid.len()).map(depth).collect()
}

/// The squared distance of each pixel to the nearest that holds.
fn squared_distance(
    [width, height]: [usize; 2],
    wraps: bool,
    holds: &impl Fn(usize) -> bool,
) -> Vec<f64> {
    let at = |n: usize| if holds(n) { 0.0 } else { FAR };
    let mut field: Vec<f64> = (0..width * height).map(at).collect();
    let mut line = Envelope::default();
    for row in field.chunks_mut(width) {
        line.relax(row, wraps);
    }
    for x in 0..width {
        let mut column: Vec<f64> = (0..height).map(|y| field[y * width + x]).collect();
        line.relax(&mut column, wraps);
        for (y, value) in column.into_iter().enumerate() {
            field[y * width + x] = value;
        }
    }
    field
}

/// The lower envelope of parabolas, one on each sample of a line.
#[derive(Default)]
struct Envelope {
    /// Where the parabolas stand, and their least values.
    feet: Vec<(f64, f64)>,
    /// From where on each is the lowest.
    starts: Vec<f64>,
}

impl Envelope {
    /// Replaces every value by the least of `value[j] + (i - j)²`. On a line that wraps three periods
    /// hold whatever is nearest.
    fn relax(&mut self, values: &mut [f64], wraps: bool) {
        let count = values.len();
        let periods = if wraps { 3 } else { 1 };
        self.feet.clear();
        self.starts.clear();
        for i in 0..periods * count {
            let value = values[i % count];
            if value < FAR {
                self.put(i as f64, value);
            }
        }
        let middle = if wraps { count } else { 0 };
        let mut lowest = 0;
        for (i, value) in values.iter_mut().enumerate() {
            let at = (i + middle) as f64;
            while lowest + 1 < self.feet.len() && self.starts[lowest + 1] <= at {
                lowest += 1;
            }
            *value = self
                .feet
                .get(lowest)
                .map_or(FAR, |&(foot, least)| least + (at - foot) * (at - foot));
        }
    }

    fn put(&mut self, foot: f64, least: f64) {
        while let (Some(&(last, low)), Some(&start)) = (self.feet.last(), self.starts.last()) {
            let height = |at: f64, least: f64| least + at * at;
            let meet = (height(foot, least) - height(last, low)) / (2.0 * (foot - last));
            if meet > start {
                self.feet.push((foot, least));
                self.starts.push(meet);
                return;
            }
            self.feet.pop();
            self.starts.pop();
        }
        self.feet.push((foot, least));
        self.starts.push(f64::NEG_INFINITY);
    }
}

/// The radius of the features of an exemplar, as a length: its `feature_radius`, or where there is
/// none a high quantile of the distance from the edge at the places that are farthest inside, which
/// are those of the medial axis. 0 where nothing is solid.
pub fn feature_radius(exemplar: &Pixels) -> f64 {
    if let Some(radius) = exemplar.feature_radius {
        return radius;
    }
    let depth = signed_distance(exemplar);
    f64::from(medial_radius(exemplar, &depth)) * exemplar.pixel_size
}

/// The same in pixels, of an exemplar whose distances are known.
pub(super) fn medial_radius(exemplar: &Pixels, depth: &[f32]) -> f32 {
    let size = [exemplar.width, exemplar.height()];
    let place = |at: usize, by: usize, size: usize| {
        let moved = at + by;
        if exemplar.tileable {
            (moved + size - 1) % size
        } else {
            moved.saturating_sub(1).min(size - 1)
        }
    };
    let is_ridge = |n: usize| {
        let [x, y] = [n % size[0], n / size[0]];
        let around = |by: usize| {
            let x = place(x, by % 3, size[0]);
            depth[place(y, by / 3, size[1]) * size[0] + x]
        };
        depth[n] > 0.0 && (0..9).all(|by| around(by) <= depth[n])
    };
    let mut radii: Vec<f32> = (0..depth.len())
        .filter(|&n| is_ridge(n))
        .map(|n| depth[n])
        .collect();
    if radii.is_empty() {
        return 0.0;
    }
    radii.sort_by(f32::total_cmp);
    radii[((radii.len() - 1) as f64 * QUANTILE) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(width: usize, height: usize, tileable: bool) -> Pixels {
        let solid: Vec<bool> = (0..width * height)
            .map(|n| n * n % 17 == 3 || n % 29 == 4)
            .collect();
        Pixels {
            width,
            rgb: vec![[0; 3]; solid.len()],
            solid,
            pixel_size: 1.0,
            feature_radius: None,
            tileable,
        }
    }

    #[test]
    fn distances_are_those_of_the_oracle() {
        for tileable in [false, true] {
            let exemplar = picture(13, 9, tileable);
            let found = signed_distance(&exemplar);
            for n in 0..found.len() {
                let along = |a: usize, b: usize, size: usize| {
                    let d = a.abs_diff(b);
                    if tileable { d.min(size - d) } else { d }
                };
                let squared =
                    |m: usize| along(n % 13, m % 13, 13).pow(2) + along(n / 13, m / 13, 9).pow(2);
                let other = |m: &usize| exemplar.solid[*m] != exemplar.solid[n];
                let nearest = (0..found.len()).filter(other).map(squared).min().unwrap();
                let expected = (nearest as f32).sqrt() - 0.5;
                assert!((found[n].abs() - expected).abs() < 1e-5);
                assert_eq!(found[n] > 0.0, exemplar.solid[n]);
            }
        }
    }

    #[test]
    fn the_radius_of_stripes_is_half_their_width() {
        let mut exemplar = picture(40, 40, true);
        exemplar.solid = (0..1600).map(|n| n % 20 < 7).collect();
        exemplar.pixel_size = 0.5;
        assert!((feature_radius(&exemplar) - 1.75).abs() < 0.01);
        exemplar.feature_radius = Some(2.0);
        assert_eq!(feature_radius(&exemplar), 2.0);
    }
}
