//! GLB (glTF 2.0, binary), in metres and y up as the format has it: a node for each group and part,
//! bodies shared, physically based materials.

mod layout;
mod vertices;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::{Value as Json, json};

use self::layout::Layout;
use self::vertices::{Vertices, up};
use crate::check::model_check::check;
use crate::origin::Origin;
use crate::srgb;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::{Coloring, ImageFormat, Material, Part};
use fretwork_geometry::{Affine3, Model, Point3};

/// The scene with all parts, `unit_mm` millimetres to a unit. Parts of a group are children of a
/// node of its name.
///
/// # Errors
/// What [`check`] finds; more than four gigabytes.
pub fn write(model: &Model, unit_mm: f64, origin: Option<&Origin>) -> Result<Vec<u8>, Diagnostic> {
    check(model, unit_mm)?;
    let mut scene = Scene {
        model,
        unit: unit_mm / 1000.0,
        ..Scene::new(model)
    };
    let (nodes, roots) = scene.nodes();
    let mut root = json!({
        "asset": { "version": "2.0", "generator": "fretwork" },
        "scene": 0,
        "scenes": [{ "nodes": roots }],
        "nodes": nodes,
        "meshes": scene.meshes,
    });
    if let Some(origin) = origin {
        root["asset"]["extras"] = json!({ "origin": origin.json() });
    }
    if !scene.materials.is_empty() {
        root["materials"] = scene.materials.into();
    }
    if !scene.images.is_empty() {
        root["textures"] = (0..scene.images.len())
            .map(|source| json!({ "source": source }))
            .collect();
        root["images"] = scene.images.into();
    }
    scene
        .layout
        .finish(root)
        .ok_or_else(|| Diagnostic::error("the model is too large for a GLB file"))
}

/// A part in a body, with or without places on a picture.
type Shape = (u32, bool);

/// The lists of a file as they are filled, and where known things stand in them.
struct Scene<'a> {
    model: &'a Model,
    /// Metres to a unit.
    unit: f64,
    layout: Layout,
    meshes: Vec<Json>,
    materials: Vec<Json>,
    images: Vec<Json>,
    known_meshes: BTreeMap<(Shape, Option<u32>), usize>,
    known_shapes: BTreeMap<Shape, Json>,
    known_materials: BTreeMap<(u32, bool), usize>,
    known_images: BTreeMap<u32, usize>,
}

