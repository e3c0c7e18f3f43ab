use std::sync::Arc;

use super::*;
use crate::check::model_check::tests::cube;
use fretwork_geometry::mesh::{Body, Image};

fn png() -> Arc<[u8]> {
    let image = resvg::tiny_skia::Pixmap::new(2, 2).unwrap();
    image.encode_png().unwrap().into()
}

/// A cube in two places of one layer, one that is sheared, and one with a picture.
fn model() -> Model {
    let mut model = Model::of("base", cube(2.0));
    let tan = model.add_material(Material::of("tan", [0xd2, 0xb4, 0x8c]));
    model.images.push(Image {
        format: ImageFormat::Png,
        bytes: png(),
    });
    let photo = model.add_material(Material {
        image: Some(0),
        ..Material::of("photo", [255; 3])
    });
    model.parts[0].material = Some(tan);
    model.parts[0].group = Some("walls".into());
    let again = model.parts[0].clone();
    let moved = Affine3::translation(Point3::new(5.0, 1.0, 2.0));
    let turned = Affine3::rotation(Point3::new(0.0, 0.0, 1.0), 0.5).then(&moved);
    let sheared = Affine3 {
        y: Point3::new(0.5, 1.0, 0.0),
        ..moved
    };
    for (name, place) in [("moved", moved), ("turned", turned), ("sheared", sheared)] {
        model.parts.push(Part {
            name: name.into(),
            place,
            ..again.clone()
        });
    }
    let uv = vec![[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]; 12];
    let body = model.add_body(Body {
        uv: Some(uv),
        ..Body::plain(cube(1.0))
    });
    model.place("pictured", body, Affine3::IDENTITY).material = Some(photo);
    model
}

#[test]
fn a_foreign_reader_sees_the_same_scene() {
    let bytes = write(&model(), 10.0, None).unwrap();
    assert_eq!(bytes, write(&model(), 10.0, None).unwrap());
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = blob.unwrap();
    let names: Vec<_> = document
        .nodes()
        .map(|n| n.name().unwrap().to_string())
        .collect();
    assert_eq!(
        names,
        ["walls", "base", "moved", "turned", "sheared", "pictured"]
    );
    let scene = document.default_scene().unwrap();
    assert_eq!(scene.nodes().map(|n| n.index()).collect::<Vec<_>>(), [0, 5]);
    assert_eq!(
        (
            document.meshes().len(),
            document.materials().len(),
            document.images().len()
        ),
        (3, 2, 1)
    );
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for node in document.nodes().filter(|n| n.mesh().is_some()) {
        let matrix = node.transform().matrix();
        let mesh = node.mesh().unwrap();
        let reader = mesh.primitives().next().unwrap();
        let reader = reader.reader(|_| Some(&blob[..]));
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        assert_eq!(reader.read_normals().unwrap().len(), positions.len());
        assert_eq!(reader.read_indices().unwrap().into_u32().count(), 36);
        for p in positions {
            for i in 0..3 {
                let v =
                    matrix[0][i] * p[0] + matrix[1][i] * p[1] + matrix[2][i] * p[2] + matrix[3][i];
                low[i] = low[i].min(v);
                high[i] = high[i].max(v);
            }
        }
    }
    // In world units the box is that of the model; there y is up and z is toward the viewer.
    let bounds = model().bounds();
    let expected = [
        [bounds.min.x, bounds.min.z, -bounds.max.y],
        [bounds.max.x, bounds.max.z, -bounds.min.y],
    ];
    for i in 0..3 {
        assert!((f64::from(low[i]) - expected[0][i] / 100.0).abs() < 1e-6);
        assert!((f64::from(high[i]) - expected[1][i] / 100.0).abs() < 1e-6);
    }
}

#[test]
fn corners_are_split_only_at_creases() {
    let sharp = Vertices::of(&cube(1.0), None, 1.0);
    assert_eq!(sharp.positions.len(), 24);
    let mut octahedron = cube(1.0);
    octahedron.positions.iter_mut().for_each(|p| p.z *= 1e-3);
    assert!(Vertices::of(&octahedron, None, 1.0).positions.len() <= 24);
    assert_eq!(crate::srgb::linear(255), 1.0);
    assert!((crate::srgb::linear(128) - 0.21586).abs() < 1e-5);
}
