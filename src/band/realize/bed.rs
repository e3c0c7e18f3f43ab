//! Where a pattern is laid, and how fine it may be.

use fretwork_geometry::Point;

/// Where a pattern is laid.
#[derive(Clone, Debug, PartialEq)]
pub struct Bed<'a> {
    /// The length of the curve.
    pub length: f64,
    /// How fine the pattern may be.
    pub detail: Detail,
    /// The radius at which a closed curve's strip is laid as a ring; none for an open one.
    pub radius: Option<f64>,
    /// Places along the curve where edges are divided, ascending; on a closed curve from 0 to below
    /// its length.
    pub lines: &'a [f64],
}

/// How fine a pattern may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// Necks and gaps narrower than this are mended where that is possible.
    pub finest: f64,
    /// How many steps of the coordinates in files make a unit: the counts must hold in steps too.
    pub steps: f64,
}

impl Bed<'_> {
    /// The place along the curve of a point of the bed.
    pub fn along(&self, p: Point) -> f64 {
        if self.radius.is_none() {
            return p.x;
        }
        let turn = libm::atan2(-p.y, p.x) / std::f64::consts::TAU;
        self.length * if turn < 0.0 { turn + 1.0 } else { turn }
    }

    /// Adds the points where the edge from `a` to `b` crosses lines of the bed. On a loop the lines
    /// come again in every turn.
    pub fn divide(&self, a: Point, b: Point, out: &mut Vec<Point>) {
        let (low, high) = (a.x.min(b.x), a.x.max(b.x));
        // A line within rounding of an end of the edge does not divide it.
        let clear = 1e-9 * self.length;
        let mut places: Vec<f64> = Vec::new();
        let turn = |x: f64| match self.radius {
            Some(_) => (x / self.length).floor(),
            None => 0.0,
        };
        let mut shift = turn(low) * self.length;
        while shift <= turn(high) * self.length {
            let from = self.lines.partition_point(|&l| l + shift <= low + clear);
            let to = self.lines.partition_point(|&l| l + shift < high - clear);
            places.extend(self.lines[from..to.max(from)].iter().map(|l| l + shift));
            shift += self.length;
        }
        if a.x > b.x {
            places.reverse();
        }
        let at = |x: f64| Point::new(x, a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x));
        out.extend(places.into_iter().map(at));
    }
}
