//! A disc of triangles flattened as rigidly as possible: first onto a convex polygon, which turns no triangle over (Tutte 1963;
//! Floater 1997), then by local and global steps (Liu et al. 2008, section 4), which leave the border free.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use fretwork_geometry::{Point, Point3, budget};

/// Local and global steps. The energy falls fast at first: a dome of half a sphere changes by less than a thousandth after thirty.
const ROUNDS: usize = 60;

/// Steps charged for a triangle in a round.
const TRIANGLE: u64 = 60;

/// Where the corners of the disc lie in the plane, triangles counter-clockwise as they are seen from outside; `border` runs
/// around it counter-clockwise. None where a triangle has no area or the system cannot be solved.
pub fn flattened(
    positions: &[Point3],
    triangles: &[[u32; 3]],
    border: &[u32],
) -> Option<Vec<Point>> {
    budget::spend(
        "triangles to be flattened",
        TRIANGLE * (ROUNDS * triangles.len()) as u64,
    );
    let shapes: Option<Vec<Shape>> = triangles
        .iter()
        .map(|t| Shape::new(t.map(|c| positions[c as usize])))
        .collect();
    let shapes = shapes?;
    let mut flat = onto_circle(positions, triangles, border)?;
    let system = System::new(positions.len(), triangles, &shapes)?;
    for _ in 0..ROUNDS {
        flat = system.step(triangles, &shapes, &flat)?;
    }
    flat.iter().all(|p| p.is_finite()).then_some(flat)
}

/// A triangle laid flat by itself.
struct Shape {
    corners: [Point; 3],
    /// Half the cotangent of the angle opposite to the side from corner i to the next.
    weights: [f64; 3],
}

impl Shape {
    fn new([a, b, c]: [Point3; 3]) -> Option<Shape> {
        let length = (b - a).length();
        let x = (b - a) * (1.0 / length);
        let along = (c - a).dot(x);
        let high = ((c - a) - x * along).length();
        let corners = [
            Point::ORIGIN,
            Point::new(length, 0.0),
            Point::new(along, high),
        ];
        let cot = |i: usize| {
            let (at, p, q) = (corners[(i + 2) % 3], corners[i], corners[(i + 1) % 3]);
            0.5 * (p - at).dot(q - at) / (p - at).cross(q - at).abs()
        };
        let weights = [cot(0), cot(1), cot(2)];
        let is_sound = high > 1e-12 * length && weights.iter().all(|w| w.is_finite());
        is_sound.then_some(Shape { corners, weights })
    }
}

/// The corners with the border on a circle and every other one in the middle of its neighbours.
fn onto_circle(positions: &[Point3], triangles: &[[u32; 3]], border: &[u32]) -> Option<Vec<Point>> {
    let count = positions.len();
    let side = |i: usize| {
        let (a, b) = (border[i], border[(i + 1) % border.len()]);
        positions[a as usize].distance(positions[b as usize])
    };
    let around: f64 = (0..border.len()).map(side).sum();
    let radius = around / std::f64::consts::TAU;
    let mut fixed: Vec<Option<Point>> = vec![None; count];
    let mut way = 0.0;
    for (i, corner) in border.iter().enumerate() {
        let angle = std::f64::consts::TAU * way / around;
        fixed[*corner as usize] = Some(Point::unit(angle) * radius);
        way += side(i);
    }
    let mut entries: Vec<Triplet<usize, usize, f64>> = Vec::new();
    let mut loads = vec![[0.0; 2]; count];
    for t in triangles {
        for i in 0..3 {
            // Each inner edge comes twice, once in each direction.
            let (a, b) = (t[i] as usize, t[(i + 1) % 3] as usize);
            for (from, to) in [(a, b), (b, a)] {
                if fixed[from].is_none() {
                    entries.push(Triplet::new(from, from, 1.0));
                    match fixed[to] {
                        Some(p) => {
                            loads[from][0] += p.x;
                            loads[from][1] += p.y;
                        }
                        None if from > to => entries.push(Triplet::new(from, to, -1.0)),
                        None => {}
                    }
                }
            }
        }
    }
    for (corner, place) in fixed.iter().enumerate() {
        if let Some(p) = place {
            entries.push(Triplet::new(corner, corner, 1.0));
            loads[corner] = [p.x, p.y];
        }
    }
    Factor::new(count, &entries)?.solve(&loads)
}

