//! The part of a mesh around a place, cut out and flattened.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use fretwork_geometry::halving::largest;
use fretwork_geometry::mesh::nearest::{Foot, Nearest};
use fretwork_geometry::mesh::{doubled_normal, open_sides};
use fretwork_geometry::{Mesh, Point, Point3};

use super::flatten::flattened;
use super::{Chart, Deck, Demand, Flap, Room, Stretch};
use crate::WrapError;

/// A patch reaches this many times as far as the drawing, so that its border, where it is least held, lies outside.
const BEYOND: f64 = 1.35;

/// Parts of the largest disc that are tried, where a drawing of its own size cannot be laid flat.
const TRIED: [f64; 6] = [1.0, 0.8, 0.6, 0.4, 0.2, 0.1];

/// The chart of a patch of `mesh`.
///
/// # Errors
/// No place, a broken mesh, and a drawing that reaches farther than the mesh can be laid flat; with the part of it that can, which was
/// tried.
pub fn chart(mesh: &Mesh, demand: &Demand) -> Result<Chart, WrapError> {
    let at = demand.at.ok_or(WrapError::NoPlace)?;
    let foot = Nearest::new(mesh).foot(at).ok_or(WrapError::Broken)?;
    let disc = Disc::around(mesh, &foot, demand.reach);
    let is_disc = disc.is_some();
    let turned_back = match disc.map(|disc| disc.flattened(mesh, &foot)) {
        Some(Ok(chart)) => return Ok(chart),
        Some(Err(error)) => error,
        None => WrapError::TurnsBack {
            at: foot.at,
            fits: None,
        },
    };
    let most = if is_disc {
        Some(demand.reach)
    } else {
        largest(demand.reach, |reach| {
            Disc::around(mesh, &foot, reach).is_some()
        })
    };
    let can_be_laid = |reach: &f64| {
        let disc = Disc::around(mesh, &foot, *reach);
        disc.is_some_and(|disc| disc.flattened(mesh, &foot).is_ok())
    };
    let tried = TRIED.iter().skip(usize::from(is_disc));
    let fits = most.and_then(|most| tried.map(|part| part * most).find(can_be_laid));
    let fits = fits.map(|reach| reach / demand.reach);
    Err(match (turned_back, fits) {
        (_, Some(part)) if !is_disc => WrapError::TooLarge {
            by: demand.reach * (1.0 - part),
            fits,
        },
        (WrapError::TurnsBack { at, .. }, _) => WrapError::TurnsBack { at, fits },
        (other, _) => other,
    })
}

/// A part of a mesh around a place that is a disc.
struct Disc {
    /// The numbers of its triangles, ascending.
    chosen: Vec<u32>,
    patch: Patch,
    border: Vec<u32>,
}

impl Disc {
    /// None where what is reached is no disc.
    fn around(mesh: &Mesh, foot: &Foot, reach: f64) -> Option<Disc> {
        let chosen = around(mesh, foot.triangle, foot.at, BEYOND * reach);
        let patch = Patch::new(mesh, &chosen);
        let border = patch.border()?;
        Some(Disc {
            chosen,
            patch,
            border,
        })
    }

    /// Its chart, in which no triangle is turned over.
    fn flattened(&self, mesh: &Mesh, foot: &Foot) -> Result<Chart, WrapError> {
        let (chosen, patch) = (&self.chosen, &self.patch);
        let triangle = chosen
            .binary_search(&foot.triangle)
            .map_err(|_| WrapError::Broken)?;
        let turned_back = |at| WrapError::TurnsBack { at, fits: None };
        let mut flat = flattened(&patch.positions, &patch.triangles, &self.border)
            .ok_or(turned_back(foot.at))?;
        patch.settle(&mut flat, triangle, foot.at);
        let flaps: Vec<Flap> = (0..patch.triangles.len())
            .map(|t| patch.flap(mesh, chosen[t], t, &flat))
            .collect();
        if let Some(flap) = flaps.iter().find(|flap| signed(flap.drawn) <= 0.0) {
            return Err(turned_back(mesh.positions[flap.corners[0] as usize]));
        }
        let is_chosen = |t: &u32| chosen.binary_search(t).is_ok();
        let all = 0..mesh.triangles.len() as u32;
        Ok(Chart {
            flaps,
            others: all.filter(|t| !is_chosen(t)).collect(),
            deck: Deck::Open,
            room: Room::Flaps,
            slack: 1.0,
        })
    }
}

fn signed([a, b, c]: [Point; 3]) -> f64 {
    (b - a).cross(c - a)
}

