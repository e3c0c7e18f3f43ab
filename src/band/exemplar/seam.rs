//! What it costs to join two pieces, and how the second must be shifted (Zhou 2014, section 3.6.1).

use fretwork_geometry::Point;

use super::piece::Piece;

/// The joint of a piece with the one that follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seam {
    /// D(i, j): the mismatch of positions and tangents, without a unit.
    pub cost: f64,
    /// τ: the shift along v, relative to the first piece, at which the second piece fits best.
    pub rise: f64,
    /// How far the second piece is moved away where no portal joins the two and they would touch.
    pub gap: f64,
}

/// All seams between the pieces of one exemplar.
#[derive(Clone, Debug, PartialEq)]
pub struct Seams {
    pieces: usize,
    table: Vec<Option<Seam>>,
}

impl Seams {
    /// Compares all pairs of `pieces` with equal numbers of portals.
    ///
    /// The cost is (1 - `tangent_weight`)·d_match + `tangent_weight`·d_tangent. d_match is the mean
    /// squared distance of the endpoints after the best shift, in units of the exemplar's mean
    /// portal width, so that a drawing costs the same at any scale. d_tangent is the sum of 1 - cos
    /// of the angles between tangents. Two pieces that are neighbours in the exemplar cost nothing.
    pub fn new(pieces: &[Piece], tangent_weight: f64) -> Seams {
        let unit = mean_portal(pieces);
        let between = |(i, j): (usize, usize)| {
            let matched = pieces[i].right.len() == pieces[j].left.len();
            matched.then(|| seam(&pieces[i], &pieces[j], j == i + 1, tangent_weight, unit))
        };
        let n = pieces.len();
        Seams {
            pieces: n,
            table: (0..n * n).map(|k| between((k / n, k % n))).collect(),
        }
    }

    /// The seams of this many pieces by a rule of one's own.
    pub fn by(pieces: usize, between: impl Fn(usize, usize) -> Option<Seam>) -> Seams {
        let n = pieces;
        Seams {
            pieces,
            table: (0..n * n).map(|k| between(k / n, k % n)).collect(),
        }
    }

    /// The seam at which `next` follows `piece`, if it can.
    pub fn get(&self, piece: usize, next: usize) -> Option<Seam> {
        self.table[piece * self.pieces + next]
    }

    /// From now on `next` cannot follow `piece`.
    pub fn forbid(&mut self, piece: usize, next: usize) {
        self.table[piece * self.pieces + next] = None;
    }

    /// The mean cost of all seams that are possible.
    pub fn mean_cost(&self) -> f64 {
        let (sum, count) = self
            .table
            .iter()
            .flatten()
            .fold((0.0, 0.0), |(s, n), seam| (s + seam.cost, n + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    }
}

/// The mean width of all portals; a fiftieth of the exemplar's width where there are none.
fn mean_portal(pieces: &[Piece]) -> f64 {
    let widths = || {
        pieces
            .iter()
            .flat_map(|p| p.left.chunks(2))
            .map(|p| p[1].v - p[0].v)
    };
    match widths().count() {
        0 => pieces.iter().map(|p| p.width).sum::<f64>() / 50.0,
        n => widths().sum::<f64>() / n as f64,
    }
}

fn seam(a: &Piece, b: &Piece, natural: bool, tangent_weight: f64, unit: f64) -> Seam {
    if a.right.is_empty() {
        // No portal joins the two. Neighbours in the exemplar keep the gap that it has.
        let room = (a.width - a.bounds.max.x).max(0.0) + b.bounds.min.x.max(0.0);
        return Seam {
            cost: 0.0,
            rise: 0.0,
            gap: if natural { 0.0 } else { (unit - room).max(0.0) },
        };
    }
    let count = a.right.len() as f64;
    let differences = || a.right.iter().zip(&b.left).map(|(r, l)| r.v - l.v);
    let rise = if natural {
        0.0
    } else {
        differences().sum::<f64>() / count
    };
    let spread = differences().map(|d| (d - rise) * (d - rise)).sum::<f64>() / count;
    let mismatch = |g: Point, h: Point| (1.0 - g.dot(h)).max(0.0);
    let tangents: f64 = a
        .right
        .iter()
        .zip(&b.left)
        .map(|(r, l)| mismatch(r.tangent, l.tangent))
        .sum();
    let cost = (1.0 - tangent_weight) * spread / (unit * unit) + tangent_weight * tangents;
    Seam {
        cost: if natural { 0.0 } else { cost },
        rise,
        gap: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exemplar::piece::cut;
    use fretwork_geometry::Ring;

    /// A bar that rises by 1 on every 10, cut at 10, 20, 30, with two legs that are not cut.
    fn pieces() -> Vec<Piece> {
        let bar: Ring = [[0., 0.], [40., 4.], [40., 6.], [0., 2.]]
            .map(Point::from)
            .to_vec();
        cut(&[bar], 40.0, &[10.0, 20.0, 30.0]).unwrap()
    }

    #[test]
    fn neighbours_in_the_exemplar_cost_nothing() {
        let seams = Seams::new(&pieces(), 0.2);
        assert_eq!(
            seams.get(1, 2),
            Some(Seam {
                cost: 0.0,
                rise: 0.0,
                gap: 0.0
            })
        );
        let again = seams.get(2, 1).unwrap();
        assert!((again.rise - 2.0).abs() < 1e-12 && again.cost.abs() < 1e-12);
    }

    #[test]
    fn pieces_with_other_numbers_of_portals_do_not_follow() {
        let seams = Seams::new(&pieces(), 0.2);
        assert_eq!(seams.get(0, 0), None);
        // The end and a new beginning may stand side by side, a portal's width apart.
        assert_eq!(seams.get(3, 0).unwrap().gap, 2.0);
    }

    #[test]
    fn costs_do_not_depend_on_the_unit() {
        let bar: Ring = [[0., 0.], [40., 9.], [40., 11.5], [0., 2.]]
            .map(Point::from)
            .to_vec();
        let scaled: Ring = bar.iter().map(|&p| p * 25.4).collect();
        let seams = Seams::new(&cut(&[bar], 40.0, &[10.0, 20.0, 30.0]).unwrap(), 0.2);
        let inches = Seams::new(
            &cut(&[scaled], 1016.0, &[254.0, 508.0, 762.0]).unwrap(),
            0.2,
        );
        let (a, b) = (
            seams.get(2, 1).unwrap().cost,
            inches.get(2, 1).unwrap().cost,
        );
        assert!(a > 1e-3 && (a - b).abs() < 1e-9 * a, "{a} {b}");
    }
}
