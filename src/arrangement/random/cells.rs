//! Irregular partitions: a region cut by the Voronoi cells of random points (Loi 2015, section 3.3;
//! rules R8 and R9). The points are in `points`, the diagram of the plane in `voronoi`; here
//! it is cut by the border of a region, and labelled.
//!
//! Both are functions of the whole plane and the seed: two regions that overlap have the same
//! cells, bit by bit, where both show them whole. A density that is a field changes cells near
//! the places where it changes: at most a few times the distance of sites there.

use crate::border::Border;
use crate::error::ArrangementError;
use crate::limit::NEGLIGIBLE;
use crate::mask::overlay::{Overlay, outline};
use crate::mask::region_raster::{RegionRaster, Side};
use crate::near::locality::{common, reaching};
use crate::random::density::LocalDensity;
use crate::random::points;
use crate::random::points::{RADIUS, Site};
use crate::random::properties::IrregularProperties;
use crate::random::voronoi::{Diagram, Edge};
use crate::tiled::zone::near;
use fretwork_geometry::planar_map::{EdgeId, FaceId};
use fretwork_geometry::{Bounds, CurveLabels, Curves, LabelSet, Point, Region, Seed, Tile};

/// The Voronoi cells of a Poisson-disk set: random points whose distances are at least 0.8/√d, d
/// being the density, and the lesser of both where it varies.
///
/// Sides run from their end of lesser coordinates to the other. Labels are drawn for every vertex,
/// edge and face of the plane; those of faces and vertices are carried by the sides.
pub fn uniform(
    properties: &IrregularProperties,
    border: Border,
    region: &Region,
    seed: Seed,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    uniform_in(properties, border, (region, resolution), seed, None)
}

/// The same without curves that do not come into a room; all where there is none. Time grows with the cells in the room and,
/// where the border of the region comes into it, with that border.
///
/// # Errors
/// Those of [`uniform`].
pub(crate) fn uniform_in(
    properties: &IrregularProperties,
    border: Border,
    (region, resolution): (&Region, f64),
    seed: Seed,
    room: Option<&Bounds>,
) -> Result<Curves, ArrangementError> {
    if let Some(Tile { period, .. }) = region.tile() {
        let density = LocalDensity::new(&properties.density, region)?;
        let least = 2.0 * RADIUS / density.range().0.sqrt();
        let side = period.x.min(period.y);
        if side < least {
            return Err(ArrangementError::Tile { side, least });
        }
    }
    let process = Process {
        seed,
        sample: points::poisson_disk,
    };
    partition(properties, border, (region, resolution), &process, room)
}

/// The Voronoi cells of a Poisson process: independent random points. Otherwise like [`uniform`].
pub fn random(
    properties: &IrregularProperties,
    border: Border,
    region: &Region,
    seed: Seed,
    resolution: f64,
) -> Result<Curves, ArrangementError> {
    random_in(properties, border, (region, resolution), seed, None)
}

/// The same without curves that do not come into a room, as of [`uniform_in`].
///
/// # Errors
/// Those of [`random`].
pub(crate) fn random_in(
    properties: &IrregularProperties,
    border: Border,
    (region, resolution): (&Region, f64),
    seed: Seed,
    room: Option<&Bounds>,
) -> Result<Curves, ArrangementError> {
    let process = Process {
        seed,
        sample: points::poisson,
    };
    partition(properties, border, (region, resolution), &process, room)
}

/// A random point set of the plane.
struct Process {
    /// All that is random follows from it, the labels of cells too.
    seed: Seed,
    /// The sites in a window; see [`points`].
    sample: fn(&LocalDensity, &Bounds, Seed) -> Result<Vec<Site>, ArrangementError>,
}

fn partition(
    properties: &IrregularProperties,
    border: Border,
    (region, resolution): (&Region, f64),
    process: &Process,
    room: Option<&Bounds>,
) -> Result<Curves, ArrangementError> {
    let density = LocalDensity::new(&properties.density, region)?;
    let page = region.bounds();
    if page.is_empty() {
        return Ok(Curves::new());
    }
    if !(page.min.is_finite() && page.max.is_finite()) {
        return Err(ArrangementError::Region);
    }
    let spacing = 1.0 / density.range().0.sqrt();
    let window = match room {
        Some(room) => common(&page, &room.grown(AROUND * spacing)),
        None => page,
    };
    if window.is_empty() {
        return Ok(Curves::new());
    }
    let diagram = Diagram::around(&window, spacing, density.period(), |part| {
        (process.sample)(&density, part, process.seed.name("sites"))
    })?;
    // What lies inside of a part of the region lies inside of it.
    let part = room.map(|_| near(region, &window.grown(AROUND * spacing)));
    let raster = RegionRaster::new(
        part.as_ref().unwrap_or(region),
        (4 * diagram.edges.len()).clamp(256, 4_000_000),
        resolution,
    );
    let sides = sides(&diagram, &raster);
    let cells = RegionCells {
        diagram: &diagram,
        properties,
        seed: process.seed,
        region,
        window: room.map(|_| window),
        sides,
        resolution,
    };
    let curves = match border {
        Border::Crop => cells.cropped(false),
        Border::CropAddBoundary => cells.cropped(true),
        Border::KeepInside => cells.kept(|inside, whole| whole - inside <= NEGLIGIBLE * whole),
        Border::KeepOutside => cells.kept(|inside, whole| inside > NEGLIGIBLE * whole),
    }?;
    Ok(match room {
        Some(room) => reaching(&curves, room),
        None => curves,
    })
}

