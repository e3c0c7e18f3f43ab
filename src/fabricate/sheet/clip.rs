//! What lies inside a region: lines cut at its border, areas intersected with it.

use super::layer::{Item, Layer, Sheet};
use super::lines::{self, cut, is_closed};
use super::slabs::{Edge, Slabs};
use fretwork_geometry::polygon::{AreaError, fill, intersect};
use fretwork_geometry::{Bounds, FillRule, Point, Polygon};

/// The sheet with only what lies in `region` or on its border. Lines stay lines; areas, and
/// closed lines on layers that are filled, become the areas of their intersection. The cost is
/// that of looking at the edges of the region near each segment in height.
pub fn clip(sheet: &Sheet, region: &[Polygon]) -> Result<Sheet, AreaError> {
    let bounds = Bounds::of(region.iter().flat_map(Polygon::rings).flatten().copied());
    let clipper = Clipper {
        slabs: Slabs::new(edges(region)),
        near: 1e-9 * bounds.longer_side(),
    };
    let layers = sheet.layers.iter().map(|layer| {
        let mut items = Vec::with_capacity(layer.items.len());
        for item in &layer.items {
            clip_item(item, layer, region, &clipper, &mut items)?;
        }
        Ok(layer.with(items))
    });
    Ok(sheet.with(layers.collect::<Result<_, AreaError>>()?))
}

fn clip_item(
    item: &Item,
    layer: &Layer,
    region: &[Polygon],
    clipper: &Clipper,
    out: &mut Vec<Item>,
) -> Result<(), AreaError> {
    let area = match item {
        Item::Area(polygon) => vec![polygon.clone()],
        Item::Line(points) if layer.style.fill.is_some() && is_closed(points) => {
            fill(std::slice::from_ref(points), FillRule::EvenOdd)?
        }
        Item::Line(points) => {
            out.extend(clipper.clip(points).into_iter().map(Item::Line));
            return Ok(());
        }
    };
    out.extend(intersect(&area, region)?.into_iter().map(Item::Area));
    Ok(())
}

fn edges(region: &[Polygon]) -> Vec<Edge> {
    let outlines = region.iter().flat_map(lines::rings);
    outlines
        .flat_map(|line| {
            line.windows(2)
                .map(|w| Edge {
                    a: w[0],
                    b: w[1],
                    outline: 0,
                })
                .collect::<Vec<_>>()
        })
        .collect()
}

struct Clipper {
    slabs: Slabs,
    /// What is nearer to the border than this is on it.
    near: f64,
}

impl Clipper {
    fn clip(&self, line: &[Point]) -> Vec<Vec<Point>> {
        let mut stops = Vec::new();
        cut(line, |a, b, parts| {
            self.stops(a, b, &mut stops);
            for t in stops.windows(2) {
                if self.has(a.lerp(b, 0.5 * (t[0] + t[1]))) {
                    let at = |t: f64| if t == 1.0 { b } else { a.lerp(b, t) };
                    parts.push((at(t[0]), at(t[1])));
                }
            }
        })
    }

    /// Where the segment from `a` to `b` meets the border, as shares of its length; 0 and 1 too.
    fn stops(&self, a: Point, b: Point, stops: &mut Vec<f64>) {
        let along = b - a;
        let length = along.length();
        let margin = self.near / length;
        stops.clear();
        let mut add = |t: f64| {
            if t > margin && t < 1.0 - margin {
                stops.push(t);
            }
        };
        for edge in self
            .slabs
            .between(a.y.min(b.y) - self.near, a.y.max(b.y) + self.near)
        {
            let side = |p: Point| along.cross(p - a) / length;
            let (p, q) = (side(edge.a), side(edge.b));
            if (p > 0.0) != (q > 0.0) {
                let crossing = edge.a.lerp(edge.b, p / (p - q));
                add((crossing - a).dot(along) / (length * length));
            }
            // An edge that runs along the segment begins and ends there without crossing it.
            for (end, distance) in [(edge.a, p), (edge.b, q)] {
                if distance.abs() <= self.near {
                    add((end - a).dot(along) / (length * length));
                }
            }
        }
        stops.extend([0.0, 1.0]);
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|t, before| *t - *before <= margin);
    }

    /// Whether `p` is inside or on the border.
    fn has(&self, p: Point) -> bool {
        self.slabs.contains(p)
            || self
                .slabs
                .between(p.y - self.near, p.y + self.near)
                .any(|e| distance(p, e) <= self.near)
    }
}

