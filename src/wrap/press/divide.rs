//! Faces of the planar map made into triangles, and their corners found on the surface.

use std::collections::{BTreeMap, HashMap};

use rayon::prelude::*;

use fretwork_geometry::index::{BoxTree, Extent, KdTree};
use fretwork_geometry::mesh::triangulate;
use fretwork_geometry::{Bounds, FaceId, OnMesh, PlanarMap, Point, Polygon, polygon};

use super::trace::weights;
use crate::chart::{Chart, Flap};

/// The triangles of a chart after they were divided.
pub struct Divided {
    /// Where corners are on the surface.
    pub places: Vec<OnMesh>,
    /// Triangles, facing as the surface does.
    pub triangles: Vec<[u32; 3]>,
    /// The face of the map that each is a part of.
    pub faces: Vec<FaceId>,
    /// The number of the flap that each is a part of.
    pub flaps: Vec<u32>,
    /// The numbers of corners of the mesh, where they are corners here.
    corners: BTreeMap<u32, u32>,
}

fn key(p: Point) -> [u64; 2] {
    [p.x, p.y].map(f64::to_bits)
}

/// The points of the map that corners of the mesh have become: the nearest ones, for rounding moves corners, and another point
/// may be hardly farther from a corner than that.
fn corners_of_mesh(chart: &Chart, map: &PlanarMap) -> HashMap<[u64; 2], u32> {
    let mut points: Vec<[f64; 2]> = map
        .edges()
        .flat_map(|edge| map.points(edge))
        .map(Into::into)
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let tree = KdTree::new(points.clone());
    let mut corners: Vec<([u64; 2], u32)> = Vec::with_capacity(3 * chart.flaps.len());
    for flap in &chart.flaps {
        corners.extend(
            flap.plan
                .iter()
                .zip(flap.corners)
                .map(|(p, corner)| (key(*p), corner)),
        );
    }
    corners.sort_unstable();
    corners.dedup();
    let nearest = |(at, corner): &([u64; 2], u32)| {
        let point = points[tree.nearest(at.map(f64::from_bits))?];
        Some((key(point.into()), *corner))
    };
    corners.par_iter().filter_map(nearest).collect()
}

/// A face, divided by itself: its flap, and its triangles by their places in the plane.
type Parts = Option<(u32, Vec<[Point; 3]>)>;

/// The faces of `map` that lie on triangles of the chart, in triangles.
pub fn divide(chart: &Chart, map: &PlanarMap, resolution: f64) -> Divided {
    let boxes: Vec<Extent<2>> = chart
        .flaps
        .iter()
        .map(|flap| Bounds::of(flap.plan).into())
        .collect();
    let tree = BoxTree::new(&boxes);
    let faces: Vec<FaceId> = map.bounded_faces().collect();
    let parts = |face: &FaceId| -> Parts {
        let triangles: Vec<[Point; 3]> = polygon::of_face(map, *face)
            .iter()
            .flat_map(in_triangles)
            .collect();
        let area = |t: &&[Point; 3]| (t[1] - t[0]).cross(t[2] - t[0]);
        let largest = triangles
            .iter()
            .max_by(|a, b| area(a).total_cmp(&area(b)))?;
        let middle = (largest[0] + largest[1] + largest[2]) * (1.0 / 3.0);
        Some((flap_at(chart, &tree, middle)?, triangles))
    };
    let found: Vec<Parts> = faces.par_iter().map(parts).collect();
    let mut divided = Divided {
        places: Vec::new(),
        triangles: Vec::new(),
        faces: Vec::new(),
        flaps: Vec::new(),
        corners: BTreeMap::new(),
    };
    let at_corners = corners_of_mesh(chart, map);
    let mut known: HashMap<[u64; 2], u32> = HashMap::new();
    for (face, parts) in faces.iter().zip(found) {
        let Some((flap, triangles)) = parts else {
            continue;
        };
        for triangle in triangles {
            let corners = triangle.map(|p| {
                let key = key(p);
                *known
                    .entry(key)
                    .or_insert_with(|| match at_corners.get(&key) {
                        Some(corner) => divided.of_mesh(*corner),
                        None => divided.place(on_mesh(&chart.flaps[flap as usize], p, resolution)),
                    })
            });
            divided.triangles.push(corners);
            divided.faces.push(*face);
            divided.flaps.push(flap);
        }
    }
    divided
}

/// The triangle of a chart that a place in the plane of counting lies on.
fn flap_at(chart: &Chart, tree: &BoxTree<2>, p: Point) -> Option<u32> {
    let met = tree.meeting(&Bounds::of([p]).into());
    met.into_iter().find(|number| {
        let flap = &chart.flaps[*number as usize];
        weights(flap.plan, p).iter().all(|weight| *weight >= 0.0)
    })
}

/// A polygon in triangles. One that cannot be divided is none of a planar map.
fn in_triangles(polygon: &Polygon) -> Vec<[Point; 3]> {
    if let ([a, b, c], []) = (&polygon.outer[..], &polygon.holes[..]) {
        return vec![[*a, *b, *c]];
    }
    let corners: Vec<Point> = polygon.rings().flatten().copied().collect();
    let triangles = triangulate(polygon).unwrap_or_default();
    let places = |t: &[u32; 3]| t.map(|corner| corners[corner as usize]);
    triangles.iter().map(places).collect()
}

impl Divided {
    /// The number of a new corner.
    fn place(&mut self, place: OnMesh) -> u32 {
        self.places.push(place);
        (self.places.len() - 1) as u32
    }

    /// The number of a corner of the mesh, which is one however often it stands in the plane.
    fn of_mesh(&mut self, corner: u32) -> u32 {
        *self.corners.entry(corner).or_insert_with(|| {
            self.places.push(OnMesh::corner(corner));
            (self.places.len() - 1) as u32
        })
    }

    /// Adds triangles of the mesh as they are.
    pub fn append(&mut self, triangles: impl Iterator<Item = [u32; 3]>) {
        for triangle in triangles {
            let corners = triangle.map(|corner| self.of_mesh(corner));
            self.triangles.push(corners);
        }
    }
}

/// A place of the plane of counting on the mesh. What is within the resolution of a side lies on it.
fn on_mesh(flap: &Flap, p: Point, resolution: f64) -> OnMesh {
    let [a, b, c] = flap.plan;
    let whole = (b - a).cross(c - a).abs();
    let mut weights = weights(flap.plan, p);
    for (i, side) in [c - b, a - c, b - a].into_iter().enumerate() {
        let distance = weights[i] * whole / side.length();
        if distance < resolution {
            weights[i] = 0.0;
        }
    }
    let sum: f64 = weights.iter().sum();
    let weights = weights.map(|weight| weight / sum);
    OnMesh {
        of: flap.corners,
        weights,
    }
}
