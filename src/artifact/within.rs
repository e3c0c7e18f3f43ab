//! What of a value lies in a window, to be measured.

use std::sync::Arc;

use fretwork_action::{Data, Value};
use fretwork_fabricate::{Item, Window};
use fretwork_geometry::{Bounds, Curves, Polygon, Region};

/// The lines or the area of `value` in a window; lines are half-open as in files, and closed at the far sides of `page`. None for what
/// does not lie in the plane.
pub fn within(value: &Value, window: Bounds, page: Option<Bounds>) -> Option<Value> {
    let is_far = |side: fn(&Bounds) -> f64| page.is_some_and(|page| side(&window) >= side(&page));
    let window = Window {
        bounds: window,
        closed: [is_far(|b| b.max.x), is_far(|b| b.max.y)],
        open: [false; 2],
        is_mirrored: false,
    };
    let lines = |curves: &Curves| {
        let mut cut = Curves::new();
        for curve in curves.iter() {
            for piece in window.line(curve.points) {
                cut.push(piece, curve.labels);
            }
        }
        Value::Data(Data::Curves(Arc::new(cut)))
    };
    let areas = |area: &[Polygon]| {
        let parts = area.iter().cloned().map(Item::Area);
        let parts = parts.flat_map(|item| window.parts(&item));
        let areas = parts.filter_map(|item| match item {
            Item::Area(area) => Some(area),
            Item::Line(_) => None,
        });
        Value::Data(Data::Region(Arc::new(Region::of_area(areas.collect()))))
    };
    match value {
        Value::Data(Data::Curves(curves)) => Some(lines(curves)),
        Value::Data(Data::Drawing(drawing)) => Some(lines(&drawing.curves())),
        Value::Data(Data::Region(region)) => Some(areas(&region.area)),
        Value::Data(Data::Cutout(cutout)) => Some(areas(&cutout.flat())),
        _ => None,
    }
}
