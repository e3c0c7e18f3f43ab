//! The pieces around every node, counter-clockwise.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::exact::cross;
use super::lattice::Site;
use super::noding::Network;
use super::parallel::{accumulate, for_each_row};

/// A piece as it leaves a node.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spoke {
    /// The node at the other end.
    pub to: u32,
    /// 2 × piece, + 1 where the piece runs toward the node.
    pub half: u32,
}

/// The spokes of every node, counter-clockwise (+x toward +y); those of coincident pieces stand together, by
/// number.
pub(super) struct Stars {
    pub starts: Vec<u32>,
    pub spokes: Vec<Spoke>,
    /// Whether any pieces coincide.
    pub coincident: bool,
}

impl Stars {
    /// The stars of a network without crossings.
    pub fn around(network: &Network) -> Stars {
        let mut starts = vec![0u32; network.sites.len() + 1];
        network.pieces.iter().flatten().for_each(|v| starts[*v as usize] += 1);
        let mut spokes = vec![Spoke::default(); accumulate(&mut starts)];
        for (piece, &[from, to]) in (0..network.pieces.len() as u32).zip(&network.pieces).rev() {
            for (at, spoke) in [(from, Spoke { to, half: 2 * piece }), (to, Spoke { to: from, half: 2 * piece + 1 })] {
                starts[at as usize] -= 1;
                spokes[starts[at as usize] as usize] = spoke;
            }
        }
        let coincident = AtomicBool::new(false);
        for_each_row(&starts, &mut spokes, &|star: &mut Vec<Ray>, v, row| {
            sort(v, row, star, &network.sites);
            if row.windows(2).any(|w| w[0].to == w[1].to) {
                coincident.store(true, Relaxed);
            }
        });
        Stars { starts, spokes, coincident: coincident.into_inner() }
    }

    /// The spokes of a node.
    pub fn of(&self, v: usize) -> &[Spoke] {
        &self.spokes[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// The spokes of a node, the first of those that coincide.
    pub fn distinct(&self, v: usize) -> impl Iterator<Item = Spoke> {
        self.of(v).chunk_by(|p, q| p.to == q.to).map(|same| same[0])
    }
}

/// A spoke with its direction and a number that grows with the angle.
struct Ray {
    angle: f64,
    direction: Site,
    spoke: Spoke,
}

/// Sorts a star by angle.
fn sort(v: usize, row: &mut [Spoke], star: &mut Vec<Ray>, sites: &[Site]) {
    if row.len() < 3 {
        return;
    }
    star.clear();
    star.extend(row.iter().map(|&spoke| {
        let (a, b) = (sites[v], sites[spoke.to as usize]);
        let direction = [b[0] - a[0], b[1] - a[1]];
        Ray { angle: angle(direction), direction, spoke }
    }));
    star.sort_unstable_by(|p, q| {
        // The angles are off by less than 1e-15.
        let apart = p.angle - q.angle;
        if apart.abs() > 1e-14 { apart.total_cmp(&0.0) } else { exactly(p, q) }
    });
    row.iter_mut().zip(star.iter()).for_each(|(slot, ray)| *slot = ray.spoke);
}

/// Grows with the angle from +x toward +y: from 0 by 1 a quarter turn.
fn angle(d: Site) -> f64 {
    let along = d[0] / (d[0].abs() + d[1].abs());
    if d[1] < 0.0 { 3.0 + along } else { 1.0 - along }
}

#[cold]
fn exactly(p: &Ray, q: &Ray) -> std::cmp::Ordering {
    // Within 1e-14 of each other, only at a half turn are two rays on different sides.
    let lower = |d: Site| d[1] < 0.0 || (d[1] == 0.0 && d[0] < 0.0);
    let turn = 0f64.total_cmp(&(cross(p.direction, q.direction) + 0.0));
    lower(p.direction).cmp(&lower(q.direction)).then(turn).then(p.spoke.half.cmp(&q.spoke.half))
}
