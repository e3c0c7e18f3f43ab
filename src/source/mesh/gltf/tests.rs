use std::sync::Arc;

use serde_json::{Value as Json, json};

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

/// The model of a file of which all is read.
fn model(json: &Json) -> Model {
    let (model, told) = read(json.to_string().as_bytes(), &mut alone).unwrap();
    assert_eq!(told, [""; 0]);
    model
}

fn error(change: impl FnOnce(&mut Json)) -> String {
    let mut json = triangle();
    change(&mut json);
    read(json.to_string().as_bytes(), &mut alone).unwrap_err()
}

#[test]
fn nodes_are_placed_and_z_is_up() {
    let model = model(&triangle());
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
    assert_eq!(
        read(ring.to_string().as_bytes(), &mut alone).unwrap_err(),
        "node 0 is its own ancestor"
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
    let corners = |json: &Json| model(json).bodies[0].mesh.positions.clone();
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
    assert_eq!(model(&strip).triangle_count(), 1);
    strip["meshes"][0]["primitives"][0]["mode"] = 1.into();
    let (lines, told) = read(strip.to_string().as_bytes(), &mut alone).unwrap();
    assert_eq!(lines.triangle_count(), 0);
    assert_eq!(told, ["its lines and points are not read"]);
}

/// A document whose only buffer holds these floats, each view of so many of them after the one before.
fn with_floats(mut json: Json, views: &[&[f32]]) -> Json {
    let bytes: Vec<u8> = views
        .iter()
        .flat_map(|view| view.iter())
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let mut at = 0;
    let place = |view: &&[f32]| {
        let (start, length) = (at, 4 * view.len());
        at += length;
        json!({ "buffer": 0, "byteOffset": start, "byteLength": length })
    };
    json["asset"] = json!({ "version": "2.0" });
    json["bufferViews"] = views.iter().map(place).collect();
    let uri = format!("data:application/octet-stream;base64,{}", base64(&bytes));
    json["buffers"] = json!([{ "byteLength": bytes.len(), "uri": uri }]);
    json
}

fn floats(view: usize, count: usize, kind: &str) -> Json {
    json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind })
}

const CORNERS: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];

/// The corners of the first part, where they stand.
fn places(json: &Json) -> Vec<[f64; 3]> {
    let model = model(json);
    let mesh = model.mesh(&model.parts[0]);
    mesh.positions
        .iter()
        .map(|p| <[f64; 3]>::from(*p))
        .collect()
}

#[test]
fn morph_targets_move_by_the_weights_of_the_node_or_the_mesh() {
    let moves = [0., 0., 0., 2., 0., 0., 0., 0., 0.];
    let json = with_floats(
        json!({
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "weights": [0.5], "primitives": [{
                "attributes": { "POSITION": 0 },
                "targets": [{ "POSITION": 1 }, { "NORMAL": 1 }]
            }] }],
            "accessors": [floats(0, 3, "VEC3"), floats(1, 3, "VEC3")],
        }),
        &[&CORNERS, &moves],
    );
    assert_eq!(places(&json)[1], [2.0, 0.0, 0.0]);
    let mut own = json.clone();
    own["nodes"][0]["weights"] = json!([2.0, 1.0]);
    assert_eq!(places(&own)[1], [5.0, 0.0, 0.0]);
    let mut both = json.clone();
    both["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "weights": [0] }, { "mesh": 0 }]);
    let model = model(&both);
    assert_eq!((model.bodies.len(), model.parts.len()), (2, 3));
}

