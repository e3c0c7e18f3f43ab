//! Walls on a curve, unrolled: along the curve and upward, all lengths kept.

use fretwork_geometry::{Point, Point3, Swept};

use super::{Chart, Deck, Demand, Flap, Room, Stretch, along, crossing, lengths, ring};
use crate::WrapError;

/// The chart of a wall.
///
/// # Errors
/// A curve that crosses itself where the drawing lies.
pub fn chart(form: &Swept, demand: &Demand) -> Result<Chart, WrapError> {
    let wall = Wall::new(form, demand);
    if let Some(at) = wall.crossing(demand) {
        return Err(WrapError::TurnsBack {
            at: Point3::new(at.x, at.y, wall.height),
            fits: None,
        });
    }
    let columns = wall.s.len() - 1;
    let flaps = (0..columns).flat_map(|k| wall.column(k)).collect();
    let across = (!form.closed).then_some([wall.start, wall.start + wall.length]);
    let [low, high] = form.heights;
    Ok(Chart {
        flaps,
        others: Vec::new(),
        deck: if form.closed {
            Deck::Step(wall.length)
        } else {
            Deck::Open
        },
        room: Room::Strip(across, [low - wall.height, high - wall.height]),
        slack: 1.0,
    })
}

/// A wall, and where its chart begins.
struct Wall<'a> {
    form: &'a Swept,
    /// How far along the curve its points are, and the whole.
    s: Vec<f64>,
    length: f64,
    /// The height that the drawing's middle comes to.
    height: f64,
    /// The edge at which the chart begins, and where it lies in the drawing.
    first: usize,
    start: f64,
    /// How far along the curve the drawing's middle comes to.
    place: f64,
}

impl<'a> Wall<'a> {
    fn new(form: &'a Swept, demand: &Demand) -> Wall<'a> {
        let [low, high] = form.heights;
        let s = lengths(&form.points, form.closed);
        let (columns, length) = (s.len() - 1, s[s.len() - 1]);
        let middle = if form.closed { 0.0 } else { 0.5 * length };
        let (place, height) = demand.at.map_or((middle, 0.5 * (low + high)), |at| {
            let place = along(&form.points, form.closed, Point::new(at.x, at.y));
            (place, at.z.clamp(low, high))
        });
        // On a closed wall the chart begins at the edge that is nearest to being opposite.
        let back = (place + 0.5 * length) % length;
        let apart = |j: &usize| (s[*j] - back).abs();
        let opposite = (0..columns).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        let first = opposite.filter(|_| form.closed).unwrap_or(0);
        let start = s[first] - place;
        let is_behind = form.closed && start > 0.0;
        let start = if is_behind { start - length } else { start };
        Wall {
            form,
            s,
            length,
            height,
            first,
            start,
            place,
        }
    }

    /// Where the curve crosses itself under the drawing.
    fn crossing(&self, demand: &Demand) -> Option<Point> {
        let ends = if demand.is_around {
            [0.0, self.length]
        } else {
            [demand.extent.min.x, demand.extent.max.x].map(|x| self.place + x)
        };
        crossing(&self.form.points, self.form.closed, ends)
    }

    /// The two triangles of a column, counted from the beginning of the chart.
    fn column(&self, k: usize) -> [Flap; 2] {
        let columns = self.s.len() - 1;
        let j = (self.first + k) % columns;
        let begin = match k {
            0 => self.start,
            _ => self.start + (self.s[j] + self.length - self.s[self.first]) % self.length,
        };
        let ends = [begin, begin + self.s[j + 1] - self.s[j]];
        let corner = |side: usize, top: bool| self.corner((j, side), (k + side, ends[side]), top);
        let quad = [
            corner(0, false),
            corner(1, false),
            corner(1, true),
            corner(0, true),
        ];
        [[0, 1, 2], [0, 2, 3]].map(|half| Flap {
            corners: half.map(|i: usize| quad[i].0),
            drawn: half.map(|i| quad[i].1),
            plan: half.map(|i| quad[i].2),
            stretch: Stretch::Around([1.0; 3]),
        })
    }

    /// A corner on either side of column `j`, the `k`th of the chart, at `x` in the drawing: its number, and its places in the drawing
    /// and in the plane of counting, where columns are as wide as one another, for only their order matters there.
    fn corner(
        &self,
        (j, side): (usize, usize),
        (k, x): (usize, f64),
        top: bool,
    ) -> (u32, Point, Point) {
        let ([low, high], count) = (self.form.heights, self.form.points.len());
        let (columns, rise) = (self.s.len() - 1, if top { high - low } else { 0.0 });
        let drawn = Point::new(x, low + rise - self.height);
        let plan = if self.form.closed {
            let part = (k % columns) as f64 / columns as f64;
            ring(part, rise, self.length / std::f64::consts::TAU)
        } else {
            drawn
        };
        let number = (j + side) % count + if top { count } else { 0 };
        (number as u32, drawn, plan)
    }
}
