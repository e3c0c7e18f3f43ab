//! Narrow triangles taken out of a closed mesh: where one has a short side, its ends become one corner; where a corner
//! lies on the side across from it, that side is turned to the next triangle's corner.
//!
//! The mesh stays the closed 2-manifold that it is (an end is moved to the other only where no corner but two is joined to both:
//! the link condition of Dey and others, Topology Preserving Edge Contraction, 1999), and no triangle turns far.

use rayon::prelude::*;

use fretwork_geometry::index::Rows;
use fretwork_geometry::mesh::doubled_normal;
use fretwork_geometry::{Mesh, Point3};

use super::relax::are_folded;

/// A triangle with an angle of less than this sine is narrow: 10 degrees.
const NARROW: f64 = 0.174;
/// The cosine of the angle by which a change may turn a triangle, at most.
const TURN: f64 = 0.85;
/// How far a turned side may leave the surface, as a part of its length.
const OFF: f64 = 0.05;
/// A triangle with an angle of less than this sine faces no way that can be told: half a degree.
const DEGENERATE: f64 = 0.009;
/// The rank of a corner all of whose triangles must stay as they are.
pub const FIXED: u8 = u8::MAX;
/// Rounds, at most: of changes that touch one another only the first is made in a round.
const ROUNDS: usize = 12;

/// A mesh some of whose triangles were changed or taken out.
pub struct Mended {
    /// The mesh, with all its corners.
    pub mesh: Mesh,
    /// The triangles that were changed, ascending.
    pub changed: Vec<u32>,
    /// What number each triangle had before, ascending.
    pub of: Vec<u32>,
}

/// Takes narrow triangles out where that is possible. A corner with a greater `rank` is not moved to one with a lesser: it
/// lies on a sharp edge; the triangles of one whose rank is [`FIXED`] stay.
pub fn without_slivers(mut mesh: Mesh, ranks: &[u8]) -> Mended {
    let mut is_changed = vec![false; mesh.triangles.len()];
    let mut of: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
    for _ in 0..ROUNDS {
        let all = (0..mesh.triangles.len() as u32).into_par_iter();
        let is_narrow = |t: &u32| sine(mesh.corners(mesh.triangles[*t as usize])) < NARROW;
        let narrow: Vec<u32> = all.filter(is_narrow).collect();
        let mut round = Round::new(&mut mesh, ranks, &mut is_changed);
        let changed = narrow.into_iter().filter(|t| round.mend(*t)).count();
        let dead = round.dead;
        retain(&mut mesh.triangles, &dead);
        retain(&mut is_changed, &dead);
        retain(&mut of, &dead);
        if changed == 0 {
            break;
        }
    }
    let changed = (0..).zip(is_changed).filter(|(_, changed)| *changed);
    Mended {
        changed: changed.map(|(number, _)| number).collect(),
        of,
        mesh,
    }
}

/// Takes what is dead out of a list.
fn retain<T>(list: &mut Vec<T>, dead: &[bool]) {
    let mut number = 0;
    list.retain(|_| {
        number += 1;
        !dead[number - 1]
    });
}

/// The sine of the least angle of a triangle: its area doubled by the product of its two longest sides.
pub fn sine(corners: [Point3; 3]) -> f64 {
    let [a, b, c] = corners;
    let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
    sides.sort_by(f64::total_cmp);
    let product = sides[1] * sides[2];
    if product > 0.0 {
        doubled_normal(corners).length() / product
    } else {
        0.0
    }
}

/// One round of changes, none of which touches another.
struct Round<'a> {
    mesh: &'a mut Mesh,
    ranks: &'a [u8],
    /// The triangles of each corner, true for those that are not locked.
    around: Rows,
    locked: Vec<bool>,
    dead: Vec<bool>,
    is_changed: &'a mut [bool],
}

