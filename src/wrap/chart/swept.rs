//! Walls on a curve, unrolled: along the curve and upward, all lengths kept.

use fretwork_geometry::{Point, Swept};

use super::{Chart, Deck, Demand, Flap, Room, along, lengths, ring};

/// The chart of a wall.
pub fn chart(form: &Swept, demand: &Demand) -> Chart {
    let Swept {
        points,
        closed,
        heights: [low, high],
    } = form;
    let s = lengths(points, *closed);
    let (columns, length) = (s.len() - 1, s[s.len() - 1]);
    let (u, v) = match demand.at {
        Some(at) => (
            along(points, *closed, Point::new(at.x, at.y)),
            at.z.clamp(*low, *high),
        ),
        None => (if *closed { 0.0 } else { 0.5 * length }, 0.5 * (low + high)),
    };
    // On a closed wall the chart begins at the edge that is nearest to being opposite.
    let first = match closed {
        true => {
            let back = (u + 0.5 * length) % length;
            let apart = |j: &usize| (s[*j] - back).abs();
            (0..columns)
                .min_by(|a, b| apart(a).total_cmp(&apart(b)))
                .unwrap_or(0)
        }
        false => 0,
    };
    // Where that edge lies before the place.
    let start = s[first] - u;
    let start = if *closed && start > 0.0 {
        start - length
    } else {
        start
    };
    let count = points.len();
    let radius = length / std::f64::consts::TAU;
    let mut flaps = Vec::with_capacity(2 * columns);
    for k in 0..columns {
        let j = (first + k) % columns;
        let begin = (s[j] + length - s[first]) % length;
        let begin = if k == 0 { 0.0 } else { begin };
        let ends = [start + begin, start + begin + s[j + 1] - s[j]];
        // In the plane of counting what matters is the order only, so that columns are as wide there as one another.
        let parts = [k, k + 1].map(|k| (k % columns.max(1)) as f64 / columns as f64);
        let corner = |side: usize, top: bool| {
            let height = if top { high - low } else { 0.0 };
            let drawn = Point::new(ends[side], low + height - v);
            let plan = if *closed {
                ring(parts[side], height, radius)
            } else {
                drawn
            };
            let number = (j + side) % count + if top { count } else { 0 };
            (number as u32, drawn, plan)
        };
        let quad = [
            corner(0, false),
            corner(1, false),
            corner(1, true),
            corner(0, true),
        ];
        for half in [[0, 1, 2], [0, 2, 3]] {
            flaps.push(Flap {
                corners: half.map(|i| quad[i].0),
                drawn: half.map(|i| quad[i].1),
                plan: half.map(|i| quad[i].2),
                stretch: [1.0; 3],
            });
        }
    }
    let across = (!closed).then_some([start, start + length]);
    Chart {
        flaps,
        others: Vec::new(),
        deck: if *closed {
            Deck::Step(length)
        } else {
            Deck::Open
        },
        room: Room::Strip(across, [low - v, high - v]),
    }
}
