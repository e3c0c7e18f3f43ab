//! The materials of Wavefront OBJ files: colours and how much shows through. Pictures and how light is reflected are not read.

use super::lines::{Lines, unmarked};
use fretwork_geometry::mesh::Material;

/// A material without a colour of its own.
const PLAIN: [u8; 3] = [204, 204, 204];

/// The materials in the bytes of a library, in order. A colour is taken as it is shown, from 0 to 1.
///
/// # Errors
/// Text that cannot be read at all.
pub fn read(bytes: &[u8]) -> Result<Vec<Material>, String> {
    let mut materials: Vec<Material> = Vec::new();
    for (_, line) in Lines::new(unmarked(bytes)?, 0) {
        let text = String::from_utf8_lossy(line);
        let content = text.split('#').next().unwrap_or("").trim();
        let (word, rest) = content
            .split_once(char::is_whitespace)
            .unwrap_or((content, ""));
        if word == "newmtl" {
            materials.push(Material::of(rest.trim(), PLAIN));
            continue;
        }
        let Some(material) = materials.last_mut() else {
            continue;
        };
        let numbers: Vec<f64> = rest
            .split_ascii_whitespace()
            .map_while(|word| word.parse().ok())
            .filter(|v: &f64| v.is_finite())
            .map(|v| v.clamp(0.0, 1.0))
            .collect();
        match (word, &numbers[..]) {
            // One number stands for all three.
            ("Kd", [v]) => material.color = [shown(*v); 3],
            ("Kd", [r, g, b, ..]) => material.color = [*r, *g, *b].map(shown),
            ("d", [v, ..]) => material.opacity = *v,
            ("Tr", [v, ..]) => material.opacity = 1.0 - v,
            ("Pm", [v, ..]) => material.metallic = *v,
            ("Pr", [v, ..]) => material.roughness = *v,
            _ => {}
        }
    }
    Ok(materials)
}

fn shown(part: f64) -> u8 {
    (part * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_and_all_else_is_passed_over() {
        let text = "# made by hand\nKd 1 1 1\nnewmtl dark red\nNs 96\nKd 0.5 0 0\nd 0.25\nmap_Kd a.png\n\nnewmtl grey\nKd 0.2\nTr 0.5\nPm 1\nPr 0.1\nKs x\n";
        let found = read(text.as_bytes()).unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!((&*found[0].name, found[0].color), ("dark red", [128, 0, 0]));
        assert_eq!((found[0].opacity, found[1].opacity), (0.25, 0.5));
        assert_eq!((found[1].color, found[1].metallic), ([51; 3], 1.0));
        assert_eq!(found[1].roughness, 0.1);
    }
}
