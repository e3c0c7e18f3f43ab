//! The Voronoi diagram of a point set of the whole plane, as far as a window needs it. How regions
//! cut it is in `irregular`.

use spade::handles::{DirectedEdgeHandle, FaceHandle, InnerTag};
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use crate::error::ArrangementError;
use crate::random::points::Site;
use fretwork_geometry::{Bounds, Point};

/// The cells that meet a window, and their sides. All coordinates are functions of the sites
/// alone, bit by bit the same in every window.
#[derive(Debug, Default)]
pub(crate) struct Diagram {
    /// The sites by position, with those around the window that were looked at.
    pub sites: Vec<Site>,
    /// The corners of cells.
    pub vertices: Vec<Vertex>,
    /// The sides of the cells that meet the window, ordered by their sites.
    pub edges: Vec<Edge>,
}

/// A corner of three cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Vertex {
    /// Where it is.
    pub position: Point,
    /// The numbers of the three sites, ascending.
    pub sites: [u32; 3],
}

/// The side between two cells, directed from the end of lesser coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Edge {
    /// The numbers of the vertices where it begins and ends.
    pub ends: [u32; 2],
    /// The numbers of the sites on its left and on its right.
    pub sides: [u32; 2],
}

/// A site or, with a number beyond the sites, a far point that bounds the outermost cells.
struct Numbered {
    position: Point,
    number: u32,
}

impl HasPosition for Numbered {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        Point2::new(self.position.x, self.position.y)
    }
}

type Delaunay = DelaunayTriangulation<Numbered>;
type Triangle<'a> = FaceHandle<'a, InnerTag, Numbered, (), (), ()>;

impl Diagram {
    /// The cells that meet `window` of the point set that `sample` shows parts of; `spacing` is the
    /// distance between sites, roughly.
    ///
    /// The sample is taken with a margin that grows until the circle around every corner of the
    /// cells, on which its sites lie, is inside the sample: then no site outside can change them.
    /// A point set without a site, as that of a small tile may be, gives a diagram without edges.
    pub fn around(
        window: &Bounds,
        spacing: f64,
        period: Option<Point>,
        sample: impl Fn(&Bounds) -> Result<Vec<Site>, ArrangementError>,
    ) -> Result<Diagram, ArrangementError> {
        let mut margin = 2.0 * spacing;
        for _ in 0..12 {
            let seen = window.grown(margin);
            let sites = sample(&seen)?;
            if sites.is_empty()
                && period.is_some_and(|p| p.x <= seen.width() && p.y <= seen.height())
            {
                return Ok(Diagram::default());
            }
            let delaunay = triangulate(&sites, &seen)?;
            if let Some(diagram) = Diagram::certain(window, &seen, sites, &delaunay) {
                return Ok(diagram);
            }
            margin *= 2.0;
        }
        Err(ArrangementError::Region)
    }

    /// The diagram, when no site beyond `seen` can have a part in it.
    fn certain(
        window: &Bounds,
        seen: &Bounds,
        sites: Vec<Site>,
        delaunay: &Delaunay,
    ) -> Option<Diagram> {
        let circles: Vec<(Point, f64)> = delaunay.inner_faces().map(circumcircle).collect();
        let is_safe = |f: Triangle| {
            let (center, radius) = circles[f.index() - 1];
            seen.grown(-radius * (1.0 + 1e-9)).contains(center)
        };
        let mut needed = vec![false; sites.len()];
        for vertex in delaunay.vertices() {
            let number = vertex.data().number as usize;
            let around = || vertex.out_edges();
            let corners = || around().filter_map(|e| e.face().as_inner());
            let bounds = Bounds::of(corners().map(|f| circles[f.index() - 1].0));
            if number < sites.len() && around().any(|e| e.is_outer_edge()) {
                return None;
            }
            if bounds.intersects(window) && !around().any(|e| beats(e, window)) {
                if number >= sites.len() || !corners().all(is_safe) {
                    return None;
                }
                needed[number] = true;
            }
        }
        Some(Diagram::collect(sites, delaunay, &circles, &needed))
    }