impl Round<'_> {
    fn new<'a>(mesh: &'a mut Mesh, ranks: &'a [u8], is_changed: &'a mut [bool]) -> Round<'a> {
        let around = Rows::fill(mesh.positions.len(), |filler| {
            for (number, triangle) in (0u32..).zip(&mesh.triangles) {
                let put = |corner: &u32| filler.put(*corner as usize, number);
                triangle.iter().for_each(put);
            }
        });
        Round {
            around,
            ranks,
            locked: vec![false; mesh.positions.len()],
            dead: vec![false; mesh.triangles.len()],
            is_changed,
            mesh,
        }
    }

    /// Takes a narrow triangle out, if that is possible.
    fn mend(&mut self, number: u32) -> bool {
        let triangle = self.mesh.triangles[number as usize];
        if triangle.iter().any(|corner| !self.is_free(*corner)) {
            return false;
        }
        let at = |corner: u32| self.mesh.positions[corner as usize];
        let length = |side: &usize| at(triangle[*side]).distance(at(triangle[(*side + 1) % 3]));
        let mut sides = [0, 1, 2];
        sides.sort_by(|a, b| length(a).total_cmp(&length(b)));
        let [short, _, long] = sides;
        let [u, v] = [triangle[short], triangle[(short + 1) % 3]];
        self.contract(u, v) || self.contract(v, u) || self.turn(number, long)
    }

    fn is_free(&self, corner: u32) -> bool {
        !self.locked[corner as usize]
    }

    /// Whether a triangle must stay as it is.
    fn is_fixed(&self, number: u32) -> bool {
        let mut corners = self.mesh.triangles[number as usize].iter();
        corners.any(|corner| self.ranks[*corner as usize] == FIXED)
    }

    fn triangle(&self, number: u32) -> [Point3; 3] {
        self.mesh.corners(self.mesh.triangles[number as usize])
    }

    /// The corners that are joined to one, in order.
    fn beside(&self, corner: u32) -> Vec<u32> {
        let of = |t: &u32| self.mesh.triangles[*t as usize];
        let around = self.around.row(corner as usize).iter().flat_map(of);
        let mut beside: Vec<u32> = around.filter(|other| *other != corner).collect();
        beside.sort_unstable();
        beside.dedup();
        beside
    }

    /// Moves the corner `u` to its neighbour `v`.
    fn contract(&mut self, u: u32, v: u32) -> bool {
        let (near, far) = (self.beside(u), self.beside(v));
        let shared = near.iter().filter(|w| far.binary_search(w).is_ok());
        let is_linked = shared.count() == 2 && near.len().max(far.len()) > 3;
        if !is_linked || self.ranks[u as usize] > self.ranks[v as usize] {
            return false;
        }
        let ring = self.around.row(u as usize).to_vec();
        let (gone, kept): (Vec<u32>, Vec<u32>) = ring
            .into_iter()
            .partition(|t| self.mesh.triangles[*t as usize].contains(&v));
        let moved = |t: &u32| {
            let corners = self.mesh.triangles[*t as usize];
            let corners = corners.map(|corner| if corner == u { v } else { corner });
            (self.triangle(*t), self.mesh.corners(corners))
        };
        let mut touched = gone.iter().chain(&kept);
        if touched.any(|t| self.is_fixed(*t)) {
            return false;
        }
        let pairs: Vec<_> = kept.iter().map(moved).collect();
        let worst = |before: f64, t: &u32| before.min(sine(self.triangle(*t)));
        let worst = gone.iter().chain(&kept).fold(1.0, worst);
        if !pairs
            .iter()
            .all(|(before, after)| sine(*after) > worst && is_turned_little(*before, *after))
        {
            return false;
        }
        let fan = self.around.row(v as usize).iter();
        let fan = fan.filter(|t| !gone.contains(t)).map(|t| self.triangle(*t));
        if are_folded(fan.chain(pairs.iter().map(|(_, after)| *after))) {
            return false;
        }
        gone.iter().for_each(|t| self.dead[*t as usize] = true);
        for t in kept {
            self.is_changed[t as usize] = true;
            let corners = &mut self.mesh.triangles[t as usize];
            *corners = corners.map(|corner| if corner == u { v } else { corner });
        }
        let touched = near.into_iter().chain([u, v]);
        touched.for_each(|corner| self.locked[corner as usize] = true);
        true
    }

    /// Turns the side of a triangle to the corner of the triangle beyond it.
    fn turn(&mut self, number: u32, side: usize) -> bool {
        let [u, v, a] = [0, 1, 2].map(|k| self.mesh.triangles[number as usize][(side + k) % 3]);
        let beyond = self.around.row(u as usize).iter().copied();
        let Some(other) =
            { beyond }.find(|t| *t != number && self.mesh.triangles[*t as usize].contains(&v))
        else {
            return false;
        };
        let apex = self.mesh.triangles[other as usize];
        let Some(b) = apex.into_iter().find(|corner| *corner != u && *corner != v) else {
            return false;
        };
        let is_fixed = self.is_fixed(number) || self.is_fixed(other);
        if is_fixed || !self.is_free(b) || self.beside(a).binary_search(&b).is_ok() {
            return false;
        }
        let (one, two) = ([a, b, v], [b, a, u]);
        let at = |corner: u32| self.mesh.positions[corner as usize];
        let (before, beyond) = (self.triangle(number), self.triangle(other));
        let off = doubled_normal(beyond)
            .unit()
            .map_or(0.0, |normal| normal.dot(at(a) - at(u)).abs());
        let after = [one, two].map(|t| self.mesh.corners(t));
        let worst = sine(before).min(sine(beyond));
        let is_good = off <= OFF * at(u).distance(at(v))
            && after
                .iter()
                .all(|t| sine(*t) > worst && is_turned_little(beyond, *t));
        if is_good {
            self.mesh.triangles[number as usize] = one;
            self.mesh.triangles[other as usize] = two;
            self.is_changed[number as usize] = true;
            self.is_changed[other as usize] = true;
            [u, v, a, b]
                .into_iter()
                .for_each(|corner| self.locked[corner as usize] = true);
        }
        is_good
    }
}

/// Whether a triangle faces nearly the same way as before; one that was so narrow that it faced nowhere may turn.
fn is_turned_little(before: [Point3; 3], after: [Point3; 3]) -> bool {
    let (n, m) = (doubled_normal(before), doubled_normal(after));
    sine(before) < DEGENERATE || n.dot(m) >= TURN * n.length() * m.length()
}
