//! What a sheet is drawn on: its plane, its unit, the region and the window that it shows.

use std::sync::Arc;

use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::{Sheet, Window};
use fretwork_geometry::{Affine, Bounds, Curve, Curves, PlanarMap, Point, Region, planar_map};
use fretwork_language::kinds::artifacts::{Artifact, Format, Role};

/// How far beyond a window lines are looked at, in units of which a file has ten thousand steps: where they lie is known once
/// they are rounded to these steps, and then one that lay beside the window may lie on its side.
pub const SLACK: f64 = 2e-4;

/// What all parts of a sheet share.
pub struct Page<'a> {
    /// The fields of the artifact.
    pub artifact: &'a Artifact,
    /// The region that it shows, if it names one.
    pub region: Option<Arc<Region>>,
    /// Units of the file per unit of the spec: millimetres, or what the plane of a map is measured in.
    pub unit_mm: f64,
    /// Millimetres in a unit of the file.
    pub width_mm: f64,
    /// Millimetres of paper per millimetre of the object.
    pub scale: f64,
    /// The format of the file: SVG, DXF, GeoJSON or a picture.
    pub format: Format,
    /// The plane, where it is that of a map.
    pub plane: Option<MapPlane>,
    /// The part of the plane that is shown, if it is not the whole.
    pub window: Option<Bounds>,
    /// Whether what is drawn is made ready as a whole, and other windows are cut of it too. Only where
    /// [`Page::may_be_shared`] says so.
    pub is_shared: bool,
}

/// How the plane of a map, whose y goes north, is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPlane {
    /// Whether the page begins at the corner of the paper.
    pub is_paper: bool,
}

impl Page<'_> {
    /// From the plane of the spec to that of the sheet, whose y goes down unless the file is a map itself.
    pub(crate) fn turn(&self) -> Affine {
        if self.plane.is_none() || self.format == Format::GeoJson {
            return Affine::IDENTITY;
        }
        let mirror = Affine::scale(1.0, -1.0);
        let corner = self.shown().filter(|_| self.is_paper());
        corner.map_or(mirror, |shown| {
            mirror.then(Affine::translation(Point::new(-shown.min.x, shown.max.y)))
        })
    }

    fn is_paper(&self) -> bool {
        self.plane.is_some_and(|plane| plane.is_paper)
    }

    /// The page in the plane of the spec, if it is known.
    fn shown(&self) -> Option<Bounds> {
        let region = self.region.as_ref().map(|region| region.bounds());
        self.window.or(region)
    }

    /// The planar map of curves, with the resolution of the region that is shown.
    pub(crate) fn planar_map(&self, curves: &Curves) -> Result<PlanarMap, Diagnostic> {
        PlanarMap::build(curves, self.resolution(curves.bounds()))
            .map_err(|e| Diagnostic::error(e.to_string()))
    }

    /// The distance below which points are one, where what is drawn has the box `drawn`.
    pub(crate) fn resolution(&self, drawn: Bounds) -> f64 {
        if self.plane.is_some() {
            return planar_map::MAP_RESOLUTION;
        }
        let region = self.region.as_ref().map(|region| region.bounds());
        planar_map::resolution(region.unwrap_or(drawn).longer_side())
    }

    /// Whether windows that are cut of the whole of parts with these roles are those that are cut of what is near each of them: lines are
    /// not chained, and none is put in order by others around it, moved for a beam, or placed by a corner of the window.
    pub fn may_be_shared(&self, mut roles: impl Iterator<Item = Role>) -> bool {
        let artifact = self.artifact;
        let is_plain = !artifact.optimize && artifact.kerf.0 == 0.0 && !self.is_paper();
        let is_drawn = roles.all(|role| role == Role::Draw);
        is_plain && is_drawn && self.region.is_some() && self.window.is_some()
    }

    /// What of a sheet can be seen in the window, if a part of the plane is shown. Where a beam's width is made up for,
    /// what is in the window depends on what is around it.
    pub(crate) fn seen(&self, sheet: Sheet) -> Sheet {
        match self.window_on(&sheet) {
            Some(window) if self.artifact.kerf.0 == 0.0 && !self.is_shared => {
                let slack = SLACK / sheet.unit_mm;
                sheet.near(&window.bounds.grown(slack))
            }
            _ => sheet,
        }
    }

    /// The curves in their place on the ground: those that can be seen in the window, where a part of a region is shown.
    /// The first stays, so that a window with nothing in it is told from nothing to draw.
    pub(crate) fn near(&self, curves: &Curves, map: &Affine) -> Curves {
        let is_cut = self.region.is_some() && !self.is_shared;
        let Some(window) = self.window.filter(|_| is_cut) else {
            return curves.transformed(map);
        };
        let window = window.grown(SLACK);
        let is_near = |curve: Curve<'_>| {
            let points = curve.points.iter().map(|p| map.apply(*p));
            Bounds::of(points).intersects(&window)
        };
        curves
            .filtered(|i, curve| i == 0 || is_near(curve))
            .transformed(map)
    }

    /// The window on the sheet, if a part of the plane is shown. Sides beyond which there is nothing
    /// of the region are closed, and the window beyond is open there.
    pub(crate) fn window_on(&self, sheet: &Sheet) -> Option<Window> {
        let window = self.window?;
        let region = self.region.as_ref().map(|region| region.bounds());
        let turn = self.turn();
        let turned = |b: Bounds| Bounds::of([turn.apply(b.min), turn.apply(b.max)]);
        let whole = region.map_or_else(|| sheet.content(), turned);
        let bounds = turned(window);
        let is_mirrored = turn.determinant() < 0.0;
        let (is_far, is_beyond) = if is_mirrored {
            (bounds.min.y <= whole.min.y, bounds.max.y == whole.min.y)
        } else {
            (bounds.max.y >= whole.max.y, bounds.min.y == whole.max.y)
        };
        Some(Window {
            bounds,
            closed: [bounds.max.x >= whole.max.x, is_far],
            open: [bounds.min.x == whole.max.x, is_beyond],
            is_mirrored,
        })
    }
}
