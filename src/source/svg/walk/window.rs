//! What hides parts of a drawing: the viewports of nested drawings, symbols and markers, clips and masks. Nothing is
//! cut; what would be is told.

use roxmltree::Node;

use fretwork_geometry::{Affine, Bounds, Point, Shape};

const EDGE: (&str, &str) = (
    "the edge of a nested drawing or symbol",
    "what lies outside of it is read; cut the paths in the drawing program",
);
/// What is said of clips and masks, and the help.
pub const CLIP: (&str, &str) = (
    "a clip or mask",
    "what it hides is read; cut the paths in the drawing program",
);

/// Convex areas through which something is seen.
pub struct Window<'a, 'input> {
    /// The element that has it.
    pub node: Node<'a, 'input>,
    /// Their corners in order, in spec units.
    areas: Vec<Vec<Point>>,
    /// The number of the first shape in it.
    pub first: usize,
    /// What is said when something is hidden, and the help.
    pub told: (&'static str, &'static str),
    /// Whether the width of strokes counts.
    with_strokes: bool,
}

impl<'a, 'input> Window<'a, 'input> {
    /// The viewport of `node`: a box in user space that `map` takes to spec units.
    pub fn of_viewport(
        node: Node<'a, 'input>,
        [min, max]: [Point; 2],
        map: &Affine,
        first: usize,
    ) -> Window<'a, 'input> {
        Window {
            node,
            areas: vec![rectangle(min, max).map(|p| map.apply(p)).to_vec()],
            first,
            told: EDGE,
            with_strokes: false,
        }
    }

    /// The areas that the clip or mask of `node` shows.
    pub fn of_clip(
        node: Node<'a, 'input>,
        areas: Vec<Vec<Point>>,
        first: usize,
    ) -> Window<'a, 'input> {
        Window {
            node,
            areas,
            first,
            told: CLIP,
            with_strokes: true,
        }
    }

    /// Whether one of the areas holds all of the shape's lines, up to `slack` outside of it.
    pub fn holds(&self, shape: &Shape, slack: f64) -> bool {
        let half = match shape.stroke {
            Some(stroke) if self.with_strokes => stroke.width / 2.0,
            _ => 0.0,
        };
        let holds = |path: &Vec<Point>| {
            let mut areas = self.areas.iter();
            areas.any(|area| path.iter().all(|p| is_inside(area, *p, slack - half)))
        };
        shape.paths.iter().all(holds)
    }

    /// The extent of the areas.
    pub fn size(&self) -> f64 {
        let bounds = Bounds::of(self.areas.iter().flatten().copied());
        bounds.longer_side()
    }
}

/// Whether `p` is in a convex polygon, or outside by no more than `slack`.
pub fn is_inside(area: &[Point], p: Point, slack: f64) -> bool {
    let count = area.len();
    let sides = (0..count).map(|i| (area[i], area[(i + 1) % count]));
    let distances = sides
        .filter(|(a, b)| a != b)
        .map(|(a, b)| (b - a).cross(p - a) / a.distance(b));
    let (low, high) = distances.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| {
        (l.min(d), h.max(d))
    });
    // A mirrored one has its inside on the other side of all.
    low >= -slack || high <= slack
}

/// The corners of a box in order.
pub fn rectangle(min: Point, max: Point) -> [Point; 4] {
    [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)]
}

/// Whether a ring turns to one side everywhere and once round in all.
pub fn is_convex(ring: &[Point]) -> bool {
    let count = ring.len();
    if count < 3 {
        return false;
    }
    let at = |i: usize| ring[i % count];
    let turn = |i: usize| (at(i + 1) - at(i)).cross(at(i + 2) - at(i + 1));
    let (left, right) = (
        (0..count).any(|i| turn(i) > 0.0),
        (0..count).any(|i| turn(i) < 0.0),
    );
    // A star turns to one side everywhere too, but its sides change between left and right more often.
    let side = |i: usize| at(i + 1).x - at(i).x;
    let sides: Vec<f64> = (0..count).map(side).filter(|x| *x != 0.0).collect();
    let changes = (0..sides.len()).filter(|&i| sides[i] * sides[(i + 1) % sides.len()] < 0.0);
    left != right && changes.count() == 2
}
