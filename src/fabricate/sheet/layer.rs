//! A flat sheet of lines and areas, ready to be written.

use std::sync::Arc;

use super::style::{Role, Style};
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::{Bounds, Curves, Point, Polygon, budget};

/// The farthest coordinate, in millimetres. Whole ten-thousandths of it are still exact in an `i64`
/// and, doubled, in the sums that order lines.
const LARGEST: f64 = 1e12;

/// Bytes for a point while it is put in order and written, and steps.
const POINT: usize = 100;
const POINT_STEPS: u64 = 60;

/// What is drawn on one plane, in paint order. Coordinates are those of the drawing plane (y
/// down), in spec units.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// The page; without one, the box of what is drawn.
    pub page: Option<Bounds>,
    /// Millimetres in the file per spec unit, above zero.
    pub unit_mm: f64,
    /// From the lowest.
    pub layers: Vec<Layer>,
}

/// Things that are drawn alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its name in the file.
    pub name: Arc<str>,
    /// What a machine does with it.
    pub role: Role,
    /// How it looks.
    pub style: Style,
    /// In paint order.
    pub items: Vec<Item>,
}

/// One thing on a layer.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A polyline, closed when its first and its last point are the same.
    Line(Vec<Point>),
    /// A polygon with holes.
    Area(Polygon),
}

impl Sheet {
    /// The same page with other layers.
    pub fn with(&self, layers: Vec<Layer>) -> Sheet {
        Sheet {
            page: self.page,
            unit_mm: self.unit_mm,
            layers,
        }
    }

    /// The sheet with only the items whose boxes meet `part`: all that is ever seen there.
    pub fn near(mut self, part: &Bounds) -> Sheet {
        for layer in &mut self.layers {
            let is_near = |item: &Item| Bounds::of(item.points()).intersects(part);
            layer.items.retain(is_near);
        }
        self
    }

    /// The box of what is drawn, without the width of lines.
    pub fn content(&self) -> Bounds {
        let layers = self.layers.iter();
        layers.fold(Bounds::EMPTY, |b, layer| b.union(layer.bounds()))
    }

    /// The page in millimetres: the given one, or the box of what is drawn with the width of its
    /// lines. Never empty.
    pub fn page_mm(&self) -> Bounds {
        let page = self.page.unwrap_or_else(|| {
            let content = self.content();
            let pens = self.layers.iter().filter_map(|layer| layer.style.stroke);
            content.grown(pens.fold(0.0, |w: f64, pen| w.max(pen.width)) / 2.0 / self.unit_mm)
        });
        if page.is_empty() {
            return Bounds {
                min: Point::ORIGIN,
                max: Point::new(1.0, 1.0),
            };
        }
        let page = Bounds {
            min: page.min * self.unit_mm,
            max: page.max * self.unit_mm,
        };
        if page.width() > 0.0 && page.height() > 0.0 {
            page
        } else {
            page.grown(0.5)
        }
    }

    /// Whether it can be written: every coordinate and width is a number in the range of the formats (10^12 mm).
    ///
    /// # Errors
    /// Which is not.
    pub fn check_numbers(&self) -> Result<(), Diagnostic> {
        let items = self.layers.iter().flat_map(|layer| &layer.items);
        let points = items.map(|item| item.points().count()).sum();
        budget::make("points of lines", points, POINT);
        budget::spend("points of lines", POINT_STEPS * points as u64);
        if !(self.unit_mm.is_finite() && self.unit_mm > 0.0) {
            return Err(Diagnostic::error(format!(
                "a unit cannot be {} mm",
                self.unit_mm
            )));
        }
        let corners = self.page.into_iter().flat_map(|page| [page.min, page.max]);
        let points = self
            .layers
            .iter()
            .flat_map(|layer| &layer.items)
            .flat_map(Item::points);
        let out = |p: &Point| {
            !(p.x.abs() * self.unit_mm <= LARGEST && p.y.abs() * self.unit_mm <= LARGEST)
        };
        if let Some(p) = corners.chain(points).find(out) {
            return Err(Diagnostic::error(format!(
                "({}, {}) is too far out to be written",
                p.x, p.y
            )));
        }
        let pens = self.layers.iter().filter_map(|layer| layer.style.stroke);
        if let Some(pen) = pens
            .into_iter()
            .find(|pen| !(0.0..=LARGEST).contains(&pen.width))
        {
            return Err(Diagnostic::error(format!(
                "a line cannot be {} mm wide",
                pen.width
            )));
        }
        Ok(())
    }

