//! What a file needs or uses beyond the core of glTF.

use super::document::Document;

/// Those that are read. Quantized positions are what `normalized` accessors are anyway.
const READ: [&str; 3] = [
    "EXT_mesh_gpu_instancing",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
];

/// The beginnings of those that change no shape: looks, lights, and remarks.
const WITHOUT_SHAPE: [&str; 12] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_audio",
    "KHR_animation_pointer",
    "KHR_node_selectability",
    "KHR_node_hoverability",
    "MSFT_texture_dds",
    "EXT_structural_metadata",
];

/// Warnings for extensions that could change the shape and are not read.
///
/// # Errors
/// When the file cannot be understood without one of those.
pub fn check(document: &Document) -> Result<Vec<String>, String> {
    let names = |list: &str| -> Vec<String> {
        let list = document.root[list].as_array().into_iter().flatten();
        list.map(|name| name.as_str().unwrap_or("").to_string())
            .filter(|name| !is_harmless(name))
            .collect()
    };
    if let Some(name) = names("extensionsRequired").first() {
        return Err(format!(
            "it needs the extension \"{name}\", which is not supported"
        ));
    }
    let told = names("extensionsUsed").into_iter();
    Ok(told
        .map(|name| format!("it uses the extension `{name}`, which is not read"))
        .collect())
}

fn is_harmless(name: &str) -> bool {
    READ.contains(&name) || WITHOUT_SHAPE.iter().any(|begin| name.starts_with(begin))
}
