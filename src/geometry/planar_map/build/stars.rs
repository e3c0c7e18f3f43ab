//! The pieces around every node, counter-clockwise.

use std::cmp::Ordering;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use crate::planar_map::noding::exact::cross;
use crate::planar_map::noding::routes::Routes;
use crate::planar_map::noding::snap_grid::Site;
use crate::planar_map::parallel::{accumulate, for_each_row};

/// A piece as it leaves a node.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::planar_map) struct Spoke {
    /// The node at the other end.
    pub to: u32,
    /// 2 × the curve that it is of, + 1 where the curve runs toward the node.
    pub source: u32,
}

/// The spokes of every node, counter-clockwise (+x toward +y) from +x on; those of coincident
/// pieces stand together, by source.
pub(in crate::planar_map) struct Stars<'a> {
    sites: &'a [Site],
    pub starts: Vec<u32>,
    pub spokes: Vec<Spoke>,
    /// Whether any pieces coincide.
    pub coincident: bool,
}

impl<'a> Stars<'a> {
    /// The stars of routes that do not cross.
    pub fn around(sites: &'a [Site], routes: &Routes) -> Stars<'a> {
        let mut starts = vec![0u32; sites.len() + 1];
        for i in 0..routes.len() {
            routes
                .pieces(i)
                .flatten()
                .for_each(|v| starts[v as usize] += 1);
        }
        let mut spokes = vec![Spoke::default(); accumulate(&mut starts)];
        for (i, &source) in routes.curves.iter().enumerate() {
            for [a, b] in routes.pieces(i) {
                for (at, spoke) in [
                    (a, Spoke { to: b, source }),
                    (
                        b,
                        Spoke {
                            to: a,
                            source: source ^ 1,
                        },
                    ),
                ] {
                    starts[at as usize] -= 1;
                    spokes[starts[at as usize] as usize] = spoke;
                }
            }
        }
        let coincident = AtomicBool::new(false);
        for_each_row(&starts, &mut spokes, &|star: &mut Vec<Ray>, v, row| {
            sort(v, row, star, sites);
            if row.windows(2).any(|w| w[0].to == w[1].to) {
                coincident.store(true, Relaxed);
            }
        });
        Stars {
            sites,
            starts,
            spokes,
            coincident: coincident.into_inner(),
        }
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.sites.len()
    }

    /// The spokes of a node.
    pub fn of(&self, v: usize) -> &[Spoke] {
        &self.spokes[self.starts[v] as usize..self.starts[v + 1] as usize]
    }

    /// The number of pieces at a node, coincident ones counted once.
    pub fn degree(&self, v: usize) -> usize {
        if self.coincident {
            self.of(v).chunk_by(|p, q| p.to == q.to).count()
        } else {
            self.of(v).len()
        }
    }

    /// The place in `spokes` of the first spoke from one node to another, which must be there.
    pub fn slot(&self, from: u32, to: u32) -> usize {
        let star = self.of(from as usize);
        let near = if star.len() <= 16 {
            // Without a jump that depends on where it is.
            (0..star.len()).rev().fold(
                None,
                |found, i| if star[i].to == to { Some(i) } else { found },
            )
        } else {
            let ray = |to: u32| {
                Ray::new(
                    self.sites[from as usize],
                    self.sites[to as usize],
                    Spoke { to, source: 0 },
                )
            };
            Some(star.partition_point(|s| ray(s.to).turn(&ray(to)).is_lt()))
        };
        self.starts[from as usize] as usize + near.expect("a piece has a spoke at either end")
    }
}

/// A spoke with its direction and a number that grows with the angle.
struct Ray {
    angle: f64,
    direction: Site,
    spoke: Spoke,
}

impl Ray {
    fn new(from: Site, to: Site, spoke: Spoke) -> Ray {
        let direction = [to[0] - from[0], to[1] - from[1]];
        Ray {
            angle: angle(direction),
            direction,
            spoke,
        }
    }

    /// The order counter-clockwise from +x on.
    fn turn(&self, other: &Ray) -> Ordering {
        // The angles are off by less than 1e-15.
        let apart = self.angle - other.angle;
        if apart.abs() > 1e-14 {
            apart.total_cmp(&0.0)
        } else {
            exact_turn(self.direction, other.direction)
        }
    }
}

/// Sorts a star by angle, then by source.
fn sort(v: usize, row: &mut [Spoke], star: &mut Vec<Ray>, sites: &[Site]) {
    if row.len() < 2 {
        return;
    }
    star.clear();
    star.extend(
        row.iter()
            .map(|&spoke| Ray::new(sites[v], sites[spoke.to as usize], spoke)),
    );
    star.sort_unstable_by(|p, q| p.turn(q).then(p.spoke.source.cmp(&q.spoke.source)));
    row.iter_mut()
        .zip(star.iter())
        .for_each(|(slot, ray)| *slot = ray.spoke);
}

/// Grows with the angle from +x toward +y: from 0 by 1 a quarter turn.
fn angle(d: Site) -> f64 {
    let along = d[0] / (d[0].abs() + d[1].abs());
    if d[1] < 0.0 { 3.0 + along } else { 1.0 - along }
}

#[cold]
fn exact_turn(d: Site, e: Site) -> Ordering {
    // Of two rays this near to each other one is above and one below only at a half turn.
    let lower = |d: Site| d[1] < 0.0 || (d[1] == 0.0 && d[0] < 0.0);
    lower(d)
        .cmp(&lower(e))
        .then_with(|| 0f64.total_cmp(&(cross(d, e) + 0.0)))
}
