//! The colours of DXF: a palette of 255 (AutoCAD's color index), of which files of release 2000
//! name one by its number.

use crate::sheet::{Color, Layer, Role};
use fretwork_diagnostic::Diagnostic;

/// Black on white, white on black.
pub const BLACK: u8 = 7;
/// How far a channel of the nearest colour may be from the one that was asked for without a
/// warning. Programs that choose by colour know the first seven, which are exact; nobody tells
/// shades apart that are nearer than this.
const ALIKE: u8 = 24;
/// The colours that have names, from 1 on.
const NAMED: [[u8; 3]; 9] = [
    [255, 0, 0],
    [255, 255, 0],
    [0, 255, 0],
    [0, 255, 255],
    [0, 0, 255],
    [255, 0, 255],
    [255, 255, 255],
    [128, 128, 128],
    [192, 192, 192],
];
/// The brightness of each pair of colours of one hue.
const BRIGHTNESS: [u32; 5] = [255, 165, 127, 76, 38];

/// The number of the palette's colour that is nearest to that of a layer's lines, and that colour.
/// Layers whose lines are not drawn have the colour of their role.
pub fn of(layer: &Layer) -> (u8, Color) {
    let Some(pen) = layer.style.stroke else {
        return match layer.role {
            Role::Cut => (1, color(1)),
            Role::Engrave => (5, color(5)),
            Role::Draw => (BLACK, Color::default()),
        };
    };
    if pen.color == Color::default() {
        return (BLACK, pen.color);
    }
    let away = |number: &u8| -> u32 {
        let parts = color(*number).0.into_iter().zip(pen.color.0);
        parts.map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
    };
    let nearest = (1..=249).min_by_key(away).unwrap_or(BLACK);
    (nearest, color(nearest))
}

/// Warnings for the layers whose lines DXF cannot show in the colour that was asked for.
pub fn warnings(layers: &[Layer]) -> Vec<Diagnostic> {
    let warning = |layer: &Layer| {
        let asked = layer.style.stroke?.color;
        let (number, shown) = of(layer);
        let parts = shown.0.into_iter().zip(asked.0);
        let is_alike = parts.into_iter().all(|(a, b)| a.abs_diff(b) <= ALIKE);
        (!is_alike).then(|| {
            let name = &layer.name;
            let message = format!("DXF has no colour {asked}: the layer `{name}` is {shown}");
            Diagnostic::warning(message).help(format!(
                "it is the nearest of DXF's colours, number {number}"
            ))
        })
    };
    layers.iter().filter_map(warning).collect()
}

/// The colours 10 to 249 are 24 hues in steps of 15 degrees, each in five degrees of brightness,
/// full and half saturated.
fn color(number: u8) -> Color {
    let number = u32::from(number);
    if let Some(named) = number.checked_sub(1).and_then(|i| NAMED.get(i as usize)) {
        return Color(*named);
    }
    let (hue, shade) = ((number / 10 - 1) * 15, number % 10);
    let brightness = BRIGHTNESS[(shade / 2) as usize];
    let (sixth, part) = (hue / 60, hue % 60);
    let (rising, falling) = (brightness * part / 60, brightness * (60 - part) / 60);
    let channels = match sixth {
        0 => [brightness, rising, 0],
        1 => [falling, brightness, 0],
        2 => [0, brightness, rising],
        3 => [0, falling, brightness],
        4 => [rising, 0, brightness],
        _ => [brightness, 0, falling],
    };
    let is_pale = shade % 2 == 1;
    Color(channels.map(|c| if is_pale { (c + brightness) / 2 } else { c } as u8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;

    fn layer(color: &str) -> Layer {
        let mut style = Style::outline(0.1);
        if let Some(pen) = &mut style.stroke {
            pen.color = color.parse().unwrap();
        }
        Layer {
            name: "a".into(),
            role: Role::Engrave,
            style,
            items: vec![],
        }
    }

    #[test]
    fn asked_colours_are_honoured_or_told() {
        let number = |color: &str| of(&layer(color)).0;
        assert_eq!(
            ["red", "lime", "blue", "magenta", "black"].map(number),
            [1, 3, 5, 6, 7]
        );
        assert_eq!(number("#ff7f00"), 30);
        let mut plain = layer("red");
        plain.style.stroke = None;
        assert_eq!(of(&plain).0, 5);
        assert_eq!(warnings(&[layer("lime"), layer("#ff7f00"), plain]), []);
        let told = warnings(&[layer("#e8d8ff")]);
        assert!(
            told[0].message.contains("DXF has no colour #e8d8ff"),
            "{told:?}"
        );
    }

    #[test]
    fn the_palette_is_that_of_other_programs() {
        // Compared with the table of ezdxf.
        let known = [
            (10, [255, 0, 0]),
            (13, [165, 82, 82]),
            (20, [255, 63, 0]),
            (21, [255, 159, 127]),
            (27, [76, 47, 38]),
            (140, [0, 191, 255]),
        ];
        for (number, channels) in known {
            assert_eq!(color(number).0, channels, "{number}");
        }
    }
}