    fn collect(
        sites: Vec<Site>,
        delaunay: &Delaunay,
        circles: &[(Point, f64)],
        needed: &[bool],
    ) -> Diagram {
        let mut numbers = vec![u32::MAX; circles.len()];
        let mut diagram = Diagram {
            sites,
            ..Diagram::default()
        };
        let mut edges: Vec<_> = delaunay
            .directed_edges()
            .filter(|e| number(e, 0) < number(e, 1))
            .collect();
        edges.retain(|e| {
            [number(e, 0), number(e, 1)]
                .iter()
                .any(|n| needed.get(*n as usize) == Some(&true))
        });
        edges.sort_by_key(|e| (number(e, 0), number(e, 1)));
        for e in edges {
            // The cell of the site where e begins is on the left of the way from the circle on its
            // right to the one on its left.
            let (Some(right), Some(left)) = (e.rev().face().as_inner(), e.face().as_inner()) else {
                continue;
            };
            let ends = [right, left].map(|f| {
                let n = &mut numbers[f.index() - 1];
                if *n == u32::MAX {
                    *n = diagram.vertices.len() as u32;
                    let mut sites = f.vertices().map(|v| v.data().number);
                    sites.sort_unstable();
                    diagram.vertices.push(Vertex {
                        position: circles[f.index() - 1].0,
                        sites,
                    });
                }
                *n
            });
            let [a, b] = ends.map(|v| diagram.vertices[v as usize].position);
            let sides = [number(&e, 0), number(&e, 1)];
            diagram.edges.push(if (a.x, a.y) <= (b.x, b.y) {
                Edge { ends, sides }
            } else {
                Edge {
                    ends: [ends[1], ends[0]],
                    sides: [sides[1], sides[0]],
                }
            });
        }
        diagram
    }

    /// The number of the site nearest to `p`.
    pub fn nearest(&self, p: Point) -> Option<u32> {
        let distance = |i: &u32| self.sites[*i as usize].position.distance(p);
        (0..self.sites.len() as u32).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

/// The Delaunay triangulation of the sites and four points far outside.
fn triangulate(sites: &[Site], seen: &Bounds) -> Result<Delaunay, ArrangementError> {
    let far = 64.0 * (seen.width() + seen.height());
    let corners = [[-far, -far], [far, -far], [far, far], [-far, far]]
        .map(|c| seen.center() + Point::from(c));
    let points = sites.iter().map(|s| s.position).chain(corners);
    let numbered = points
        .zip(0..)
        .map(|(position, number)| Numbered { position, number })
        .collect();
    Delaunay::bulk_load_stable(numbered).map_err(|_| ArrangementError::Region)
}

/// Whether all of `window` is nearer to the site where `e` ends than to the one where it begins.
fn beats(e: DirectedEdgeHandle<'_, Numbered, (), (), ()>, window: &Bounds) -> bool {
    let (from, to) = (e.from().data().position, e.to().data().position);
    let corner = |x, y| Point::new(x, y);
    let (min, max) = (window.min, window.max);
    let corners = [min, corner(max.x, min.y), max, corner(min.x, max.y)];
    corners
        .iter()
        .all(|c| (to - *c).dot(to - *c) * (1.0 + 1e-9) < (from - *c).dot(from - *c))
}

fn number(e: &DirectedEdgeHandle<'_, Numbered, (), (), ()>, end: usize) -> u32 {
    if end == 0 {
        e.from().data().number
    } else {
        e.to().data().number
    }
}

/// Centre and radius of the circle through the corners, computed from them in their order by
/// number, whichever way the triangle is turned.
fn circumcircle(triangle: Triangle) -> (Point, f64) {
    let mut corners = triangle
        .vertices()
        .map(|v| (v.data().number, v.data().position));
    corners.sort_by_key(|c| c.0);
    let [a, b, c] = corners.map(|c| c.1);
    let (b, c) = (b - a, c - a);
    let (bb, cc, d) = (b.dot(b), c.dot(c), 2.0 * b.cross(c));
    let to_center = Point::new((c.y * bb - b.y * cc) / d, (b.x * cc - c.x * bb) / d);
    (a + to_center, to_center.length())
}
