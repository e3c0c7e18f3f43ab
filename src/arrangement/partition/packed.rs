//! As many copies of elements as fit without overlap, by dart throwing (Loi 2015, figure 6.1).

use crate::distance::{Segment, nearest, project, segments};
use crate::error::ArrangementError;
use crate::partition::packed::places::Places;
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
    /// The point that the places for darts are anchored at, where that is not the corner of the region: then the copies are
    /// those of one packing of the plane.
    pub anchor: Option<Point>,
}

/// From one round of throwing to the next, copies get smaller by this factor at most.
const SHRINK: f64 = 0.85;

/// How far around a region the plane is packed, in extents of the largest copy with its gap. Whether a dart is taken depends on
/// what lies beyond only through chains of copies, each of which was thrown before the next one that it was in the way of;
/// such chains are hardly ever longer than three or four.
const AROUND: f64 = 8.0;

/// What is charged for.
const WORK: &str = "copies that may meet";

/// Places for darts along the extent of a copy, and darts for each before it is given up.
const PLACES: f64 = 4.0;
const DARTS: u64 = 12;

/// Copies inside `region`, none of which meets another or is nearer to it than the gap, or lies within
/// a closed curve of another. In a periodic tile they may cross its sides, and are repeated there. With an anchor, they are
/// those copies of a packing of the whole plane that come into the region, uncut: neighbouring regions have the same ones
/// across their common border. An anchor is without effect in a periodic tile.
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
    if region.bounds().is_empty() {
        return Ok(Curves::new());
    }
    let anchor = properties.anchor.filter(|_| region.period.is_none());
    let mut packing = Packing::new(properties, &elements, (region, anchor))?;
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
    let mut all = Curves::new();
    for copy in &packing.copies {
        if anchor.is_none() || packing.comes_into_region(copy) {
            all.append(&copy.curves);
        }
    }
    Ok(all)
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
    anchor: Option<Point>,
    border: Vec<Segment>,
    near_border: BucketGrid,
    copies: Vec<Copy>,
    near_copies: BucketGrid,
}

impl<'a> Packing<'a> {
    fn new(
        properties: &'a PackedProperties,
        elements: &'a [Element],
        (region, anchor): (&'a Region, Option<Point>),
    ) -> Result<Packing<'a>, ArrangementError> {
        let largest = elements.iter().map(|e| e.radius).fold(0.0, f64::max);
        let around = AROUND * (2.0 * largest * properties.scale[1] + properties.gap);
        let window = match anchor {
            Some(_) => region.bounds().grown(around),
            None => region.bounds(),
        };
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
        let extent = 2.0 * middle * largest;
        let near_copies = BucketGrid::empty(Squares::over(&window, extent + properties.gap));
        Ok(Packing {
            properties,
            elements,
            window,
            region,
            anchor,
            border,
            near_border,
            copies: Vec::new(),
            near_copies,
        })
    }

    /// The places for copies of this scale.
    fn places(&self, scale: f64) -> Result<Places, ArrangementError> {
        let smallest = self
            .elements
            .iter()
            .map(|e| e.radius)
            .fold(f64::INFINITY, f64::min);
        let side = 2.0 * smallest * scale / PLACES;
        Places::over(&self.window, side, self.anchor)
    }

    /// Throws copies with scales in `range` until no place takes one.
    fn throw_round(&mut self, range: [f64; 2], seed: Seed) -> Result<(), ArrangementError> {
        let all = self.places(range[0])?;
        let covered = self.covered(range[0], &all);
        let mut places: Vec<u64> = (0..all.count())
            .filter(|place| !covered[*place as usize])
            .collect();
        // Places in random order, so that copies do not grow from one corner.
        places.sort_by_cached_key(|place| all.order(seed, *place));
        let mut failures = vec![0u64; all.count() as usize];
        for dart in 0.. {
            places.retain(|place| failures[*place as usize] < DARTS);
            if places.is_empty() {
                return Ok(());
            }
            for &place in &places {
                let seed = all.seed(seed, place).number(dart);
                let at = all.at(place, seed.unit(0), seed.unit(1));
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
    fn covered(&self, scale: f64, places: &Places) -> Vec<bool> {
        let own = self
            .elements
            .iter()
            .map(|e| e.core)
            .fold(f64::INFINITY, f64::min)
            * scale;
        let mut covered = vec![false; places.count() as usize];
        for copy in self.copies.iter().filter(|copy| copy.core > 0.0) {
            let reach = copy.core + own;
            let margin = Point::new(reach, reach);
            let [columns, rows] = places.meeting(copy.center - margin, copy.center + margin);
            for row in rows[0]..=rows[1] {
                for column in columns[0]..=columns[1] {
                    let place = row * places.size[0] + column;
                    let middle = places.at(place, 0.5, 0.5);
                    // Half the diagonal of a place, and a little for rounding.
                    if middle.distance(copy.center) < reach - 0.708 * places.side {
                        covered[place as usize] = true;
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
        if self.anchor.is_some() {
            return !self.meets_others(copy);
        }
        if self.region.period.is_none() {
            return self.is_inside(copy) && !self.meets_others(copy);
        }
        let moves = self.repetitions();
        !moves[1..]
            .iter()
            .any(|by| self.conflict(copy, &moved(copy, *by)))
            && !moves.iter().any(|by| self.meets_others(&moved(copy, *by)))
    }

    /// Whether the border of the region cuts or touches a copy.
    fn is_cut(&self, copy: &Copy) -> bool {
        let is_cut = |number: u32| {
            let border = self.border[number as usize];
            let is_near = Bounds::of(border).intersects(&copy.bounds);
            is_near && segments(&copy.curves).any(|s| touch(s, border, 0.0))
        };
        self.near_border.near(&copy.bounds).into_iter().any(is_cut)
    }

    /// Whether some of a copy lies in the region.
    fn comes_into_region(&self, copy: &Copy) -> bool {
        let mut points = copy.curves.points().iter();
        let is_inside = |p: &Point| self.region.area.iter().any(|polygon| polygon.contains(*p));
        copy.bounds.intersects(&self.region.bounds())
            && (points.any(is_inside) || self.is_cut(copy))
    }

    fn is_inside(&self, copy: &Copy) -> bool {
        budget::spend(WORK, 20 + copy.curves.points().len() as u64 / 2);
        let begins_inside = |p: &Point| self.region.area.iter().any(|polygon| polygon.contains(*p));
        self.window.contains(copy.center)
            && copy
                .curves
                .iter()
                .filter_map(|c| c.points.first())
                .all(begins_inside)
            && !self.is_cut(copy)
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

mod places;

#[cfg(test)]
mod tests;
