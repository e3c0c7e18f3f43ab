//! Components and holes of a pattern on a surface, by the triangles that it fills.

use std::collections::BTreeMap;

use fretwork_geometry::numeric::UnionFind;
use fretwork_geometry::{Imprint, Point, Topology};

use crate::WrapError;
use crate::chart::{Chart, Deck};
use crate::press::Pressed;

/// What a pattern is on a surface.
pub struct Counts {
    /// Components, and holes without those of components that run around.
    pub topology: Topology,
    /// How many components run around the surface.
    pub around: usize,
}

/// A side of a filled triangle: the numbers of its ends, lower first, the triangle, and how far it leads around.
type Side = ([u32; 2], u32, f64);

/// Counts a pattern by Euler's formula: for a piece of a surface without handles, corners less sides and faces are two less the
/// number of its borders.
///
/// # Errors
/// Where parts meet in a point.
pub fn count(pressed: &Pressed, chart: &Chart) -> Result<Counts, WrapError> {
    let Pressed { imprint, flaps } = pressed;
    let sides = sides(imprint, chart, flaps);
    let mut pieces = UnionFind::new(imprint.triangles.len());
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        pieces.unite(pair[0].1, pair[1].1);
    }
    // Of each piece: corners less sides and faces.
    let mut sums: BTreeMap<u32, i64> = BTreeMap::new();
    let mut corners: Vec<(u32, u32)> = Vec::new();
    for (t, triangle) in imprint.triangles.iter().enumerate() {
        if imprint.inside[t] {
            let piece = pieces.find(t as u32);
            *sums.entry(piece).or_default() += 1;
            corners.extend(triangle.iter().map(|corner| (*corner, piece)));
        }
    }
    for (n, side) in sides.iter().enumerate() {
        if n == 0 || sides[n - 1].0 != side.0 {
            *sums.entry(pieces.find(side.1)).or_default() -= 1;
        }
    }
    corners.sort_unstable();
    corners.dedup();
    if let Some(pair) = corners.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        let at = imprint.places[pair[0].0 as usize].blend(&imprint.surface.positions);
        return Err(WrapError::Pinched { at });
    }
    for (_, piece) in &corners {
        *sums.entry(*piece).or_default() += 1;
    }
    let winding = winding(&sides, &mut pieces, imprint.places.len());
    let (mut holes, mut around) = (0, 0);
    for (piece, sum) in &sums {
        let borders = (1 - sum).max(0) as usize;
        let runs_around = winding.contains_key(piece);
        around += usize::from(runs_around);
        holes += borders.saturating_sub(usize::from(runs_around));
    }
    let topology = Topology {
        components: sums.len(),
        holes,
    };
    Ok(Counts { topology, around })
}

/// The sides of all filled triangles, sorted by their ends.
fn sides(imprint: &Imprint, chart: &Chart, flaps: &[Option<u32>]) -> Vec<Side> {
    let mut sides: Vec<Side> = Vec::new();
    for (t, triangle) in imprint
        .triangles
        .iter()
        .enumerate()
        .filter(|(t, _)| imprint.inside[*t])
    {
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            let ends = [a.min(b), a.max(b)];
            let way = flaps[t].map_or(0.0, |flap| {
                let place = |corner: u32| turn(imprint, chart, flap, corner);
                place(ends[1]) - place(ends[0])
            });
            sides.push((ends, t as u32, way));
        }
    }
    sides.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.cmp(&b.1)));
    sides
}

/// Which part of the way around a corner of a flap is, counted on without a jump on that flap.
fn turn(imprint: &Imprint, chart: &Chart, flap: u32, corner: u32) -> f64 {
    let flap = &chart.flaps[flap as usize];
    let place = &imprint.places[corner as usize];
    let mut p = Point::ORIGIN;
    for (of, weight) in place.of.iter().zip(place.weights) {
        if weight > 0.0
            && let Some(i) = flap.corners.iter().position(|corner| corner == of)
        {
            p = p + flap.drawn[i] * weight;
        }
    }
    match chart.deck {
        Deck::Open => 0.0,
        Deck::Step(step) => p.x / step,
        Deck::Turn(center, whole) => {
            let (down, way) = (center * -1.0, p - center);
            libm::atan2(down.cross(way), down.dot(way)) / whole
        }
    }
}

/// The pieces in which a way comes back to its beginning after a turn around the surface.
fn winding(sides: &[Side], pieces: &mut UnionFind, corners: usize) -> BTreeMap<u32, ()> {
    let mut beside: Vec<Vec<(u32, f64)>> = vec![Vec::new(); corners];
    for ([a, b], _, way) in sides {
        beside[*a as usize].push((*b, *way));
        beside[*b as usize].push((*a, -*way));
    }
    let mut turns: Vec<Option<f64>> = vec![None; corners];
    let mut found = BTreeMap::new();
    for (ends, t, _) in sides {
        if turns[ends[0] as usize].is_some() {
            continue;
        }
        turns[ends[0] as usize] = Some(0.0);
        let mut waiting = vec![ends[0]];
        while let Some(corner) = waiting.pop() {
            let here = turns[corner as usize].unwrap_or(0.0);
            for &(next, way) in &beside[corner as usize] {
                match turns[next as usize] {
                    None => {
                        turns[next as usize] = Some(here + way);
                        waiting.push(next);
                    }
                    Some(there) if (there - here - way).abs() > 0.5 => {
                        found.insert(pieces.find(*t), ());
                    }
                    Some(_) => {}
                }
            }
        }
    }
    found
}