    /// Whether it can be written and there is something on it.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn check(&self) -> Result<(), Diagnostic> {
        self.check_numbers()?;
        if self.layers.iter().all(|layer| layer.items.is_empty()) {
            return Err(Diagnostic::error("there is nothing to draw"));
        }
        Ok(())
    }
}

impl Layer {
    /// The same layer with other items.
    pub fn with(&self, items: Vec<Item>) -> Layer {
        Layer {
            name: self.name.clone(),
            role: self.role,
            style: self.style,
            items,
        }
    }

    /// The curves as the lines of a layer.
    pub fn of_curves(
        name: impl Into<Arc<str>>,
        role: Role,
        style: Style,
        curves: &Curves,
    ) -> Layer {
        let items = curves
            .iter()
            .map(|curve| Item::Line(curve.points.to_vec()))
            .collect();
        Layer {
            name: name.into(),
            role,
            style,
            items,
        }
    }

    /// The polygons as the areas of a layer.
    pub fn of_areas(
        name: impl Into<Arc<str>>,
        role: Role,
        style: Style,
        areas: &[Polygon],
    ) -> Layer {
        Layer {
            name: name.into(),
            role,
            style,
            items: areas.iter().cloned().map(Item::Area).collect(),
        }
    }

    /// The box of its items.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.items.iter().flat_map(Item::points))
    }
}

impl Item {
    /// The same with every corner moved.
    pub fn mapped(&self, place: impl Fn(Point) -> Point) -> Item {
        let ring = |points: &Vec<Point>| points.iter().map(|p| place(*p)).collect();
        match self {
            Item::Line(points) => Item::Line(ring(points)),
            Item::Area(polygon) => Item::Area(Polygon {
                outer: ring(&polygon.outer),
                holes: polygon.holes.iter().map(ring).collect(),
            }),
        }
    }

    /// Its corners.
    pub fn points(&self) -> Box<dyn Iterator<Item = Point> + '_> {
        match self {
            Item::Line(points) => Box::new(points.iter().copied()),
            Item::Area(polygon) => Box::new(polygon.rings().flatten().copied()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(points: &[[f64; 2]]) -> Sheet {
        let items = vec![Item::Line(points.iter().map(|&p| p.into()).collect())];
        let layer = Layer {
            name: "a".into(),
            role: Role::Cut,
            style: Style::outline(2.0),
            items,
        };
        Sheet {
            page: None,
            unit_mm: 10.0,
            layers: vec![layer],
        }
    }

    #[test]
    fn the_page_is_the_content_with_its_lines() {
        let page = sheet(&[[0.0, 0.0], [3.0, 2.0]]).page_mm();
        assert_eq!(
            page,
            Bounds {
                min: Point::new(-1.0, -1.0),
                max: Point::new(31.0, 21.0)
            }
        );
        let mut flat = sheet(&[[0.0, 0.0], [3.0, 0.0]]);
        flat.layers[0].style.stroke = None;
        assert_eq!(flat.page_mm().height(), 1.0);
        flat.layers.clear();
        assert_eq!(flat.page_mm().width(), 1.0);
        flat.page = Some(Bounds {
            min: Point::ORIGIN,
            max: Point::new(2.0, 1.0),
        });
        assert_eq!(flat.page_mm().max, Point::new(20.0, 10.0));
    }

    #[test]
    fn what_cannot_be_written_is_found() {
        assert!(sheet(&[[0.0, 0.0], [1.0, 1.0]]).check().is_ok());
        assert!(sheet(&[[0.0, f64::NAN]]).check().is_err());
        assert!(sheet(&[[0.0, 1e12]]).check().is_err());
        let empty = Sheet {
            page: None,
            unit_mm: 1.0,
            layers: vec![],
        };
        assert_eq!(
            empty.check().unwrap_err().message,
            "there is nothing to draw"
        );
        assert!(
            Sheet {
                unit_mm: 0.0,
                ..empty
            }
            .check()
            .is_err()
        );
        let mut wide = sheet(&[[0.0, 0.0]]);
        wide.layers[0].style = Style::outline(f64::NAN);
        assert!(wide.check().is_err());
    }
}
