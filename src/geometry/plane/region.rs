//! The part of the plane that an arrangement is applied to.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::{Affine, Bounds, Curve, CurveLabels, Curves, LabelSet, Point, Polygon, Ring};

/// A region of the plane: what lies inside its polygons, and the labelled curves that bound it.
/// A face of a planar map is a region too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// The area; the polygons do not overlap.
    pub area: Vec<Polygon>,
    /// The boundary, with the region on the left of every curve: a rectangle has four curves, a
    /// face one per edge.
    pub contour: Curves,
    /// The size of a tile whose opposite sides join, when the region is one.
    pub period: Option<Point>,
    /// The tile that the region is a piece of, when it is a face in one.
    #[serde(skip)]
    pub within: Option<Tile>,
    /// The box of the whole that the region is a part of, where it is one: partitions are anchored and positions are
    /// rounded as on the whole.
    #[serde(skip)]
    pub whole: Option<Bounds>,
    /// What the region is put together of, where its parts carry attributes: the features of a map in the order of
    /// their file. Where they overlap the first one answers.
    pub features: Vec<Feature>,
    /// The columns of the features' table; none without a table.
    pub columns: Vec<Arc<str>>,
}

/// A part of a region, with what a table says of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Feature {
    /// What it covers; the polygons do not overlap.
    pub area: Vec<Polygon>,
    /// The points of it that stand alone.
    pub points: Vec<Point>,
    /// Its labels.
    pub labels: LabelSet,
    /// What the columns of the table hold, in their order; a column without a value for it is left out.
    pub attributes: Vec<(Arc<str>, Attribute)>,
}

impl Feature {
    /// What the table says in the column `name`.
    pub fn attribute(&self, name: &str) -> Option<&Attribute> {
        let found = self.attributes.iter().find(|(column, _)| &**column == name);
        found.map(|(_, value)| value)
    }
}

/// An entry of a table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Attribute {
    /// A whole number, which may have more digits than a float.
    Whole(i64),
    /// Another number.
    Number(f64),
    /// Yes or no, 1 or 0 as a number.
    Truth(bool),
    /// A text.
    Text(Arc<str>),
    /// A list or an object.
    Nested {
        /// As JSON.
        json: Arc<str>,
        /// The texts of a list of plain values; none of anything else.
        names: Vec<Arc<str>>,
    },
}

/// A rectangle whose opposite sides join: what is one period further is the same place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Its least corner.
    pub corner: Point,
    /// Its size.
    pub period: Point,
}

impl Tile {
    /// The place in the tile that `p` is.
    pub fn wrap(&self, p: Point) -> Point {
        let turn = |v: f64, from: f64, size: f64| v - ((v - from) / size).floor() * size;
        Point::new(
            turn(p.x, self.corner.x, self.period.x),
            turn(p.y, self.corner.y, self.period.y),
        )
    }
}

