//! PNG: pictures of things in space, drawn on the CPU: orthographic, softly shaded, smooth at the edges. Pictures on
//! bodies are not shown, nor do things throw shadows.

mod camera;
mod raster;

use rayon::prelude::*;
use resvg::tiny_skia::{IntSize, Pixmap};

use self::camera::Camera;
use self::raster::{Band, Facet};
use crate::check::model_check::check;
use crate::sheet::Color;
use crate::srgb;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::corner_normals;
use fretwork_geometry::{Model, Point3};

/// The most pixels along a side.
const LONGEST: u32 = 8192;
/// Rows of pixels that are drawn together.
const BAND: u32 = 32;
/// Samples along each side of a pixel.
const SAMPLES: u32 = 3;
/// The cosine of the angle from which on two faces meet in a crease (30 degrees).
const CREASE: f64 = 0.866;
/// Colours of parts without a material, one after the other.
const PALETTE: [[u8; 3]; 6] = [
    [0xd9, 0xcd, 0xb8],
    [0x9c, 0xb4, 0xc0],
    [0xc8, 0x9f, 0x82],
    [0xa9, 0xb8, 0x96],
    [0xb9, 0xa5, 0xbd],
    [0xd8, 0xc4, 0x78],
];

/// How a picture is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// In pixels; the height follows from what is seen.
    pub width: u32,
    /// From the object to the viewer; its length does not matter.
    pub direction: Point3,
    /// What is seen beside the object; nothing where it is transparent.
    pub background: Option<Color>,
}

/// A picture of all parts. The same bytes for any number of threads.
///
/// # Errors
/// A model that [`check`] refuses, a direction that is none, an image without pixels or with more than 8192 along its width.
pub fn write(model: &Model, view: &View) -> Result<Vec<u8>, Diagnostic> {
    check(model, 1.0)?;
    if view.width == 0 || view.width > LONGEST {
        let message = format!("an image {} pixels wide cannot be made", view.width);
        return Err(Diagnostic::error(message).help("choose another `width`"));
    }
    let Some(direction) = view.direction.unit() else {
        return Err(Diagnostic::error("the view has no direction"));
    };
    let camera = Camera::new(model, direction, view.width);
    let facets = facets(model, &camera);
    let rows = (0..camera.height)
        .step_by(BAND as usize)
        .collect::<Vec<_>>();
    let bands = rows.into_par_iter().map(|row| {
        let mut band = Band::new(view.width, row, BAND.min(camera.height - row), SAMPLES);
        facets.iter().for_each(|facet| band.draw(facet, &camera));
        band.pixels(view.background)
    });
    let pixels: Vec<Vec<u8>> = bands.collect();
    let size = IntSize::from_wh(view.width, camera.height);
    let image = size.and_then(|size| Pixmap::from_vec(pixels.concat(), size));
    let image = image.ok_or_else(|| Diagnostic::error("the picture has no pixels"))?;
    image
        .encode_png()
        .map_err(|e| Diagnostic::error(format!("the picture cannot be written: {e}")))
}

/// The triangles of all parts as they are seen.
fn facets(model: &Model, camera: &Camera) -> Vec<Facet> {
    let mut facets = Vec::with_capacity(model.triangle_count());
    for (number, part) in model.parts.iter().enumerate() {
        let mesh = model.mesh(part);
        let color = match part.material {
            Some(material) => model.materials[material as usize].color,
            None => PALETTE[number % PALETTE.len()],
        };
        for (triangle, normals) in mesh.triangles.iter().zip(corner_normals(&mesh, CREASE)) {
            let corners = mesh.corners(*triangle).map(|p| camera.project(p));
            facets.push(Facet {
                corners,
                normals,
                color: color.map(|byte| srgb::linear(byte) as f32),
            });
        }
    }
    facets
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::model_check::tests::cube;
    use fretwork_geometry::Affine3;

    fn picture(model: &Model, direction: [f64; 3], background: Option<Color>) -> Pixmap {
        let view = View {
            width: 60,
            direction: direction.into(),
            background,
        };
        let bytes = write(model, &view).unwrap();
        assert_eq!(bytes, write(model, &view).unwrap());
        Pixmap::decode_png(&bytes).unwrap()
    }

    fn pixel(image: &Pixmap, x: u32, y: u32) -> [u8; 4] {
        let c = image.pixel(x, y).unwrap();
        [c.red(), c.green(), c.blue(), c.alpha()]
    }

    #[test]
    fn what_is_nearer_hides_what_is_farther() {
        // A red cube in front of a green one, seen along x and along -x.
        let mut model = Model::of("red", cube(1.0));
        for (part, color) in [[255, 0, 0], [0, 255, 0]].into_iter().enumerate() {
            let material = model.add_material(fretwork_geometry::mesh::Material::of("m", color));
            if part == 1 {
                model.place(
                    "green",
                    0,
                    Affine3::translation(Point3::new(-3.0, 0.0, 0.0)),
                );
            }
            model.parts[part].material = Some(material);
        }
        let front = pixel(&picture(&model, [1.0, 0.0, 0.0], None), 30, 30);
        let back = pixel(&picture(&model, [-1.0, 0.0, 0.0], None), 30, 30);
        assert!(
            front[0] > 100 && front[1] == 0 && front[3] == 255,
            "{front:?}"
        );
        assert!(back[1] > 100 && back[0] == 0, "{back:?}");
    }

    #[test]
    fn the_background_is_seen_beside_the_object() {
        let model = Model::of("cube", cube(1.0));
        let clear = picture(&model, [1.0, -1.0, 0.5], None);
        assert_eq!(pixel(&clear, 0, 0), [0; 4]);
        let white = picture(&model, [1.0, -1.0, 0.5], Some(Color([255; 3])));
        assert_eq!(pixel(&white, 0, 0), [255; 4]);
        let (width, height) = (white.width(), white.height());
        assert!(width == 60 && (50..90).contains(&height), "{height}");
        // Its three sides are lit differently.
        let sides = [(30, height / 4), (18, height * 5 / 8), (42, height * 5 / 8)]
            .map(|(x, y)| pixel(&white, x, y));
        assert!(
            sides[0] != sides[1] && sides[1] != sides[2] && sides[0] != sides[2],
            "{sides:?}"
        );
    }

    #[test]
    fn edges_are_smooth() {
        let model = Model::of("cube", cube(1.0));
        let image = picture(&model, [1.0, -1.0, 0.5], None);
        assert!(
            image
                .pixels()
                .iter()
                .any(|p| p.alpha() > 0 && p.alpha() < 255)
        );
    }

    #[test]
    fn impossible_views_are_refused() {
        let model = Model::of("cube", cube(1.0));
        let view = |width, direction: [f64; 3]| View {
            width,
            direction: direction.into(),
            background: None,
        };
        assert!(
            write(&model, &view(0, [1.0; 3])).is_err()
                && write(&model, &view(100_000, [1.0; 3])).is_err()
        );
        assert!(
            write(&model, &view(9, [0.0; 3])).is_err()
                && write(&Model::default(), &view(9, [1.0; 3])).is_err()
        );
        assert!(write(&model, &view(1, [0.0, 0.0, -1.0])).is_ok());
    }
}
