//! Transform lists to affine maps.

use svgtypes::{Error, TransformListParser, TransformListToken as Token};

use super::length::{Axis, Length};
use fretwork_geometry::{Affine, Point};

/// The map of an SVG `transform` list, the last of which acts first.
pub fn parse(text: &str) -> Result<Affine, Error> {
    let mut map = Affine::IDENTITY;
    for token in TransformListParser::from(text) {
        map = one(token?).then(map);
    }
    if map.0.iter().all(|n| n.is_finite()) {
        Ok(map)
    } else {
        Err(Error::InvalidValue)
    }
}

fn one(token: Token) -> Affine {
    match token {
        Token::Matrix { a, b, c, d, e, f } => Affine([a, b, c, d, e, f]),
        Token::Translate { tx, ty } => Affine::translation(Point::new(tx, ty)),
        Token::Scale { sx, sy } => Affine::scale(sx, sy),
        Token::Rotate { angle } => rotation(angle),
        Token::SkewX { angle } => Affine([1.0, 0.0, libm::tan(angle.to_radians()), 1.0, 0.0, 0.0]),
        Token::SkewY { angle } => Affine([1.0, libm::tan(angle.to_radians()), 0.0, 1.0, 0.0, 0.0]),
    }
}

/// The rotation by `degrees`, exact for quarter turns.
fn rotation(degrees: f64) -> Affine {
    let (c, s) = match degrees.rem_euclid(360.0) {
        0.0 => (1.0, 0.0),
        90.0 => (0.0, 1.0),
        180.0 => (-1.0, 0.0),
        270.0 => (0.0, -1.0),
        other => (libm::cos(other.to_radians()), libm::sin(other.to_radians())),
    };
    Affine([c, s, -s, c, 0.0, 0.0])
}

/// The point of `transform-origin`; none when it is not understood.
pub fn origin(text: &str, viewport: Point) -> Option<Point> {
    let mut place = Point::ORIGIN;
    let words: Vec<&str> = text.split([' ', ',']).filter(|w| !w.is_empty()).collect();
    for (i, word) in words.iter().take(2).enumerate() {
        let (axis, length) = match *word {
            "left" => (Axis::X, "0"),
            "right" => (Axis::X, "100%"),
            "top" => (Axis::Y, "0"),
            "bottom" => (Axis::Y, "100%"),
            "center" if i == 0 => (Axis::X, "50%"),
            "center" => (Axis::Y, "50%"),
            other => (if i == 0 { Axis::X } else { Axis::Y }, other),
        };
        let value = length.parse::<Length>().ok()?.user(axis, viewport);
        if !value.is_finite() {
            return None;
        }
        *(if axis == Axis::X {
            &mut place.x
        } else {
            &mut place.y
        }) = value;
    }
    Some(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_transform_acts_first() {
        let image = |text: &str| parse(text).unwrap().apply(Point::new(1.0, 0.0));
        assert_eq!(image("translate(10, 20) scale(2)"), Point::new(12.0, 20.0));
        assert_eq!(image("scale(2) translate(10)"), Point::new(22.0, 0.0));
        assert_eq!(image("rotate(90)"), Point::new(0.0, 1.0));
        assert_eq!(image("rotate(-90 1 1)"), Point::new(0.0, 1.0));
        assert_eq!(image("matrix(1 2 3 4 5 6)"), Point::new(6.0, 8.0));
        assert!(image("skewY(45)").distance(Point::new(1.0, 1.0)) < 1e-15);
        assert_eq!(image(" "), Point::new(1.0, 0.0));
        for bad in [
            "rotate(",
            "turn(3)",
            "scale(1e300) scale(1e300)",
            "matrix(1 2 3)",
            "translate(1) x",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
