//! Arrangements as values: functions from regions to curves (Loi 2015, section 3.1).

use std::fmt;
use std::sync::Arc;

use crate::near::locality::{Hull, Locality, reaching};
use crate::patch::Patch;
use crate::tiled::regularity::{Irregular, Regularity};
use crate::tiled::varied::Varied;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::planar_map::{FaceId, PlanarMap};
use fretwork_geometry::{Curves, Point, Polygon, Region, polygon};

/// What applying an arrangement gives.
pub type Applied = Result<Arc<Curves>, Vec<Diagnostic>>;

/// How an arrangement is applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Manner {
    /// To draw it.
    Free,
    /// To learn what is repeated in it: an error where something is asked that is not the same one period further.
    Regular(Patch),
}

/// A function from regions to curves. Pure: on the same region it gives the same curves. Cheap to
/// clone.
#[derive(Clone)]
pub struct Arrangement {
    function: Arc<Function>,
    lack: Option<Arc<Lack>>,
    regularity: Result<Regularity, Irregular>,
    /// The arrangements that it is the union of.
    parts: Option<Arc<[Arrangement]>>,
    /// The regular arrangement that it varies.
    varied: Option<Arc<Varied>>,
    /// The region whose outline it is.
    area: Option<Arc<Region>>,
    /// How it is drawn near a room.
    local: Option<Arc<Locality>>,
}

/// The curves on a region, of a resolution, in a manner.
type Function = dyn Fn(&Region, f64, Manner) -> Applied + Send + Sync;

/// Where a region is asked for a value that is not there.
type Lack = dyn Fn(&Region) -> Option<Point> + Send + Sync;

impl Arrangement {
    /// The arrangement that `function` computes from a region and a resolution, the distance below
    /// which points are one. Nothing is known of what is repeated in it.
    pub fn new(function: impl Fn(&Region, f64) -> Applied + Send + Sync + 'static) -> Arrangement {
        let unknown = Irregular::new("nothing is known of its structure");
        Arrangement::with(Err(unknown), move |region, resolution, _| {
            function(region, resolution)
        })
    }

    /// The same, of which it is known what is repeated in it, or why nothing is.
    pub(crate) fn with(
        regularity: Result<Regularity, Irregular>,
        function: impl Fn(&Region, f64, Manner) -> Applied + Send + Sync + 'static,
    ) -> Arrangement {
        Arrangement {
            function: Arc::new(function),
            lack: None,
            regularity,
            parts: None,
            varied: None,
            area: None,
            local: None,
        }
    }

    /// The outline of `area` for every region. Holes of the area, and gaps between its polygons, are no faces.
    pub fn outline(area: Arc<Region>) -> Arrangement {
        let contour = Arc::new(area.contour.clone());
        let fixed = Irregular::new("it takes a region, which lies in one place");
        Arrangement {
            area: Some(area),
            regularity: Err(fixed),
            ..Arrangement::given(contour)
        }
    }

    /// The region whose outline it is, if it is one.
    pub fn area(&self) -> Option<&Region> {
        self.area.as_deref()
    }

    /// The bounded faces of its planar map; those of the outline of a region which the region covers.
    pub fn covered(&self, map: &PlanarMap) -> Vec<FaceId> {
        self.covered_among(map, map.bounded_faces())
    }

    /// The same, of some of the faces.
    pub(crate) fn covered_among(
        &self,
        map: &PlanarMap,
        faces: impl Iterator<Item = FaceId>,
    ) -> Vec<FaceId> {
        let Some(area) = &self.area else {
            return faces.collect();
        };
        let extent = |polygon: &Polygon| Extent::from(polygon.bounds());
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

    /// The same arrangement, which is the union of `parts`.
    pub(crate) fn united(self, parts: Vec<Arrangement>) -> Arrangement {
        Arrangement {
            parts: Some(parts.into()),
            ..self
        }
    }

    /// The same arrangement, which varies a regular one.
    pub(crate) fn varying(self, varied: Varied) -> Arrangement {
        Arrangement {
            varied: Some(Arc::new(varied)),
            ..self
        }
    }

    /// The same arrangement, of which `local` tells how it is drawn near a room.
    pub(crate) fn local_by(self, local: Option<Locality>) -> Arrangement {
        Arrangement {
            local: local.map(Arc::new),
            ..self
        }
    }

    /// How it is drawn near a room, where that is known.
    pub(crate) fn local(&self) -> Option<&Locality> {
        self.local.as_deref()
    }

    /// The same arrangement with `change` made to what comes out where it is drawn.
    pub(crate) fn changed(
        self,
        change: impl Fn(Arc<Curves>, &Region) -> Arc<Curves> + Send + Sync + 'static,
    ) -> Arrangement {
        let function = self.function.clone();
        Arrangement {
            function: Arc::new(move |region, resolution, manner| {
                Ok(change(function(region, resolution, manner)?, region))
            }),
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
        let fixed = Irregular::new("it takes a drawing that lies in one place");
        let whole = curves.clone();
        let local = Locality {
            near: Box::new(move |_, _, room| Ok(Some(Arc::new(reaching(&whole, &room.bounds))))),
            extent: Some(Hull::fixed(curves.bounds())),
            cell: None,
            is_noded: false,
        };
        Arrangement::with(Err(fixed), move |_, _, _| Ok(curves.clone())).local_by(Some(local))
    }

    /// The curves for `region`. The resolution is that of the outermost region, also for faces.
    ///
    /// # Errors
    /// What the arrangement's own definition, its region or its scripts do wrong.
    pub fn apply(&self, region: &Region, resolution: f64) -> Applied {
        self.apply_as(region, resolution, Manner::Free)
    }

    /// The curves for `region` in a manner.
    ///
    /// # Errors
    /// Those of [`Arrangement::apply`], and where the manner does not allow for what is asked.
    pub(crate) fn apply_as(&self, region: &Region, resolution: f64, manner: Manner) -> Applied {
        (self.function)(region, resolution, manner)
    }

    /// What is known to be repeated in it on a region, as far as its definition tells.
    pub(crate) fn regularity(&self) -> Result<&Regularity, &Irregular> {
        self.regularity.as_ref()
    }

    /// Whether, drawn on a region that is moved, it moves along.
    pub(crate) fn goes_along(&self) -> bool {
        let regularity = self.regularity.as_ref();
        regularity.is_ok_and(|regularity| regularity.fixed.is_empty())
    }

    /// The arrangements that it is the union of, if it is one.
    pub(crate) fn parts(&self) -> Option<&[Arrangement]> {
        self.parts.as_deref()
    }

    /// What it varies, if it is a last random mapper.
    pub(crate) fn varied(&self) -> Option<&Varied> {
        self.varied.as_deref()
    }
}

impl fmt::Debug for Arrangement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Arrangement")
    }
}
