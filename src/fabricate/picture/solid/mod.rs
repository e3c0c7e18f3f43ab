//! PNG: pictures of things in space, drawn on the CPU: orthographic, softly shaded, with lines
//! where faces meet or end, darker in hollows, smooth at the edges. Pictures on bodies are not
//! shown, nor do things throw shadows on one another.

mod camera;
mod obscurance;
mod raster;
mod shading;

use rayon::prelude::*;
use resvg::tiny_skia::{IntSize, Pixmap};

use self::camera::Camera;
use self::raster::{Band, Facet};
use self::shading::Pixel;
use crate::check::model_check::check;
use crate::sheet::Color;
use crate::srgb;
use fretwork_diagnostic::Diagnostic;
use fretwork_geometry::mesh::corner_normals;
use fretwork_geometry::progress::step;
use fretwork_geometry::{Bounds, Model, Point, Point3, budget};

/// The most pixels along a side.
const LONGEST: u32 = 8192;
/// Rows of pixels that are drawn together: enough bands for all threads, and few triangles in
/// several.
const BAND: u32 = 32;
/// Steps in the table from linear light to bytes; the steepest part then has less than one byte a
/// step.
const LEVELS: usize = 4096;
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

/// Bytes for a pixel, with all that is known of it while it is drawn.
const PIXEL: usize = 64;

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
/// A model that [`check`] refuses, a direction that is none, an image without pixels or with more
/// than 8192 along its width.
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
    budget::make(
        "pixels",
        view.width as usize * camera.height as usize,
        PIXEL,
    );
    budget::make("triangles", model.triangle_count(), size_of::<Facet>());
    let facets = facets(model, &camera);
    step(|| format!("drawing {} triangles", facets.len()));
    facets
        .iter()
        .for_each(|facet| budget::spend("pixels of triangles", seen(facet)));
    let up = camera.turn(Point3::new(0.0, 0.0, 1.0));
    let members = band_members(&facets, camera.height);
    let bands = members.par_iter().enumerate().map(|(number, members)| {
        let row = number as u32 * BAND;
        let mut band = Band::new(view.width, row, BAND.min(camera.height - row));
        for &facet in members {
            band.draw(facet, &facets[facet as usize]);
        }
        shading::pixels(&band, &facets, up)
    });
    let pixels: Vec<Pixel> = bands.collect::<Vec<_>>().concat();
    let kept = obscurance::kept_light(&pixels, view.width as usize);
    let bytes = encoded(&pixels, &kept, view.background);
    let size = IntSize::from_wh(view.width, camera.height);
    let image = size.and_then(|size| Pixmap::from_vec(bytes, size));
    let image = image.ok_or_else(|| Diagnostic::error("the picture has no pixels"))?;
    image
        .encode_png()
        .map_err(|e| Diagnostic::error(format!("the picture cannot be written: {e}")))
}

/// Steps for drawing a facet: a fraction of one for each pixel of its box.
fn seen(facet: &Facet) -> u64 {
    let corners = facet.corners.map(|p| Point::new(p.x, p.y));
    let bounds = Bounds::of(corners);
    let side = |length: f64| length.clamp(0.0, 1e5) + 1.0;
    20 + (side(bounds.width()) * side(bounds.height()) / 2.0) as u64
}

/// The numbers of the facets that reach into each band, in their order.
fn band_members(facets: &[Facet], height: u32) -> Vec<Vec<u32>> {
    let count = height.div_ceil(BAND);
    let mut members = vec![Vec::new(); count as usize];
    for (number, facet) in facets.iter().enumerate() {
        let heights = facet.corners.map(|p| p.y / f64::from(BAND));
        let low = heights.into_iter().fold(f64::INFINITY, f64::min);
        let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // A pixel more on both sides, for the rows that bands look at beyond their own.
        let margin = 1.0 / f64::from(BAND);
        let last = f64::from(count - 1);
        let first = (low - margin).floor().clamp(0.0, last) as usize;
        let last = (high + margin).floor().clamp(0.0, last) as usize;
        for band in &mut members[first..=last] {
            band.push(number as u32);
        }
    }
    members
}

