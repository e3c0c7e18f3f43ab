//! The drawing put on the unrolled surface: scaled and turned about its middle, once or as often as it goes around,
//! united with itself where it meets itself. How the surface is unrolled is known to `chart`.

use fretwork_geometry::cutout::mapped;
use fretwork_geometry::polygon::unite;
use fretwork_geometry::{Affine, Bounds, Point, Polygon, Ring, budget};

use crate::WrapError;
use crate::chart::{Chart, Deck, Room};

/// Copies meet where they are nearer than this part of the way around.
const MEETING: f64 = 1e-9;
/// What reaches over a rim by less than this part of the drawing or of the surface is as high as the surface but for the
/// grid on which areas are united, and is cut off there.
const RIM: f64 = 1e-6;
/// More copies than this are refused.
const MOST: f64 = 10_000.0;
/// Bytes for a point of a copy.
const POINT: usize = 16;
/// Corners are one where they are nearer than this part of the whole's longer side: a step of the grid on which areas are united.
const SAME: f64 = 1e-8;

/// How often a drawing is laid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Around {
    /// Once.
    Once,
    /// Side by side, as many as go around; each is stretched a little so that they do exactly.
    Joined,
    /// So many, evenly spaced.
    Spaced(usize),
}

/// How a drawing is laid.
#[derive(Clone, Copy, Debug)]
pub struct Laying {
    /// Factors along x and y.
    pub scale: [f64; 2],
    /// A turn in radians, from x toward y of the drawing.
    pub rotate: f64,
    /// How often.
    pub around: Around,
    /// How far a period may be from one that closes, as a part of it.
    pub tolerance: f64,
}

impl Laying {
    /// The map from the drawing, y down, to the unrolled surface, y up, for a drawing with this middle.
    pub fn map(&self, middle: Point) -> Affine {
        Affine::translation(middle * -1.0)
            .then(Affine::scale(self.scale[0], self.scale[1]))
            .then(Affine::rotation(self.rotate))
            .then(Affine::scale(1.0, -1.0))
    }
}

/// A drawing on the unrolled surface.
pub struct Copies {
    /// All copies, and at the ends of the chart those that reach over its border.
    pub area: Vec<Polygon>,
    /// How many copies go around.
    pub count: usize,
    /// How they were stretched along x to do so.
    pub fit: f64,
}

/// The copies of `area` that lie on `chart`; `period` is how wide a copy is where copies are joined.
///
/// # Errors
/// When nothing goes around, when copies overlap or do not close, and when the drawing reaches over a rim.
pub fn copies(
    chart: &Chart,
    area: &[Polygon],
    period: f64,
    laying: &Laying,
) -> Result<Copies, WrapError> {
    let around = chart.around();
    let (count, fit) = match (laying.around, around) {
        (Around::Once, None) => (1, 1.0),
        (_, None) => return Err(WrapError::NoWayAround),
        (Around::Once, Some(around)) => (1, rounded(chart, area, around)),
        (Around::Spaced(count), Some(around)) => {
            (count, rounded(chart, area, around / count as f64))
        }
        (Around::Joined, Some(around)) => joined(period, around, laying.tolerance)?,
    };
    let area = mapped(area, |p| Point::new(p.x * fit, p.y));
    let bounds = bounds(&area);
    check_rims(chart, &area)?;
    let area = within_rims(chart, area);
    let Some(around) = around else {
        return Ok(Copies { area, count, fit });
    };
    let wide = width(chart, &area, &bounds) * count as f64;
    // Periods are joined, so that what reaches over one lies on its neighbour, and that is meant.
    if !matches!(laying.around, Around::Joined) && wide > around * (1.0 + MEETING) {
        return Err(WrapError::TooWide {
            wide,
            around,
            copies: count,
        });
    }
    let places = places(chart, &area, count);
    let points: usize = area.iter().flat_map(Polygon::rings).map(Vec::len).sum();
    budget::make("points of copies", places.clone().count() * points, POINT);
    let mut all = Vec::new();
    for k in places {
        all.extend(mapped(&area, |p| {
            moved(chart.deck, k as f64 / count as f64, p)
        }));
    }
    let is_alone = all.len() == area.len();
    let area = if is_alone { all } else { tidied(unite(&all)?) };
    Ok(Copies { area, count, fit })
}

/// The polygons without corners that are nearly where the one before is. Copies that meet have their common corners twice,
/// apart by no more than rounding.
fn tidied(area: Vec<Polygon>) -> Vec<Polygon> {
    let near = SAME * bounds(&area).longer_side();
    let ring = |ring: &Ring| -> Ring {
        let before = ring.iter().cycle().skip(ring.len() - 1);
        let kept: Ring = ring
            .iter()
            .zip(before)
            .filter(|(p, before)| p.distance(**before) > near)
            .map(|(p, _)| *p)
            .collect();
        if kept.len() < 3 { ring.clone() } else { kept }
    };
    let tidy = |polygon: &Polygon| Polygon {
        outer: ring(&polygon.outer),
        holes: polygon.holes.iter().map(ring).collect(),
    };
    area.iter().map(tidy).collect()
}

/// What copies are stretched by that would go around a true circle, and are a little too wide for the flat pieces of the mesh.
fn rounded(chart: &Chart, area: &[Polygon], room: f64) -> f64 {
    let Deck::Step(_) = chart.deck else {
        return 1.0;
    };
    let wide = bounds(area).width();
    if wide > room && wide <= room * chart.slack * (1.0 + MEETING) {
        room / wide
    } else {
        1.0
    }
}

