//! Synthesizers by example in the plane, as simple as their papers have them, and the comparison with them.
//!
//! Both have it easier than a synthesizer on surfaces: their pixels are those of the exemplar, and one of
//! them copies whole blocks of it.

use fretwork_geometry::Seed;

use super::field::{Field, of_exemplar, of_square};
use super::*;

/// Pixels along a block of a quilt, and of how many it overlaps those before it.
const BLOCK: usize = 24;
const OVERLAP: usize = 8;

/// Image quilting (Efros and Freeman 2001): blocks of the exemplar in rows, each drawn from those that fit the ones
/// before it nearly best, joined along the cut of least difference.
fn quilted(exemplar: &Field, size: [usize; 2]) -> Field {
    let step = BLOCK - OVERLAP;
    let counts = size.map(|side| side.div_ceil(step));
    let wide = counts.map(|count| count * step + OVERLAP);
    let mut quilt = Field {
        size: wide,
        solid: vec![false; wide[0] * wide[1]],
    };
    for row in 0..counts[1] {
        for column in 0..counts[0] {
            let corner = [column * step, row * step];
            let seed = Seed::root(11).number(row as i64).number(column as i64);
            let from = block(&quilt, exemplar, corner, seed);
            lay(&mut quilt, exemplar, corner, from);
        }
    }
    cropped(&quilt, size)
}

/// Where the block at `corner` comes from: one of those whose difference from what is there is at most a tenth more
/// than the least.
fn block(quilt: &Field, exemplar: &Field, [x, y]: [usize; 2], seed: Seed) -> [usize; 2] {
    let is_over = |i: usize, j: usize| (x > 0 && i < OVERLAP) || (y > 0 && j < OVERLAP);
    let difference = |from: [usize; 2]| {
        let pixels = (0..BLOCK * BLOCK).map(|n| (n % BLOCK, n / BLOCK));
        let over = pixels.filter(|&(i, j)| is_over(i, j));
        over.filter(|&(i, j)| quilt.at(x + i, y + j) != exemplar.at(from[0] + i, from[1] + j))
            .count()
    };
    let [width, height] = exemplar.size;
    let places: Vec<[usize; 2]> = (0..width * height)
        .map(|n| [n % width, n / width])
        .collect();
    let differences: Vec<usize> = places.iter().map(|from| difference(*from)).collect();
    let most = *differences.iter().min().unwrap() as f64 * 1.1;
    let good: Vec<usize> = (0..places.len())
        .filter(|n| differences[*n] as f64 <= most)
        .collect();
    places[good[(seed.unit(0) * good.len() as f64) as usize]]
}

/// Lays a block, up to the cuts through its overlaps with what is to the left and above.
fn lay(quilt: &mut Field, exemplar: &Field, [x, y]: [usize; 2], from: [usize; 2]) {
    let new = |i: usize, j: usize| exemplar.at(from[0] + i, from[1] + j);
    let differs = |i: usize, j: usize| quilt.at(x + i, y + j) != new(i, j);
    let left = cut(|along, across| differs(across, along));
    let above = cut(differs);
    let is_new = |i: usize, j: usize| (x == 0 || i >= left[j]) && (y == 0 || j >= above[i]);
    let pixels = (0..BLOCK * BLOCK).map(|n| (n % BLOCK, n / BLOCK));
    let taken: Vec<(usize, bool)> = pixels
        .filter(|&(i, j)| is_new(i, j))
        .map(|(i, j)| ((y + j) * quilt.size[0] + x + i, new(i, j)))
        .collect();
    for (pixel, is_solid) in taken {
        quilt.solid[pixel] = is_solid;
    }
}

/// The way along an overlap over the fewest pixels that differ: how far across it is at each place along.
fn cut(differs: impl Fn(usize, usize) -> bool) -> Vec<usize> {
    let near = |across: usize| across.saturating_sub(1)..(across + 2).min(OVERLAP);
    let mut costs = vec![[0u32; OVERLAP]; BLOCK];
    for along in 0..BLOCK {
        for across in 0..OVERLAP {
            let before = match along {
                0 => 0,
                _ => near(across).map(|k| costs[along - 1][k]).min().unwrap(),
            };
            costs[along][across] = before + u32::from(differs(along, across));
        }
    }
    let mut way = vec![0; BLOCK];
    for along in (0..BLOCK).rev() {
        let range = if along + 1 == BLOCK {
            0..OVERLAP
        } else {
            near(way[along + 1])
        };
        way[along] = range.min_by_key(|k| costs[along][*k]).unwrap();
    }
    way
}

