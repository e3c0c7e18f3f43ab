//! Between sRGB bytes and linear light (IEC 61966-2-1).

/// From an sRGB byte to linear light, 0 to 1.
pub fn linear(byte: u8) -> f64 {
    let v = f64::from(byte) / 255.0;
    if v <= 0.04045 {
        v / 12.92
    } else {
        libm::pow((v + 0.055) / 1.055, 2.4)
    }
}

/// From linear light to sRGB, both 0 to 1.
pub fn encoded(linear: f32) -> f32 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back() {
        for byte in 0..=255 {
            let back = encoded(linear(byte) as f32) * 255.0;
            assert_eq!(back.round() as u8, byte);
        }
    }
}
