//! Nodes and their meshes.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Value as Json;

use super::super::limit::{MOST_TRIANGLES, Sibling};
use super::document::Document;
use super::place::{children, instances, places, roots};
use super::{accessor, material, pose};
use fretwork_geometry::Point3;
use fretwork_geometry::budget;
use fretwork_geometry::mesh::{Affine3, Body, Mesh, Model};

/// More parts than this are refused: a few bytes can ask for many.
const MOST_PARTS: usize = 1_000_000;
/// More corners than this in meshes that poses make anew are refused.
const MOST_POSED: usize = 20_000_000;
/// Bytes for a triangle with its share of corners, and steps for a part.
const TRIANGLE: usize = 48;
const PART_STEPS: u64 = 10;

/// The bodies and materials of the primitives of a mesh.
type Primitives = Arc<[(u32, Option<u32>)]>;

/// Collects the parts of a scene.
pub struct Reader<'a> {
    document: &'a Document,
    /// Where every node stands.
    places: Vec<Affine3>,
    model: Model,
    /// The meshes that are known, by their numbers and the weights of their targets.
    meshes: BTreeMap<(u64, Vec<u64>), Primitives>,
    materials: BTreeMap<u64, u32>,
    triangles: usize,
    posed: usize,
    /// Whether there are lines or points.
    has_lines: bool,
    /// How many triangles have named a corner twice.
    collapsed: usize,
}

/// How a node shows its mesh.
struct Pose {
    weights: Vec<f64>,
    joints: Option<Vec<Affine3>>,
}

