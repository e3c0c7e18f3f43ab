//! Pictures of textures, to be looked at: `target/looks/*.png`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use fretwork_geometry::{Mesh, Pixels};

use super::exemplars;
use crate::synthesize::{Options, Pattern, Synthesizer};
use crate::voxelize::tests::shapes;
use crate::voxelize::{Level, pyramid, voxelize};

/// Pixels a voxel.
const SCALE: f64 = 2.0;

/// Draws every exemplar on every shape. `FRETWORK_EXEMPLARS` may name a folder with more of them as PNG,
/// `FRETWORK_RESOLUTION` a resolution, `FRETWORK_LOOK` a part of the names of those to be drawn.
#[test]
#[ignore = "pictures to look at"]
fn look() {
    let resolution = std::env::var("FRETWORK_RESOLUTION");
    let resolution: f64 = resolution.map_or(128.0, |r| r.parse().unwrap());
    let mut all = vec![
        ("dots".to_owned(), exemplars::dots()),
        ("stripes".to_owned(), exemplars::stripes()),
        ("hooks".to_owned(), exemplars::hooks()),
        ("keys".to_owned(), exemplars::keys()),
    ];
    if let Ok(folder) = std::env::var("FRETWORK_EXEMPLARS") {
        all.extend(["zebra", "keyboard"].map(|name| {
            let file = Path::new(&folder).join(format!("{name}.png"));
            (name.to_owned(), read(&file, name != "keyboard"))
        }));
    }
    let shapes = [
        ("plane", shapes::square(100.0)),
        ("turned", shapes::turned(&shapes::square(100.0))),
        ("sphere", shapes::sphere(50.0, 128)),
        ("torus", shapes::torus(34.0, 16.0, 128)),
        ("cube", shapes::cube(80.0)),
    ];
    let only = std::env::var("FRETWORK_LOOK").unwrap_or_default();
    for (shape, mesh) in &shapes {
        for (name, exemplar) in &all {
            let name = format!("{name}-{shape}");
            if name.contains(&only) {
                let mut exemplar = exemplar.clone();
                exemplar.pixel_size = 100.0 / 256.0;
                draw(&name, mesh, &exemplar, resolution);
            }
        }
    }
}

fn draw(name: &str, mesh: &Mesh, exemplar: &Pixels, resolution: f64) {
    let side = mesh.bounds().longest_side();
    let levels = pyramid(voxelize(mesh, side / resolution).unwrap());
    let start = Instant::now();
    let synthesizer = Synthesizer::new(&levels, exemplar, &Options::default()).unwrap();
    let prepared = start.elapsed();
    let pattern = synthesizer.synthesize();
    println!(
        "{name}: {} voxels, {prepared:.2?} + {:.2?}, solid {:.3} of {:.3}",
        pattern.solid.len(),
        start.elapsed() - prepared,
        pattern.solid_fraction(),
        exemplar.solid_fraction()
    );
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../target/looks");
    std::fs::DirBuilder::new()
        .recursive(true)
        .create(&folder)
        .unwrap();
    // Rings about the z axis that must be solid, as if a structure needed them.
    let pitch = levels[0].surface.voxels.lattice.pitch;
    let rings = levels[0].surface.voxels.cells.iter();
    let forced: Vec<bool> = rings
        .map(|cell| (f64::from(cell[2]) * pitch).rem_euclid(20.0) < 3.0)
        .collect();
    let start = Instant::now();
    let local = synthesizer.resynthesize(&pattern, &forced).unwrap();
    println!(
        "    local {:.2?}, solid {:.3}",
        start.elapsed(),
        local.solid_fraction()
    );
    let views = [(&pattern, [0.0, -1.0, 0.35]), (&pattern, [0.2, 0.1, 1.0])];
    let views = [views[0], views[1], (&local, [0.0, -1.0, 0.35])];
    let pictures = views.map(|(pattern, view)| rendered(&levels[0], pattern, view));
    write(&folder.join(format!("{name}.png")), &pictures);
}

