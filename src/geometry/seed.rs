//! Randomness without state: every value is a hash of what it is for.

use serde::{Deserialize, Serialize};

use crate::{Point, Region, Tile};

/// The key of a family of random values. Children of different names or numbers are independent;
/// the same path from the same root gives the same value on every machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Seed(u64);

impl Seed {
    /// The root of a file with this `seed:`.
    #[inline]
    pub fn root(seed: u64) -> Seed {
        Seed(mix(seed ^ 0x6672_6574_776f_726b))
    }

    /// The child numbered `n`: an ordinal, a rounded coordinate.
    #[inline]
    pub fn number(self, n: i64) -> Seed {
        Seed(mix(
            self.0.rotate_left(23) ^ mix(n as u64 ^ 0x9e37_79b9_7f4a_7c15)
        ))
    }

    /// The child named `name`: an entry, a kind of cell.
    #[inline]
    pub fn name(self, name: &str) -> Seed {
        name.bytes()
            .fold(self.number(name.len() as i64 ^ 0x5eed), |seed, byte| {
                seed.number(byte.into())
            })
    }

    /// The child of a cell at `position`, rounded by `snap`.
    #[inline]
    pub fn at(self, position: Point, snap: Snap) -> Seed {
        let [x, y] = snap.cell(position);
        self.number(x).number(y)
    }

    /// The `n`-th value of this seed, uniform in [0, 1).
    #[inline]
    pub fn unit(self, n: u64) -> f64 {
        // 53 bits: every value is a multiple of 2^-53.
        (mix(self.0 ^ mix(n.wrapping_add(0x2545_f491_4f6c_dd1d))) >> 11) as f64
            / (1u64 << 53) as f64
    }

    /// The `n`-th value of this seed, uniform in [lo, hi).
    #[inline]
    pub fn range(self, n: u64, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit(n)
    }
}

/// Where between two steps positions are rounded up, less one half: no round part of a step.
const EDGE: f64 = 0.309_016_994_374_947_45;

/// How positions are rounded where they are hashed: to a millionth of the longer side of a region. On a
/// periodic region positions a period apart are one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    grid: f64,
    /// By how much of a step the places between two steps are moved from their middle.
    shift: f64,
    /// Where positions a period apart are one.
    tile: Option<Tile>,
}

impl Snap {
    /// That of `region`.
    pub fn of(region: &Region) -> Snap {
        let side = region.page().longer_side();
        let grid = 1e-6
            * if side.is_finite() && side > 0.0 {
                side
            } else {
                1.0
            };
        Snap {
            grid,
            shift: 0.0,
            tile: region.tile(),
        }
    }

    /// The same with positions rounded to `step`, where there is one, on a lattice of the whole plane. Round
    /// designs have their cells at whole or half steps, which are never on the edge between two.
    pub fn in_steps(self, step: Option<f64>) -> Snap {
        step.map_or(self, |grid| Snap {
            grid,
            shift: EDGE,
            ..self
        })
    }

    /// The tile of which positions are rounded, if there is one.
    #[inline]
    pub fn tile(self) -> Option<Tile> {
        self.tile
    }

    fn cell(self, position: Point) -> [i64; 2] {
        let rounded = |x: f64| libm::round(x / self.grid) as i64;
        let Some(Tile { corner, period }) = self.tile else {
            let moved = |x: f64| libm::round(x / self.grid + self.shift) as i64;
            return [moved(position.x), moved(position.y)];
        };
        let wrapped = |x: f64, period: f64| {
            let rest = x - period * (x / period).floor();
            if rest > period - 0.5 * self.grid {
                0
            } else {
                rounded(rest)
            }
        };
        [
            wrapped(position.x - corner.x, period.x),
            wrapped(position.y - corner.y, period.y),
        ]
    }
}

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): a bijection whose every output bit
/// depends on every input bit.
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_a_period_apart_are_one() {
        let mut tile = Region::rectangle(Point::new(-3.0, 2.0), Point::new(97.0, 62.0));
        let place = Point::new(-3.0, 17.25);
        let [plain, far] = [place, place + Point::new(100.0 - 1e-9, 120.0)];
        assert_ne!(
            Seed::root(1).at(plain, Snap::of(&tile)),
            Seed::root(1).at(far, Snap::of(&tile))
        );
        tile.period = Some(Point::new(100.0, 60.0));
        let snap = Snap::of(&tile);
        assert_eq!(Seed::root(1).at(plain, snap), Seed::root(1).at(far, snap));
        assert_ne!(
            Seed::root(1).at(plain, snap),
            Seed::root(1).at(place + Point::new(0.0, 1.0), snap)
        );
    }

    #[test]
    fn round_places_are_on_no_edge_between_steps() {
        let page = Region::rectangle(Point::ORIGIN, Point::new(1000.0, 700.0));
        let snap = Snap::of(&page).in_steps(Some(0.001));
        let seed = |p: Point| Seed::root(1).at(p, snap);
        for i in 0..2000 {
            let place = Point::new(735_000.0 + f64::from(i) * 0.0005, f64::from(i) * 0.0025);
            let nudge = Point::new(1e-9, -1e-9);
            assert_eq!(seed(place - nudge), seed(place + nudge), "{place:?}");
        }
    }

    #[test]
    fn values_are_uniform_and_depend_on_the_whole_path() {
        let seed = Seed::root(42).name("puzzle");
        let mean = (0..10_000).map(|n| seed.number(n).unit(0)).sum::<f64>() / 10_000.0;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        assert_ne!(seed.unit(0), seed.unit(1));
        assert_ne!(Seed::root(1).name("ab"), Seed::root(1).name("ba"));
        assert_ne!(Seed::root(1).name("a").name("b"), Seed::root(1).name("ab"));
        assert_eq!(Seed::root(42).name("puzzle").unit(3), seed.unit(3));
    }
}
