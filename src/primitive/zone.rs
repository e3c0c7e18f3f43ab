//! Fields that are constant in each face of a region: what a table says of it, and statistics of another
//! field in it.

use fretwork_action::Action;
use fretwork_diagnostic::{Diagnostic, nearest};
use fretwork_geometry::polygon::inner_point;
use fretwork_geometry::{Attribute, Bounds, Field, Lattice, Point, Polygon, Region, aspect};
use fretwork_language::kinds::fields::{Attribute as Column, Statistic, Zonal};

/// The values of a column of the table of a region's features: at a point that of the point, and elsewhere that of the first one
/// that holds the place.
///
/// # Errors
/// When there is no such column, or it holds a text.
pub fn attribute(action: &Action, kind: &Column) -> Result<Field, Vec<Diagnostic>> {
    let region = action.input(&kind.region);
    let name = &*kind.name.0;
    check_column(&region, name, &kind.region.name).map_err(|error| {
        vec![error.at(
            action.definition.field(&["attribute", "name"]),
            "no such attribute",
        )]
    })?;
    let mut faces = Vec::with_capacity(region.features.len());
    let mut points = Vec::new();
    for (i, feature) in region.features.iter().enumerate() {
        let value = match feature.attribute(name) {
            None => f64::NAN,
            Some(Attribute::Whole(value)) => *value as f64,
            Some(Attribute::Number(value)) => *value,
            Some(Attribute::Truth(value)) => f64::from(u8::from(*value)),
            Some(other @ (Attribute::Text(_) | Attribute::Nested { .. })) => {
                let what = match other {
                    Attribute::Text(text) => format!("the text {text:?}"),
                    _ => "a list or an object".to_string(),
                };
                let message = format!(
                    "`{name}` of face {} of `{}` is {what}, and a number is needed",
                    i + 1,
                    kind.region.name
                );
                let error = Diagnostic::error(message);
                let name = action.definition.field(&["attribute", "name"]);
                return Err(vec![error.at(name, "in this column")]);
            }
        };
        if !feature.area.is_empty() {
            faces.push((feature.area.clone(), value));
        }
        points.extend(feature.points.iter().map(|p| (*p, value)));
    }
    let mut field = Field::per_face(faces);
    if !points.is_empty() {
        field = field.with_points(points, NEAR);
    }
    Ok(kind
        .otherwise
        .map_or(field.clone(), |value| field.filled(value.0)))
}

/// What is no farther from a point of a map is that point, in metres: a vertex is rounded by a micrometre.
const NEAR: f64 = 1e-5;

fn check_column(region: &Region, name: &str, of: &str) -> Result<(), Diagnostic> {
    if region.columns.iter().any(|column| &**column == name) {
        return Ok(());
    }
    if region.columns.is_empty() {
        let message = format!("the faces of `{of}` have no attributes, and so no `{name}`");
        return Err(Diagnostic::error(message).help(
            "attributes come from the table of a `geodata` region, for a Shapefile its `.dbf`",
        ));
    }
    let error = Diagnostic::error(format!("the faces of `{of}` have no attribute `{name}`"));
    let columns = region.columns.iter().map(|column| &**column);
    Err(match nearest(name, columns.clone()) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None => {
            let all: Vec<String> = columns.map(|column| format!("`{column}`")).collect();
            error.help(format!("they have {}", all.join(", ")))
        }
    })
}

/// A statistic of `from` in each face of a region. Parts of a feature that lie apart are faces of their own.
pub fn zonal(action: &Action, kind: &Zonal, from: &Field) -> Field {
    let region = action.input(&kind.faces);
    let areas: Vec<&Polygon> = match region.features.is_empty() {
        true => region.area.iter().collect(),
        false => region
            .features
            .iter()
            .flat_map(|feature| &feature.area)
            .collect(),
    };
    let value = |polygon: &Polygon| {
        let area = vec![polygon.clone()];
        let value = statistic(&area, kind.statistic, from);
        (area, value)
    };
    let field = Field::per_face(areas.into_iter().map(value).collect());
    kind.otherwise
        .map_or(field.clone(), |value| field.filled(value.0))
}

/// So many places along either side of a face stand for a field without samples.
const PLACES: usize = 64;
/// How far apart the heights are of which a field without samples has its gradient.
const STEP: f64 = 1e-3;

