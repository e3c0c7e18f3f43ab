//! Curves cut by the outline of a mask: the planar map of both, in which every face is inside the
//! mask or outside, and the curves as pieces between cuts.

use fretwork_geometry::index::{BucketGrid, Squares};
use fretwork_geometry::planar_map::{EdgeId, FaceId, PlanarMap, PlanarMapError};
use fretwork_geometry::{Bounds, CurveLabels, Curves, LabelSet, Point, Region};

/// The planar map of curves and the outline that cuts them.
pub(crate) struct Overlay<'a> {
    /// The map; the cut curves come first in it.
    pub map: PlanarMap,
    curves: &'a Curves,
    resolution: f64,
    inside: Vec<bool>,
}

impl<'a> Overlay<'a> {
    /// Lays `outline`, closed curves, over `curves`. Inside is what a way from infinity reaches by
    /// crossing the outline an odd number of times.
    pub fn new(
        curves: &'a Curves,
        outline: &Curves,
        resolution: f64,
    ) -> Result<Overlay<'a>, PlanarMapError> {
        let mut all = curves.clone();
        for curve in outline.iter() {
            all.push(curve.points.iter().copied(), CurveLabels::default());
        }
        let map = PlanarMap::build(&all, resolution)?;
        let of_outline = |e: EdgeId| {
            let passes = map.passes(e).filter(|p| p.0 as usize >= curves.len());
            passes.map(|p| p.1).sum::<i32>() % 2 != 0
        };
        let mut inside: Vec<Option<bool>> = vec![None; map.face_count() + 1];
        inside[0] = Some(false);
        map.spread(&mut inside, |h, known| Some(*known != of_outline(h.edge)));
        let inside = inside
            .into_iter()
            .map(|side| side.unwrap_or(false))
            .collect();
        Ok(Overlay {
            map,
            curves,
            resolution,
            inside,
        })
    }

    /// Whether a face is inside the mask.
    pub fn is_inside(&self, f: FaceId) -> bool {
        self.inside[f.0 as usize]
    }

    /// Whether an edge is in the closed mask.
    pub fn touches_inside(&self, e: EdgeId) -> bool {
        self.is_inside(self.map.left(e)) || self.is_inside(self.map.right(e))
    }

    /// The number of the first curve along an edge, unless that is one of the outline.
    pub fn curve(&self, e: EdgeId) -> Option<usize> {
        self.map
            .sources(e)
            .map(|s| s.curve as usize)
            .next()
            .filter(|c| *c < self.curves.len())
    }

    /// Adds to `out` the parts of the curves that consist of edges to which `part` gives a value;
    /// `labels` turns the curve's labels and the value into those of the part. Parts are as long
    /// as one value lasts. Labels at the ends of a curve stay there.
    pub fn add_parts<T: PartialEq>(
        &self,
        part: impl Fn(usize, EdgeId) -> Option<T>,
        labels: impl Fn(CurveLabels, &T) -> CurveLabels,
        out: &mut Curves,
    ) {
        let mut edges: Vec<(usize, EdgeId)> = self
            .map
            .edges()
            .filter_map(|e| self.curve(e).map(|curve| (curve, e)))
            .collect();
        edges.sort_unstable();
        for of_curve in edges.chunk_by(|a, b| a.0 == b.0) {
            let curve = of_curve[0].0;
            let of_curve = self.in_order(curve, of_curve.iter().map(|(_, e)| *e).collect());
            let follows = |a: &EdgeId, b: &EdgeId| {
                self.map.target(*a) == self.map.source(*b) && part(curve, *a) == part(curve, *b)
            };
            for run in of_curve.chunk_by(follows) {
                if let Some(value) = part(curve, run[0]) {
                    self.add_run(curve, run, |l| labels(l, &value), out);
                }
            }
        }
    }

    /// The edges along a curve, as it runs through them.
    fn in_order(&self, curve: usize, mut edges: Vec<EdgeId>) -> Vec<EdgeId> {
        if edges.len() > 1 {
            let way = PolylineIndex::new(self.curves.get(curve).points, 4.0 * self.resolution);
            edges.sort_by_cached_key(|e| {
                let mut of_edge = self.map.points(*e);
                let (Some(a), Some(b)) = (of_edge.next(), of_edge.next()) else {
                    return (0, 0);
                };
                way.place(a, b)
            });
        }
        edges
    }

    fn add_run(
        &self,
        curve: usize,
        run: &[EdgeId],
        labels: impl Fn(CurveLabels) -> CurveLabels,
        out: &mut Curves,
    ) {
        let original = self.curves.get(curve);
        let near = |p: Option<&Point>, v| {
            p.is_some_and(|p| p.distance(self.map.location(v)) <= 2.0 * self.resolution)
        };
        let starts = near(original.points.first(), self.map.source(run[0]));
        let ends = near(original.points.last(), self.map.target(run[run.len() - 1]));
        let mut of_run = labels(original.labels);
        if !starts {
            of_run.start = LabelSet::EMPTY;
        }
        if !ends {
            of_run.end = LabelSet::EMPTY;
        }
        let is_closed = original.points.first() == original.points.last();
        let length = || run.iter().map(|e| self.map.edge_length(*e)).sum::<f64>();
        let of_curve = || {
            original
                .points
                .windows(2)
                .map(|w| w[0].distance(w[1]))
                .sum::<f64>()
        };
        if starts && ends && (!is_closed || (length() - of_curve()).abs() <= 4.0 * self.resolution)
        {
            out.push(original.points.iter().copied(), of_run);
            return;
        }
        let mut points: Vec<Point> = Vec::new();
        for e in run {
            points.extend(self.map.points(*e).skip(usize::from(!points.is_empty())));
        }
        out.push(points, of_run);
    }
}