/// The bytes of an image, four for each pixel, premultiplied.
fn encoded(pixels: &[Pixel], kept: &[f32], background: Option<Color>) -> Vec<u8> {
    let level = |i: usize| srgb::encoded(i as f32 / (LEVELS - 1) as f32) * 255.0;
    let table: Vec<f32> = (0..LEVELS).map(level).collect();
    let behind = background.map(|color| color.0.map(|byte| srgb::linear(byte) as f32));
    let byte = |linear: f32| table[(linear * (LEVELS - 1) as f32).round() as usize % LEVELS];
    let pixel = |(pixel, kept): (&Pixel, &f32)| -> [u8; 4] {
        let seen = pixel.color.map(|v| (v * kept).clamp(0.0, 1.0));
        let Some(behind) = behind else {
            let [r, g, b] = seen.map(|v| (byte(v) * pixel.cover).round() as u8);
            return [r, g, b, (pixel.cover * 255.0).round() as u8];
        };
        let mix = |k: usize| seen[k] * pixel.cover + behind[k] * (1.0 - pixel.cover);
        let [r, g, b] = [0, 1, 2].map(|k| byte(mix(k).min(1.0)).round() as u8);
        [r, g, b, 255]
    };
    pixels.par_iter().zip(kept).flat_map_iter(pixel).collect()
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
        let linear = |color: [u8; 3]| color.map(|byte| srgb::linear(byte) as f32);
        let coloring = model.bodies[part.body as usize].coloring.as_ref();
        for (triangle, normals) in mesh.triangles.iter().zip(corner_normals(&mesh, CREASE)) {
            let corners = mesh.corners(*triangle).map(|p| camera.project(p));
            facets.push(Facet {
                corners,
                normals: normals.map(|normal| camera.turn(normal)),
                color: match coloring {
                    Some(coloring) => mean(triangle.map(|c| linear(coloring.corners[c as usize]))),
                    None => linear(color),
                },
            });
        }
    }
    facets
}

fn mean([a, b, c]: [[f32; 3]; 3]) -> [f32; 3] {
    std::array::from_fn(|k| (a[k] + b[k] + c[k]) / 3.0)
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

    /// A plate from 0 to 40, 20 thick, with a pocket that is `depth` deep in its top.
    fn engraved(depth: f64) -> Model {
        let mut model = Model::of("below", cube(1.0));
        let stretch = |x: f64, y: f64, z: f64| Affine3::scale(Point3::new(x, y, z));
        let at = |x: f64, y: f64, z: f64| Affine3::translation(Point3::new(x, y, z));
        model.parts[0].place = stretch(40.0, 40.0, 20.0 - depth);
        let walls = [
            (40.0, 15.0, 0.0, 0.0),
            (40.0, 15.0, 0.0, 25.0),
            (15.0, 10.0, 0.0, 15.0),
            (15.0, 10.0, 25.0, 15.0),
        ];
        for (width, height, x, y) in walls {
            let place = stretch(width, height, depth).then(&at(x, y, 20.0 - depth));
            model.place("wall", 0, place);
        }
        let wood = fretwork_geometry::mesh::Material::of("wood", [0xc9, 0xa2, 0x7a]);
        let wood = model.add_material(wood);
        model
            .parts
            .iter_mut()
            .for_each(|part| part.material = Some(wood));
        model
    }

    #[test]
    fn an_engraving_is_seen_from_the_front() {
        let view = View {
            width: 400,
            direction: Point3::new(0.0, 0.0, 1.0),
            background: Some(Color([255; 3])),
        };
        let image = Pixmap::decode_png(&write(&engraved(0.4), &view).unwrap()).unwrap();
        let at = |x: u32| i32::from(pixel(&image, x, 200)[0]);
        // From the face over the side of the pocket, which is 10 of 40 wide, to its middle.
        let (face, middle) = (at(60), at(200));
        let side = (140..170).map(at).min().unwrap();
        assert!(face - side > 40, "face {face}, side {side}");
        assert!(face >= middle, "face {face}, middle {middle}");
        let flat = Pixmap::decode_png(&write(&engraved(1e-6), &view).unwrap()).unwrap();
        let is_plain = (60..340).all(|x| (i32::from(pixel(&flat, x, 200)[0]) - face).abs() <= 1);
        assert!(is_plain);
    }

    #[test]
    fn the_same_bytes_for_any_number_of_threads() {
        let view = View {
            width: 120,
            direction: Point3::new(1.0, -2.0, 1.2),
            background: None,
        };
        let model = engraved(3.0);
        let of = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build()
                .unwrap()
                .install(|| write(&model, &view).unwrap())
        };
        assert_eq!(of(1), of(4));
    }
}
