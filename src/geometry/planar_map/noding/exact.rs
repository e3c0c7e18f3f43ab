//! Exact predicates on sites: floating point with an error bound, integers of 128 bits where
//! that cannot tell.

use crate::planar_map::noding::snap_grid::Site;

/// Twice the area of the triangle a, b, c; the sign is exact: positive where c is to the left of
/// a→b. The magnitude is rounded.
pub(in crate::planar_map) fn orientation(a: Site, b: Site, c: Site) -> f64 {
    cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
}

/// The vector product of two differences of sites, with an exact sign.
pub(in crate::planar_map) fn cross(u: Site, v: Site) -> f64 {
    let (p, q) = (u[0] * v[1], u[1] * v[0]);
    let value = p - q;
    // Each product and the difference are off by at most 2^-53 of themselves.
    if value.abs() >= (p.abs() + q.abs()) * 4.5e-16 {
        value
    } else {
        cross_wide(u, v) as f64
    }
}

#[cold]
fn cross_wide(u: Site, v: Site) -> i128 {
    (u[0] as i128) * (v[1] as i128) - (u[1] as i128) * (v[0] as i128)
}

/// The order in which one reads: by y, then by x.
#[inline]
pub(in crate::planar_map) fn before(a: Site, b: Site) -> std::cmp::Ordering {
    a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0]))
}

/// A segment between two different sites, `a` before `b` in reading order: a segment and its
/// reversal are one value, so whatever is computed from it ignores how curves run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::planar_map) struct Segment {
    pub a: Site,
    pub b: Site,
}

impl Segment {
    /// The segment and whether it runs against from→to. The sites must differ.
    pub fn between(from: Site, to: Site) -> (Segment, bool) {
        if before(from, to).is_lt() {
            (Segment { a: from, b: to }, false)
        } else {
            (Segment { a: to, b: from }, true)
        }
    }

    /// b - a.
    pub fn delta(&self) -> Site {
        [self.b[0] - self.a[0], self.b[1] - self.a[1]]
    }

    /// Where `p` projects to along the segment: 0 at a, |b - a|² at b.
    pub fn position(&self, p: Site) -> f64 {
        let d = self.delta();
        d[0] * (p[0] - self.a[0]) + d[1] * (p[1] - self.a[1])
    }

    /// The distance to `p` in grid units.
    pub fn distance(&self, p: Site) -> f64 {
        let (d, w) = (self.delta(), [p[0] - self.a[0], p[1] - self.a[1]]);
        let (along, squared) = (d[0] * w[0] + d[1] * w[1], d[0] * d[0] + d[1] * d[1]);
        if along <= 0.0 {
            distance(p, self.a)
        } else if along >= squared {
            distance(p, self.b)
        } else {
            (d[0] * w[1] - d[1] * w[0]).abs() / squared.sqrt()
        }
    }
}

/// The euclidean distance.
pub(in crate::planar_map) fn distance(a: Site, b: Site) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1]];
    (d[0] * d[0] + d[1] * d[1]).sqrt()
}

/// The site nearest to the point where two segments cross in the interior of both; within 0.6
/// units of it in either coordinate. None where they do not cross, or only touch.
pub(in crate::planar_map) fn crossing(s: &Segment, t: &Segment) -> Option<Site> {
    let (d1, d2) = (orientation(s.a, s.b, t.a), orientation(s.a, s.b, t.b));
    if d1 * d2 >= 0.0 {
        return None;
    }
    let (d3, d4) = (orientation(t.a, t.b, s.a), orientation(t.a, t.b, s.b));
    if d3 * d4 >= 0.0 {
        return None;
    }
    // One of the two is followed to the crossing, the same one in whatever order they came.
    let first = before(s.a, t.a).then(before(s.b, t.b)).is_le();
    let (u, v, at_a, at_b) = if first {
        (s, t, d3, d4)
    } else {
        (t, s, d1, d2)
    };
    let (du, dv) = (u.delta(), v.delta());
    let sine = (at_a - at_b).abs();
    let span = (du[0].abs() + du[1].abs()) * (dv[0].abs() + dv[1].abs());
    // At an angle above 1/64 the rounding of the products moves the crossing by less than 1/16.
    let lambda = if sine * 64.0 > span {
        at_a / (at_a - at_b)
    } else {
        let exact = |p: Site| cross_wide(dv, [p[0] - v.a[0], p[1] - v.a[1]]);
        let (a, b) = (exact(u.a), exact(u.b));
        a as f64 / (a - b) as f64
    };
    // Sites are not negative, so a cast rounds down.
    let round = |v: f64| (v + 0.5) as i64 as f64;
    Some([
        round(u.a[0] + lambda * du[0]),
        round(u.a[1] + lambda * du[1]),
    ])
}
