//! The places of nodes.

use serde_json::Value as Json;

use super::accessor;
use super::document::Document;
use fretwork_geometry::Point3;
use fretwork_geometry::mesh::Affine3;

/// From y up to z up.
const UPRIGHT: Affine3 = Affine3 {
    x: Point3::new(1.0, 0.0, 0.0),
    y: Point3::new(0.0, 0.0, 1.0),
    z: Point3::new(0.0, -1.0, 0.0),
    origin: Point3::ORIGIN,
};

/// Where every node stands, z up.
///
/// # Errors
/// When a node has two parents or is its own, or stands at no finite place.
pub fn places(document: &Document) -> Result<Vec<Affine3>, String> {
    let empty = Vec::new();
    let nodes = document.root["nodes"].as_array().unwrap_or(&empty);
    let mut is_child = vec![false; nodes.len()];
    for child in nodes.iter().flat_map(children) {
        document.item("nodes", child)?;
        let slot = child.as_u64().and_then(|n| is_child.get_mut(n as usize));
        if slot.is_none_or(|seen| std::mem::replace(seen, true)) {
            return Err(format!("node {child} has two parents"));
        }
    }
    let mut places = vec![None; nodes.len()];
    let roots = (0..nodes.len()).filter(|n| !is_child[*n]);
    let mut waiting: Vec<(usize, Affine3)> = roots.map(|n| (n, UPRIGHT)).collect();
    while let Some((number, parent)) = waiting.pop() {
        let place = local(&nodes[number]).then(&parent);
        if !place.is_finite() {
            return Err(format!("node {number} stands at no finite place"));
        }
        places[number] = Some(place);
        let inner = children(&nodes[number]).filter_map(Json::as_u64);
        waiting.extend(inner.map(|n| (n as usize, place)));
    }
    let own_parent = places.iter().position(Option::is_none);
    match own_parent {
        Some(number) => Err(format!("node {number} is its own ancestor")),
        None => Ok(places.into_iter().flatten().collect()),
    }
}

/// The numbers of a node's children.
pub fn children(node: &Json) -> impl DoubleEndedIterator<Item = &Json> {
    node["children"].as_array().into_iter().flatten()
}

/// The nodes of the default scene, outermost only; those that are no children where there is no scene.
pub fn roots(document: &Document) -> Result<Vec<Json>, String> {
    let root = &document.root;
    if root["scenes"].is_array() {
        let first = Json::from(0);
        let scene = match &root["scene"] {
            Json::Null => &first,
            number => number,
        };
        let nodes = document.item("scenes", scene)?["nodes"].as_array();
        return Ok(nodes.cloned().unwrap_or_default());
    }
    let empty = Vec::new();
    let nodes = root["nodes"].as_array().unwrap_or(&empty);
    let mut is_child = vec![false; nodes.len()];
    for child in nodes.iter().flat_map(children).filter_map(Json::as_u64) {
        if let Some(slot) = is_child.get_mut(child as usize) {
            *slot = true;
        }
    }
    Ok((0..nodes.len())
        .filter(|n| !is_child[*n])
        .map(Json::from)
        .collect())
}

/// The places of a node's instances within it (`EXT_mesh_gpu_instancing`); none when it has no such.
pub fn instances(document: &Document, node: &Json) -> Result<Option<Vec<Affine3>>, String> {
    let attributes = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    if attributes.is_null() {
        return Ok(None);
    }
    let moved = vectors::<3>(document, &attributes["TRANSLATION"])?;
    let turned = vectors::<4>(document, &attributes["ROTATION"])?;
    let scaled = vectors::<3>(document, &attributes["SCALE"])?;
    let lengths = [
        moved.as_ref().map(Vec::len),
        turned.as_ref().map(Vec::len),
        scaled.as_ref().map(Vec::len),
    ];
    let count = lengths.into_iter().flatten().next().unwrap_or(0);
    if lengths.into_iter().flatten().any(|length| length != count) {
        return Err("the lists of a node's instances differ in their lengths".into());
    }
    let at = |i: usize| {
        let scale = scaled.as_ref().map_or([1.0; 3], |all| all[i]);
        let turn = turned.as_ref().map_or([0.0, 0.0, 0.0, 1.0], |all| all[i]);
        let origin = moved.as_ref().map_or([0.0; 3], |all| all[i]);
        Affine3::scale(scale.into())
            .then(&rotation(turn))
            .then(&Affine3::translation(origin.into()))
    };
    Ok(Some((0..count).map(at).collect()))
}

fn vectors<const N: usize>(
    document: &Document,
    number: &Json,
) -> Result<Option<Vec<[f64; N]>>, String> {
    match number {
        Json::Null => Ok(None),
        number => accessor::vectors::<N>(document, number).map(Some),
    }
}

/// The place of a node in its parent.
fn local(node: &Json) -> Affine3 {
    let number = |value: &Json, default: f64| value.as_f64().unwrap_or(default);
    if let Some(columns) = node["matrix"].as_array().filter(|m| m.len() == 16) {
        return matrix(std::array::from_fn(|i| number(&columns[i], 0.0)));
    }
    let vector = |name: &str, default: f64| {
        Point3::new(
            number(&node[name][0], default),
            number(&node[name][1], default),
            number(&node[name][2], default),
        )
    };
    let quaternion =
        [0, 1, 2, 3].map(|i| number(&node["rotation"][i], if i == 3 { 1.0 } else { 0.0 }));
    Affine3::scale(vector("scale", 1.0))
        .then(&rotation(quaternion))
        .then(&Affine3::translation(vector("translation", 0.0)))
}

/// The map with these columns, each of four numbers of which the last is left out.
pub fn matrix(columns: [f64; 16]) -> Affine3 {
    let column = |i: usize| Point3::new(columns[i], columns[i + 1], columns[i + 2]);
    Affine3 {
        x: column(0),
        y: column(4),
        z: column(8),
        origin: column(12),
    }
}

/// The rotation of a quaternion (x, y, z, w), which is scaled to unit length.
fn rotation(quaternion: [f64; 4]) -> Affine3 {
    let length = quaternion.iter().map(|v| v * v).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return Affine3::IDENTITY;
    }
    let [x, y, z, w] = quaternion.map(|v| v / length);
    Affine3 {
        x: Point3::new(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y + z * w),
            2.0 * (x * z - y * w),
        ),
        y: Point3::new(
            2.0 * (x * y - z * w),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z + x * w),
        ),
        z: Point3::new(
            2.0 * (x * z + y * w),
            2.0 * (y * z - x * w),
            1.0 - 2.0 * (x * x + y * y),
        ),
        origin: Point3::ORIGIN,
    }
}