fn statistic(area: &[Polygon], what: Statistic, from: &Field) -> f64 {
    if area.is_empty() {
        return f64::NAN;
    }
    let mut sum = Sum::default();
    let mut add = |p: Point| match what {
        Statistic::Direction => sum.add_gradient(from.gradient(p, STEP)),
        _ => sum.add(from.value(p)),
    };
    match from.grid() {
        Some(grid) => middles(area, grid, &mut add),
        None => places(area, &mut add),
    }
    if sum.count == 0 {
        let inner = inner_point(area);
        match what {
            Statistic::Direction => sum.add_gradient(from.gradient(inner, STEP)),
            _ => sum.add(from.value(inner)),
        }
    }
    sum.result(what)
}

#[derive(Debug)]
struct Sum {
    count: usize,
    total: f64,
    least: f64,
    greatest: f64,
    gradient: Point,
}

impl Default for Sum {
    fn default() -> Sum {
        Sum {
            count: 0,
            total: 0.0,
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            gradient: Point::ORIGIN,
        }
    }
}

impl Sum {
    fn add(&mut self, value: f64) {
        if value.is_finite() {
            self.count += 1;
            self.total += value;
            self.least = self.least.min(value);
            self.greatest = self.greatest.max(value);
        }
    }

    fn add_gradient(&mut self, gradient: Point) {
        if gradient.is_finite() {
            self.count += 1;
            self.gradient = self.gradient + gradient;
        }
    }

    fn result(&self, what: Statistic) -> f64 {
        match what {
            _ if self.count == 0 => f64::NAN,
            Statistic::Mean => self.total / self.count as f64,
            Statistic::Min => self.least,
            Statistic::Max => self.greatest,
            Statistic::Direction => aspect(self.gradient),
        }
    }
}

/// Calls `add` with the middles of the pixels of `grid` that lie in `area`, row by row.
fn middles(area: &[Polygon], grid: &Lattice, add: &mut impl FnMut(Point)) {
    let flat: Vec<Polygon> = area
        .iter()
        .map(|polygon| {
            let ring = |ring: &Vec<Point>| ring.iter().map(|p| grid.column_and_row(*p)).collect();
            Polygon {
                outer: ring(&polygon.outer),
                holes: polygon.holes.iter().map(ring).collect(),
            }
        })
        .collect();
    let [width, height] = grid.samples().size();
    inside(&flat, [width, height], &mut |i, j| add(grid.middle(i, j)));
}

/// Calls `add` with places in `area`, spread evenly.
fn places(area: &[Polygon], add: &mut impl FnMut(Point)) {
    let bounds = area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
    let n = PLACES as f64;
    for j in 0..PLACES {
        for i in 0..PLACES {
            let part = Point::new((i as f64 + 0.5) / n, (j as f64 + 0.5) / n);
            let p = bounds.min + Point::new(part.x * bounds.width(), part.y * bounds.height());
            if area.iter().any(|polygon| polygon.contains(p)) {
                add(p);
            }
        }
    }
}

/// Calls `found` with the columns and rows of the pixels whose middles lie in `area`, which is in columns and rows.
fn inside(area: &[Polygon], size: [usize; 2], found: &mut impl FnMut(usize, usize)) {
    let bounds = area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()));
    let clamped = |v: f64, n: usize| (v - 0.5).ceil().clamp(0.0, n as f64) as usize;
    let (low, high) = (
        clamped(bounds.min.y, size[1]),
        clamped(bounds.max.y, size[1]),
    );
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); high - low];
    for ring in area.iter().flat_map(Polygon::rings) {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let rows = clamped(a.y.min(b.y), size[1])..clamped(a.y.max(b.y), size[1]);
            for row in rows {
                let part = (row as f64 + 0.5 - a.y) / (b.y - a.y);
                crossings[row - low].push(a.x + part * (b.x - a.x));
            }
        }
    }
    for (row, line) in (low..).zip(&mut crossings) {
        line.sort_by(f64::total_cmp);
        for pair in line.chunks_exact(2) {
            for column in clamped(pair[0], size[0])..clamped(pair[1], size[0]) {
                found(column, row);
            }
        }
    }
}
