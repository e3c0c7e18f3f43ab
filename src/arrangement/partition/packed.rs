//! As many copies of elements as fit without overlap, by dart throwing (Loi 2015, figure 6.1).

use crate::distance::{Segment, nearest, project, segments};
use crate::error::ArrangementError;
use crate::limit::LIMIT;
use fretwork_geometry::budget;
use fretwork_geometry::index::{BucketGrid, Squares};
use fretwork_geometry::{Affine, Bounds, Curves, Point, Region, Seed};

/// What is packed.
#[derive(Clone, Debug, PartialEq)]
pub struct PackedProperties {
    /// The elements; each copy is of one drawn at random.
    pub elements: Vec<Curves>,
    /// How far a copy is turned about the centre of its box: the least and the greatest angle, radians.
    pub rotate: [f64; 2],
    /// By what a copy is scaled: the least and the greatest factor, above 0.
    pub scale: [f64; 2],
    /// The least distance between copies.
    pub gap: f64,
}

/// From one round of throwing to the next, copies get smaller by this factor at most.
const SHRINK: f64 = 0.85;

/// Bytes that a place for darts takes.
const PLACE: usize = 48;

/// What is charged for.
const WORK: &str = "copies that may meet";

/// Places for darts along the extent of a copy, and darts for each before it is given up.
const PLACES: f64 = 4.0;
const DARTS: u64 = 12;

/// Copies inside `region`, none of which meets another or is nearer to it than the gap, or lies within
/// a closed curve of another. In a periodic tile they may cross its sides, and are repeated there.
///
/// Copies of the greatest scales are thrown first; a round ends when no place of the region has
/// taken one of the last 12 darts, so that in the end hardly any copy of the least scale would fit.
/// Distances are those of the polylines. Time grows with the area over that of the smallest copy.
///
/// # Errors
/// When there is no element with an extent, when scales, angles or the gap are no numbers that make
/// sense, and when there would be too many copies.
pub fn packed(
    properties: &PackedProperties,
    region: &Region,
    seed: Seed,
) -> Result<Curves, ArrangementError> {
    let elements = centered(&properties.elements)?;
    let [least, greatest] = properties.scale;
    let is_range = |[low, high]: [f64; 2]| low.is_finite() && high.is_finite() && low <= high;
    if !(is_range(properties.scale) && least > 0.0 && is_range(properties.rotate)) {
        return Err(ArrangementError::Packing(
            "scales and angles must be ranges of numbers, scales above 0",
        ));
    }
    if !(properties.gap.is_finite() && properties.gap >= 0.0) {
        return Err(ArrangementError::Packing("the gap must not be negative"));
    }
    let mut packing = Packing::new(properties, &elements, region)?;
    packing.places(least)?;
    let mut high = greatest;
    for round in 0.. {
        let low = (high * SHRINK).max(least);
        packing.throw_round([low, high], seed.number(round))?;
        if low <= least {
            break;
        }
        high = low;
    }
    Ok(packing
        .copies
        .into_iter()
        .fold(Curves::new(), |mut all, copy| {
            all.append(&copy.curves);
            all
        }))
}

/// An element around the origin.
struct Element {
    curves: Curves,
    /// Of the circle around it.
    radius: f64,
    /// Of the disc around the origin that is inside of it; 0 where there is none.
    core: f64,
}

fn centered(elements: &[Curves]) -> Result<Vec<Element>, ArrangementError> {
    let center = |curves: &Curves| {
        let moved = curves.transformed(&Affine::translation(-curves.bounds().center()));
        let radius = moved
            .points()
            .iter()
            .map(|p| p.length())
            .fold(0.0, f64::max);
        let least = segments(&moved)
            .map(|s| project(Point::ORIGIN, s).length())
            .fold(f64::INFINITY, f64::min);
        let core = if encloses(&moved, Point::ORIGIN) {
            least
        } else {
            0.0
        };
        Element {
            curves: moved,
            radius,
            core,
        }
    };
    let elements: Vec<Element> = elements
        .iter()
        .filter(|e| !e.is_empty())
        .map(center)
        .collect();
    let is_bad = |e: &Element| !(e.radius.is_finite() && e.radius > 0.0);
    if elements.is_empty() || elements.iter().any(is_bad) {
        return Err(ArrangementError::Packing(
            "every element must have an extent",
        ));
    }
    Ok(elements)
}

