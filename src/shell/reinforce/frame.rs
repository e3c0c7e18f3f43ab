//! The body that stands for an abstract graph: a pad for every sample, a beam for every edge (Dumas 2015,
//! 5.2.1, figure 8). What is stiff, and what is asked of it, is not known here.

use fretwork_geometry::Point3;

use super::element::Vector;
use super::ring::{Ring, ring};
use crate::connect::{AbstractEdge, AbstractGraph, SurfaceGraph};

/// The radius of a pad as a part of the distance to its nearest neighbour, at least and at most. Below it
/// a pad would be a needle, above it no beam would be left between two pads.
const RADIUS: [f64; 2] = [0.12, 0.35];
/// How far the stiffness of a beam may differ from that of its shape, where the pattern is wider or
/// narrower there than the room that its pads leave it.
const FACTOR: [f64; 2] = [0.1, 10.0];

/// Lengths of the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    /// Metres in a pitch.
    pub pitch: f64,
    /// The shell's thickness, m.
    pub thickness: f64,
    /// The width of a bridge, m.
    pub bridge: f64,
}

/// A flat prism round a sample, of which each slice from the middle is a wedge.
#[derive(Clone, Debug)]
pub(super) struct Pad {
    pub center: Vector,
    /// Its first node: the middle below and above, then each corner below and above.
    pub first: u32,
    /// How many corners it has.
    pub corners: u32,
}

/// A beam between two pads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beam {
    pub pads: [u32; 2],
    /// As a brick: along the beam, across it, up.
    pub nodes: [u32; 8],
    /// The width of the pattern there over that of the beam.
    pub factor: f64,
    /// Its own section, m².
    pub area: f64,
}

/// Pads and beams.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub points: Vec<Vector>,
    pub pads: Vec<Pad>,
    /// For each edge of the graph its beam.
    pub beams: Vec<Beam>,
}

impl Pad {
    /// The six nodes of its wedges: the middle and two corners below, then above.
    pub fn wedges(&self) -> impl Iterator<Item = [u32; 6]> + '_ {
        (0..self.corners).map(|k| {
            let corner = |k: u32| self.first + 2 + 2 * (k % self.corners);
            let below = [self.first, corner(k), corner(k + 1)];
            let [a, b, c] = below;
            [a, b, c, a + 1, b + 1, c + 1]
        })
    }

    /// Its nodes.
    pub fn nodes(&self) -> std::ops::Range<u32> {
        self.first..self.first + 2 + 2 * self.corners
    }
}

/// A pad while it is made: where it lies and which edges leave it.
struct Plan {
    normal: Vector,
    axes: [Vector; 2],
    edges: Vec<usize>,
    ring: Ring,
}

impl Frame {
    /// The body of `abstracted`.
    pub fn new(graph: &SurfaceGraph, abstracted: &AbstractGraph, measure: &Measure) -> Frame {
        let centers: Vec<Vector> = abstracted
            .samples
            .iter()
            .map(|v| place(graph, *v, measure))
            .collect();
        let mut edges = vec![Vec::new(); centers.len()];
        for (e, edge) in abstracted.edges.iter().enumerate() {
            edge.ends
                .iter()
                .for_each(|end| edges[*end as usize].push(e));
        }
        let mut frame = Frame {
            points: Vec::new(),
            pads: Vec::new(),
            beams: Vec::new(),
        };
        let mut sides = vec![[[0; 2]; 2]; abstracted.edges.len()];
        for (u, edges) in edges.into_iter().enumerate() {
            let normal = normal(graph, abstracted.samples[u]);
            let plan = Plan::new(u, &centers, normal, edges, &abstracted.edges);
            let radius = plan.radius(u, &centers, &abstracted.edges, measure);
            let first = frame.points.len() as u32;
            for (&e, corners) in plan.edges.iter().zip(&plan.ring.sides) {
                let end = usize::from(abstracted.edges[e].ends[1] == u as u32);
                sides[e][end] = corners.map(|corner| first + 2 + 2 * corner as u32);
            }
            frame.raise(&plan, centers[u], radius, measure.thickness);
        }
        let beams = abstracted.edges.iter().zip(&sides);
        frame.beams = beams
            .map(|(edge, sides)| frame.beam(edge, sides, measure))
            .collect();
        frame
    }