impl<'a> Scene<'a> {
    fn new(model: &'a Model) -> Scene<'a> {
        Scene {
            model,
            unit: 1.0,
            layout: Layout::default(),
            meshes: Vec::new(),
            materials: Vec::new(),
            images: Vec::new(),
            known_meshes: BTreeMap::new(),
            known_shapes: BTreeMap::new(),
            known_materials: BTreeMap::new(),
            known_images: BTreeMap::new(),
        }
    }

    /// All nodes, and the numbers of those at the top.
    fn nodes(&mut self) -> (Vec<Json>, Vec<usize>) {
        let mut nodes: Vec<Json> = Vec::new();
        let mut roots = Vec::new();
        let mut groups: BTreeMap<&Arc<str>, (usize, Vec<usize>)> = BTreeMap::new();
        for part in &self.model.parts {
            if let Some(group) = &part.group
                && !groups.contains_key(group)
            {
                groups.insert(group, (nodes.len(), Vec::new()));
                roots.push(nodes.len());
                nodes.push(json!({ "name": group }));
            }
            let number = nodes.len();
            nodes.push(self.node(part));
            match part.group.as_ref().and_then(|group| groups.get_mut(group)) {
                Some((_, children)) => children.push(number),
                None => roots.push(number),
            }
        }
        for (node, children) in groups.into_values() {
            nodes[node]["children"] = children.into();
        }
        (nodes, roots)
    }

    fn node(&mut self, part: &Part) -> Json {
        // A node may scale, turn and move, but not shear.
        if !part.place.is_square() {
            let mesh = self.baked(part);
            return json!({ "name": part.name, "mesh": mesh });
        }
        let mut node = json!({ "name": part.name, "mesh": self.mesh(part) });
        let place = &part.place;
        let axes = Affine3 {
            origin: Point3::ORIGIN,
            ..*place
        };
        if axes != Affine3::IDENTITY {
            let columns = [
                up(place.x),
                up(place.z),
                up(-place.y),
                up(place.origin) * self.unit,
            ];
            let matrix: Vec<f64> = columns
                .into_iter()
                .zip([0.0, 0.0, 0.0, 1.0])
                .flat_map(|(c, w)| [c.x, c.y, c.z, w].map(|v| v + 0.0))
                .collect();
            node["matrix"] = matrix.into();
        } else if place.origin != Point3::ORIGIN {
            let [x, y, z]: [f64; 3] = (up(place.origin) * self.unit).into();
            node["translation"] = json!([x + 0.0, y + 0.0, z + 0.0]);
        }
        node
    }

    /// The number of the mesh of a part's body in its material.
    fn mesh(&mut self, part: &Part) -> usize {
        let shape = (part.body, self.is_pictured(part));
        if let Some(known) = self.known_meshes.get(&(shape, part.material)) {
            return *known;
        }
        let mut primitive = match self.known_shapes.get(&shape) {
            Some(known) => known.clone(),
            None => {
                let body = &self.model.bodies[part.body as usize];
                let uv = body.uv.as_deref().filter(|_| shape.1);
                let primitive = self.layout.push_shape(
                    &Vertices::of(&body.mesh, uv, self.unit),
                    body.coloring.as_ref(),
                );
                self.known_shapes.insert(shape, primitive.clone());
                primitive
            }
        };
        self.dress(&mut primitive, part);
        self.known_meshes
            .insert((shape, part.material), self.meshes.len());
        self.push_mesh(part, primitive)
    }

    /// The number of a mesh of its own for a part, in its place.
    fn baked(&mut self, part: &Part) -> usize {
        let body = &self.model.bodies[part.body as usize];
        let mirrored = part.place.determinant() < 0.0;
        let turned = |uv: &[[f32; 2]; 3]| if mirrored { [uv[0], uv[2], uv[1]] } else { *uv };
        let uv: Option<Vec<_>> = body
            .uv
            .as_ref()
            .filter(|_| self.is_pictured(part))
            .map(|uv| uv.iter().map(turned).collect());
        let vertices = Vertices::of(&self.model.mesh(part), uv.as_deref(), self.unit);
        let mut primitive = self.layout.push_shape(&vertices, body.coloring.as_ref());
        self.dress(&mut primitive, part);
        self.push_mesh(part, primitive)
    }

    fn push_mesh(&mut self, part: &Part, primitive: Json) -> usize {
        let mut mesh = json!({ "name": part.name, "primitives": [primitive] });
        if let Some(coloring) = &self.model.bodies[part.body as usize].coloring {
            mesh["extras"] = legend(coloring);
        }
        self.meshes.push(mesh);
        self.meshes.len() - 1
    }

    /// Whether a part shows a picture.
    fn is_pictured(&self, part: &Part) -> bool {
        let image = part
            .material
            .and_then(|m| self.model.materials[m as usize].image);
        image.is_some() && self.model.bodies[part.body as usize].uv.is_some()
    }

    /// Gives a primitive its material.
    fn dress(&mut self, primitive: &mut Json, part: &Part) {
        let Some(number) = part.material else { return };
        let key = (number, self.is_pictured(part));
        if !self.known_materials.contains_key(&key) {
            let material = self.material(&self.model.materials[number as usize], key.1);
            self.known_materials.insert(key, self.materials.len());
            self.materials.push(material);
        }
        primitive["material"] = self.known_materials[&key].into();
    }

    fn material(&mut self, material: &Material, is_pictured: bool) -> Json {
        let [r, g, b] = material.color.map(srgb::linear);
        let mut surface = json!({
            "baseColorFactor": [r, g, b, material.opacity.clamp(0.0, 1.0)],
            "metallicFactor": material.metallic.clamp(0.0, 1.0),
            "roughnessFactor": material.roughness.clamp(0.0, 1.0),
        });
        if let Some(image) = material.image.filter(|_| is_pictured) {
            surface["baseColorTexture"] = json!({ "index": self.image(image) });
        }
        let mut json = json!({ "name": material.name, "pbrMetallicRoughness": surface });
        if material.opacity < 1.0 {
            json["alphaMode"] = "BLEND".into();
        }
        json
    }

    fn image(&mut self, number: u32) -> usize {
        if let Some(known) = self.known_images.get(&number) {
            return *known;
        }
        let image = &self.model.images[number as usize];
        let view = self.layout.push_view(&image.bytes, None);
        let format = match image.format {
            ImageFormat::Png => "image/png",
            ImageFormat::Jpeg => "image/jpeg",
        };
        self.known_images.insert(number, self.images.len());
        self.images
            .push(json!({ "bufferView": view, "mimeType": format }));
        self.images.len() - 1
    }
}

/// What the colours of a body mean.
fn legend(coloring: &Coloring) -> Json {
    let hex = |[r, g, b]: &[u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
    json!({
        "quantity": coloring.quantity,
        "unit": coloring.unit,
        "range": coloring.range,
        "scale": coloring.scale.iter().map(hex).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests;
