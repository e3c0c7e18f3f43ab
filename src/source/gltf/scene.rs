//! Nodes and their meshes.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Value as Json;

use super::super::mesh::{MOST_TRIANGLES, Sibling};
use super::document::Document;
use super::{accessor, item, material};
use fretwork_geometry::Point3;
use fretwork_geometry::mesh::{Affine3, Body, Mesh, Model};

/// From y up to z up.
const UPRIGHT: Affine3 = Affine3 {
    x: Point3::new(1.0, 0.0, 0.0),
    y: Point3::new(0.0, 0.0, 1.0),
    z: Point3::new(0.0, -1.0, 0.0),
    origin: Point3::ORIGIN,
};

/// Collects the parts of a scene.
pub struct Reader<'a> {
    document: &'a Document,
    model: Model,
    /// Bodies and materials of the primitives of each mesh that is known.
    meshes: BTreeMap<u64, Arc<[(u32, Option<u32>)]>>,
    triangles: usize,
}

impl<'a> Reader<'a> {
    /// A reader of the scene of `document`.
    pub fn new(document: &'a Document) -> Reader<'a> {
        Reader {
            document,
            model: Model::default(),
            meshes: BTreeMap::new(),
            triangles: 0,
        }
    }

    /// The parts of the default scene, or of all nodes where there is none.
    pub fn model(mut self, sibling: Sibling<'_>) -> Result<Model, String> {
        let root = &self.document.root;
        let nodes = root["nodes"].as_array().map_or(0, Vec::len);
        let scene = if root["scene"].is_null() {
            &Json::from(0)
        } else {
            &root["scene"]
        };
        let roots: Vec<Json> = match root["scenes"].as_array() {
            Some(_) => item(self.document, "scenes", scene)?["nodes"]
                .as_array()
                .cloned()
                .unwrap_or_default(),
            None => (0..nodes)
                .filter(|n| !is_child(root, *n as u64))
                .map(Json::from)
                .collect(),
        };
        let mut waiting: Vec<(Json, Affine3)> = roots
            .into_iter()
            .rev()
            .map(|node| (node, UPRIGHT))
            .collect();
        let mut seen = vec![false; nodes];
        while let Some((number, place)) = waiting.pop() {
            let node = item(self.document, "nodes", &number)?;
            let slot = number.as_u64().and_then(|n| seen.get_mut(n as usize));
            if slot.is_none_or(|seen| std::mem::replace(seen, true)) {
                return Err(format!("node {number} has two parents, or is its own"));
            }
            let place = local(node).then(&place);
            if !place.is_finite() {
                return Err(format!("node {number} stands at no finite place"));
            }
            self.push(node, &place, sibling)?;
            let children = node["children"].as_array().into_iter().flatten();
            waiting.extend(children.rev().map(|child| (child.clone(), place)));
        }
        Ok(self.model)
    }

    /// Adds the parts of one node.
    fn push(&mut self, node: &Json, place: &Affine3, sibling: Sibling<'_>) -> Result<(), String> {
        let Some(number) = node["mesh"].as_u64() else {
            return Ok(());
        };
        let mesh = item(self.document, "meshes", &node["mesh"])?;
        let primitives = match self.meshes.get(&number) {
            Some(known) => known.clone(),
            None => {
                let list = mesh["primitives"].as_array().into_iter().flatten();
                let read = list
                    .map(|primitive| self.primitive(primitive, sibling))
                    .collect::<Result<Vec<_>, _>>()?;
                let read: Arc<[_]> = read.into_iter().flatten().collect();
                self.meshes.insert(number, read.clone());
                read
            }
        };
        let name = node["name"]
            .as_str()
            .or(mesh["name"].as_str())
            .unwrap_or("mesh");
        for &(body, material) in primitives.iter() {
            self.triangles += self.model.bodies[body as usize].mesh.triangles.len();
            if self.triangles > MOST_TRIANGLES {
                return Err(format!("it has more than {MOST_TRIANGLES} triangles"));
            }
            self.model.place(name, body, *place).material = material;
        }
        Ok(())
    }

    /// The body and the material of a primitive; none when it has no triangles.
    fn primitive(
        &mut self,
        primitive: &Json,
        sibling: Sibling<'_>,
    ) -> Result<Option<(u32, Option<u32>)>, String> {
        let mode = primitive["mode"].as_u64().unwrap_or(4);
        if !matches!(mode, 4..=6) || primitive["attributes"]["POSITION"].is_null() {
            return Ok(None);
        }
        let positions =
            accessor::vectors::<3>(self.document, &primitive["attributes"]["POSITION"])?;
        let positions: Vec<Point3> = positions.into_iter().map(Point3::from).collect();
        let corners = match &primitive["indices"] {
            Json::Null => (0..positions.len() as u32).collect(),
            number => accessor::indices(self.document, number)?,
        };
        if let Some(corner) = corners
            .iter()
            .find(|corner| **corner as usize >= positions.len())
        {
            return Err(format!(
                "a triangle names vertex {corner}, and there are {}",
                positions.len()
            ));
        }
        let mut triangles = triangles(mode, &corners);
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        if triangles.is_empty() {
            return Ok(None);
        }
        let uv = self.uv(primitive, positions.len(), &triangles)?;
        let material = match &primitive["material"] {
            Json::Null => None,
            number => Some(material::push(
                self.document,
                number,
                &mut self.model,
                sibling,
            )?),
        };
        Ok(Some((
            self.model.add_body(Body {
                mesh: Mesh {
                    positions,
                    triangles,
                },
                uv,
            }),
            material,
        )))
    }

    /// The places of the corners on a picture, where the primitive has them.
    fn uv(
        &self,
        primitive: &Json,
        count: usize,
        triangles: &[[u32; 3]],
    ) -> Result<Option<Vec<[[f32; 2]; 3]>>, String> {
        let number = &primitive["attributes"]["TEXCOORD_0"];
        if number.is_null() || primitive["material"].is_null() {
            return Ok(None);
        }
        let places = accessor::vectors::<2>(self.document, number)?;
        if places.len() != count || places.iter().flatten().any(|v| !v.is_finite()) {
            return Err("places on a picture do not fit the vertices".into());
        }
        let place = |corner: u32| places[corner as usize].map(|v| v as f32);
        Ok(Some(triangles.iter().map(|t| t.map(place)).collect()))
    }
}

fn is_child(root: &Json, node: u64) -> bool {
    let nodes = root["nodes"].as_array().into_iter().flatten();
    nodes
        .flat_map(|n| n["children"].as_array().into_iter().flatten())
        .any(|child| child.as_u64() == Some(node))
}

/// The triangles of a list (4), a strip (5) or a fan (6).
fn triangles(mode: u64, corners: &[u32]) -> Vec<[u32; 3]> {
    let at = |i: usize| corners[i];
    let count = corners.len().saturating_sub(2);
    match mode {
        4 => corners
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect(),
        5 => (0..count)
            .map(|i| {
                if i % 2 == 0 {
                    [at(i), at(i + 1), at(i + 2)]
                } else {
                    [at(i + 1), at(i), at(i + 2)]
                }
            })
            .collect(),
        _ => (0..count).map(|i| [at(0), at(i + 1), at(i + 2)]).collect(),
    }
}

/// The place of a node in its parent.
fn local(node: &Json) -> Affine3 {
    let number = |value: &Json, default: f64| value.as_f64().unwrap_or(default);
    if let Some(matrix) = node["matrix"].as_array() {
        let column = |i: usize| {
            Point3::new(
                number(&matrix[i], 0.0),
                number(&matrix[i + 1], 0.0),
                number(&matrix[i + 2], 0.0),
            )
        };
        if matrix.len() == 16 {
            return Affine3 {
                x: column(0),
                y: column(4),
                z: column(8),
                origin: column(12),
            };
        }
    }
    let vector = |name: &str, default: f64| {
        Point3::new(
            number(&node[name][0], default),
            number(&node[name][1], default),
            number(&node[name][2], default),
        )
    };
    let scaled = Affine3::scale(vector("scale", 1.0));
    scaled
        .then(&turn(&node["rotation"]))
        .then(&Affine3::translation(vector("translation", 0.0)))
}

/// The rotation of a unit quaternion (x, y, z, w).
fn turn(json: &Json) -> Affine3 {
    let q = [0, 1, 2, 3].map(|i| json[i].as_f64().unwrap_or(if i == 3 { 1.0 } else { 0.0 }));
    let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return Affine3::IDENTITY;
    }
    let [x, y, z, w] = q.map(|v| v / length);
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
