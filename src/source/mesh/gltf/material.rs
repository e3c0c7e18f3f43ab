//! Colours and pictures.

use serde_json::Value as Json;

use super::super::limit::Sibling;
use super::document::{Document, content};
use crate::image;
use fretwork_geometry::mesh::{Image, ImageFormat, Material, Model};

/// Adds material `number` to `model` and gives its number there.
pub fn push(
    document: &Document,
    number: &Json,
    model: &mut Model,
    sibling: Sibling<'_>,
) -> Result<u32, String> {
    let json = document.item("materials", number)?;
    let surface = &json["pbrMetallicRoughness"];
    let factor = |value: &Json| {
        value
            .as_f64()
            .filter(|v| v.is_finite())
            .map(|v| v.clamp(0.0, 1.0))
            .unwrap_or(1.0)
    };
    let color = &surface["baseColorFactor"];
    let image = match &surface["baseColorTexture"]["index"] {
        Json::Null => None,
        texture => picture(document, texture, sibling)?.map(|image| {
            let known = model.images.iter().position(|i| *i == image);
            known.unwrap_or_else(|| {
                model.images.push(image);
                model.images.len() - 1
            }) as u32
        }),
    };
    let name = json["name"]
        .as_str()
        .map_or_else(|| format!("material {number}"), str::to_string);
    Ok(model.add_material(Material {
        name: name.into(),
        color: [0, 1, 2].map(|i| encoded(factor(&color[i]))),
        opacity: if json["alphaMode"].as_str() == Some("BLEND") {
            factor(&color[3])
        } else {
            1.0
        },
        metallic: factor(&surface["metallicFactor"]),
        roughness: factor(&surface["roughnessFactor"]),
        image,
    }))
}

/// The picture of a texture; none when it is in a format that is not known.
fn picture(
    document: &Document,
    texture: &Json,
    sibling: Sibling<'_>,
) -> Result<Option<Image>, String> {
    let texture = document.item("textures", texture)?;
    if texture["source"].is_null() {
        return Ok(None);
    }
    let image = document.item("images", &texture["source"])?;
    let bytes = match image["uri"].as_str() {
        Some(uri) => content(uri, sibling)?,
        None => document.view(&image["bufferView"])?.0.into(),
    };
    let format = match &bytes[..] {
        [0x89, b'P', b'N', b'G', ..] => ImageFormat::Png,
        [0xff, 0xd8, 0xff, ..] => ImageFormat::Jpeg,
        _ => return Ok(None),
    };
    image::check(&bytes).map_err(|e| format!("a texture cannot be used: {e}"))?;
    Ok(Some(Image { format, bytes }))
}

/// From linear light to an sRGB byte (IEC 61966-2-1).
fn encoded(linear: f64) -> u8 {
    let v = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    };
    (v * 255.0).round() as u8
}
