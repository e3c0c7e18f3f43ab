//! Arrangements as values: functions from regions to curves (Loi 2015, section 3.1).

use std::fmt;
use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::planar_map::{FaceId, PlanarMap};
use fretwork_geometry::{Curves, Point, Polygon, Region, polygon};

/// What applying an arrangement gives.
pub type Applied = Result<Arc<Curves>, Vec<Diagnostic>>;

/// A function from regions to curves. Pure: on the same region it gives the same curves. Cheap to
/// clone.
#[derive(Clone)]
pub struct Arrangement {
    function: Arc<dyn Fn(&Region, f64) -> Applied + Send + Sync>,
    lack: Option<Arc<Lack>>,
    /// The region whose outline it is.
    area: Option<Arc<Region>>,
}

/// Where a region is asked for a value that is not there.
type Lack = dyn Fn(&Region) -> Option<Point> + Send + Sync;

impl Arrangement {
    /// The arrangement that `function` computes from a region and a resolution, the distance below
    /// which points are one.
    pub fn new(function: impl Fn(&Region, f64) -> Applied + Send + Sync + 'static) -> Arrangement {
        Arrangement {
            function: Arc::new(function),
            lack: None,
            area: None,
        }
    }

    /// The outline of `area` for every region. Holes of the area, and gaps between its polygons, are no faces.
    pub fn outline(area: Arc<Region>) -> Arrangement {
        let contour = Arc::new(area.contour.clone());
        Arrangement {
            area: Some(area),
            ..Arrangement::given(contour)
        }
    }

    /// The region whose outline it is, if it is one.
    pub fn area(&self) -> Option<&Region> {
        self.area.as_deref()
    }

    /// The bounded faces of its planar map; those of the outline of a region which the region covers.
    pub fn covered(&self, map: &PlanarMap) -> Vec<FaceId> {
        let faces = map.bounded_faces();
        let Some(area) = &self.area else {
            return faces.collect();
        };
        let extent = |polygon: &Polygon| {
            let bounds = polygon.bounds();
            Extent {
                min: [bounds.min.x, bounds.min.y],
                max: [bounds.max.x, bounds.max.y],
            }
        };
        let tree = BoxTree::new(&area.area.iter().map(extent).collect::<Vec<_>>());
        let is_covered = |face: &FaceId| {
            let inside = polygon::inner_point(&polygon::of_face(map, *face));
            let near = tree.meeting(&Extent::from([inside.x, inside.y]));
            let mut near = near.into_iter().map(|number| &area.area[number as usize]);
            near.any(|polygon| polygon.contains(inside))
        };
        faces.filter(is_covered).collect()
    }

    /// The same arrangement, of which `lack` tells the place in a region where a field that it reads has no value, and so
    /// nothing is drawn.
    pub fn lacking(
        self,
        lack: impl Fn(&Region) -> Option<Point> + Send + Sync + 'static,
    ) -> Arrangement {
        Arrangement {
            lack: Some(Arc::new(lack)),
            ..self
        }
    }

    /// Whether it reads fields, of which some may have no value somewhere.
    pub fn may_lack(&self) -> bool {
        self.lack.is_some()
    }

    /// The place in `region` where a field has no value, if that is why nothing is drawn in it.
    pub fn lack(&self, region: &Region) -> Option<Point> {
        self.lack.as_ref().and_then(|lack| lack(region))
    }

    /// The arrangement that gives `curves` for every region: one that was applied before.
    pub fn given(curves: Arc<Curves>) -> Arrangement {
        Arrangement::new(move |_, _| Ok(curves.clone()))
    }

    /// The curves for `region`. The resolution is that of the outermost region, also for faces.
    ///
    /// # Errors
    /// What the arrangement's own definition, its region or its scripts do wrong.
    pub fn apply(&self, region: &Region, resolution: f64) -> Applied {
        (self.function)(region, resolution)
    }
}

impl fmt::Debug for Arrangement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Arrangement")
    }
}
