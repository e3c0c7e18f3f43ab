//! Positions as a node poses them: morph targets by their weights (glTF 2.0, section 3.7.2.2), then skins (section 3.7.3).

use serde_json::Value as Json;

use super::accessor;
use super::document::Document;
use super::place::matrix;
use fretwork_geometry::Point3;
use fretwork_geometry::mesh::Affine3;

/// The weights of a node's morph targets: its own, or those of its mesh.
pub fn weights(node: &Json, mesh: &Json) -> Vec<f64> {
    let list = node["weights"].as_array().or(mesh["weights"].as_array());
    let number = |w: &Json| w.as_f64().filter(|w| w.is_finite()).unwrap_or(0.0);
    list.into_iter().flatten().map(number).collect()
}

/// Moves `positions` by the targets of a primitive, each times its weight.
pub fn morph(
    document: &Document,
    primitive: &Json,
    weights: &[f64],
    positions: &mut [Point3],
) -> Result<(), String> {
    let targets = primitive["targets"].as_array().into_iter().flatten();
    for (target, &weight) in targets.zip(weights).filter(|(_, weight)| **weight != 0.0) {
        if target["POSITION"].is_null() {
            continue;
        }
        let moves = accessor::vectors::<3>(document, &target["POSITION"])?;
        if moves.len() != positions.len() {
            return Err("a morph target does not fit the vertices".into());
        }
        for (p, by) in positions.iter_mut().zip(moves) {
            *p = *p + Point3::from(by) * weight;
        }
    }
    Ok(())
}

/// The maps of a skin's joints, from the mesh at rest to where the joints stand.
pub fn joints(
    document: &Document,
    skin: &Json,
    places: &[Affine3],
) -> Result<Vec<Affine3>, String> {
    let skin = document.item("skins", skin)?;
    let joints = skin["joints"].as_array().map_or(&[][..], Vec::as_slice);
    let inverses = match &skin["inverseBindMatrices"] {
        Json::Null => None,
        number => Some(accessor::vectors::<16>(document, number)?),
    };
    let joint = |(i, number): (usize, &Json)| {
        let place = number.as_u64().and_then(|n| places.get(n as usize));
        let place = place.ok_or_else(|| format!("`nodes` has no item {number}"))?;
        match &inverses {
            None => Ok(*place),
            Some(all) => {
                let columns = all.get(i).ok_or("a skin has fewer matrices than joints")?;
                Ok(matrix(*columns).then(place))
            }
        }
    };
    joints.iter().enumerate().map(joint).collect()
}

/// The positions as the joints of a skin carry them, and whether the joints mirror most of them.
pub fn skinned(
    document: &Document,
    primitive: &Json,
    joints: &[Affine3],
    positions: &[Point3],
) -> Result<(Vec<Point3>, bool), String> {
    let mut blends = vec![Blend::default(); positions.len()];
    for set in 0.. {
        let attributes = &primitive["attributes"];
        let numbers = &attributes[format!("JOINTS_{set}")];
        let shares = &attributes[format!("WEIGHTS_{set}")];
        if numbers.is_null() || shares.is_null() {
            break;
        }
        let numbers = accessor::vectors::<4>(document, numbers)?;
        let shares = accessor::vectors::<4>(document, shares)?;
        if numbers.len() != positions.len() || shares.len() != positions.len() {
            return Err("joints and weights do not fit the vertices".into());
        }
        for (blend, (numbers, shares)) in blends.iter_mut().zip(numbers.iter().zip(&shares)) {
            for (number, share) in numbers.iter().zip(shares).filter(|(_, s)| **s != 0.0) {
                let joint = joints.get(*number as usize);
                let joint =
                    joint.ok_or_else(|| format!("a vertex names joint {number} of its skin"))?;
                blend.add(joint, *share);
            }
        }
    }
    let mut mirrored = 0;
    let mut carried = Vec::with_capacity(positions.len());
    for (p, blend) in positions.iter().zip(&blends) {
        let map = blend.map().ok_or("a vertex of a skin has no weights")?;
        mirrored += usize::from(map.determinant() < 0.0);
        carried.push(map.apply(*p));
    }
    Ok((carried, 2 * mirrored > positions.len()))
}

/// A weighted sum of maps.
#[derive(Clone, Copy, Default)]
struct Blend {
    columns: [[f64; 3]; 4],
    weight: f64,
}

impl Blend {
    fn add(&mut self, map: &Affine3, weight: f64) {
        let columns = [map.x, map.y, map.z, map.origin].map(<[f64; 3]>::from);
        for (sum, column) in self.columns.iter_mut().zip(columns) {
            (0..3).for_each(|i| sum[i] += weight * column[i]);
        }
        self.weight += weight;
    }

    /// The sum, divided by the weights, which quantization may leave beside 1.
    fn map(&self) -> Option<Affine3> {
        let weight = Some(self.weight).filter(|w| w.abs() > 1e-9 && w.is_finite())?;
        let column = |i: usize| Point3::from(self.columns[i].map(|v: f64| v / weight));
        Some(Affine3 {
            x: column(0),
            y: column(1),
            z: column(2),
            origin: column(3),
        })
    }
}