/// A square picture as its side and colours.
type Picture = (usize, Vec<[u8; 3]>);

/// An orthographic view against `toward`: the nearest voxels, shaded; what is solid is dark.
fn rendered(level: &Level, pattern: &Pattern, toward: [f64; 3]) -> Picture {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let unit = |v: [f64; 3]| v.map(|c| c / dot(v, v).sqrt());
    let toward = unit(toward);
    let up = unit([0, 1, 2].map(|i| [0.0, 0.0001, 1.0][i] - toward[i] * toward[2]));
    let right = [
        up[1] * toward[2] - up[2] * toward[1],
        up[2] * toward[0] - up[0] * toward[2],
        up[0] * toward[1] - up[1] * toward[0],
    ];
    let cells = &level.surface.voxels.cells;
    let places: Vec<[f64; 3]> = cells
        .iter()
        .map(|cell| cell.map(f64::from))
        .map(|p| [dot(p, right) * SCALE, -dot(p, up) * SCALE, dot(p, toward)])
        .collect();
    let low = |axis: usize| places.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
    let high = |axis: usize| {
        places
            .iter()
            .map(|p| p[axis])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let side = (high(0) - low(0)).max(high(1) - low(1)) as usize + 8;
    let corner = [low(0) - 4.0, low(1) - 4.0];
    let mut nearest = vec![(f64::NEG_INFINITY, [255u8; 3]); side * side];
    for (voxel, place) in places.iter().enumerate() {
        let normal = level.surface.normals[voxel].map(f64::from);
        let light = 0.45 + 0.55 * dot(normal, unit([toward[0], toward[1], toward[2] + 0.6])).abs();
        let base = if pattern.solid[voxel] {
            [60.0, 70.0, 110.0]
        } else {
            [250.0, 235.0, 205.0]
        };
        let color = base.map(|c| (c * light) as u8);
        let [x, y] = [0, 1].map(|axis| (place[axis] - corner[axis]) as usize);
        for n in 0..9 {
            let at = &mut nearest[(y + n / 3 - 1) * side + x + n % 3 - 1];
            if place[2] > at.0 {
                *at = (place[2], color);
            }
        }
    }
    (side, nearest.into_iter().map(|(_, color)| color).collect())
}

fn write(file: &Path, pictures: &[Picture]) {
    let height = pictures.iter().map(|p| p.0).max().unwrap();
    let width: usize = pictures.iter().map(|p| p.0).sum();
    let mut bytes = Vec::new();
    for y in 0..height {
        for (side, colors) in pictures {
            let row = |x: usize| colors.get(y * side + x).filter(|_| y < *side);
            bytes.extend((0..*side).flat_map(|x| row(x).copied().unwrap_or([255; 3])));
        }
    }
    let file = std::fs::File::create(file).unwrap();
    let mut encoder = png::Encoder::new(file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&bytes).unwrap();
}

/// An exemplar from a file: dark pixels are solid.
fn read(file: &Path, tileable: bool) -> Pixels {
    let file = std::io::BufReader::new(std::fs::File::open(file).unwrap());
    let mut decoder = png::Decoder::new(file);
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let samples = info.color_type.samples();
    let rgb: Vec<[u8; 3]> = bytes
        .chunks(samples)
        .map(|p| {
            if samples < 3 {
                [p[0]; 3]
            } else {
                [p[0], p[1], p[2]]
            }
        })
        .collect();
    let luma =
        |p: &[u8; 3]| 0.299 * f64::from(p[0]) + 0.587 * f64::from(p[1]) + 0.114 * f64::from(p[2]);
    Pixels {
        width: info.width as usize,
        solid: rgb.iter().map(|p| luma(p) < 127.5).collect(),
        rgb,
        pixel_size: 1.0,
        feature_radius: None,
        tileable,
    }
}
