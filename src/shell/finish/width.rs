//! How wide the narrowest feature of a pattern is, measured where its wall ends: at the pattern's smooth border, not at
//! its voxels.
//!
//! The border is sampled. What lies across from a sample is the nearest one straight ahead of it, into the pattern, that faces
//! it: a place where the sides of a feature are as near to one another as anywhere has them parallel. Sides that lean from
//! one another, as those of a corner do, do not face one another.

use std::sync::atomic::{AtomicU64, Ordering};

use fretwork_geometry::budget::Meter;
use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::mesh::doubled_normal;
use fretwork_geometry::mesh::nearest::Nearest;
use fretwork_geometry::{Mesh, Point3, budget};
use rayon::prelude::*;

use super::coverage::Coverage;
use super::rim::border;
use super::thin::{Thin, leaf};
use crate::connect::SurfaceGraph;

/// How far apart samples of the border of a surface are, in pitches, and how far from that of a voxel on the border of the pattern
/// are two more of it: the border bends from one voxel to the next.
const SAMPLE: f64 = 0.25;
const BESIDE: f64 = 0.3;
/// Steps of Newton's method from the middle of a voxel to the border, and how near counts as there, in pitches.
const STEPS: usize = 6;
const NEAR: f64 = 0.005;
/// How far a sample may be from the middle of its voxel, in pitches: farther away there are nearer voxels.
const FAR: f64 = 1.5;
/// The cosine of the angle between the ways into the pattern from two places of its border, from which on they face one another: 162
/// degrees.
const FACING: f64 = -0.95;
/// The cosine of the angle between the way to a place and the way into the pattern, from which on it is straight ahead.
const AHEAD: f64 = 0.9;
/// How much of its width, or of two pitches, a feature is deep in its middle, at least; but for ripples of a border it is half of
/// it. A single row of voxels is a quarter.
const RIPPLE: f64 = 0.15;
/// How steep the border of a pattern is, at least, where its direction can be told. It is 1 where it is straight.
const STEEP: f64 = 0.3;
/// Steps of the budget for a sample.
const BUDGET: u64 = 400;

/// A place of the border of a pattern, and the unit vector along the surface into the pattern.
#[derive(Clone, Copy)]
struct Sample {
    at: Point3,
    inward: Point3,
    /// Whether the surface ends there.
    is_rim: bool,
}

/// A place of a pattern that is narrow.
#[derive(Clone, Copy, Debug)]
pub struct Narrow {
    /// How wide it is there, as a length.
    pub width: f64,
    /// The middle of it, on the surface; where the surface ends beside it, what would be its middle if it were as wide as asked.
    pub middle: Point3,
    /// The normal of the surface there.
    pub normal: Point3,
}

/// The places at which a feature of the pattern is narrower than `most`, in the order of the border's samples. Ends that
/// are short beside the `width` that was asked for are passed over, as they are not widened. O(n log n).
///
/// On strips of known width a width is right to a fifth of a pitch, mostly to a twentieth; where a surface bends by a radius R it is that of the chord, shorter than
/// a width w by w³ / 24 R².
pub fn narrow(
    (mesh, graph): (&Mesh, &SurfaceGraph),
    (solid, rim): (&[bool], &[bool]),
    (width, most): (f64, f64),
) -> Vec<Narrow> {
    let field = Field::new((mesh, graph), (solid, rim), width);
    let of = |sample: &Sample| field.narrow(sample, field.across(sample, most)?, width);
    field.samples.par_iter().filter_map(of).collect()
}

/// The least width of a feature of the pattern, as [`narrow`] has it, and the middle of the first feature that has it: `most` and
/// nowhere where none is narrower.
pub fn least_width(
    of: (&Mesh, &SurfaceGraph),
    pattern: (&[bool], &[bool]),
    (width, most): (f64, f64),
) -> (f64, Option<Point3>) {
    let field = Field::new(of, pattern, width);
    // Of lengths the greater has the greater bits. Whichever thread is first, the least is the same.
    let least = AtomicU64::new(most.to_bits());
    field.samples.par_iter().for_each(|sample| {
        let most = f64::from_bits(least.load(Ordering::Relaxed));
        let place = field.across(sample, most);
        if let Some(place) = place.and_then(|found| field.narrow(sample, found, width)) {
            least.fetch_min(place.width.to_bits(), Ordering::Relaxed);
        }
    });
    let least = f64::from_bits(least.into_inner());
    if least >= most {
        return (most, None);
    }
    let of = |sample: &Sample| field.narrow(sample, field.across(sample, least.next_up())?, width);
    let first = field.samples.par_iter().find_map_first(of);
    (least, first.map(|place| place.middle))
}

/// The border of a pattern, to be searched.
struct Field<'a> {
    mesh: &'a Mesh,
    graph: &'a SurfaceGraph<'a>,
    nearest: Nearest<'a>,
    coverage: Coverage<'a>,
    samples: Vec<Sample>,
    tree: BoxTree<3>,
    thin: Thin,
}

