//! Pictures of the kinds that the source of shells measures, drawn by formulas: keys, hooks, and waving bands that are
//! anisotropic. Nothing joins their figures.

use fretwork::geometry::Pixels;

/// Pixels of a picture along a side.
const SIDE: usize = 96;

/// Where a picture is dark, by the place in it from 0 to 1.
pub type Picture = fn(f64, f64) -> bool;

/// All of them with their names, and whether they tile.
pub const PICTURES: [(&str, bool, Picture); 3] = [
    ("keyboard", false, keyboard),
    ("hooks", true, hooks),
    ("waves", true, waves),
];

fn dark(picture: Picture) -> impl Iterator<Item = bool> {
    let at = |n: usize| (n as f64 + 0.5) / SIDE as f64;
    (0..SIDE * SIDE).map(move |n| picture(at(n % SIDE), at(n / SIDE)))
}

/// A picture as an exemplar whose dark pixels are solid, half a millimetre each.
pub fn pixels(picture: Picture, tileable: bool) -> Pixels {
    let solid: Vec<bool> = dark(picture).collect();
    let ink = |solid: &bool| if *solid { [30; 3] } else { [230; 3] };
    Pixels {
        width: SIDE,
        rgb: solid.iter().map(ink).collect(),
        solid,
        pixel_size: 0.5,
        feature_radius: Some(1.5),
        tileable,
    }
}

/// A picture as a file.
pub fn png(picture: Picture) -> Vec<u8> {
    let pixels: Vec<u8> = dark(picture)
        .map(|dark| if dark { 20 } else { 240 })
        .collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIDE as u32, SIDE as u32);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("memory can be written");
    writer
        .write_image_data(&pixels)
        .expect("memory can be written");
    writer.finish().expect("memory can be written");
    bytes
}

/// Keys of several widths in rows.
fn keyboard(x: f64, y: f64) -> bool {
    let row = (y * 5.0).floor();
    let inside = |a: f64| (0.12..0.88).contains(&a.rem_euclid(1.0));
    inside(x * (3.0 + row * 0.7) + row * 0.3) && inside(y * 5.0)
}

/// Arcs of three quarters of a circle with a tail, of alternate hand.
fn hooks(x: f64, y: f64) -> bool {
    let cell = [(x * 3.0).floor(), (y * 3.0).floor()];
    let hand = if (cell[0] + cell[1]) % 2.0 == 0.0 {
        1.0
    } else {
        -1.0
    };
    let [u, v] = [(x * 3.0 - cell[0] - 0.5) * hand, y * 3.0 - cell[1] - 0.5];
    let is_ring = ((u * u + (v + 0.08) * (v + 0.08)).sqrt() - 0.28).abs() < 0.1;
    let is_tail = (u - 0.28).abs() < 0.1 && v > 0.0 && v < 0.42;
    (is_ring && !(u < 0.0 && v > -0.1)) || is_tail
}

/// Waving bands.
pub fn waves(x: f64, y: f64) -> bool {
    let bend = 0.15 * (std::f64::consts::TAU * 2.0 * x).sin();
    (std::f64::consts::TAU * (6.0 * y + bend)).sin() > 0.1
}
