//! The areas of drawings compared, layer by layer: what lies over something else is none the less seen to change.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::Amounts;
use fretwork_fabricate::{Item, Layer};
use fretwork_geometry::index::{BoxTree, Extent};
use fretwork_geometry::polygon::{AreaError, subtract, unite};
use fretwork_geometry::{Bounds, Polygon};

/// What differs.
#[derive(Clone, Debug, Default)]
pub struct Areas {
    /// What is only after.
    pub added: Vec<Polygon>,
    /// What was only before.
    pub removed: Vec<Polygon>,
    /// The area of what both have.
    pub common: f64,
}

impl Areas {
    /// The sizes, in squares of `unit`.
    pub fn amounts(&self, unit: &'static str) -> Amounts {
        Amounts {
            added: size(&self.added),
            removed: size(&self.removed),
            common: self.common,
            unit: match unit {
                "cm" => "cm2",
                "in" => "in2",
                "m" => "m2",
                _ => "mm2",
            },
        }
    }
}

fn size(areas: &[Polygon]) -> f64 {
    areas.iter().map(Polygon::area).sum()
}

/// The areas of layers of the same name compared; none where they cannot be computed.
pub fn compare(before: &[Layer], after: &[Layer]) -> Option<Areas> {
    let (before, after) = (by_layer(before), by_layer(after));
    let names: BTreeSet<_> = before.keys().chain(after.keys()).collect();
    let mut all = Areas::default();
    for name in names {
        let of = |layers: &BTreeMap<_, Vec<Polygon>>| layers.get(name).cloned().unwrap_or_default();
        let one = compare_areas(&of(&before), &of(&after)).ok()?;
        all.added.extend(one.added);
        all.removed.extend(one.removed);
        all.common += one.common;
    }
    Some(all)
}

fn by_layer(layers: &[Layer]) -> BTreeMap<Arc<str>, Vec<Polygon>> {
    let mut all: BTreeMap<_, Vec<Polygon>> = BTreeMap::new();
    for layer in layers {
        let areas = layer.items.iter().filter_map(|item| match item {
            Item::Area(area) => Some(area.clone()),
            Item::Line(_) => None,
        });
        let known = all.entry(layer.name.clone()).or_default();
        known.extend(areas);
    }
    all
}

/// Areas compared. Those of one side may overlap.
///
/// # Errors
/// When areas cannot be computed.
///
/// ```
/// use fretwork_difference::areas::compare_areas;
/// use fretwork_geometry::{Point, Region};
/// let square = |x: f64| Region::rectangle(Point::new(x, 0.0), Point::new(x + 2.0, 2.0)).area;
/// let found = compare_areas(&square(0.0), &square(0.5)).unwrap();
/// assert_eq!((found.added[0].area(), found.removed[0].area(), found.common), (1.0, 1.0, 3.0));
/// ```
pub fn compare_areas(before: &[Polygon], after: &[Polygon]) -> Result<Areas, AreaError> {
    let removed = less(before, after)?;
    let common = (size(&unite(before)?) - size(&removed)).max(0.0);
    Ok(Areas {
        added: less(after, before)?,
        removed,
        common,
    })
}

/// What is in `areas` and not in `other`. What both hold in the same corners is not looked at, and of the rest of `other` only
/// what is near: after a small change of a large drawing, little is left.
fn less(areas: &[Polygon], other: &[Polygon]) -> Result<Vec<Polygon>, AreaError> {
    let known: BTreeSet<Vec<u64>> = other.iter().map(key).collect();
    let fresh = areas.iter().filter(|area| !known.contains(&key(area)));
    let fresh: Vec<Polygon> = fresh.cloned().collect();
    if fresh.is_empty() {
        return Ok(fresh);
    }
    let extents: Vec<Extent<2>> = other.iter().map(|area| extent(&area.bounds())).collect();
    let tree = BoxTree::new(&extents);
    let near = fresh
        .iter()
        .flat_map(|area| tree.meeting(&extent(&area.bounds())));
    let near: BTreeSet<u32> = near.collect();
    let near: Vec<Polygon> = near.iter().map(|i| other[*i as usize].clone()).collect();
    subtract(&unite(&fresh)?, &unite(&near)?)
}

fn extent(bounds: &Bounds) -> Extent<2> {
    Extent {
        min: bounds.min.into(),
        max: bounds.max.into(),
    }
}

/// The corners in bits, by which equal polygons are found.
fn key(area: &Polygon) -> Vec<u64> {
    let ring = |ring: &Vec<fretwork_geometry::Point>| {
        let corners = ring.iter().flat_map(|p| [p.x.to_bits(), p.y.to_bits()]);
        [ring.len() as u64]
            .into_iter()
            .chain(corners)
            .collect::<Vec<_>>()
    };
    area.rings().flat_map(ring).collect()
}
