//! Pictures of both formats through the reader.

use ::png::{BitDepth, ColorType, Encoder};

use super::*;

fn encoded(color: ColorType, depth: BitDepth, width: u32, height: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == ColorType::Indexed {
        encoder.set_palette(vec![0, 0, 0, 255, 255, 255]);
    }
    encoder
        .write_header()
        .unwrap()
        .write_image_data(data)
        .unwrap();
    bytes
}

#[test]
fn every_colour_type_is_read() {
    use ::png::BitDepth::{Eight, One, Sixteen};
    let values =
        |color, depth, data: &[u8]| luma(&encoded(color, depth, 2, 1, data)).unwrap().values;
    assert_eq!(values(ColorType::Grayscale, Eight, &[0, 255]), [0.0, 1.0]);
    assert_eq!(
        values(ColorType::Grayscale, One, &[0b0100_0000]),
        [0.0, 1.0]
    );
    assert_eq!(
        values(ColorType::Grayscale, Sixteen, &[0, 0, 0xff, 0xff]),
        [0.0, 1.0]
    );
    assert_eq!(
        values(ColorType::GrayscaleAlpha, Eight, &[0, 0, 0, 255]),
        [1.0, 0.0]
    );
    assert_eq!(values(ColorType::Indexed, One, &[0b0100_0000]), [0.0, 1.0]);
    assert_eq!(
        values(ColorType::Rgba, Eight, &[0, 0, 0, 0, 0, 0, 0, 255]),
        [1.0, 0.0]
    );
    let rgb = values(ColorType::Rgb, Eight, &[255, 255, 255, 0, 255, 0]);
    assert!((rgb[0] - 1.0).abs() < 1e-12 && (rgb[1] - 0.7152).abs() < 1e-12);
}

#[test]
fn rows_run_from_the_top() {
    let read = luma(&encoded(
        ColorType::Grayscale,
        BitDepth::Eight,
        1,
        2,
        &[0, 255],
    ))
    .unwrap();
    assert_eq!((read.width, read.values), (1, vec![0.0, 1.0]));
}

#[test]
fn what_is_damaged_or_too_large_is_refused() {
    let whole = encoded(ColorType::Grayscale, BitDepth::Eight, 40, 40, &[7; 1600]);
    for end in 0..whole.len() - 12 {
        assert!(luma(&whole[..end]).is_err(), "cut at {end}");
    }
    let mut huge = whole.clone();
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    assert!(luma(&huge).is_err());
}

const GRAY: &[u8] = include_bytes!("../../../tests/pictures/gray.jpg");
const TURNED: &[u8] = include_bytes!("../../../tests/pictures/turned.jpg");
const PROGRESSIVE: &[u8] = include_bytes!("../../../tests/pictures/progressive.jpg");
const RED: &[u8] = include_bytes!("../../../tests/pictures/red.jpg");
const CMYK: &[u8] = include_bytes!("../../../tests/pictures/cmyk.jpg");

#[test]
fn jpegs_are_read_grey_or_coloured_baseline_or_progressive() {
    for bytes in [GRAY, PROGRESSIVE] {
        let read = luma(bytes).unwrap();
        assert_eq!((read.width, read.values.len()), (16, 128));
        for (i, value) in read.values.iter().enumerate() {
            let expected = if i % 16 < 8 { 0.0 } else { 1.0 };
            assert!((value - expected).abs() < 0.02, "{i}: {value}");
        }
    }
    let red = luma(RED).unwrap();
    assert!(red.values.iter().all(|v| (v - 0.2126).abs() < 0.01));
}

#[test]
fn a_picture_that_was_taken_turned_stands_upright() {
    let read = luma(TURNED).unwrap();
    assert_eq!((read.width, read.values.len()), (8, 128));
    assert!(read.values[..64].iter().all(|v| *v < 0.02));
    assert!(read.values[64..].iter().all(|v| *v > 0.98));
}

#[test]
fn jpegs_for_printing_and_other_formats_are_refused() {
    assert!(matches!(luma(CMYK), Err(ImageError::Cmyk)));
    assert!(matches!(luma(b"GIF89a"), Err(ImageError::Unknown)));
    assert!(matches!(luma(b""), Err(ImageError::Unknown)));
}

#[test]
fn jpegs_that_are_cut_off_or_claim_too_much_are_refused() {
    for end in 0..GRAY.len() - 2 {
        assert!(luma(&GRAY[..end]).is_err(), "cut at {end}");
    }
    let frame = GRAY.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
    let claimed = |height: u16, width: u16| {
        let mut bytes = GRAY.to_vec();
        bytes[frame + 5..frame + 7].copy_from_slice(&height.to_be_bytes());
        bytes[frame + 7..frame + 9].copy_from_slice(&width.to_be_bytes());
        luma(&bytes)
    };
    assert!(matches!(
        claimed(60_000, 60_000),
        Err(ImageError::TooLarge(..))
    ));
    assert!(matches!(claimed(8_000, 8_000), Err(ImageError::Hollow(..))));
    assert!(claimed(0, 16).is_err());
}

/// The same numbers in every run (splitmix64).
fn next(state: &mut u64) -> usize {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as usize
}

#[test]
fn damaged_pictures_never_break_anything() {
    let mut state = 7;
    for round in 0..4000 {
        let whole = [GRAY, TURNED, PROGRESSIVE, RED, CMYK][round % 5];
        let mut bytes = whole.to_vec();
        for _ in 0..1 + next(&mut state) % 6 {
            let at = next(&mut state) % bytes.len();
            bytes[at] = next(&mut state) as u8;
        }
        bytes.truncate(1 + next(&mut state) % (2 * bytes.len()));
        if let Ok(read) = luma(&bytes) {
            assert_eq!(read.values.len() % read.width, 0);
        }
    }
}
