//! The options `--window` and `--tile`, read.

use fretwork_engine::{Cutting, MAX_LEVEL, TileRange, TileSpan, Window};

/// A part of the plane from `X0,Y0,X1,Y1`.
///
/// # Errors
/// With a sentence on what is wrong with the text.
pub fn part(text: &str) -> Result<Window, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    let Some([x0, y0, x1, y1]) = numbers.as_deref() else {
        return Err("a window is four numbers, `X0,Y0,X1,Y1`".to_string());
    };
    Window::new([*x0, *y0], [*x1, *y1])
}

/// A window to be built; in paths it is called by its numbers in their shortest form.
///
/// # Errors
/// As [`part`].
pub fn window(text: &str) -> Result<Cutting, String> {
    let window = part(text)?;
    let [low, high] = [window.low(), window.high()];
    let name = format!("{}_{}_{}_{}", low[0], low[1], high[0], high[1]);
    Ok(Cutting::Window(window, name))
}

/// Tiles from `Z/X/Y`, where X and Y are a number, a range `A-B` or `*`.
///
/// # Errors
/// As [`window`].
pub fn tiles(text: &str) -> Result<Cutting, String> {
    let form = || "a tile is `Z/X/Y`: whole numbers, and for X and Y also `A-B` or `*`".to_string();
    let [level, x, y] = *text.split('/').collect::<Vec<_>>() else {
        return Err(form());
    };
    let level: u8 = whole(level)
        .and_then(|level| level.try_into().ok())
        .ok_or_else(form)?;
    if level > MAX_LEVEL {
        return Err(format!("the deepest level of tiles is {MAX_LEVEL}"));
    }
    let x = span(x).ok_or_else(form)?;
    let y = span(y).ok_or_else(form)?;
    Ok(Cutting::Tiles(TileRange { level, x, y }))
}

/// A number of digits alone.
fn whole(text: &str) -> Option<u32> {
    let is_plain = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    text.parse().ok().filter(|_| is_plain)
}

fn span(text: &str) -> Option<TileSpan> {
    if text == "*" {
        return Some(TileSpan::All);
    }
    match text.split_once('-') {
        None => whole(text).map(TileSpan::One),
        Some((first, last)) => {
            let (first, last) = (whole(first)?, whole(last)?);
            (first <= last).then_some(TileSpan::Between(first, last))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_called_by_their_shortest_numbers() {
        let name = |text: &str| match window(text) {
            Ok(Cutting::Window(_, name)) => name,
            other => panic!("{other:?}"),
        };
        assert_eq!(
            name("735000,4048500.0, 738600.50,4.0515e6"),
            "735000_4048500_738600.5_4051500"
        );
        assert_eq!(name("-1,-0,2,0.1"), "-1_0_2_0.1");
    }

    #[test]
    fn what_is_no_window_or_tile_is_told() {
        for text in [
            "",
            "1,2,3",
            "1,2,3,4,5",
            "a,2,3,4",
            "3,0,1,2",
            "0,0,0,1",
            "0,0,nan,1",
            "0,0,inf,1",
        ] {
            assert!(window(text).is_err(), "{text}");
        }
        for text in [
            "", "1/2", "1/2/3/4", "a/0/0", "31/0/0", "3/-1/0", "3/2-1/0", "3/+1/0", "3/0/**",
            "256/0/0",
        ] {
            assert!(tiles(text).is_err(), "{text}");
        }
        let range = TileRange {
            level: 3,
            x: TileSpan::Between(0, 3),
            y: TileSpan::All,
        };
        assert_eq!(tiles("3/0-3/*"), Ok(Cutting::Tiles(range)));
    }
}