/// A copy in its place.
struct Copy {
    curves: Curves,
    bounds: Bounds,
    center: Point,
    /// As those of the element.
    radius: f64,
    core: f64,
}

/// How a copy is to be made.
struct Dart<'a> {
    element: &'a Element,
    at: Point,
    factor: f64,
    angle: f64,
}

impl Dart<'_> {
    fn copy(&self) -> Copy {
        let map = Affine::scale(self.factor, self.factor).then(Affine::rotation(self.angle));
        let curves = self
            .element
            .curves
            .transformed(&map.then(Affine::translation(self.at)));
        let (radius, core) = (
            self.element.radius * self.factor,
            self.element.core * self.factor,
        );
        Copy {
            bounds: curves.bounds(),
            curves,
            center: self.at,
            radius,
            core,
        }
    }
}

struct Packing<'a> {
    properties: &'a PackedProperties,
    elements: &'a [Element],
    window: Bounds,
    region: &'a Region,
    border: Vec<Segment>,
    near_border: BucketGrid,
    copies: Vec<Copy>,
    near_copies: BucketGrid,
}

impl<'a> Packing<'a> {
    fn new(
        properties: &'a PackedProperties,
        elements: &'a [Element],
        region: &'a Region,
    ) -> Result<Packing<'a>, ArrangementError> {
        let window = region.bounds();
        if !(window.is_empty() || window.min.is_finite() && window.max.is_finite()) {
            return Err(ArrangementError::Region);
        }
        let rings = region.area.iter().flat_map(|polygon| polygon.rings());
        let border: Vec<Segment> = rings
            .flat_map(|ring| (0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]))
            .collect();
        let mut near_border = BucketGrid::empty(Squares::over(
            &window,
            window.longer_side() / (1.0 + (border.len() as f64).sqrt()),
        ));
        for (number, segment) in (0..).zip(&border) {
            near_border.insert(number, &Bounds::of(*segment));
        }
        let middle = (properties.scale[0] * properties.scale[1]).sqrt();
        let extent = 2.0 * middle * elements.iter().map(|e| e.radius).fold(0.0, f64::max);
        let near_copies = BucketGrid::empty(Squares::over(&window, extent + properties.gap));
        Ok(Packing {
            properties,
            elements,
            window,
            region,
            border,
            near_border,
            copies: Vec::new(),
            near_copies,
        })
    }

    /// The side of the places for copies of this scale, and how many columns and rows there are of them.
    fn places(&self, scale: f64) -> Result<(f64, [u64; 2]), ArrangementError> {
        let smallest = self
            .elements
            .iter()
            .map(|e| e.radius)
            .fold(f64::INFINITY, f64::min);
        let side = 2.0 * smallest * scale / PLACES;
        let (columns, rows) = (
            (self.window.width() / side).ceil(),
            (self.window.height() / side).ceil(),
        );
        let count = columns * rows;
        if count.is_nan() || count > 4.0 * LIMIT as f64 {
            return Err(ArrangementError::TooMany {
                what: "places for copies",
                count,
            });
        }
        budget::make("places for copies", count as usize, PLACE);
        Ok((side, [columns as u64, rows as u64]))
    }

    /// Throws copies with scales in `range` until no place takes one.
    fn throw_round(&mut self, range: [f64; 2], seed: Seed) -> Result<(), ArrangementError> {
        let (side, [columns, rows]) = self.places(range[0])?;
        let count = columns * rows;
        let covered = self.covered(range[0], side, [columns, rows]);
        let mut places: Vec<u64> = (0..count)
            .filter(|place| !covered[*place as usize])
            .collect();
        // Places in random order, so that copies do not grow from one corner.
        places.sort_by_cached_key(|place| seed.name("order").unit(*place).to_bits());
        let mut failures = vec![0u64; count as usize];
        for dart in 0.. {
            places.retain(|place| failures[*place as usize] < DARTS);
            if places.is_empty() {
                return Ok(());
            }
            for &place in &places {
                let seed = seed.number(place as i64).number(dart);
                let corner = Point::new((place % columns) as f64, (place / columns) as f64) * side;
                let at = self.window.min + corner + Point::new(seed.unit(0), seed.unit(1)) * side;
                let dart = self.dart(at, range, seed);
                match self
                    .is_free(&dart)
                    .then(|| dart.copy())
                    .filter(|copy| self.fits(copy))
                {
                    Some(copy) => self.keep(copy),
                    None => failures[place as usize] += 1,
                }
            }
        }
        Ok(())
    }

    /// The places in which every dart for a copy of at least this scale would fall too deep into another copy.
    fn covered(&self, scale: f64, side: f64, [columns, rows]: [u64; 2]) -> Vec<bool> {
        let own = self
            .elements
            .iter()
            .map(|e| e.core)
            .fold(f64::INFINITY, f64::min)
            * scale;
        let mut covered = vec![false; (columns * rows) as usize];
        for copy in self.copies.iter().filter(|copy| copy.core > 0.0) {
            let reach = copy.core + own;
            let index = |v: f64, n: u64| (v / side).clamp(0.0, n as f64 - 1.0) as u64;
            let from = copy.center - self.window.min - Point::new(reach, reach);
            let to = copy.center - self.window.min + Point::new(reach, reach);
            for row in index(from.y, rows)..=index(to.y, rows) {
                for column in index(from.x, columns)..=index(to.x, columns) {
                    let middle =
                        self.window.min + Point::new(column as f64 + 0.5, row as f64 + 0.5) * side;
                    // Half the diagonal of a place, and a little for rounding.
                    if middle.distance(copy.center) < reach - 0.708 * side {
                        covered[(row * columns + column) as usize] = true;
                    }
                }
            }
        }
        covered
    }

    fn dart(&self, at: Point, scale: [f64; 2], seed: Seed) -> Dart<'a> {
        let [low, high] = self.properties.rotate;
        Dart {
            element: &self.elements[(seed.unit(2) * self.elements.len() as f64) as usize],
            at,
            factor: seed.range(3, scale[0], scale[1]),
            angle: seed.range(4, low, high),
        }
    }

    /// Whether no disc inside another copy meets the disc inside the one that the dart would make; two
    /// such copies overlap, whatever their outlines are.
    fn is_free(&self, dart: &Dart) -> bool {
        let core = dart.element.core * dart.factor;
        self.near_copies
            .near(&Bounds::of([dart.at]))
            .into_iter()
            .all(|number| {
                let copy = &self.copies[number as usize];
                copy.core == 0.0 || copy.center.distance(dart.at) >= copy.core + core
            })
    }

    /// The moves by which a copy in a tile is repeated around it.
    fn repetitions(&self) -> Vec<Point> {
        let Some(period) = self.region.period else {
            return vec![Point::ORIGIN];
        };
        let steps = || [0.0, -1.0, 1.0].into_iter();
        steps()
            .flat_map(|i| steps().map(move |j| Point::new(i * period.x, j * period.y)))
            .collect()
    }

    fn fits(&self, copy: &Copy) -> bool {
        if self.region.period.is_none() {
            return self.is_inside(copy) && !self.meets_others(copy);
        }
        let moves = self.repetitions();
        !moves[1..]
            .iter()
            .any(|by| self.conflict(copy, &moved(copy, *by)))
            && !moves.iter().any(|by| self.meets_others(&moved(copy, *by)))
    }

    fn is_inside(&self, copy: &Copy) -> bool {
        budget::spend(WORK, 20 + copy.curves.points().len() as u64 / 2);
        let is_cut = |number: u32| {
            let border = self.border[number as usize];
            let is_near = Bounds::of(border).intersects(&copy.bounds);
            is_near && segments(&copy.curves).any(|s| touch(s, border, 0.0))
        };
        let begins_inside = |p: &Point| self.region.area.iter().any(|polygon| polygon.contains(*p));
        self.window.contains(copy.center)
            && copy
                .curves
                .iter()
                .filter_map(|c| c.points.first())
                .all(begins_inside)
            && !self.near_border.near(&copy.bounds).into_iter().any(is_cut)
    }

    fn meets_others(&self, copy: &Copy) -> bool {
        let near = self
            .near_copies
            .near(&copy.bounds.grown(self.properties.gap));
        near.into_iter()
            .any(|number| self.conflict(copy, &self.copies[number as usize]))
    }

    /// Whether two copies are too near to each other.
    fn conflict(&self, a: &Copy, b: &Copy) -> bool {
        let gap = self.properties.gap;
        // A little more than the sum of the radii, for rounding.
        let is_apart = a.center.distance(b.center) > (a.radius + b.radius) * (1.0 + 1e-9) + gap;
        if is_apart || !a.bounds.grown(gap).intersects(&b.bounds) {
            return false;
        }
        let near_b: Vec<Segment> = segments(&b.curves)
            .filter(|t| Bounds::of(*t).intersects(&a.bounds.grown(gap)))
            .collect();
        let points = [a, b].map(|copy| copy.curves.points().len());
        let work = (points[0] + points[1]) / 4 + points[0] * near_b.len() / 20;
        budget::spend(WORK, work as u64);
        let are_near = |s: Segment| {
            let reach = Bounds::of(s).grown(gap);
            near_b
                .iter()
                .any(|t| Bounds::of(*t).intersects(&reach) && touch(s, *t, gap))
        };
        segments(&a.curves).any(are_near)
            || holds(&a.curves, &b.curves)
            || holds(&b.curves, &a.curves)
    }

    fn keep(&mut self, copy: Copy) {
        for by in self.repetitions() {
            let repeated = moved(&copy, by);
            if repeated.bounds.intersects(&self.window) {
                self.near_copies
                    .insert(self.copies.len() as u32, &repeated.bounds);
                self.copies.push(repeated);
            }
        }
    }
}

