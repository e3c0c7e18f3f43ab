use std::sync::Arc;

use serde_json::json;

use super::*;
use fretwork_geometry::Point3;

fn alone(_: &str) -> Result<Arc<[u8]>, String> {
    Err("there is no other file".into())
}

/// A triangle as a list, under a node that is scaled, turned and moved.
fn triangle() -> Json {
    let mut bytes: Vec<u8> = [0f32, 0., 0., 1., 0., 0., 0., 2., 0.]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    bytes.extend([0, 1, 2, 0]);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    json!({
        "asset": { "version": "2.0" },
        "nodes": [
            { "children": [1], "translation": [0, 0, 10] },
            { "mesh": 0, "name": "blade", "scale": [2, 2, 2], "rotation": [0, half, 0, half] }
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
        "materials": [{ "name": "red", "pbrMetallicRoughness": { "baseColorFactor": [1, 0, 0, 1], "metallicFactor": 0 } }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
            { "bufferView": 0, "byteOffset": 36, "componentType": 5121, "count": 3, "type": "SCALAR" }
        ],
        "bufferViews": [{ "buffer": 0, "byteLength": 40 }],
        "buffers": [{ "byteLength": 40, "uri": format!("data:application/octet-stream;base64,{}", base64(&bytes)) }]
    })
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |g: &[u8]| {
        let bits = (0..3).fold(0u32, |b, i| {
            b << 8 | u32::from(g.get(i).copied().unwrap_or(0))
        });
        let digit = |i: usize| {
            if i > g.len() {
                '='
            } else {
                DIGITS[(bits >> (18 - 6 * i) & 63) as usize] as char
            }
        };
        (0..4).map(digit).collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}

fn error(change: impl FnOnce(&mut Json)) -> String {
    let mut json = triangle();
    change(&mut json);
    read(json.to_string().as_bytes(), &mut alone).unwrap_err()
}

#[test]
fn nodes_are_placed_and_z_is_up() {
    let model = read(triangle().to_string().as_bytes(), &mut alone).unwrap();
    let [part] = &model.parts[..] else {
        panic!("one part")
    };
    assert_eq!(
        (
            &*part.name,
            model.materials[0].color,
            model.materials[0].metallic
        ),
        ("blade", [255, 0, 0], 0.0)
    );
    let mesh = model.mesh(part);
    // x turns about y to -z of glTF, and that is y here; up is z.
    let expected = [
        Point3::new(0.0, -10.0, 0.0),
        Point3::new(0.0, -8.0, 0.0),
        Point3::new(0.0, -10.0, 4.0),
    ];
    for (p, q) in mesh.positions.iter().zip(expected) {
        assert!(p.distance(q) < 1e-12, "{p:?} {q:?}");
    }
}

#[test]
fn broken_files_are_told() {
    assert!(
        read(b"", &mut alone)
            .unwrap_err()
            .starts_with("its JSON is broken")
    );
    assert_eq!(
        read(b"{}", &mut alone).unwrap_err(),
        "it is no glTF file: it has no `asset.version`"
    );
    assert!(
        read(b"glTF\x02\0\0\0\xff\0\0\0", &mut alone)
            .unwrap_err()
            .starts_with("it is cut off")
    );
    let huge = error(|j| j["accessors"][0]["count"] = 4_000_000_000u64.into());
    assert_eq!(
        huge,
        "accessor 0 claims 4000000000 items, more than its buffer view has bytes for"
    );
    assert!(error(|j| j["accessors"][1]["byteOffset"] = u64::MAX.into()).contains("accessor 1"));
    assert!(
        error(|j| j["bufferViews"][0]["byteLength"] = 99.into()).contains("outside its buffer")
    );
    assert!(
        error(|j| j["buffers"][0]["byteLength"] = 99.into()).contains("claims 99 bytes and has 40")
    );
    assert!(error(|j| j["buffers"][0]["uri"] = "a.bin".into()).contains("no other file"));
    let none = |j: &mut Json| j["nodes"][1]["children"] = json!([0]);
    let mut ring = triangle();
    none(&mut ring);
    // Every node is another's child: there is no root.
    assert_eq!(
        read(ring.to_string().as_bytes(), &mut alone).map(|m| m.parts.len()),
        Ok(0)
    );
    assert!(error(|j| j["nodes"][0]["children"] = json!([1, 1])).contains("two parents"));
    assert!(error(|j| j["nodes"][1]["mesh"] = 5.into()).contains("`meshes` has no item 5"));
    assert!(
        error(|j| j["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]))
            .contains("KHR_draco")
    );
    assert!(error(|j| j["accessors"][0]["type"] = "VEC2".into()).contains("VEC3"));
}

#[test]
fn sparse_accessors_replace_some_of_their_items() {
    // Item 2 becomes the second vector of the buffer.
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": 0, "byteOffset": 38, "componentType": 5121 },
        "values": { "bufferView": 0, "byteOffset": 12 }
    });
    let mut dense = triangle();
    dense["accessors"][0]["sparse"] = sparse.clone();
    let corners = |json: &Json| {
        read(json.to_string().as_bytes(), &mut alone)
            .unwrap()
            .bodies[0]
            .mesh
            .positions
            .clone()
    };
    let [zero, one] = [Point3::ORIGIN, Point3::new(1.0, 0.0, 0.0)];
    assert_eq!(corners(&dense), [zero, one, one]);
    let mut empty = dense.clone();
    empty["accessors"][0]["bufferView"] = Json::Null;
    assert_eq!(corners(&empty), [zero, zero, one]);
    let wrong = |path: &str, value: Json| {
        error(|j| {
            j["accessors"][0]["sparse"] = sparse.clone();
            *j.pointer_mut(path).unwrap() = value;
        })
    };
    let mut far = dense.clone();
    far["accessors"][0]["count"] = 2.into();
    assert!(
        read(far.to_string().as_bytes(), &mut alone)
            .unwrap_err()
            .contains("does not have")
    );
    assert!(
        wrong("/accessors/0/sparse/indices/componentType", 5126.into()).contains("which items")
    );
    assert!(
        wrong("/accessors/0/sparse/count", 4_000_000_000u64.into()).contains("claims 4000000000")
    );
}

#[test]
fn strips_and_fans_are_lists() {
    let mut strip = triangle();
    strip["meshes"][0]["primitives"][0]["mode"] = 5.into();
    assert_eq!(
        read(strip.to_string().as_bytes(), &mut alone)
            .unwrap()
            .triangle_count(),
        1
    );
    strip["meshes"][0]["primitives"][0]["mode"] = 1.into();
    assert_eq!(
        read(strip.to_string().as_bytes(), &mut alone)
            .unwrap()
            .triangle_count(),
        0
    );
}