#[test]
fn skins_stand_where_their_joints_carry_them() {
    let weights = [1., 0., 0., 0., 0.5, 0.5, 0., 0., 1., 0., 0., 0.];
    let joints = [0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0., 0.];
    // The second joint was bound at x = 1.
    let mut bind = [
        1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.,
    ]
    .repeat(2);
    bind[28] = -1.0;
    let json = with_floats(
        json!({
            "nodes": [
                { "mesh": 0, "skin": 0, "translation": [9, 9, 9] },
                { "scale": [3, 3, 3], "children": [2] },
                { "translation": [1, 0, 0] }
            ],
            "meshes": [{ "primitives": [{
                "attributes": { "POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2 }
            }] }],
            "skins": [{ "joints": [1, 2], "inverseBindMatrices": 3 }],
            "accessors": [
                floats(0, 3, "VEC3"), floats(1, 3, "VEC4"), floats(2, 3, "VEC4"), floats(3, 2, "MAT4")
            ],
        }),
        &[&CORNERS, &joints, &weights, &bind],
    );
    assert_eq!(places(&json), [[0., 0., 0.], [3., 0., 0.], [0., 0., 3.]]);
    let mut mirrored = json.clone();
    mirrored["nodes"][1]["scale"] = json!([-1, 1, 1]);
    assert_eq!(model(&mirrored).bodies[0].mesh.triangles, [[0, 2, 1]]);
    let wrong = |path: &str, value: Json| {
        let mut json = json.clone();
        *json.pointer_mut(path).unwrap() = value;
        read(json.to_string().as_bytes(), &mut alone).unwrap_err()
    };
    assert!(wrong("/skins/0/joints", json!([1, 7])).contains("`nodes` has no item 7"));
    assert!(wrong("/skins/0/joints", json!([1])).contains("names joint 1 of its skin"));
    assert!(wrong("/accessors/3/count", json!(1)).contains("fewer matrices"));
    assert!(wrong("/meshes/0/primitives/0/attributes/JOINTS_0", Json::Null).contains("no weights"));
}

#[test]
fn instances_are_parts() {
    let moves = [0., 0., 0., 5., 0., 0.];
    let json = with_floats(
        json!({
            "nodes": [{ "mesh": 0, "translation": [1, 0, 0], "extensions": {
                "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 1 } }
            } }],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "accessors": [floats(0, 3, "VEC3"), floats(1, 2, "VEC3")],
            "extensionsUsed": ["EXT_mesh_gpu_instancing"],
        }),
        &[&CORNERS, &moves],
    );
    let found = model(&json);
    let origins: Vec<f64> = found.parts.iter().map(|part| part.place.origin.x).collect();
    assert_eq!((found.bodies.len(), origins), (1, vec![1.0, 6.0]));
    let mut uneven = json.clone();
    let place = &mut uneven["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    place["SCALE"] = json!(0);
    let error = read(uneven.to_string().as_bytes(), &mut alone).unwrap_err();
    assert!(error.contains("differ in their lengths"), "{error}");
}

#[test]
fn what_is_not_read_is_told() {
    let told = |change: &dyn Fn(&mut Json)| {
        let mut json = triangle();
        change(&mut json);
        read(json.to_string().as_bytes(), &mut alone).unwrap()
    };
    let used = told(&|j| j["extensionsUsed"] = json!(["KHR_materials_unlit", "ACME_bend"]));
    assert_eq!(
        used.1,
        ["it uses the extension `ACME_bend`, which is not read"]
    );
    assert!(told(&|j| j["animations"] = json!([{}])).1[0].contains("posed as at rest"));
    let hidden = told(&|j| {
        j["nodes"][0]["extensions"] = json!({ "KHR_node_visibility": { "visible": false } });
    });
    assert_eq!(hidden.0.parts.len(), 0);
    let needed = told(&|j| j["extensionsRequired"] = json!(["KHR_mesh_quantization"]));
    assert_eq!(needed.0.parts.len(), 1);
}

#[test]
fn chunks_that_are_not_padded_are_read() {
    let mut json = triangle();
    json["buffers"][0].as_object_mut().unwrap().remove("uri");
    let mut bytes: Vec<u8> = CORNERS.iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0, 1, 2, 0]);
    let mut text = json.to_string();
    while text.len() % 4 != 1 {
        text.push(' ');
    }
    let file = |claimed: usize, padding: &str| {
        let mut file = b"glTF\x02\0\0\0".to_vec();
        let length = 28 + text.len() + padding.len() + bytes.len();
        file.extend((length as u32).to_le_bytes());
        file.extend((claimed as u32).to_le_bytes());
        file.extend(b"JSON");
        file.extend(text.as_bytes());
        file.extend(padding.as_bytes());
        file.extend((bytes.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(&bytes);
        read(&file, &mut alone).unwrap().0.triangle_count()
    };
    assert_eq!(file(text.len(), ""), 1);
    assert_eq!(file(text.len(), "   "), 1);
    assert_eq!(file(text.len() + 3, "   "), 1);
    assert_eq!(file(text.len() + 3, "\0\0\0"), 1);
}

/// A triangle that names a corner twice vanishes, which is told with how many there are; the others stay.
#[test]
fn triangles_that_name_a_corner_twice_are_counted() {
    let mut json = triangle();
    json["meshes"][0]["primitives"][0]["mode"] = json!(6);
    json["accessors"][1]["count"] = json!(4);
    let (model, told) = read(json.to_string().as_bytes(), &mut alone).unwrap();
    assert_eq!(model.triangle_count(), 1);
    assert_eq!(told, ["1 triangle names a corner twice; it is left out"]);
}
