//! A wrap from its area to its cutout: the steps in their order, and its measures.

use std::sync::Arc;

use fretwork_geometry::cutout::{Carrier, Cutout, Measures, Side, Wrapping, mapped};
use fretwork_geometry::neck::{Neck, below, narrowest_neck};
use fretwork_geometry::polygon::intersect;
use fretwork_geometry::progress::step;
use fretwork_geometry::{Bounds, Point, Point3, Polygon, SurfaceMesh, topology};

use crate::WrapError;
use crate::chart::{Chart, Deck, Demand, chart};
use crate::copies::{Around, Copies, Laying, copies};
use crate::count::{Counts, count};
use crate::press::{Pressed, press};

/// What is laid on a surface.
pub struct Drawn<'a> {
    /// The area in the drawing plane, y down; polygons do not overlap.
    pub area: &'a [Polygon],
    /// The box whose middle is the drawing's: that of its region, or its own.
    pub bounds: Bounds,
}

/// The drawing as a cutout that lies on the surface, its middle at the place of the surface nearest to `at`.
///
/// # Errors
/// [`WrapError`], each with what would help where something is known.
pub fn wrap(
    drawn: &Drawn,
    surface: &SurfaceMesh,
    at: Option<Point3>,
    laying: &Laying,
) -> Result<Cutout, WrapError> {
    if drawn.area.is_empty() {
        return Err(WrapError::Empty);
    }
    let map = laying.map(drawn.bounds.center());
    let area = mapped(drawn.area, |p| map.apply(p));
    let bounds = of_area(&area);
    let corners = [
        bounds.min,
        bounds.max,
        Point::new(bounds.min.x, bounds.max.y),
        Point::new(bounds.max.x, bounds.min.y),
    ];
    let demand = Demand {
        at,
        reach: corners.iter().map(|p| p.length()).fold(0.0, f64::max),
        extent: bounds,
        is_around: laying.around != Around::Once,
        in_rows: laying.around == Around::Joined,
    };
    step(|| "unrolling the surface".to_owned());
    let chart = chart(surface, &demand).map_err(|error| error.of(&area))?;
    let laid = copies(&chart, &area, period(drawn, laying), laying)?;
    step(|| "pressing the drawing into the surface".to_owned());
    let pressed = press(&surface.mesh, &chart, &laid.area)?;
    let Counts { topology, around } = count(&pressed, &chart)?;
    let polygons = developed(&chart, &laid)?;
    let measures = measures(&chart, &laid, &pressed, &polygons)?;
    Ok(Cutout {
        polygons,
        components: topology.components,
        holes: topology.holes,
        around,
        carrier: Carrier::Surface(Arc::new(pressed.imprint)),
        developed: Vec::new(),
        is_strip: true,
        side: Side::Center,
        measures,
    })
}

/// How wide a copy is where copies are joined.
fn period(drawn: &Drawn, laying: &Laying) -> f64 {
    let Bounds { min, max } = drawn.bounds;
    let map = laying.map(drawn.bounds.center());
    let corners = [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)];
    Bounds::of(corners.map(|p| map.apply(p))).width()
}

fn of_area(area: &[Polygon]) -> Bounds {
    area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
}

/// What lies on the unrolled surface once: a ring is cut open where its chart begins.
fn developed(chart: &Chart, laid: &Copies) -> Result<Vec<Polygon>, WrapError> {
    let Deck::Step(step) = chart.deck else {
        // A sector has no straight ends, and what lies on it is smaller.
        return Ok(once(chart, laid));
    };
    let bounds = of_area(&laid.area);
    let low = start(chart);
    let corner = |x: f64, y: f64| Point::new(x, y);
    let (bottom, top) = (bounds.min.y - 1.0, bounds.max.y + 1.0);
    let strip = Polygon {
        outer: vec![
            corner(low, bottom),
            corner(low + step, bottom),
            corner(low + step, top),
            corner(low, top),
        ],
        holes: Vec::new(),
    };
    Ok(intersect(&laid.area, &[strip])?)
}

/// The polygons of an unrolled cone whose first corner is on the chart once.
fn once(chart: &Chart, laid: &Copies) -> Vec<Polygon> {
    let Deck::Turn(center, whole) = chart.deck else {
        return laid.area.clone();
    };
    let flaps = chart.flaps.iter().flat_map(|flap| flap.drawn);
    let turn = |p: Point| {
        let (down, way) = (center * -1.0, p - center);
        libm::atan2(down.cross(way), down.dot(way)) / whole
    };
    let low = flaps.map(turn).fold(f64::INFINITY, f64::min);
    let on_chart = |polygon: &&Polygon| {
        let middle = turn(polygon.bounds().center()) - low;
        (0.0..1.0).contains(&middle)
    };
    laid.area.iter().filter(on_chart).cloned().collect()
}

/// The narrowest place that is none at the cut where a ring is opened: there the outline goes on, on the other copies.
fn narrowest(chart: &Chart, laid: &Copies, polygons: &[Polygon]) -> Option<f64> {
    let found = narrowest_neck(polygons)?;
    let Deck::Step(step) = chart.deck else {
        return Some(found.width);
    };
    let low = start(chart);
    let on_chart = |neck: &Neck| (low..=low + step).contains(&neck.middle().x);
    let mut width = found.width * (1.0 + 1e-9);
    let most = of_area(polygons).longer_side();
    while width < most {
        let mut necks = below(&laid.area, width);
        necks.sort_by(|a, b| a.width.total_cmp(&b.width));
        let is_inside = |neck: &Neck| laid.area.iter().any(|p| p.contains(neck.middle()));
        if let Some(least) = necks.iter().find(|neck| on_chart(neck) && is_inside(neck)) {
            return Some(least.width);
        }
        width *= 2.0;
    }
    None
}

/// Where the chart of a ring begins.
fn start(chart: &Chart) -> f64 {
    let flaps = chart.flaps.iter().flat_map(|flap| flap.drawn);
    flaps.map(|p| p.x).fold(f64::INFINITY, f64::min)
}

fn measures(
    chart: &Chart,
    laid: &Copies,
    pressed: &Pressed,
    polygons: &[Polygon],
) -> Result<Measures, WrapError> {
    let mut stretch = [f64::INFINITY, 0.0, 0.0f64];
    let mut whole = 0.0;
    let positions = pressed.imprint.positions();
    for (t, flap) in pressed.flaps.iter().enumerate() {
        let Some(flap) = flap.filter(|_| pressed.imprint.inside[t]) else {
            continue;
        };
        let corners = pressed.imprint.triangles[t].map(|corner| corner as usize);
        let [a, b, c] = corners.map(|corner| positions[corner]);
        let area = (b - a).cross(c - a).length();
        let places = corners.map(|corner| &pressed.imprint.places[corner]);
        let of = chart.flaps[flap as usize].stretched(places, laid.fit);
        stretch[0] = stretch[0].min(of[0]);
        stretch[1] += area * of[1];
        stretch[2] = stretch[2].max(of[2]);
        whole += area;
    }
    let flat = topology::count(polygons)?;
    stretch[1] /= whole;
    let wrapping = Wrapping {
        copies: laid.count,
        stretch: if whole > 0.0 { stretch } else { [1.0; 3] },
        area: 0.5 * whole,
        flat,
    };
    Ok(Measures {
        length: of_area(polygons).width(),
        area: polygons.iter().map(Polygon::area).sum(),
        min_width: narrowest(chart, laid, polygons),
        synthesis: None,
        wrapping: Some(wrapping),
    })
}