impl<'a> Reader<'a> {
    /// A reader of the scene of `document`.
    ///
    /// # Errors
    /// When the nodes are no trees.
    pub fn new(document: &'a Document) -> Result<Reader<'a>, String> {
        Ok(Reader {
            document,
            places: places(document)?,
            model: Model::default(),
            meshes: BTreeMap::new(),
            materials: BTreeMap::new(),
            triangles: 0,
            posed: 0,
            has_lines: false,
            collapsed: 0,
        })
    }

    /// The parts of the default scene, or of all nodes where there is none, and what was not read.
    pub fn model(mut self, sibling: Sibling<'_>) -> Result<(Model, Vec<String>), String> {
        let mut waiting = roots(self.document)?;
        waiting.reverse();
        let mut seen = vec![false; self.places.len()];
        while let Some(number) = waiting.pop() {
            let node = self.document.item("nodes", &number)?;
            let index = number.as_u64().unwrap_or(0) as usize;
            if std::mem::replace(&mut seen[index], true) {
                return Err(format!("node {number} is in the scene twice"));
            }
            if node["extensions"]["KHR_node_visibility"]["visible"].as_bool() == Some(false) {
                continue;
            }
            let place = self.places[index];
            self.push(node, &place, sibling)?;
            waiting.extend(children(node).rev().cloned());
        }
        let lines = self
            .has_lines
            .then(|| "its lines and points are not read".into());
        let collapsed = (self.collapsed > 0).then(|| self.told_collapsed());
        Ok((self.model, lines.into_iter().chain(collapsed).collect()))
    }

    fn told_collapsed(&self) -> String {
        let (are, they) = match self.collapsed {
            1 => ("triangle names a corner twice", "it is"),
            _ => ("triangles name a corner twice", "they are"),
        };
        format!("{} {are}; {they} left out", self.collapsed)
    }

    /// Adds the parts of one node.
    fn push(&mut self, node: &Json, place: &Affine3, sibling: Sibling<'_>) -> Result<(), String> {
        if node["mesh"].is_null() {
            return Ok(());
        }
        let mesh = self.document.item("meshes", &node["mesh"])?;
        let joints = match &node["skin"] {
            Json::Null => None,
            skin => Some(pose::joints(self.document, skin, &self.places)?),
        };
        let pose = Pose {
            weights: pose::weights(node, mesh),
            joints,
        };
        let primitives =
            self.primitives(node["mesh"].as_u64().unwrap_or(0), mesh, &pose, sibling)?;
        let name = node["name"].as_str().or(mesh["name"].as_str());
        // Joints carry a skin to its place: that of its node does not count.
        let place = match pose.joints {
            Some(_) => &Affine3::IDENTITY,
            None => place,
        };
        let copies = instances(self.document, node)?.unwrap_or(vec![Affine3::IDENTITY]);
        for copy in &copies {
            let place = copy.then(place);
            if !place.is_finite() {
                return Err("an instance stands at no finite place".into());
            }
            for &(body, material) in primitives.iter() {
                self.triangles += self.model.bodies[body as usize].mesh.triangles.len();
                if self.triangles > MOST_TRIANGLES || self.model.parts.len() >= MOST_PARTS {
                    return Err(format!(
                        "it has more than {MOST_TRIANGLES} triangles or {MOST_PARTS} parts"
                    ));
                }
                budget::hold("triangles", self.triangles, TRIANGLE);
                budget::spend("parts", PART_STEPS);
                let part = self.model.place(name.unwrap_or("mesh"), body, place);
                part.material = material;
            }
        }
        Ok(())
    }

    /// The bodies of a mesh as it is posed.
    fn primitives(
        &mut self,
        number: u64,
        mesh: &Json,
        pose: &Pose,
        sibling: Sibling<'_>,
    ) -> Result<Primitives, String> {
        let weights = pose.weights.iter().map(|w| w.to_bits()).collect();
        let key = (number, weights);
        let known = self.meshes.get(&key).filter(|_| pose.joints.is_none());
        if let Some(known) = known {
            return Ok(known.clone());
        }
        let is_posed = pose.joints.is_some() || !pose.weights.is_empty();
        let list = mesh["primitives"].as_array().into_iter().flatten();
        let mut made = Vec::new();
        for primitive in list {
            let Some(body) = self.body(primitive, pose)? else {
                continue;
            };
            self.posed += if is_posed {
                body.mesh.positions.len()
            } else {
                0
            };
            if self.posed > MOST_POSED {
                return Err(format!("its poses have more than {MOST_POSED} corners"));
            }
            let material = self.material(primitive, sibling)?;
            made.push((self.model.add_body(body), material));
        }
        let made: Primitives = made.into();
        if pose.joints.is_none() {
            self.meshes.insert(key, made.clone());
        }
        Ok(made)
    }

    fn material(&mut self, primitive: &Json, sibling: Sibling<'_>) -> Result<Option<u32>, String> {
        let json = &primitive["material"];
        let Some(number) = json.as_u64() else {
            return Ok(None);
        };
        if let Some(known) = self.materials.get(&number) {
            return Ok(Some(*known));
        }
        let made = material::push(self.document, json, &mut self.model, sibling)?;
        self.materials.insert(number, made);
        Ok(Some(made))
    }

    /// The body of a primitive; none when it has no triangles.
    fn body(&mut self, primitive: &Json, pose: &Pose) -> Result<Option<Body>, String> {
        let mode = primitive["mode"].as_u64().unwrap_or(4);
        self.has_lines |= mode < 4;
        let places = &primitive["attributes"]["POSITION"];
        if !matches!(mode, 4..=6) || places.is_null() {
            return Ok(None);
        }
        let places = accessor::vectors::<3>(self.document, places)?;
        let mut positions: Vec<Point3> = places.into_iter().map(Point3::from).collect();
        let corners = match &primitive["indices"] {
            Json::Null => (0..positions.len() as u32).collect(),
            number => accessor::indices(self.document, number)?,
        };
        let count = positions.len();
        if let Some(corner) = corners.iter().find(|corner| **corner as usize >= count) {
            return Err(format!(
                "a triangle names vertex {corner}, and there are {count}"
            ));
        }
        let mut triangles = triangles(mode, &corners);
        let all = triangles.len();
        triangles.retain(|[a, b, c]| a != b && b != c && c != a);
        // Strips turn corners by such triangles, on purpose.
        if mode != STRIP {
            self.collapsed += all - triangles.len();
        }
        if triangles.is_empty() {
            return Ok(None);
        }
        let uv = self.uv(primitive, count, &triangles)?;
        pose::morph(self.document, primitive, &pose.weights, &mut positions)?;
        let mut mesh = Mesh {
            positions,
            triangles,
        };
        let mut uv = uv;
        if let Some(joints) = &pose.joints {
            let (carried, is_mirrored) =
                pose::skinned(self.document, primitive, joints, &mesh.positions)?;
            mesh.positions = carried;
            if is_mirrored {
                mesh = mesh.reversed();
                uv.iter_mut().flatten().for_each(|places| places.swap(1, 2));
            }
        }
        Ok(Some(Body {
            uv,
            ..Body::plain(mesh)
        }))
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

/// The mode of a strip of triangles.
const STRIP: u64 = 5;

/// The triangles of a list (4), a strip (5) or a fan (6).
fn triangles(mode: u64, corners: &[u32]) -> Vec<[u32; 3]> {
    let at = |i: usize| corners[i];
    let count = corners.len().saturating_sub(2);
    match mode {
        4 => corners
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect(),
        STRIP => (0..count)
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
