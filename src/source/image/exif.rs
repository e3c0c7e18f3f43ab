//! How a camera was held (Exif 2.32, section 4.6.4: the tag `Orientation`).

use super::Picture;

const ORIENTATION: u16 = 0x0112;

/// The orientation, 1 to 8, in the TIFF structure of an Exif block; 1 where there is none.
pub fn orientation(exif: &[u8]) -> u16 {
    found(exif).filter(|o| (1..=8).contains(o)).unwrap_or(1)
}

fn found(exif: &[u8]) -> Option<u16> {
    let exif = exif.strip_prefix(b"Exif\0\0").unwrap_or(exif);
    let is_little = exif.starts_with(b"II");
    let two = |at: usize| {
        let bytes = exif.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(match is_little {
            true => u16::from_le_bytes(bytes),
            false => u16::from_be_bytes(bytes),
        })
    };
    let four = |at: usize| {
        let (a, b) = (u32::from(two(at)?), u32::from(two(at.checked_add(2)?)?));
        Some(if is_little { b << 16 | a } else { a << 16 | b })
    };
    let directory = four(4)? as usize;
    let count = usize::from(two(directory)?);
    let entries = (0..count).map(|i| directory + 2 + 12 * i);
    let mut tags = entries.map_while(|at| Some((at, two(at)?)));
    let (at, _) = tags.find(|(_, tag)| *tag == ORIENTATION)?;
    two(at + 8)
}

/// The picture as it was seen: mirrored, turned, or both.
pub fn upright<T: Copy>(picture: Picture<T>, orientation: u16) -> Picture<T> {
    let (width, height) = (picture.width, picture.values.len() / picture.width.max(1));
    if orientation <= 1 {
        return picture;
    }
    let is_turned = orientation >= 5;
    let (columns, rows) = if is_turned {
        (height, width)
    } else {
        (width, height)
    };
    let source = |x: usize, y: usize| match orientation {
        2 => (width - 1 - x, y),
        3 => (width - 1 - x, height - 1 - y),
        4 => (x, height - 1 - y),
        5 => (y, x),
        6 => (y, height - 1 - x),
        7 => (width - 1 - y, height - 1 - x),
        _ => (width - 1 - y, x),
    };
    let value = |i: usize| {
        let (x, y) = source(i % columns, i / columns);
        picture.values[y * width + x]
    };
    Picture {
        width: columns,
        values: (0..columns * rows).map(value).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientations_are_those_of_the_standard() {
        // The first row and the first column of the stored picture are these sides of what was seen.
        let stored = Picture {
            width: 2,
            values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        };
        let seen = |o| {
            let found = upright(stored.clone(), o);
            (
                found.width,
                found.values.iter().map(|v| *v as u8).collect::<Vec<_>>(),
            )
        };
        assert_eq!(seen(1), (2, vec![1, 2, 3, 4, 5, 6]));
        assert_eq!(seen(2), (2, vec![2, 1, 4, 3, 6, 5]));
        assert_eq!(seen(3), (2, vec![6, 5, 4, 3, 2, 1]));
        assert_eq!(seen(4), (2, vec![5, 6, 3, 4, 1, 2]));
        assert_eq!(seen(5), (3, vec![1, 3, 5, 2, 4, 6]));
        assert_eq!(seen(6), (3, vec![5, 3, 1, 6, 4, 2]));
        assert_eq!(seen(7), (3, vec![6, 4, 2, 5, 3, 1]));
        assert_eq!(seen(8), (3, vec![2, 4, 6, 1, 3, 5]));
    }

    #[test]
    fn the_tag_is_found_in_either_byte_order() {
        let little = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0";
        let big = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x08\0\0";
        assert_eq!((orientation(little), orientation(big)), (6, 8));
        for end in 0..little.len() - 4 {
            assert_eq!(orientation(&little[..end.min(18)]), 1);
        }
        assert_eq!(orientation(b"II*\0\xff\xff\xff\xff"), 1);
    }
}
