//! The shapes of a map's features as one region: rings nested to polygons, lines as edges, points as vertices. Files, tables
//! and what is wanted of them are read elsewhere.

use std::sync::Arc;

use fretwork_geometry::polygon::{AreaError, fill, of_faces, signed_area, unite};
use fretwork_geometry::{CurveLabels, Curves, FaceId, Feature, FillRule, LabelSet};
use fretwork_geometry::{PlanarMap, Polygon, Region, Ring, planar_map};
use fretwork_source::geo::Record;
use fretwork_source::geo::simple::{Unusual, unusual};

/// What features were made into so far.
#[derive(Default)]
pub struct Gathered {
    contour: Curves,
    features: Vec<Feature>,
    /// What is doubtful about them.
    pub warnings: Vec<String>,
}

impl Gathered {
    /// Adds a feature, which is called `name` in warnings.
    ///
    /// # Errors
    /// When its coordinates are out of range.
    pub fn add(&mut self, name: &str, record: &Record, labels: LabelSet) -> Result<(), AreaError> {
        for point in &record.points {
            self.contour.push_lone(*point, labels);
        }
        for line in &record.lines {
            self.contour
                .push(line.iter().copied(), CurveLabels::edge(labels));
        }
        let area = self.area(name, record)?;
        for ring in area.iter().flat_map(Polygon::rings) {
            let sides = CurveLabels {
                left: labels,
                ..CurveLabels::default()
            };
            self.contour
                .push(ring.iter().chain(ring.first()).copied(), sides);
        }
        if !area.is_empty() || !record.points.is_empty() {
            self.features.push(Feature {
                area,
                points: record.points.clone(),
                labels,
                attributes: record.attributes.clone(),
            });
        }
        Ok(())
    }

    /// What the rings of a feature enclose by even and odd.
    fn area(&mut self, name: &str, record: &Record) -> Result<Vec<Polygon>, AreaError> {
        let crossing = unusual(&record.rings);
        // What crosses itself may have areas that cancel one another.
        let is_ring = |ring: &&Ring| match crossing {
            Some(_) => !is_flat(ring),
            None => ring.len() > 2 && signed_area(ring) != 0.0,
        };
        let rings: Vec<Ring> = record.rings.iter().filter(is_ring).cloned().collect();
        if record.unclosed > 0 {
            let message = match record.unclosed {
                1 => format!("{name}: a ring of it does not end where it begins, and is closed"),
                n => {
                    format!("{name}: {n} of its rings do not end where they begin, and are closed")
                }
            };
            self.warnings.push(message);
        }
        let dropped = record.rings.len() - rings.len();
        if dropped > 0 {
            let message =
                format!("{name}: {dropped} of its rings enclose nothing and are left out");
            self.warnings.push(message);
        }
        if let Some(Unusual::Crossing(at)) = crossing {
            let message = format!(
                "{name} crosses itself at ({}, {}): it covers what its rings go round an odd number of times",
                at.x, at.y
            );
            self.warnings.push(message);
        }
        match crossing {
            None => Ok(nested(rings)),
            Some(_) => fill(&rings, FillRule::EvenOdd),
        }
    }

    /// The region of all that was added, whose table has these columns.
    ///
    /// # Errors
    /// When coordinates are out of range.
    pub fn region(self, columns: Vec<Arc<str>>) -> Result<Region, AreaError> {
        let areas = self
            .features
            .iter()
            .flat_map(|feature| feature.area.iter().cloned());
        let areas: Vec<Polygon> = areas.collect();
        let area = if !areas.is_empty() {
            unite(&areas)?
        } else if self.contour.is_empty() {
            Vec::new()
        } else {
            let resolution = planar_map::resolution(self.contour.bounds().longer_side());
            let map = PlanarMap::build(&self.contour, resolution)?;
            of_faces(&map, |face| face != FaceId::UNBOUNDED)
        };
        Ok(Region {
            contour: self.contour,
            features: self.features,
            columns,
            ..Region::of_area(area)
        })
    }
}

/// Whether all points of a ring lie on one line.
fn is_flat(ring: &Ring) -> bool {
    let Some((first, rest)) = ring.split_first() else {
        return true;
    };
    let along = rest.iter().map(|p| *p - *first).find(|d| d.length() > 0.0);
    along.is_none_or(|along| rest.iter().all(|p| along.cross(*p - *first) == 0.0))
}

/// Rings that do not cross, as polygons: those inside of an even number of others are outer rings, the others holes in the
/// smallest ring around them.
fn nested(rings: Vec<Ring>) -> Vec<Polygon> {
    let parts: Vec<Polygon> = rings
        .into_iter()
        .map(|mut ring| {
            if signed_area(&ring) < 0.0 {
                ring.reverse();
            }
            Polygon {
                outer: ring,
                holes: Vec::new(),
            }
        })
        .collect();
    let boxes: Vec<_> = parts.iter().map(Polygon::bounds).collect();
    // A side's middle lies on no other ring: sides that are shared were told apart before.
    let around = |i: usize| -> Vec<usize> {
        let middle = parts[i].outer[0].lerp(parts[i].outer[1], 0.5);
        let holds = |j: &usize| *j != i && boxes[*j].contains(middle) && parts[*j].contains(middle);
        (0..parts.len()).filter(holds).collect()
    };
    let around: Vec<Vec<usize>> = (0..parts.len()).map(around).collect();
    let mut polygons: Vec<Option<Polygon>> = parts
        .iter()
        .zip(&around)
        .map(|(part, around)| (around.len() % 2 == 0).then(|| part.clone()))
        .collect();
    for (part, around) in parts.iter().zip(&around) {
        // The ring directly around has one ring less around itself than this one.
        let owner = around
            .iter()
            .find(|j| self::depth(around, **j, &parts) + 1 == around.len());
        if around.len() % 2 == 1
            && let Some(Some(polygon)) = owner.map(|j| &mut polygons[*j])
        {
            let mut hole = part.outer.clone();
            hole.reverse();
            polygon.holes.push(hole);
        }
    }
    polygons.into_iter().flatten().collect()
}

/// How many of the rings `among` lie around ring `j`.
fn depth(among: &[usize], j: usize, parts: &[Polygon]) -> usize {
    let middle = parts[j].outer[0].lerp(parts[j].outer[1], 0.5);
    among
        .iter()
        .filter(|k| **k != j && parts[**k].contains(middle))
        .count()
}
