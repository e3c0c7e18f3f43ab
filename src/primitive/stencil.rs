//! Letters whose islands hold: what is cut out of a sheet must not leave loose pieces inside of letters.

use fretwork_geometry::polygon::{AreaError, subtract, widest_place};
use fretwork_geometry::{Bounds, Point, Polygon, Ring};

/// Pieces beside bridges in which no disc of this radius fits, in widths of a bridge, are not cut out.
const SLIVER: f64 = 0.1;

/// Why letters make no stencil.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StencilError {
    /// A bridge is wider than what it is to hold.
    #[error("bridges {width} wide are wider than the island of {island} near ({:.1}, {:.1}) that they are to hold", .at.x, .at.y)]
    TooWide {
        /// The width of bridges.
        width: f64,
        /// That of the island.
        island: f64,
        /// Where the island is, as the text lies before it is placed.
        at: Point,
    },
    /// An island is still loose.
    #[error("an island near ({x}, {y}) is not reached by a bridge that is straight up or down")]
    Loose {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
    },
    /// The area could not be computed.
    #[error(transparent)]
    Area(#[from] AreaError),
}

impl StencilError {
    /// The place that it is about, if it is about one.
    pub fn at(&self) -> Option<Point> {
        match self {
            StencilError::TooWide { at, .. } => Some(*at),
            StencilError::Loose { x, y } => Some(Point::new(*x, *y)),
            StencilError::Area(_) => None,
        }
    }

    /// What would help, if something is known.
    pub fn help(&self) -> Option<String> {
        match self {
            StencilError::TooWide { island, .. } => Some(format!(
                "a `width` of {:.3} would hold it, or larger letters",
                0.8 * island
            )),
            StencilError::Loose { .. } | StencilError::Area(_) => None,
        }
    }
}

/// `area` without upright bridges of this width above and below every island, which is a hole of one of its polygons: cut out
/// of a sheet it leaves no piece loose. A bridge goes from the middle of the island's widest place to where
/// the area ends, which may be the next island.
///
/// # Errors
/// [`StencilError`], where an island is narrower than a bridge or still loose.
pub fn stencilled(area: &[Polygon], width: f64) -> Result<Vec<Polygon>, StencilError> {
    let mut bridges = Vec::new();
    for polygon in area {
        for hole in &polygon.holes {
            let island = hole.iter().rev().copied().collect::<Ring>();
            let bounds = Bounds::of(island.iter().copied());
            let island = Polygon {
                outer: island,
                holes: Vec::new(),
            };
            let middle = widest_place(&island).map_or(bounds.center(), |(at, _)| at);
            if bounds.width() < width {
                return Err(StencilError::TooWide {
                    width,
                    island: (bounds.width() * 1e3).round() / 1e3,
                    at: bounds.center(),
                });
            }
            let ends = ends(polygon, middle, width);
            bridges.push(bar(middle, ends, width));
        }
    }
    let mut made = subtract(area, &united(&bridges)?)?;
    if !bridges.is_empty() {
        // Beside a bridge a corner of a letter may be left that no tool could cut.
        made.retain(|piece| widest_place(piece).is_some_and(|(_, room)| room > SLIVER * width));
    }
    match made.iter().find_map(|polygon| polygon.holes.first()) {
        None => Ok(made),
        Some(hole) => {
            let at = hole[0];
            Err(StencilError::Loose { x: at.x, y: at.y })
        }
    }
}

fn united(bridges: &[Polygon]) -> Result<Vec<Polygon>, AreaError> {
    fretwork_geometry::polygon::unite(bridges)
}