    /// Adds the pad of a plan.
    fn raise(&mut self, plan: &Plan, center: Vector, radius: f64, thickness: f64) {
        self.pads.push(Pad {
            center,
            first: self.points.len() as u32,
            corners: plan.ring.corners.len() as u32,
        });
        let [e1, e2] = plan.axes;
        let corner = |a: &f64| center + (e1 * libm::cos(*a) + e2 * libm::sin(*a)) * radius;
        let half = plan.normal * (thickness / 2.0);
        for at in std::iter::once(center).chain(plan.ring.corners.iter().map(corner)) {
            self.points.extend([at - half, at + half]);
        }
    }

    /// The beam of an edge between the corners right and left of it, seen from either pad.
    fn beam(&self, edge: &AbstractEdge, sides: &[[u32; 2]; 2], measure: &Measure) -> Beam {
        let [[r, l], [r2, l2]] = *sides;
        let at = |node: u32| self.points[node as usize];
        let chord = ((at(r) - at(l)).norm() + (at(r2) - at(l2)).norm()) / 2.0;
        let width = width(edge, measure);
        Beam {
            pads: edge.ends,
            nodes: [r, l2, l, r2, r + 1, l2 + 1, l + 1, r2 + 1],
            factor: (width / chord).clamp(FACTOR[0], FACTOR[1]),
            area: chord * measure.thickness,
        }
    }
}

impl Plan {
    fn new(
        u: usize,
        centers: &[Vector],
        normal: Vector,
        edges: Vec<usize>,
        all: &[AbstractEdge],
    ) -> Plan {
        let axis = if normal.z.abs() < 0.9 {
            Vector::z()
        } else {
            Vector::x()
        };
        let e1 = normal.cross(&axis).normalize();
        let e2 = normal.cross(&e1);
        let angle = |e: &usize| {
            let way = centers[other_end(&all[*e], u)] - centers[u];
            let (x, y) = (way.dot(&e1), way.dot(&e2));
            // Straight above or below the pad there is no direction to tell; any will do.
            if x.abs() + y.abs() > 1e-6 * way.norm() {
                libm::atan2(y, x)
            } else {
                0.0
            }
        };
        let angles: Vec<f64> = edges.iter().map(angle).collect();
        Plan {
            normal,
            axes: [e1, e2],
            ring: ring(&angles),
            edges,
        }
    }

    /// Half the width of the pattern, as far as there is room. A beam on a pad that it has for itself is then
    /// as wide as the pattern, because its corners are 2π/3 apart.
    fn radius(&self, u: usize, centers: &[Vector], all: &[AbstractEdge], measure: &Measure) -> f64 {
        let edges = self.edges.iter().map(|e| &all[*e]);
        let widths = edges
            .clone()
            .filter(|edge| edge.is_solid)
            .map(|edge| width(edge, measure));
        let widest = widths.fold(0.0, f64::max);
        let wanted = if widest > 0.0 { widest } else { measure.bridge } / 3f64.sqrt();
        let distance = |edge: &AbstractEdge| (centers[other_end(edge, u)] - centers[u]).norm();
        let nearest = edges.map(distance).fold(f64::INFINITY, f64::min);
        if nearest.is_finite() {
            wanted.clamp(RADIUS[0] * nearest, RADIUS[1] * nearest)
        } else {
            wanted
        }
    }
}

/// The width of the pattern along an edge, or of the bridge that would be there, m.
fn width(edge: &AbstractEdge, measure: &Measure) -> f64 {
    if edge.is_solid {
        edge.width * measure.pitch
    } else {
        measure.bridge
    }
}

fn other_end(edge: &AbstractEdge, u: usize) -> usize {
    let [a, b] = edge.ends;
    (if a as usize == u { b } else { a }) as usize
}

/// The middle of a voxel in metres.
fn place(graph: &SurfaceGraph, v: u32, measure: &Measure) -> Vector {
    let scale = measure.pitch / graph.pitch();
    let Point3 { x, y, z } = graph.center(v);
    Vector::new(x, y, z) * scale
}

/// The normal of a voxel. One without a direction stands up, so that its pad has some plane to lie in.
fn normal(graph: &SurfaceGraph, v: u32) -> Vector {
    let normal = graph.surface.normals[v as usize].map(f64::from);
    Vector::from(normal)
        .try_normalize(1e-6)
        .unwrap_or_else(Vector::z)
}