/// How far around a room cells are made, in mean widths of a cell: those that the border of the region cuts are kept or not
/// by all of them.
const AROUND: f64 = 4.0;

/// On which side of the region's border each cell is, as far as its box tells.
fn sides(diagram: &Diagram, raster: &RegionRaster) -> Vec<Side> {
    let mut bounds = vec![Bounds::EMPTY; diagram.sites.len()];
    for edge in &diagram.edges {
        for side in edge.sides {
            if let Some(of_side) = bounds.get_mut(side as usize) {
                let ends = edge.ends.map(|v| diagram.vertices[v as usize].position);
                *of_side = ends.into_iter().fold(*of_side, Bounds::with);
            }
        }
    }
    bounds.iter().map(|b| raster.side(b)).collect()
}

/// The cells of a diagram and the region that cuts them.
struct RegionCells<'a> {
    diagram: &'a Diagram,
    properties: &'a IrregularProperties,
    seed: Seed,
    region: &'a Region,
    /// Where the cells are made, if not everywhere.
    window: Option<Bounds>,
    sides: Vec<Side>,
    resolution: f64,
}

impl RegionCells<'_> {
    /// The sides cut at the border, with the contour on demand.
    fn cropped(&self, with_contour: bool) -> Result<Curves, ArrangementError> {
        let mut curves = Curves::new();
        let mut cut = Curves::new();
        let cut_edges = self.cut_edges();
        for edge in &cut_edges {
            cut.push(self.ends(edge), self.labels(edge, |_| true));
        }
        for edge in self.diagram.edges.iter().filter(|e| !self.is_cut(e)) {
            if edge
                .sides
                .iter()
                .any(|site| self.side(*site) == Side::Inside)
            {
                curves.push(self.ends(edge), self.labels(edge, |_| true));
            }
        }
        if with_contour && self.comes_near(&self.region.contour) {
            for curve in self.region.contour.iter() {
                let labels = CurveLabels {
                    left: LabelSet::EMPTY,
                    right: LabelSet::EMPTY,
                    ..curve.labels
                };
                cut.push(curve.points.iter().copied(), labels);
            }
        }
        if cut.is_empty() {
            return Ok(curves);
        }
        let overlay = Overlay::new(&cut, &outline(self.region), self.resolution)?;
        let sites = self.sites_of_faces(&overlay, &cut_edges);
        let part = |curve: usize, e: EdgeId| {
            if curve < cut_edges.len() {
                return overlay.touches_inside(e).then_some(None);
            }
            let site = sites[overlay.map.left(e).0 as usize];
            if site.is_some() {
                return Some(site);
            }
            let mut points = overlay.map.points(e);
            let middle = points.next().zip(points.next());
            let middle = middle.map(|(a, b)| a.lerp(b, 0.5));
            if let (Some(window), Some(middle)) = (self.window, middle)
                && !window.contains(middle)
            {
                return None;
            }
            Some(middle.and_then(|middle| self.diagram.nearest(middle)))
        };
        let labels = |labels: CurveLabels, site: &Option<u32>| match site {
            Some(site) => CurveLabels {
                left: self.face_label(*site),
                ..labels
            },
            None => labels,
        };
        overlay.add_parts(part, labels, &mut curves);
        Ok(curves)
    }

    /// The sides of the cells for which `keep(area inside, area)` holds.
    fn kept(&self, keep: impl Fn(f64, f64) -> bool) -> Result<Curves, ArrangementError> {
        let mut kept: Vec<bool> = self
            .sides
            .iter()
            .map(|side| *side == Side::Inside)
            .collect();
        for (site, [inside, whole]) in self.areas(&self.cut_edges())?.into_iter().enumerate() {
            if self.sides[site] == Side::Border {
                kept[site] = whole > 0.0 && keep(inside, whole);
            }
        }
        let is_kept = |site: u32| kept.get(site as usize) == Some(&true);
        let mut curves = Curves::new();
        for edge in self
            .diagram
            .edges
            .iter()
            .filter(|e| e.sides.iter().any(|s| is_kept(*s)))
        {
            curves.push(self.ends(edge), self.labels(edge, is_kept));
        }
        Ok(curves)
    }

    /// Whether some of the curves come to where cells are made.
    fn comes_near(&self, curves: &Curves) -> bool {
        let comes = |window: Bounds| {
            let mut segments = curves.iter().flat_map(|curve| curve.points.windows(2));
            segments.any(|ends| Bounds::of(ends.iter().copied()).intersects(&window))
        };
        self.window.is_none_or(comes)
    }

    /// The area inside the region, and the whole area, of the cells all of whose sides are given.
    fn areas(&self, edges: &[&Edge]) -> Result<Vec<[f64; 2]>, ArrangementError> {
        let mut cut = Curves::new();
        for edge in edges {
            cut.push(self.ends(edge), CurveLabels::default());
        }
        let overlay = Overlay::new(&cut, &outline(self.region), self.resolution)?;
        let sites = self.sites_of_faces(&overlay, edges);
        let mut areas = vec![[0.0; 2]; self.diagram.sites.len()];
        for face in overlay.map.bounded_faces() {
            if let Some(area) = sites[face.0 as usize].and_then(|site| areas.get_mut(site as usize))
            {
                let of_face = overlay.map.face_area(face);
                area[1] += of_face;
                area[0] += if overlay.is_inside(face) {
                    of_face
                } else {
                    0.0
                };
            }
        }
        Ok(areas)
    }

    /// The cell that each face of an overlay is a part of, where one of `edges`, its first curves,
    /// is on the way to tell.
    fn sites_of_faces(&self, overlay: &Overlay, edges: &[&Edge]) -> Vec<Option<u32>> {
        let map = &overlay.map;
        let mut sites: Vec<Option<u32>> = vec![None; map.face_count() + 1];
        let side_of = |e: EdgeId| overlay.curve(e).and_then(|c| edges.get(c));
        for e in map.edges() {
            if let Some(edge) = side_of(e) {
                for (face, site) in [map.left(e), map.right(e)].into_iter().zip(edge.sides) {
                    sites[face.0 as usize].get_or_insert(site);
                }
            }
        }
        sites[FaceId::UNBOUNDED.0 as usize] = None;
        map.spread(&mut sites, |h, site| {
            side_of(h.edge).is_none().then_some(*site)
        });
        sites
    }

    fn side(&self, site: u32) -> Side {
        self.sides
            .get(site as usize)
            .copied()
            .unwrap_or(Side::Outside)
    }

    /// Whether the border comes near to a cell beside `edge`.
    fn is_cut(&self, edge: &Edge) -> bool {
        edge.sides
            .iter()
            .any(|site| self.side(*site) == Side::Border)
    }

    /// All sides of the cells that the border comes near to.
    fn cut_edges(&self) -> Vec<&Edge> {
        self.diagram
            .edges
            .iter()
            .filter(|e| self.is_cut(e))
            .collect()
    }

    fn ends(&self, edge: &Edge) -> [Point; 2] {
        edge.ends
            .map(|v| self.diagram.vertices[v as usize].position)
    }

    /// The labels of a side, with those of the faces for which `shows` holds.
    fn labels(&self, edge: &Edge, shows: impl Fn(u32) -> bool) -> CurveLabels {
        let face = |site: u32| {
            if shows(site) {
                self.face_label(site)
            } else {
                LabelSet::EMPTY
            }
        };
        let vertex = |v: u32| {
            let sites = self.diagram.vertices[v as usize].sites;
            self.draw("vertex", &sites)
        };
        let mut of_edge = edge.sides;
        of_edge.sort_unstable();
        CurveLabels {
            edge: self.draw("edge", &of_edge),
            left: face(edge.sides[0]),
            right: face(edge.sides[1]),
            start: vertex(edge.ends[0]),
            end: vertex(edge.ends[1]),
        }
    }

    fn face_label(&self, site: u32) -> LabelSet {
        self.draw("face", &[site])
    }

    /// The label drawn for the cell of the plane that these sites determine.
    fn draw(&self, kind: &str, sites: &[u32]) -> LabelSet {
        let weighted = match kind {
            "vertex" => &self.properties.vertex_labels,
            "edge" => &self.properties.edge_labels,
            _ => &self.properties.face_labels,
        };
        if weighted.is_empty() {
            return LabelSet::EMPTY;
        }
        // The bits of a first value of each site stand for the site.
        let mut keys: Vec<u64> = sites
            .iter()
            .filter_map(|s| self.diagram.sites.get(*s as usize))
            .map(|site| site.key.unit(u64::MAX).to_bits())
            .collect();
        keys.sort_unstable();
        let seed = keys
            .iter()
            .fold(self.seed.name(kind), |seed, key| seed.number(*key as i64));
        weighted.draw(seed.unit(0))
    }
}

#[cfg(test)]
mod tests;