fn moved(copy: &Copy, by: Point) -> Copy {
    let bounds = Bounds {
        min: copy.bounds.min + by,
        max: copy.bounds.max + by,
    };
    Copy {
        curves: copy.curves.transformed(&Affine::translation(by)),
        bounds,
        center: copy.center + by,
        radius: copy.radius,
        core: copy.core,
    }
}

/// Whether two segments meet or are nearer than `gap`.
fn touch(s: Segment, t: Segment, gap: f64) -> bool {
    let [p, q] = nearest(s, t);
    p == q || p.distance(q) < gap
}

/// Whether a curve of `inner` begins inside the closed curves of `outer`.
fn holds(outer: &Curves, inner: &Curves) -> bool {
    inner
        .iter()
        .filter_map(|curve| curve.points.first())
        .any(|p| encloses(outer, *p))
}

/// Whether `p` lies inside the closed curves (even-odd).
fn encloses(curves: &Curves, p: Point) -> bool {
    let closed = curves
        .iter()
        .filter(|c| c.points.first() == c.points.last());
    let crosses = |w: &[Point]| {
        let (a, b) = (w[0], w[1]);
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    };
    closed
        .map(|c| c.points.windows(2).filter(|w| crosses(w)).count())
        .sum::<usize>()
        % 2
        == 1
}

#[cfg(test)]
mod tests;
