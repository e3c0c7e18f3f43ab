//! Transform lists to affine maps.

use svgtypes::{Error, TransformListParser, TransformListToken as Token};

use super::length::{Axis, Basis, Length};
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

/// The map of a CSS `transform`: with units, and with functions that name an axis.
pub fn parse_css(text: &str) -> Result<Affine, Error> {
    let mut plain = String::new();
    for function in text.split_inclusive(')') {
        let (name, arguments) = function.split_once('(').ok_or(Error::InvalidValue)?;
        let arguments = arguments.strip_suffix(')').ok_or(Error::InvalidValue)?;
        let numbers = arguments
            .split(|c: char| c == ',' || c.is_whitespace())
            .filter(|word| !word.is_empty())
            .map(number)
            .collect::<Option<Vec<String>>>()
            .ok_or(Error::InvalidValue)?;
        let name = name.trim_matches(|c: char| c == ',' || c.is_whitespace());
        let [first, ..] = &numbers[..] else {
            return Err(Error::InvalidValue);
        };
        plain += &match name.to_ascii_lowercase().as_str() {
            "translatex" => format!("translate({first} 0)"),
            "translatey" => format!("translate(0 {first})"),
            "scalex" => format!("scale({first} 1)"),
            "scaley" => format!("scale(1 {first})"),
            "skewx" => format!("skewX({first})"),
            "skewy" => format!("skewY({first})"),
            "skew" => {
                let second = numbers.get(1).map_or("0", String::as_str);
                let tangent = |n: &str| n.parse().map(|a: f64| libm::tan(a.to_radians()));
                let (x, y) = (tangent(first), tangent(second));
                let (x, y) = x.ok().zip(y.ok()).ok_or(Error::InvalidValue)?;
                format!("matrix(1 {y} {x} 1 0 0)")
            }
            other => format!("{other}({})", numbers.join(" ")),
        };
    }
    parse(&plain)
}

/// A length in user units or an angle in degrees as a number.
fn number(word: &str) -> Option<String> {
    let in_degrees = [
        ("deg", 1.0),
        ("grad", 0.9),
        ("rad", 180.0 / std::f64::consts::PI),
        ("turn", 360.0),
    ];
    let word = word.to_ascii_lowercase();
    if let Some((text, unit)) = in_degrees
        .iter()
        .find_map(|(unit, size)| Some((word.strip_suffix(unit)?, size)))
    {
        let svgtypes::Number(n) = text.parse().ok()?;
        return Some((n * unit).to_string());
    }
    let length = word.parse::<Length>().ok()?;
    let unknown = Basis::of(Point::new(f64::NAN, f64::NAN));
    let user = length.user(Axis::X, &unknown);
    user.is_finite().then(|| user.to_string())
}

/// The point of `transform-origin` in a box with the size of the viewport; none when it is not understood.
pub fn origin(text: &str, basis: &Basis) -> Option<Point> {
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
        let value = length.parse::<Length>().ok()?.user(axis, basis);
        if !value.is_finite() {
            return None;
        }
        *(if axis == Axis::X {
            &mut place.x
        } else {
            &mut place.y
        }) = value;
    }
    // One word leaves the other axis in the middle.
    if let [word] = words[..] {
        let middle = basis.viewport * 0.5;
        match word {
            "top" | "bottom" => place.x = middle.x,
            _ => place.y = middle.y,
        }
        if !place.is_finite() {
            return None;
        }
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

    #[test]
    fn css_has_units_and_functions_of_its_own() {
        let image = |text: &str| parse_css(text).unwrap().apply(Point::new(1.0, 2.0));
        assert_eq!(image("translateX(1in) scaleY(2)"), Point::new(97.0, 4.0));
        assert_eq!(image("rotate(.25turn)"), Point::new(-2.0, 1.0));
        assert_eq!(
            image("rotate(100grad), translate(1px, 2px)"),
            Point::new(-4.0, 2.0)
        );
        assert!(image("skew(45deg)").distance(Point::new(3.0, 2.0)) < 1e-12);
        for bad in [
            "rotateX(3deg)",
            "translate(50%)",
            "none x",
            "scale()",
            "perspective(1px)",
        ] {
            assert!(parse_css(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn origins_are_places_in_the_box() {
        let basis = Basis::of(Point::new(200.0, 100.0));
        let at = |text: &str| origin(text, &basis).map(<[f64; 2]>::from);
        assert_eq!(at("center"), Some([100.0, 50.0]));
        assert_eq!(at("top left"), Some([0.0, 0.0]));
        assert_eq!(at("top"), Some([100.0, 0.0]));
        assert_eq!(at("10px 20%"), Some([10.0, 20.0]));
        assert_eq!(at("5"), Some([5.0, 50.0]));
        assert_eq!(at("middle"), None);
    }
}