/// The distance of `p` from an edge.
fn distance(p: Point, edge: &Edge) -> f64 {
    let along = edge.b - edge.a;
    let square = along.dot(along);
    let t = if square > 0.0 {
        ((p - edge.a).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    p.distance(edge.a.lerp(edge.b, t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Role, Style};
    use fretwork_geometry::Seed;

    fn line(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|&p| p.into()).collect()
    }

    fn clipped(item: Item, style: Style, region: &[Polygon]) -> Vec<Item> {
        let layers = vec![Layer {
            name: "a".into(),
            role: Role::Draw,
            style,
            items: vec![item],
        }];
        clip(
            &Sheet {
                page: None,
                unit_mm: 1.0,
                layers,
            },
            region,
        )
        .unwrap()
        .layers
        .remove(0)
        .items
    }

    fn square() -> Polygon {
        Polygon {
            outer: line(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]),
            holes: vec![],
        }
    }

    #[test]
    fn lines_are_cut_at_the_border() {
        let outline = |points: &[[f64; 2]]| {
            clipped(Item::Line(line(points)), Style::outline(1.0), &[square()])
        };
        assert_eq!(
            outline(&[[-5.0, 5.0], [15.0, 5.0]]),
            [Item::Line(line(&[[0.0, 5.0], [10.0, 5.0]]))]
        );
        assert_eq!(
            outline(&[[5.0, 5.0], [6.0, 6.0]]),
            [Item::Line(line(&[[5.0, 5.0], [6.0, 6.0]]))]
        );
        assert_eq!(outline(&[[-5.0, -5.0], [-1.0, 15.0]]), []);
        let zigzag = outline(&[[5.0, 5.0], [15.0, 5.0], [15.0, 8.0], [5.0, 8.0]]);
        assert_eq!(
            zigzag,
            [
                Item::Line(line(&[[5.0, 5.0], [10.0, 5.0]])),
                Item::Line(line(&[[10.0, 8.0], [5.0, 8.0]]))
            ]
        );
    }

    #[test]
    fn what_runs_along_the_border_stays() {
        let outline = |points: &[[f64; 2]]| {
            clipped(Item::Line(line(points)), Style::outline(1.0), &[square()])
        };
        let border = [
            [0.0, 0.0],
            [10.0, 0.0],
            [10.0, 10.0],
            [0.0, 10.0],
            [0.0, 0.0],
        ];
        assert_eq!(outline(&border), [Item::Line(line(&border))]);
        assert_eq!(
            outline(&[[-5.0, 0.0], [15.0, 0.0]]),
            [Item::Line(line(&[[0.0, 0.0], [10.0, 0.0]]))]
        );
    }

    #[test]
    fn a_closed_line_that_begins_inside_stays_in_one_piece() {
        let ring = Item::Line(line(&[
            [5.0, 5.0],
            [15.0, 5.0],
            [15.0, 8.0],
            [5.0, 8.0],
            [5.0, 5.0],
        ]));
        let cut = clipped(ring.clone(), Style::outline(1.0), &[square()]);
        assert_eq!(
            cut,
            [Item::Line(line(&[
                [10.0, 8.0],
                [5.0, 8.0],
                [5.0, 5.0],
                [10.0, 5.0]
            ]))]
        );
        let style = Style {
            fill: Some(Default::default()),
            ..Style::outline(1.0)
        };
        let [Item::Area(area)] = &clipped(ring, style, &[square()])[..] else {
            panic!("one area")
        };
        assert_eq!(area.area(), 15.0);
    }

    #[test]
    fn the_length_kept_is_the_length_inside() {
        let mut frame = square();
        frame
            .holes
            .push(line(&[[4.0, 4.0], [4.0, 6.0], [6.0, 6.0], [6.0, 4.0]]));
        let seed = Seed::root(7);
        for i in 0..200 {
            let at = |k| {
                Point::new(
                    seed.number(i).range(k, -5.0, 15.0),
                    seed.number(i).range(k + 9, -5.0, 15.0),
                )
            };
            let (a, b) = (at(0), at(1));
            let kept: f64 = clipped(
                Item::Line(vec![a, b]),
                Style::outline(1.0),
                &[frame.clone()],
            )
            .iter()
            .map(|item| item.points().collect::<Vec<_>>())
            .map(|p| p[0].distance(p[p.len() - 1]))
            .sum();
            let n = 20_000;
            let inside = (0..n)
                .filter(|k| frame.contains(a.lerp(b, (*k as f64 + 0.5) / n as f64)))
                .count();
            let sampled = a.distance(b) * inside as f64 / n as f64;
            assert!(
                (kept - sampled).abs() < 0.01,
                "{a:?} {b:?}: {kept} {sampled}"
            );
        }
    }
}
