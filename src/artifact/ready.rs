//! What an artifact shows, made ready for a machine or a map, before a window is cut of it. Several windows of one page are
//! cut of the same.

use super::page::Page;
use fretwork_diagnostic::Diagnostic;
use fretwork_fabricate::{Preparation, Sheet, prepare};
use fretwork_geometry::{Bounds, Point, Polygon};

/// A sheet that was made ready, and warnings about it.
pub struct Ready {
    sheet: Sheet,
    warnings: Vec<Diagnostic>,
    /// The boxes of all items by their layers, where several windows are cut of the sheet.
    boxes: Vec<Vec<Bounds>>,
}

impl Ready {
    /// What is seen of `sheet` on `page`, clipped to `area` and without what is there twice.
    ///
    /// # Errors
    /// What cannot be made ready.
    pub(crate) fn new(
        sheet: Sheet,
        page: &Page<'_>,
        area: Option<&[Polygon]>,
        is_outlined: bool,
    ) -> Result<Ready, Diagnostic> {
        let preparation = Preparation {
            region: area,
            kerf_mm: page.artifact.kerf.0 / page.width_mm,
            is_optimized: page.artifact.optimize,
            is_outlined,
            resolution: page.resolution(sheet.content()),
        };
        let (sheet, warnings) = prepare(&page.seen(sheet), &preparation)?;
        let boxes = match page.is_shared {
            true => sheet.layers.iter().map(boxes).collect(),
            false => Vec::new(),
        };
        Ok(Ready {
            sheet,
            warnings,
            boxes,
        })
    }

    /// What of it comes near the window of `page`.
    pub(crate) fn near(&self, page: &Page<'_>) -> Ready {
        let window = page.window_on(&self.sheet).map(|window| window.bounds);
        let is_near = |bounds: &Bounds| window.is_none_or(|window| bounds.intersects(&window));
        let layers = self.sheet.layers.iter().zip(&self.boxes);
        let near = layers.map(|(layer, boxes)| {
            let items = layer.items.iter().zip(boxes);
            let near = items.filter(|(_, bounds)| is_near(bounds));
            layer.with(near.map(|(item, _)| item.clone()).collect())
        });
        Ready {
            sheet: self.sheet.with(near.collect()),
            warnings: self.warnings.clone(),
            boxes: Vec::new(),
        }
    }

    /// Whether a point of it lies in the window of `page`; all do where there is none.
    pub(crate) fn holds(&self, at: Point, page: &Page<'_>) -> bool {
        let window = page.window_on(&self.sheet);
        window.is_none_or(|window| window.holds(at))
    }

    /// What of it lies in the window of `page`, all of it where there is none; and warnings.
    ///
    /// # Errors
    /// When what a closed line fills cannot be computed.
    pub(crate) fn cut(self, page: &Page<'_>) -> Result<(Sheet, Vec<Diagnostic>), Diagnostic> {
        let sheet = match page.window_on(&self.sheet) {
            None => self.sheet,
            Some(window) => window
                .of(&self.sheet)
                .map_err(|error| Diagnostic::error(error.to_string()))?,
        };
        Ok((sheet, self.warnings))
    }
}

fn boxes(layer: &fretwork_fabricate::Layer) -> Vec<Bounds> {
    let items = layer.items.iter();
    items.map(|item| Bounds::of(item.points())).collect()
}