/// Pixel by pixel in rows (Wei and Levoy 2000, on one level): the pixel of the exemplar whose neighbours above and to
/// the left fit best, of equal ones any. Beyond the borders noise is there first.
fn sampled(exemplar: &Field, size: [usize; 2]) -> Field {
    const REACH: usize = 4;
    let around = |field: &Field, x: usize, y: usize| {
        let [x, y] = [x + field.size[0] - REACH, y + field.size[1] - REACH];
        let all = (0..(2 * REACH + 1) * REACH + REACH)
            .map(|n| (x + n % (2 * REACH + 1), y + n / (2 * REACH + 1)));
        all.fold(0u64, |bits, (x, y)| bits << 1 | u64::from(field.at(x, y)))
    };
    let [width, height] = exemplar.size;
    let known: Vec<(u64, bool)> = (0..width * height)
        .map(|n| (around(exemplar, n % width, n / width), exemplar.solid[n]))
        .collect();
    let seed = Seed::root(12);
    let any = |n: u64| known[(seed.unit(n) * known.len() as f64) as usize].1;
    let mut field = Field {
        size,
        solid: (0..(size[0] * size[1]) as u64).map(any).collect(),
    };
    for n in 0..field.solid.len() {
        let bits = around(&field, n % size[0], n / size[0]);
        let unlike = |(known, _): &(u64, bool)| (known ^ bits).count_ones();
        let least = known.iter().map(unlike).min().unwrap();
        let good: Vec<&(u64, bool)> = known.iter().filter(|k| unlike(k) == least).collect();
        let draw = seed.unit((size[0] * size[1] + n) as u64);
        field.solid[n] = good[(draw * good.len() as f64) as usize].1;
    }
    field
}

fn cropped(field: &Field, size: [usize; 2]) -> Field {
    let places = (0..size[0] * size[1]).map(|n| (n % size[0], n / size[0]));
    Field {
        size,
        solid: places.map(|(x, y)| field.at(x, y)).collect(),
    }
}

/// On a plane, windows of our textures are nearer to windows of the exemplar than those that are sampled pixel by pixel, small
/// ones and such that hold a whole motif, and so is the exemplar to them: nothing of it is lost. A quilt, which copies blocks
/// of a picture that tiles, is nearer still; so is an unshuffled texture of ours.
#[test]
fn textures_are_as_good_as_those_of_other_synthesizers() {
    let levels = levels(&shapes::square(128.0));
    let exemplars = [
        ("dots", exemplars::dots()),
        ("stripes", exemplars::stripes()),
        ("hooks", exemplars::hooks()),
    ];
    for (name, exemplar) in exemplars {
        let ours = [0.0, 1.0].map(|jitter| {
            let options = Options {
                jitter,
                up: [0.0, 1.0, 0.0],
                ..Options::default()
            };
            of_square(&levels, &made(&levels, &exemplar, &options))
        });
        let exemplar = of_exemplar(&exemplar);
        let size = ours[0].size;
        let others = [quilted(&exemplar, size), sampled(&exemplar, size)];
        for width in [7, 15] {
            let both = |field: &Field| {
                [(field, &exemplar), (&exemplar, field)].map(|(a, b)| a.distance(width, b))
            };
            let [plain, shuffled] = ours.each_ref().map(both);
            let [quilted, sampled] = others.each_ref().map(both);
            println!(
                "{name}, {width}: plain {plain:.4?}, shuffled {shuffled:.4?}, quilted {quilted:.4?}, sampled {sampled:.4?}"
            );
            for way in 0..2 {
                assert!(
                    shuffled[way] < 0.75 * sampled[way],
                    "{name}, {width}, {way}"
                );
                assert!(plain[way] < quilted[way] + 0.01, "{name}, {width}, {way}");
            }
        }
    }
}
