//! A part of the plane that an artifact shows.

use std::hash::{Hash, Hasher};

use serde::{Deserialize, Serialize};

/// A rectangle of the spec's plane, in the spec's units: `low` is below `high` in both coordinates. No number in it
/// is NaN or a negative zero, so that equal windows have equal bits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Window {
    sides: [f64; 4],
    is_shared: bool,
}

impl Window {
    /// The window from `low` to `high`.
    ///
    /// # Errors
    /// With a sentence, when it is empty or not finite.
    pub fn new(low: [f64; 2], high: [f64; 2]) -> Result<Window, String> {
        let all = [low[0], low[1], high[0], high[1]];
        if all.iter().any(|number| !number.is_finite()) {
            return Err("the numbers of a window must be finite".into());
        }
        for (axis, low, high) in [("X", low[0], high[0]), ("Y", low[1], high[1])] {
            if low >= high {
                return Err(format!(
                    "{axis}0 of a window must be less than {axis}1, and {low} is not less than {high}"
                ));
            }
        }
        Ok(Window {
            sides: all.map(|number| number + 0.0),
            is_shared: false,
        })
    }

    /// The same window, one of several that are asked for together and show most of a page: what they show is drawn once, as
    /// a whole, for all of them.
    pub fn shared(self) -> Window {
        Window {
            is_shared: true,
            ..self
        }
    }

    /// The same window with its sides moved out by a length.
    pub fn grown(self, by: f64) -> Window {
        let [x0, y0, x1, y1] = self.sides;
        Window {
            sides: [x0 - by, y0 - by, x1 + by, y1 + by].map(|number| number + 0.0),
            ..self
        }
    }

    /// Whether it is one of several for which the whole is drawn once.
    pub fn is_shared(self) -> bool {
        self.is_shared
    }

    /// The corner of least coordinates.
    pub fn low(self) -> [f64; 2] {
        [self.sides[0], self.sides[1]]
    }

    /// The corner of greatest coordinates.
    pub fn high(self) -> [f64; 2] {
        [self.sides[2], self.sides[3]]
    }
}

impl Eq for Window {}

impl Hash for Window {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.sides.map(f64::to_bits).hash(state);
        self.is_shared.hash(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_that_are_reversed_or_empty_are_told() {
        let told = Window::new([5.0, 0.0], [1.0, 2.0]).unwrap_err();
        assert!(told.contains("X0") && told.contains("less"), "{told}");
        assert!(Window::new([0.0, 2.0], [1.0, 2.0]).is_err());
        assert!(Window::new([0.0, f64::NAN], [1.0, 2.0]).is_err());
        let window = Window::new([-0.0, 0.0], [1.0, 2.0]);
        assert_eq!(window.unwrap().low()[0].to_bits(), 0);
    }
}