/// A polyline of so many points is searched from end to end.
const FEW: usize = 16;

/// A polyline of which places are looked up.
struct PolylineIndex<'p> {
    points: &'p [Point],
    /// How far from it pieces of it may be.
    margin: f64,
    /// Its segments, where there are many.
    near: Option<BucketGrid>,
}

impl<'p> PolylineIndex<'p> {
    fn new(points: &'p [Point], margin: f64) -> PolylineIndex<'p> {
        if points.len() <= FEW {
            return PolylineIndex {
                points,
                margin,
                near: None,
            };
        }
        let bounds = Bounds::of(points.iter().copied());
        let mut near = BucketGrid::empty(Squares::over(
            &bounds,
            bounds.longer_side() / (1.0 + (points.len() as f64).sqrt()),
        ));
        for (n, ends) in (0..).zip(points.windows(2)) {
            near.insert(n, &Bounds::of(ends.iter().copied()));
        }
        PolylineIndex {
            points,
            margin,
            near: Some(near),
        }
    }

    /// Where a short piece from `a` to `b` lies that runs along it: the number of the segment and how far
    /// along it, in 2^-32 of its length.
    fn place(&self, a: Point, b: Point) -> (usize, u32) {
        let middle = a.lerp(b, 0.5);
        let along = |i: usize| {
            let (p, q) = (self.points[i], self.points[i + 1]);
            let length = (q - p).dot(q - p);
            let t = if length > 0.0 {
                ((middle - p).dot(q - p) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            // Of two segments on one line the one that runs as the piece does is meant.
            let is_backward = (q - p).dot(b - a) < 0.0;
            (is_backward, p.lerp(q, t).distance(middle), i, t)
        };
        let nearby = match &self.near {
            Some(near) => near.near(&Bounds::of([middle]).grown(self.margin)),
            None => (0..self.points.len() as u32 - 1).collect(),
        };
        let nearest = nearby
            .into_iter()
            .map(|i| along(i as usize))
            .min_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)));
        nearest.map_or((0, 0), |(_, _, i, t)| (i, (t * f64::from(u32::MAX)) as u32))
    }
}

/// The rings of a region's area as closed curves.
pub(crate) fn outline(region: &Region) -> Curves {
    let mut curves = Curves::new();
    for ring in region.area.iter().flat_map(|p| p.rings()) {
        curves.push(
            ring.iter().chain(ring.first()).copied(),
            CurveLabels::default(),
        );
    }
    curves
}
