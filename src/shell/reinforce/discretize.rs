//! Pads and beams as members of a system: which unknowns they have, and how stiff they are. How the beams are
//! strained then is told by `model`.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::element::{Element, Vector, bars, element};
use super::frame::{Beam, Frame, Pad};
use super::system::{FIXED, Member};
use crate::analyse::Material;

/// How much of the body deforms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// Beams only: pads move as rigid bodies with six unknowns each, the Galerkin restriction of the full
    /// model. A tenth of the time; for ranking edges (S11).
    Rigid,
    /// Pads and beams.
    Full,
}

/// Which unknowns the nodes of a body have.
pub(super) struct Numbering {
    pub detail: Detail,
    /// For each pad its first unknown, or [`FIXED`].
    firsts: Vec<u32>,
    /// The pad of every unknown.
    pub pads: Vec<u32>,
}

impl Numbering {
    /// Numbers the unknowns of the pads that are not held.
    pub fn new(frame: &Frame, held: &[bool], detail: Detail) -> Numbering {
        let mut pads = Vec::new();
        let mut firsts = Vec::new();
        for (number, pad) in frame.pads.iter().enumerate() {
            let count = match detail {
                _ if held[number] => 0,
                Detail::Rigid => 6,
                Detail::Full => 3 * pad.nodes().len(),
            };
            firsts.push(if count == 0 { FIXED } else { pads.len() as u32 });
            pads.extend(std::iter::repeat_n(number as u32, count));
        }
        Numbering {
            detail,
            firsts,
            pads,
        }
    }

    /// The three unknowns of a node of the full model.
    fn node(&self, frame: &Frame, pad: u32, node: u32) -> [u32; 3] {
        let first = self.firsts[pad as usize];
        let offset = 3 * (node - frame.pads[pad as usize].first);
        [0, 1, 2].map(|k| {
            if first == FIXED {
                FIXED
            } else {
                first + offset + k
            }
        })
    }

    /// The unknowns of a beam: those of its nodes, or of its two pads.
    pub fn beam(&self, frame: &Frame, beam: &Beam) -> Vec<u32> {
        if self.detail == Detail::Full {
            let nodes = beam.nodes.iter().enumerate();
            return nodes
                .flat_map(|(c, node)| self.node(frame, beam.pads[c % 2], *node))
                .collect();
        }
        let firsts = beam.pads.map(|pad| self.firsts[pad as usize]);
        firsts
            .iter()
            .flat_map(|f| (0..6).map(move |k| if *f == FIXED { FIXED } else { f + k }))
            .collect()
    }

    /// The load of the pads' own weights, and what pulls at them besides.
    pub fn steady(&self, frame: &Frame, loads: &[Vector], pull: Vector) -> DVector<f64> {
        let mut steady = DVector::zeros(self.pads.len());
        for (number, pad) in (0u32..).zip(&frame.pads) {
            let first = self.firsts[number as usize];
            let volume: f64 = pad.wedges().map(|wedge| wedge_volume(frame, &wedge)).sum();
            let force = pull + loads[number as usize] / volume;
            for wedge in pad.wedges().filter(|_| first != FIXED) {
                let share = force * (wedge_volume(frame, &wedge) / 6.0);
                for node in wedge {
                    let arm = frame.points[node as usize] - pad.center;
                    let at = match self.detail {
                        Detail::Full => self.node(frame, number, node)[0],
                        Detail::Rigid => first,
                    } as usize;
                    (0..3).for_each(|k| steady[at + k] += share[k]);
                    if self.detail == Detail::Rigid {
                        let moment = arm.cross(&share);
                        (0..3).for_each(|k| steady[at + 3 + k] += moment[k]);
                    }
                }
            }
        }
        steady
    }

    /// The wedges of the pads that move.
    pub fn wedges(&self, frame: &Frame, material: &Material) -> Vec<Member> {
        let moving = (0..frame.pads.len()).into_par_iter();
        let moving = moving.filter(|pad| self.firsts[*pad] != FIXED);
        moving
            .flat_map_iter(|pad| {
                let wedges = frame.pads[pad].wedges();
                wedges.map(move |wedge| self.wedge(frame, pad as u32, &wedge, material))
            })
            .collect()
    }

    fn wedge(&self, frame: &Frame, pad: u32, nodes: &[u32; 6], material: &Material) -> Member {
        let points = nodes.map(|node| frame.points[node as usize]);
        let wedge = element(&points, material).expect("the corners of a pad go round it");
        Member {
            unknowns: nodes
                .iter()
                .flat_map(|node| self.node(frame, pad, *node))
                .collect(),
            stiffness: wedge.stiffness,
        }
    }
}

/// The volume of a wedge of a pad: a prism that stands upright.
pub(super) fn wedge_volume(frame: &Frame, wedge: &[u32; 6]) -> f64 {
    let [a, b, c, d, ..] = wedge.map(|node| frame.points[node as usize]);
    (b - a).cross(&(c - a)).norm() / 2.0 * (d - a).norm()
}

/// The nodes of a brick whose second pad is upside down: what is below and to the right of the beam on the first
/// one is above and to the left on the second. Done twice it changes nothing.
const OVER: [usize; 8] = [0, 7, 2, 5, 4, 3, 6, 1];

/// The beam's brick. Where the two normals point to opposite sides, the second pad is taken upside down; where
/// the brick is inside out all the same, bars stand for it.
pub(super) fn brick(frame: &Frame, beam: &Beam, material: &Material) -> Element {
    let points = beam.nodes.map(|node| frame.points[node as usize]);
    if let Some(brick) = element(&points, material) {
        return brick;
    }
    let Some(over) = element(&OVER.map(|c| points[c]), material) else {
        return bars(&points, beam.area, material);
    };
    let back = |row: usize| 3 * OVER[row / 3] + row % 3;
    Element {
        stiffness: DMatrix::from_fn(24, 24, |i, j| over.stiffness[(back(i), back(j))]),
        stress: DMatrix::from_fn(6, 24, |i, j| over.stress[(i, back(j))]),
        volumes: OVER.map(|c| over.volumes[c]).to_vec(),
    }
}

/// The displacements of a beam's nodes for the motions of its two pads: three shifts and three turns each.
pub(super) fn rigid_motions(frame: &Frame, beam: &Beam) -> DMatrix<f64> {
    let mut motions = DMatrix::zeros(24, 12);
    for (c, node) in beam.nodes.iter().enumerate() {
        let pad: &Pad = &frame.pads[beam.pads[c % 2] as usize];
        let arm = frame.points[*node as usize] - pad.center;
        let first = 6 * (c % 2);
        for k in 0..3 {
            motions[(3 * c + k, first + k)] = 1.0;
            let turned = Vector::ith(k, 1.0).cross(&arm);
            (0..3).for_each(|row| motions[(3 * c + row, first + 3 + k)] = turned[row]);
        }
    }
    motions
}