/// The triangles that are reached from a place over sides that come nearer to it than `reach`, straight and along edges;
/// without gaps: what they surround belongs to them. Ascending.
fn around(mesh: &Mesh, triangle: u32, at: Point3, reach: f64) -> Vec<u32> {
    let mut chosen = reached(mesh, triangle, at, reach);
    // Of what is left of the place's body, the largest part is its rest, and with it all that has a rim.
    let bodies = parts(mesh, |_| true);
    let body = bodies[triangle as usize];
    let outside = parts(mesh, |t| !chosen[t] && bodies[t] == body);
    let mut sizes: BTreeMap<u32, (bool, usize)> = BTreeMap::new();
    let rims: Vec<[u32; 2]> = open_sides(&mesh.triangles);
    for (t, part) in outside.iter().enumerate() {
        let Some(part) = part else { continue };
        let [a, b, c] = mesh.triangles[t];
        let on_rim = [[a, b], [b, c], [c, a]]
            .iter()
            .any(|s| rims.binary_search(s).is_ok());
        let size = sizes.entry(*part).or_default();
        *size = (size.0 || on_rim, size.1 + 1);
    }
    let largest = sizes
        .iter()
        .max_by_key(|(part, size)| (size.1, Reverse(**part)))
        .map(|(part, _)| *part);
    for (t, part) in outside.iter().enumerate() {
        if let Some(part) = part
            && Some(*part) != largest
            && !sizes[part].0
        {
            chosen[t] = true;
        }
    }
    // Only what hangs together with the place.
    let inside = parts(mesh, |t| chosen[t]);
    let here = inside[triangle as usize];
    (0..mesh.triangles.len() as u32)
        .filter(|t| inside[*t as usize] == here && here.is_some())
        .collect()
}

/// Which triangles are reached from a place over sides that come near to it.
fn reached(mesh: &Mesh, triangle: u32, at: Point3, reach: f64) -> Vec<bool> {
    let distances = distances(mesh, triangle, at, reach);
    let is_near = |[a, b]: [u32; 2]| {
        let ends = [a, b].map(|corner| mesh.positions[corner as usize]);
        let length = ends[0].distance(ends[1]);
        let along = distances[a as usize].min(distances[b as usize]) - length;
        let t = (at - ends[0]).dot(ends[1] - ends[0]) / (length * length).max(f64::MIN_POSITIVE);
        let straight = ends[0].lerp(ends[1], t.clamp(0.0, 1.0)).distance(at);
        along <= reach && straight <= reach
    };
    let sides = sides(mesh, |_| true);
    let mut chosen = vec![false; mesh.triangles.len()];
    chosen[triangle as usize] = true;
    let mut waiting = vec![triangle];
    while let Some(t) = waiting.pop() {
        let [a, b, c] = mesh.triangles[t as usize];
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let ends = [from.min(to), from.max(to)];
            if !is_near(ends) {
                continue;
            }
            let first = sides.partition_point(|side| side.0 < ends);
            for (_, next) in sides[first..].iter().take_while(|side| side.0 == ends) {
                if !chosen[*next as usize] {
                    chosen[*next as usize] = true;
                    waiting.push(*next);
                }
            }
        }
    }
    chosen
}

/// The sides of chosen triangles by the numbers of their ends, lower first, each with its triangle; sorted.
fn sides(mesh: &Mesh, chosen: impl Fn(usize) -> bool) -> Vec<([u32; 2], u32)> {
    let mut sides = Vec::new();
    for (t, &[a, b, c]) in mesh
        .triangles
        .iter()
        .enumerate()
        .filter(|(t, _)| chosen(*t))
    {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            sides.push(([from.min(to), from.max(to)], t as u32));
        }
    }
    sides.sort_unstable();
    sides
}

/// How far corners are from a place on the way along edges, as far as `reach` and the longest edge: a side passes near the place
/// where both its ends are farther than `reach`, but no farther than that and its own length.
fn distances(mesh: &Mesh, triangle: u32, at: Point3, reach: f64) -> Vec<f64> {
    let mut beside: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for [a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            beside[*from as usize].push(*to);
            beside[*to as usize].push(*from);
        }
    }
    let length =
        |[from, to]: [u32; 2]| mesh.positions[from as usize].distance(mesh.positions[to as usize]);
    let lengths = mesh
        .triangles
        .iter()
        .flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]])
        .map(length);
    let reach = reach + lengths.fold(0.0, f64::max);
    let mut distances = vec![f64::INFINITY; mesh.positions.len()];
    // Distances are above zero, and such numbers are in the order of their bits.
    let mut waiting: BinaryHeap<Reverse<(u64, u32)>> = BinaryHeap::new();
    for corner in mesh.triangles[triangle as usize] {
        let distance = mesh.positions[corner as usize].distance(at);
        distances[corner as usize] = distance;
        waiting.push(Reverse((distance.to_bits(), corner)));
    }
    while let Some(Reverse((bits, corner))) = waiting.pop() {
        let here = f64::from_bits(bits);
        if here > distances[corner as usize] || here > reach {
            continue;
        }
        for &next in &beside[corner as usize] {
            let way = mesh.positions[corner as usize].distance(mesh.positions[next as usize]);
            if here + way < distances[next as usize] {
                distances[next as usize] = here + way;
                waiting.push(Reverse(((here + way).to_bits(), next)));
            }
        }
    }
    distances
}

