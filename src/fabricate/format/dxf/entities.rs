//! What is drawn in a DXF file: circles, and polylines with arcs in them.

use super::records::{MODEL_SPACE, Records};
use crate::sheet::arc_fit::{self, Circle};
use crate::sheet::fixed_point::{self, Cell};
use crate::sheet::lines::is_closed;
use fretwork_geometry::Point;

impl Records {
    /// One line, if it has an extent: a circle, or a polyline with arcs where its corners lie on
    /// them.
    pub fn line(&mut self, line: &[Point], layer: &str, unit_mm: f64) {
        let cells = fixed_point::cells(line, unit_mm);
        if cells.len() < 2 {
            return;
        }
        let is_closed = is_closed(&cells);
        match arc_fit::circle(&cells).filter(|_| is_closed) {
            Some(circle) => self.circle(circle, layer),
            None => self.polyline(&cells, is_closed, layer),
        }
    }

    fn entity(&mut self, kind: &str, layer: &str, class: &str) {
        let handle = self.handle();
        self.put(&[
            (0, kind),
            (5, &handle),
            (330, MODEL_SPACE),
            (100, "AcDbEntity"),
            (8, layer),
            (100, class),
        ]);
    }

    fn circle(&mut self, circle: Circle, layer: &str) {
        self.entity("CIRCLE", layer, "AcDbCircle");
        self.number(10, circle.center.0);
        self.number(20, -circle.center.1);
        self.number(30, 0);
        self.number(40, circle.radius);
    }

    fn polyline(&mut self, cells: &[Cell], is_closed: bool, layer: &str) {
        let stretches = arc_fit::stretches(cells);
        // Every stretch is written as the corner that it begins at; an open line has a last corner.
        let mut corners: Vec<(Cell, f64)> = Vec::with_capacity(stretches.len() + 1);
        let mut at = cells[0];
        for stretch in stretches {
            corners.push((at, stretch.arc.map_or(0.0, |arc| arc.bulge)));
            at = stretch.end;
        }
        if !is_closed {
            corners.push((at, 0.0));
        }
        self.entity("LWPOLYLINE", layer, "AcDbPolyline");
        self.put(&[
            (90, &corners.len().to_string()),
            (70, if is_closed { "1" } else { "0" }),
        ]);
        for ((x, y), bulge) in corners {
            self.number(10, x);
            self.number(20, -y);
            if bulge != 0.0 {
                // The plane is mirrored, and with it the sense of the arcs.
                self.put(&[(42, &plain_number(-bulge))]);
            }
        }
    }
}

/// A bulge with nine digits behind the point, at most: on a chord of a kilometre that is 10^-3 mm.
fn plain_number(bulge: f64) -> String {
    let mut text = String::new();
    fixed_point::push_scaled(&mut text, (bulge * 1e9).round() as i64, 9);
    text
}