/// The system of the global step: the cotangent Laplacian with its first corner held.
struct System {
    factor: Factor,
}

impl System {
    fn new(count: usize, triangles: &[[u32; 3]], shapes: &[Shape]) -> Option<System> {
        let mut entries = Vec::with_capacity(9 * triangles.len() + 1);
        let mut greatest = 0.0f64;
        for (t, shape) in triangles.iter().zip(shapes) {
            for i in 0..3 {
                let (a, b) = (t[i] as usize, t[(i + 1) % 3] as usize);
                let w = shape.weights[i];
                greatest = greatest.max(w.abs());
                entries.push(Triplet::new(a, a, w));
                entries.push(Triplet::new(b, b, w));
                entries.push(Triplet::new(a.max(b), a.min(b), -w));
            }
        }
        // Where the whole lies makes no difference; this decides it.
        entries.push(Triplet::new(0, 0, greatest.max(1.0)));
        let factor = Factor::new(count, &entries)?;
        Some(System { factor })
    }

    /// One turn of each triangle toward its place, and one solution for all places.
    fn step(&self, triangles: &[[u32; 3]], shapes: &[Shape], flat: &[Point]) -> Option<Vec<Point>> {
        let mut loads = vec![[0.0; 2]; flat.len()];
        for (t, shape) in triangles.iter().zip(shapes) {
            let (mut cos, mut sin) = (0.0, 0.0);
            for i in 0..3 {
                let (own, now) = shape.side(t, flat, i);
                cos += shape.weights[i] * own.dot(now);
                sin += shape.weights[i] * own.cross(now);
            }
            let length = libm::hypot(cos, sin);
            let (cos, sin) = if length > 0.0 {
                (cos / length, sin / length)
            } else {
                (1.0, 0.0)
            };
            for i in 0..3 {
                let (own, _) = shape.side(t, flat, i);
                let turned = Point::new(cos * own.x - sin * own.y, sin * own.x + cos * own.y);
                let w = shape.weights[i];
                let (a, b) = (t[i] as usize, t[(i + 1) % 3] as usize);
                loads[a][0] -= w * turned.x;
                loads[a][1] -= w * turned.y;
                loads[b][0] += w * turned.x;
                loads[b][1] += w * turned.y;
            }
        }
        self.factor.solve(&loads)
    }
}

impl Shape {
    /// Side number `i` as it is by itself and as it lies now.
    fn side(&self, t: &[u32; 3], flat: &[Point], i: usize) -> (Point, Point) {
        let j = (i + 1) % 3;
        (
            self.corners[j] - self.corners[i],
            flat[t[j] as usize] - flat[t[i] as usize],
        )
    }
}

/// A factorized symmetric matrix.
struct Factor {
    llt: Llt<usize, f64>,
}

impl Factor {
    /// From the entries of the lower triangle, which are added up.
    fn new(count: usize, entries: &[Triplet<usize, usize, f64>]) -> Option<Factor> {
        let matrix =
            SparseColMat::<usize, f64>::try_new_from_triplets(count, count, entries).ok()?;
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), faer::Side::Lower).ok()?;
        let llt = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), faer::Side::Lower).ok()?;
        Some(Factor { llt })
    }

    fn solve(&self, loads: &[[f64; 2]]) -> Option<Vec<Point>> {
        let mut x = faer::Mat::from_fn(loads.len(), 2, |i, j| loads[i][j]);
        self.llt.solve_in_place(&mut x);
        let places: Vec<Point> = (0..loads.len())
            .map(|i| Point::new(x[(i, 0)], x[(i, 1)]))
            .collect();
        places.iter().all(|p| p.is_finite()).then_some(places)
    }
}