/// The number of the part that each chosen triangle belongs to; triangles with a common edge are in one part.
fn parts(mesh: &Mesh, chosen: impl Fn(usize) -> bool) -> Vec<Option<u32>> {
    let sides = sides(mesh, &chosen);
    let mut sets = fretwork_geometry::numeric::UnionFind::new(mesh.triangles.len());
    for pair in sides.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
        sets.unite(pair[0].1, pair[1].1);
    }
    (0..mesh.triangles.len())
        .map(|t| chosen(t).then(|| sets.find(t as u32)))
        .collect()
}

/// Triangles of a mesh with corners of their own numbers.
struct Patch {
    positions: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
}

impl Patch {
    fn new(mesh: &Mesh, chosen: &[u32]) -> Patch {
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let mut positions = Vec::new();
        let mut own = |corner: u32| {
            *numbers.entry(corner).or_insert_with(|| {
                positions.push(mesh.positions[corner as usize]);
                (positions.len() - 1) as u32
            })
        };
        let triangles = chosen
            .iter()
            .map(|t| mesh.triangles[*t as usize].map(&mut own))
            .collect();
        Patch {
            positions,
            triangles,
        }
    }

    /// The corners around the patch, counter-clockwise; none where it is no disc.
    fn border(&self) -> Option<Vec<u32>> {
        let open = open_sides(&self.triangles);
        let sides = 3 * self.triangles.len() + open.len();
        // Euler's formula for a disc: corners less edges and faces are one.
        if self.positions.len() + self.triangles.len() != sides / 2 + 1 {
            return None;
        }
        let next: BTreeMap<u32, u32> = open.iter().map(|[a, b]| (*a, *b)).collect();
        let first = open.first()?[0];
        let mut border = vec![first];
        let mut at = *next.get(&first)?;
        while at != first && border.len() <= open.len() {
            border.push(at);
            at = *next.get(&at)?;
        }
        (border.len() == open.len() && next.len() == open.len()).then_some(border)
    }

    /// Moves and turns the flat patch so that the place on a triangle is the origin and up is up.
    fn settle(&self, flat: &mut [Point], triangle: usize, at: Point3) {
        let corners = self.triangles[triangle].map(|c| c as usize);
        let [a, b, c] = corners.map(|i| self.positions[i]);
        let normal = doubled_normal([a, b, c]);
        let up = Point3::new(0.0, 0.0, 1.0);
        let upright = normal.dot(up).abs() < 0.999 * normal.length();
        let up = if upright {
            up
        } else {
            Point3::new(0.0, 1.0, 0.0)
        };
        let [pa, pb, pc] = corners.map(|i| flat[i]);
        // A direction by its parts along two sides of the triangle, which are the same in space and in the plane.
        let (ab, ac) = (b - a, c - a);
        let (d11, d12, d22) = (ab.dot(ab), ab.dot(ac), ac.dot(ac));
        let det = d11 * d22 - d12 * d12;
        let flattened = |way: Point3| {
            let (r1, r2) = (way.dot(ab), way.dot(ac));
            let (s, t) = ((r1 * d22 - r2 * d12) / det, (r2 * d11 - r1 * d12) / det);
            (pb - pa) * s + (pc - pa) * t
        };
        let origin = pa + flattened(at - a);
        let toward = flattened(up);
        let length = toward.length();
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let y = toward * (1.0 / length);
        for p in flat.iter_mut() {
            let way = *p - origin;
            *p = Point::new(way.cross(y), way.dot(y));
        }
    }

    fn flap(&self, mesh: &Mesh, number: u32, t: usize, flat: &[Point]) -> Flap {
        let drawn = self.triangles[t].map(|c| flat[c as usize]);
        let corners = mesh.triangles[number as usize];
        Flap {
            corners,
            drawn,
            plan: drawn,
            stretch: Stretch::Even(stretch(drawn, mesh.corners(corners))),
        }
    }
}

/// The singular values of the map from a flat triangle to one in space: the least, the root of their product, the greatest.
pub fn stretch([a, b, c]: [Point; 3], [p, q, r]: [Point3; 3]) -> [f64; 3] {
    let det = (b - a).cross(c - a);
    let (bp, cp) = (q - p, r - p);
    let (db, dc) = (b - a, c - a);
    let x = (bp * dc.y - cp * db.y) * (1.0 / det);
    let y = (cp * db.x - bp * dc.x) * (1.0 / det);
    let (e, f, g) = (x.dot(x), x.dot(y), y.dot(y));
    let (mean, half) = (0.5 * (e + g), libm::hypot(0.5 * (e - g), f));
    let low = (mean - half).max(0.0).sqrt();
    let high = (mean + half).sqrt();
    [low, (low * high).sqrt(), high]
}