impl Region {
    /// The rectangle with these corners; four boundary curves, counter-clockwise (+x toward +y).
    pub fn rectangle(min: Point, max: Point) -> Region {
        let corners = [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)];
        let mut contour = Curves::new();
        for i in 0..4 {
            contour.push([corners[i], corners[(i + 1) % 4]], CurveLabels::default());
        }
        Region {
            area: vec![Polygon {
                outer: corners.to_vec(),
                holes: Vec::new(),
            }],
            contour,
            period: None,
            within: None,
            whole: None,
            features: Vec::new(),
            columns: Vec::new(),
        }
    }

    /// The region of `area`, one closed boundary curve per ring.
    pub fn of_area(area: Vec<Polygon>) -> Region {
        let mut contour = Curves::new();
        for ring in area.iter().flat_map(Polygon::rings) {
            contour.push(
                ring.iter().chain(ring.first()).copied(),
                CurveLabels::default(),
            );
        }
        Region {
            area,
            contour,
            period: None,
            within: None,
            whole: None,
            features: Vec::new(),
            columns: Vec::new(),
        }
    }

    /// Whether it has lines that are more than the outline of its area: those of a map.
    pub fn has_lines(&self) -> bool {
        let has_label = |curve: Curve<'_>| curve.labels.edge != LabelSet::EMPTY;
        !self.features.is_empty() || self.area.is_empty() || self.contour.iter().any(has_label)
    }

    /// The same region with `labels` on its inside.
    pub fn labelled(mut self, labels: LabelSet) -> Region {
        let mut contour = Curves::new();
        for curve in self.contour.iter() {
            contour.push(
                curve.points.iter().copied(),
                CurveLabels {
                    left: curve.labels.left.union(labels),
                    ..curve.labels
                },
            );
        }
        for (at, of_point) in self.contour.lone() {
            contour.push_lone(*at, *of_point);
        }
        self.contour = contour;
        self
    }

    /// The polygons by the labels that their borders have on the inside, in the order in which these first occur; those without
    /// labels, or with several sets of them, have none. O(n log n).
    pub fn by_labels(&self) -> Vec<(LabelSet, Vec<Polygon>)> {
        let key = |a: &Point, b: &Point| [a.x, a.y, b.x, b.y].map(f64::to_bits);
        let mut inside = BTreeMap::new();
        for curve in self.contour.iter().filter(|c| !c.labels.left.is_empty()) {
            let sides = curve.points.windows(2).map(|w| key(&w[0], &w[1]));
            inside.extend(sides.map(|side| (side, curve.labels.left)));
        }
        let mut parts: Vec<(LabelSet, Vec<Polygon>)> = Vec::new();
        for polygon in &self.area {
            let next = polygon.outer.iter().cycle().skip(1);
            let mut found = polygon
                .outer
                .iter()
                .zip(next)
                .map(|(a, b)| inside.get(&key(a, b)));
            let first = found.next().flatten();
            let labels = match first {
                Some(labels) if found.all(|other| other == first) => *labels,
                _ => LabelSet::EMPTY,
            };
            match parts.iter_mut().find(|(known, _)| *known == labels) {
                Some((_, polygons)) => polygons.push(polygon.clone()),
                None => parts.push((labels, vec![polygon.clone()])),
            }
        }
        parts
    }

    /// The image under `map`, still with the region on the left of its boundary; no longer a tile.
    pub fn transformed(&self, map: &Affine) -> Region {
        let is_mirrored = map.determinant() < 0.0;
        let ring = |ring: &Ring| -> Ring {
            let image = ring.iter().map(|p| map.apply(*p));
            if is_mirrored {
                image.rev().collect()
            } else {
                image.collect()
            }
        };
        let polygon = |p: &Polygon| Polygon {
            outer: ring(&p.outer),
            holes: p.holes.iter().map(ring).collect(),
        };
        let feature = |f: &Feature| Feature {
            area: f.area.iter().map(polygon).collect(),
            points: f.points.iter().map(|p| map.apply(*p)).collect(),
            ..f.clone()
        };
        let features = self.features.iter().map(feature).collect();
        let image = self.contour.transformed(map);
        let contour = if is_mirrored { image.reversed() } else { image };
        Region {
            area: self.area.iter().map(polygon).collect(),
            contour,
            period: None,
            within: None,
            whole: None,
            features,
            columns: self.columns.clone(),
        }
    }

    /// The tile that the region is, or is a piece of.
    pub fn tile(&self) -> Option<Tile> {
        self.period
            .map(|period| Tile {
                corner: self.bounds().min,
                period,
            })
            .or(self.within)
    }

    /// The box of the whole that the region is or is a part of.
    pub fn page(&self) -> Bounds {
        self.whole.unwrap_or_else(|| self.bounds())
    }

    /// The box of the area.
    pub fn bounds(&self) -> Bounds {
        self.area
            .iter()
            .fold(Bounds::EMPTY, |b, p| b.union(p.bounds()))
    }
}
