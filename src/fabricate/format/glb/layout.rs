//! The binary chunk of a GLB and the views into it.

use serde_json::{Value as Json, json};

use super::vertices::Vertices;
use crate::srgb;
use fretwork_geometry::mesh::Coloring;

const ARRAY: u32 = 34962;
const ELEMENTS: u32 = 34963;
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;

/// Bytes, and what they are.
#[derive(Default)]
pub struct Layout {
    bytes: Vec<u8>,
    views: Vec<Json>,
    accessors: Vec<Json>,
}

impl Layout {
    /// Adds bytes and gives the number of their view.
    pub fn push_view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Adds the vertices of a shape and gives its primitive, without a material.
    pub fn push_shape(&mut self, shape: &Vertices, coloring: Option<&Coloring>) -> Json {
        let mut attributes = json!({
            "POSITION": self.push_floats(&shape.positions, true),
            "NORMAL": self.push_floats(&shape.normals, false),
        });
        if let Some(uv) = &shape.uv {
            attributes["TEXCOORD_0"] = self.push_floats(uv, false).into();
        }
        if let Some(coloring) = coloring {
            let colors: Vec<[f32; 3]> = shape
                .corners
                .iter()
                .map(|corner| coloring.corners[*corner as usize].map(|b| srgb::linear(b) as f32))
                .collect();
            attributes["COLOR_0"] = self.push_floats(&colors, false).into();
        }
        let is_short = shape.positions.len() < usize::from(u16::MAX);
        let indices = shape.indices.iter();
        let bytes: Vec<u8> = if is_short {
            indices.flat_map(|i| (*i as u16).to_le_bytes()).collect()
        } else {
            indices.flat_map(|i| i.to_le_bytes()).collect()
        };
        let view = self.push_view(&bytes, Some(ELEMENTS));
        let kind = if is_short {
            UNSIGNED_SHORT
        } else {
            UNSIGNED_INT
        };
        let accessor = json!({
            "bufferView": view, "componentType": kind, "count": shape.indices.len(), "type": "SCALAR"
        });
        json!({ "attributes": attributes, "indices": self.push_accessor(accessor) })
    }

    fn push_floats<const N: usize>(&mut self, values: &[[f32; N]], has_bounds: bool) -> usize {
        let bytes: Vec<u8> = values
            .iter()
            .flatten()
            .flat_map(|v| v.to_le_bytes())
            .collect();
        let view = self.push_view(&bytes, Some(ARRAY));
        let kind = if N == 2 { "VEC2" } else { "VEC3" };
        let mut accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind });
        if has_bounds {
            let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N)
                    .map(|i| values.iter().map(|v| v[i]).reduce(pick).unwrap_or_default())
                    .collect()
            };
            accessor["min"] = bound(f32::min).into();
            accessor["max"] = bound(f32::max).into();
        }
        self.push_accessor(accessor)
    }

    fn push_accessor(&mut self, accessor: Json) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The file: the description `root` with its lists of views, and the bytes. None beyond four
    /// gigabytes.
    pub fn finish(mut self, mut root: Json) -> Option<Vec<u8>> {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        root["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        root["bufferViews"] = self.views.into();
        root["accessors"] = self.accessors.into();
        let mut text = serde_json::to_vec(&root).expect("a JSON value can be written");
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = u32::try_from(28 + text.len() + self.bytes.len()).ok()?;
        let mut out = Vec::with_capacity(length as usize);
        for word in [0x4654_6C67, 2, length, text.len() as u32, 0x4E4F_534A] {
            out.extend(u32::to_le_bytes(word));
        }
        out.extend(text);
        for word in [self.bytes.len() as u32, 0x004E_4942] {
            out.extend(u32::to_le_bytes(word));
        }
        out.extend(self.bytes);
        Some(out)
    }
}