/// How far up and down from `middle` a bridge of this width must go to leave the polygon beyond the hole that it begins in.
fn ends(polygon: &Polygon, middle: Point, width: f64) -> [f64; 2] {
    let lines = [-0.5, -0.25, 0.0, 0.25, 0.5].map(|part| middle.x + part * width);
    let far = |sign: f64| {
        let along = |x: f64| {
            let mut crossings: Vec<f64> = crossings(polygon, x)
                .into_iter()
                .map(|y| (y - middle.y) * sign)
                .filter(|distance| *distance > 0.0)
                .collect();
            crossings.sort_unstable_by(f64::total_cmp);
            // Out of the island, and out of the letter around it.
            crossings.get(1).copied().unwrap_or(0.0)
        };
        lines.into_iter().map(along).fold(0.0, f64::max)
    };
    let past = 0.01 * width;
    [middle.y - far(-1.0) - past, middle.y + far(1.0) + past]
}

/// Where the borders of a polygon cross the upright line at `x`.
fn crossings(polygon: &Polygon, x: f64) -> Vec<f64> {
    let mut found = Vec::new();
    for ring in polygon.rings() {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if (a.x > x) != (b.x > x) {
                found.push(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
            }
        }
    }
    found
}

fn bar(middle: Point, [from, to]: [f64; 2], width: f64) -> Polygon {
    let (left, right) = (middle.x - 0.5 * width, middle.x + 0.5 * width);
    let corners = [[left, from], [right, from], [right, to], [left, to]];
    Polygon {
        outer: corners.map(Point::from).to_vec(),
        holes: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(from: f64, to: f64) -> Ring {
        let corners = [[from, from], [to, from], [to, to], [from, to]];
        corners.map(Point::from).to_vec()
    }

    /// An 8: two islands above each other.
    fn eight() -> Polygon {
        let island = |y: f64| -> Ring {
            let corners = [[1.0, y], [1.0, y + 2.0], [3.0, y + 2.0], [3.0, y]];
            corners.map(Point::from).to_vec()
        };
        let outer = [[0.0, 0.0], [4.0, 0.0], [4.0, 7.0], [0.0, 7.0]];
        Polygon {
            outer: outer.map(Point::from).to_vec(),
            holes: vec![island(1.0), island(4.0)],
        }
    }

    #[test]
    fn islands_are_joined_above_and_below() {
        let made = stencilled(&[eight()], 0.5).unwrap();
        assert!(made.iter().all(|polygon| polygon.holes.is_empty()));
        assert_eq!(made.len(), 2);
        let area: f64 = made.iter().map(Polygon::area).sum();
        assert!((area - (28.0 - 8.0 - 3.0 * 0.5)).abs() < 0.02, "{area}");
        let plain = Polygon {
            outer: square(0.0, 3.0),
            holes: Vec::new(),
        };
        let same = stencilled(std::slice::from_ref(&plain), 0.5).unwrap();
        assert_eq!(same, [plain]);
    }

    #[test]
    fn slivers_beside_a_bridge_are_not_cut_out() {
        // The island's widest place lies so that the bridge leaves a hair of the letter at its left.
        let ring = |points: &[[f64; 2]]| points.iter().map(|p| Point::from(*p)).collect::<Ring>();
        let letter = Polygon {
            outer: ring(&[
                [0.0, 0.0],
                [4.0, 0.0],
                [4.0, 1.0],
                [4.0, 6.0],
                [0.0, 6.0],
                [0.98, 3.0],
            ]),
            holes: vec![ring(&[[1.0, 1.0], [1.0, 5.0], [3.0, 5.0], [3.0, 1.0]])],
        };
        let made = stencilled(&[letter], 1.99).unwrap();
        let thin = made.iter().filter(|piece| piece.bounds().width() < 0.1);
        assert_eq!(thin.count(), 0);
        assert!(made.iter().all(|piece| piece.holes.is_empty()));
    }

    #[test]
    fn a_bridge_that_is_wider_than_its_island_is_refused() {
        assert_eq!(
            stencilled(&[eight()], 2.5),
            Err(StencilError::TooWide {
                width: 2.5,
                island: 2.0,
                at: Point::new(2.0, 2.0),
            })
        );
    }
}