/// How many periods go around, and what each is stretched by.
fn joined(period: f64, around: f64, tolerance: f64) -> Result<(usize, f64), WrapError> {
    let copies = libm::round(around / period).max(1.0);
    if copies > MOST || copies.is_nan() {
        return Err(WrapError::TooMany(copies));
    }
    let fit = around / (copies * period);
    if (fit - 1.0).abs() <= tolerance {
        Ok((copies as usize, fit))
    } else {
        Err(WrapError::Seam {
            period,
            copies: copies as usize,
            around,
        })
    }
}

/// Where the copies stand that lie on the chart, as numbers of copies from the middle one. On a step there is one more at either
/// end; on a cone there must not be, for a turn farther its plane is covered again.
fn places(chart: &Chart, area: &[Polygon], count: usize) -> std::ops::RangeInclusive<i64> {
    let range = |points: &mut dyn Iterator<Item = Point>| {
        let turns = points.map(|p| turn(chart.deck, p));
        turns.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| {
            (low.min(t), high.max(t))
        })
    };
    let (low, high) = range(&mut chart.flaps.iter().flat_map(|flap| flap.drawn));
    let (left, right) = range(&mut area.iter().flat_map(|p| p.outer.iter().copied()));
    let at = |t: f64| t * count as f64;
    let (first, last) = (libm::ceil(at(low - right)), libm::floor(at(high - left)));
    match chart.deck {
        Deck::Turn(..) => first as i64..=last as i64,
        Deck::Open | Deck::Step(_) => first as i64 - 1..=last as i64 + 1,
    }
}

/// Which part of the way around a place is from the middle.
fn turn(deck: Deck, p: Point) -> f64 {
    match deck {
        Deck::Open => 0.0,
        Deck::Step(step) => p.x / step,
        Deck::Turn(center, whole) => angle(center, p) / whole,
    }
}

/// The angle at `center` from the origin to `p`, counter-clockwise.
fn angle(center: Point, p: Point) -> f64 {
    let (down, way) = (center * -1.0, p - center);
    libm::atan2(down.cross(way), down.dot(way))
}

fn moved(deck: Deck, part: f64, p: Point) -> Point {
    match deck {
        Deck::Open => p,
        Deck::Step(step) => Point::new(p.x + step * part, p.y),
        Deck::Turn(center, whole) if part != 0.0 => {
            Affine::rotation(whole * part).about(center).apply(p)
        }
        Deck::Turn(..) => p,
    }
}

fn bounds(area: &[Polygon]) -> Bounds {
    area.iter().fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
}

/// How wide a drawing is on the way around, at the height of the middle.
fn width(chart: &Chart, area: &[Polygon], bounds: &Bounds) -> f64 {
    let Deck::Turn(center, _) = chart.deck else {
        return bounds.width();
    };
    let points = area.iter().flat_map(|polygon| &polygon.outer);
    let angles = points.map(|p| angle(center, *p));
    let (low, high) = angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), a| {
        (low.min(a), high.max(a))
    });
    (high - low) * center.length()
}

/// An error where the area reaches over a rim of the surface.
fn check_rims(chart: &Chart, area: &[Polygon]) -> Result<(), WrapError> {
    let b = bounds(area);
    let over = |by: f64, rim, room: f64| {
        let is_over = by > RIM * room.max(b.longer_side());
        is_over.then_some(WrapError::OverRim { rim, by, room })
    };
    let found = match chart.room {
        Room::Flaps => None,
        Room::Strip(across, [low, high]) => {
            let upper = over(b.max.y - high, "upper", high - low);
            let lower = || over(low - b.min.y, "lower", high - low);
            let sides = || {
                let [left, right] = across?;
                let left_over = over(left - b.min.x, "left", right - left);
                left_over.or_else(|| over(b.max.x - right, "right", right - left))
            };
            upper.or_else(lower).or_else(sides)
        }
        Room::Sector(apex, [near, far], is_above) => {
            if area.iter().any(|polygon| polygon.contains(apex)) {
                return Err(WrapError::OverTip);
            }
            let (least, greatest) = distances(area, apex);
            let rims = if is_above {
                ["upper", "lower"]
            } else {
                ["lower", "upper"]
            };
            over(near - least, rims[0], far - near)
                .or_else(|| over(greatest - far, rims[1], far - near))
        }
    };
    found.map_or(Ok(()), Err)
}

/// An area that reaches over no rim but for rounding, without what does.
fn within_rims(chart: &Chart, area: Vec<Polygon>) -> Vec<Polygon> {
    let b = bounds(&area);
    match chart.room {
        Room::Flaps => area,
        Room::Strip(across, [low, high]) => {
            let [left, right] = across.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            if b.min.y >= low && b.max.y <= high && b.min.x >= left && b.max.x <= right {
                return area;
            }
            mapped(&area, |p| {
                Point::new(p.x.clamp(left, right), p.y.clamp(low, high))
            })
        }
        Room::Sector(apex, [near, far], _) => {
            let (least, greatest) = distances(&area, apex);
            if least >= near && greatest <= far {
                return area;
            }
            mapped(&area, |p| {
                let distance = p.distance(apex);
                apex + (p - apex) * (distance.clamp(near, far) / distance)
            })
        }
    }
}

/// The least and the greatest distance of an outline from a place.
fn distances(area: &[Polygon], from: Point) -> (f64, f64) {
    let mut found = (f64::INFINITY, 0.0f64);
    for polygon in area {
        let ends = polygon.outer.iter().cycle().skip(1);
        for (a, b) in polygon.outer.iter().zip(ends) {
            let way = *b - *a;
            let t = ((from - *a).dot(way) / way.dot(way).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            found.0 = found.0.min(a.lerp(*b, t).distance(from));
            found.1 = found.1.max(a.distance(from));
        }
    }
    found
}
