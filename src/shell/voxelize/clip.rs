//! The part of a triangle that lies in a cube.

/// A triangle cut by six planes has at most nine corners.
const CORNERS: usize = 10;

/// The area of the part of a triangle that lies in the closed unit cube at `corner` (Sutherland and
/// Hodgman 1974). Triangle and cube are in pitches, and so is the area.
pub(super) fn area_within(triangle: [[f64; 3]; 3], corner: [f64; 3]) -> f64 {
    let mut polygon = [[0.0; 3]; CORNERS];
    for (at, p) in polygon.iter_mut().zip(triangle) {
        *at = [p[0] - corner[0], p[1] - corner[1], p[2] - corner[2]];
    }
    let mut count = 3;
    for axis in 0..3 {
        let within = |p: &[f64; 3]| p[axis] >= 0.0 && p[axis] <= 1.0;
        if polygon[..count].iter().all(within) {
            continue;
        }
        count = cut(&mut polygon, count, |p| p[axis]);
        count = cut(&mut polygon, count, |p| 1.0 - p[axis]);
    }
    if count < 3 {
        return 0.0;
    }
    let base = polygon[0];
    let mut sum = [0f64; 3];
    for side in polygon[1..count].windows(2) {
        let [a, b] = [minus(side[0], base), minus(side[1], base)];
        for (axis, s) in sum.iter_mut().enumerate() {
            let (next, back) = ((axis + 1) % 3, (axis + 2) % 3);
            *s += a[next] * b[back] - a[back] * b[next];
        }
    }
    0.5 * (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]).sqrt()
}

/// Keeps the part of a convex polygon where `height` is not negative; its number of corners.
fn cut(
    polygon: &mut [[f64; 3]; CORNERS],
    count: usize,
    height: impl Fn(&[f64; 3]) -> f64,
) -> usize {
    let before = *polygon;
    let mut kept = 0;
    for i in 0..count {
        let (a, b) = (before[i], before[(i + 1) % count]);
        let (ha, hb) = (height(&a), height(&b));
        if ha >= 0.0 {
            polygon[kept] = a;
            kept += 1;
        }
        if (ha < 0.0) != (hb < 0.0) && kept < CORNERS {
            let t = ha / (ha - hb);
            polygon[kept] = std::array::from_fn(|axis| a[axis] + t * (b[axis] - a[axis]));
            kept += 1;
        }
    }
    kept
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_are_those_of_the_parts() {
        let flat = [[-1.0, -1.0, 0.5], [4.0, -1.0, 0.5], [-1.0, 4.0, 0.5]];
        assert!((area_within(flat, [0.0; 3]) - 1.0).abs() < 1e-12);
        assert!((area_within(flat, [1.0, 1.0, 0.0]) - 0.5).abs() < 1e-12);
        assert_eq!(area_within(flat, [0.0, 0.0, 1.0]), 0.0);
        // The plane x + y + z = 1.5 cuts a regular hexagon of side 1/√2 out of the cube.
        let slanted = [[9.5, -4.0, -4.0], [-4.0, 9.5, -4.0], [-4.0, -4.0, 9.5]];
        assert!((area_within(slanted, [0.0; 3]) - 0.75 * 3f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_parts_of_a_triangle_add_up_to_it() {
        let triangle = [[0.2, 0.3, 0.1], [4.7, 1.1, 2.9], [1.3, 3.8, 4.4]];
        let total: f64 = (0..125)
            .map(|n| [n / 25, n / 5 % 5, n % 5].map(f64::from))
            .map(|corner| area_within(triangle, corner))
            .sum();
        let whole = area_within(triangle.map(|p| p.map(|c| c / 8.0)), [0.0; 3]) * 64.0;
        assert!((total - whole).abs() < 1e-9, "{total} {whole}");
    }
}