impl<'a> Field<'a> {
    fn new(
        (mesh, graph): (&'a Mesh, &'a SurfaceGraph<'a>),
        (solid, rim): (&'a [bool], &[bool]),
        width: f64,
    ) -> Field<'a> {
        let (nearest, coverage) = (Nearest::new(mesh), Coverage::new(graph.surface, solid));
        let pitches = width / graph.pitch();
        let meter = Meter::current();
        let thin = || meter.during(|| Thin::of(graph, (solid, rim), pitches / 2.0, leaf(pitches)));
        let sampled = || samples((mesh, graph), &nearest, &coverage, solid);
        let (samples, thin) = rayon::join(sampled, thin);
        budget::spend("places of a border", BUDGET * samples.len() as u64);
        let extent = |sample: &Sample| Extent::from([sample.at.x, sample.at.y, sample.at.z]);
        let tree = BoxTree::of(samples.iter().map(extent).collect());
        Field {
            mesh,
            graph,
            nearest,
            coverage,
            tree,
            samples,
            thin,
        }
    }

    /// The way from a sample to what lies across from it, nearer than `most`.
    fn across(&self, sample: &Sample, most: f64) -> Option<Point3> {
        let here = Extent::from([sample.at.x, sample.at.y, sample.at.z]);
        let bound = |extent: &Extent<3>, _| Some(extent.distance(&here));
        let (mut reach, mut found) = (most, None);
        self.tree.nearest_first(bound, most, |number| {
            let other = &self.samples[number as usize];
            let way = other.at - sample.at;
            let length = way.length();
            if length < reach
                && way.dot(sample.inward) >= AHEAD * length
                && other.inward.dot(sample.inward) <= FACING
            {
                (reach, found) = (length, Some(way));
            }
            reach
        });
        found
    }

    /// The narrow place between a sample and what lies so far across from it; nothing where it is an end that is passed over.
    fn narrow(&self, sample: &Sample, way: Point3, asked: f64) -> Option<Narrow> {
        let width = way.length();
        // Where the surface ends there is room on one side alone.
        let middle = match sample.is_rim && width < asked {
            true => sample.at + sample.inward * (asked / 2.0),
            false => sample.at + way * 0.5,
        };
        let foot = self.nearest.foot(middle)?;
        let corners = self
            .mesh
            .corners(self.mesh.triangles[foot.triangle as usize]);
        let voxels = &self.graph.surface.voxels;
        let place = voxels.lattice.place(foot.at).map(|c| c.max(0.0) as u16);
        let is_leaf = voxels
            .find(place)
            .is_some_and(|v| self.thin.is_leaf(v as u32));
        let normal = doubled_normal(corners).unit()?;
        let half_way = self
            .nearest
            .foot_from(sample.at + way * 0.5, foot.triangle)?;
        let (depth, _) = self.coverage.outside(half_way.at, normal);
        // Where the border is a ripple of what is hardly covered, or hardly not, there is no feature.
        let is_ripple = depth > -RIPPLE * width.min(2.0 * self.graph.pitch());
        (!is_leaf && !is_ripple).then_some(Narrow {
            width,
            middle: foot.at,
            normal,
        })
    }
}

/// Places of the border of the pattern, and of the surface where the pattern reaches it.
fn samples(
    (mesh, graph): (&Mesh, &SurfaceGraph),
    nearest: &Nearest,
    coverage: &Coverage,
    solid: &[bool],
) -> Vec<Sample> {
    let pitch = graph.pitch();
    let of_voxel = |v: u32| -> Vec<Sample> {
        let mut beside = graph.neighbours(v).iter();
        if beside.all(|w| solid[*w as usize] == solid[v as usize]) {
            return Vec::new();
        }
        let settle = |at: Point3| settled((mesh, nearest), coverage, at, pitch);
        let Some(middle) = settle(graph.center(v)) else {
            return Vec::new();
        };
        let normal = Point3::from(graph.surface.normals[v as usize].map(f64::from));
        let along = normal.cross(middle.inward) * (BESIDE * pitch);
        let others = [along, along * -1.0].map(|by| settle(middle.at + by));
        [Some(middle)].into_iter().chain(others).flatten().collect()
    };
    let voxels = (0..graph.len() as u32).into_par_iter();
    let mut samples: Vec<Sample> = voxels.flat_map_iter(of_voxel).collect();
    let ends = border(mesh, SAMPLE * pitch).into_iter();
    let covered = ends.filter(|end| coverage.outside(end.at, end.normal).0 < 0.0);
    samples.extend(covered.map(|end| Sample {
        at: end.at,
        inward: end.inward,
        is_rim: true,
    }));
    samples
}

/// The place of the border of the pattern that is near to a place.
fn settled(
    (mesh, nearest): (&Mesh, &Nearest),
    coverage: &Coverage,
    from: Point3,
    pitch: f64,
) -> Option<Sample> {
    let mut foot = nearest.foot(from)?;
    for _ in 0..STEPS {
        let corners = mesh.corners(mesh.triangles[foot.triangle as usize]);
        let flat = doubled_normal(corners).unit()?;
        let (value, slope) = coverage.outside(foot.at, flat);
        let slope = slope - flat * slope.dot(flat);
        let inward = (slope * -1.0).unit().filter(|_| slope.length() > STEEP)?;
        if value.abs() <= NEAR * pitch {
            let at = foot.at;
            return (at.distance(from) <= FAR * pitch).then_some(Sample {
                at,
                inward,
                is_rim: false,
            });
        }
        if !value.is_finite() {
            return None;
        }
        foot = nearest.foot_from(foot.at + inward * (value / slope.length()), foot.triangle)?;
    }
    None
}
