use super::outline::{Outline, Side};
use super::search::CHUNK;
use super::*;
use crate::{Point, Ring, Seed};

fn ring(points: &[[f64; 2]]) -> Ring {
    points.iter().map(|&p| Point::from(p)).collect()
}

fn polygon(outer: &[[f64; 2]], holes: &[&[[f64; 2]]]) -> Polygon {
    Polygon {
        outer: ring(outer),
        holes: holes.iter().map(|h| ring(h)).collect(),
    }
}

#[test]
fn what_is_found_is_the_narrowest_of_all_pairs() {
    let seed = Seed::root(8);
    for case in 0..40 {
        let seed = seed.number(case);
        let star = |centre: Point, k: u64| -> Ring {
            let radius = |i: u64| seed.range(100 * k + i, 1.0, 4.0);
            (0..40)
                .map(|i| centre + Point::unit(i as f64 * std::f64::consts::TAU / 40.0) * radius(i))
                .collect()
        };
        let at = |k: u64| Point::new(8.5 * (k % 3) as f64, 8.5 * (k / 3) as f64);
        let polygons: Vec<Polygon> = (0..6)
            .map(|k| Polygon {
                outer: star(at(k), k),
                holes: Vec::new(),
            })
            .collect();
        let outline = Outline::new(&polygons);
        let mut all = Vec::new();
        for side in [Side::Inside, Side::Outside] {
            let mut narrowest = f64::INFINITY;
            for site in outline.sites(outline.all(), side) {
                let pairs = (0..outline.edges.len() as u32)
                    .filter_map(|k| Some((k, outline.facing(&site, k, side, 1e9)?)));
                let free = pairs.filter(|(k, n)| {
                    !(0..outline.edges.len() as u32)
                        .any(|o| o != *k && !site.edges.contains(&o) && outline.crosses(o, n))
                        && !outline.is_tip(n, &site, *k, side)
                });
                let best = free.map(|f| f.1).min_by(|a, b| a.width.total_cmp(&b.width));
                narrowest = best.map_or(narrowest, |b| narrowest.min(b.width));
                all.extend(best);
            }
            assert_eq!(
                outline.narrowest(side).map(|n| n.width),
                Some(narrowest),
                "case {case}"
            );
        }
        all.retain(|n| n.width < 1.5);
        assert!(all.len() > 10);
        let widths = |necks: &[Neck]| necks.iter().map(|n| n.width).collect::<Vec<_>>();
        assert_eq!(widths(&outline.below(1.5)), widths(&all), "case {case}");
    }
}

#[test]
fn threads_find_what_one_search_finds() {
    let seed = Seed::root(9);
    let circle = |k: u64| -> Ring {
        let radius = |i: u64| seed.range(10_000 * k + i, 3.0, 4.0);
        (0..900)
            .map(|i| Point::unit(i as f64 * std::f64::consts::TAU / 900.0) * radius(i))
            .collect()
    };
    let moved = |k: u64| {
        circle(k)
            .into_iter()
            .map(|p| p + Point::new(8.5 * k as f64, 0.0))
            .collect()
    };
    let polygons: Vec<Polygon> = (0..5)
        .map(|k| Polygon {
            outer: moved(k),
            holes: Vec::new(),
        })
        .collect();
    let outline = Outline::new(&polygons);
    assert!(outline.all().end > 3 * CHUNK);
    let (grid, reach) = (outline.buckets(), outline.reach(f64::INFINITY).unwrap());
    let mut places = Vec::new();
    for side in [Side::Inside, Side::Outside] {
        let mut best = None;
        for site in outline.sites(outline.all(), side) {
            outline.search(&grid, &site, side, reach, &mut best);
            let mut near = None;
            outline.search(&grid, &site, side, 1.0, &mut near);
            places.extend(near);
        }
        assert_eq!(
            outline.narrowest(side).map(|n| n.width),
            best.map(|n| n.width)
        );
    }
    assert!(places.len() > 100);
    assert_eq!(outline.below(1.0), places);
}

#[test]
fn a_frame_is_as_wide_as_its_thinnest_side() {
    let frame = polygon(
        &[[0., 0.], [10., 0.], [10., 6.], [0., 6.]],
        &[&[[2., 1.], [2., 5.5], [7., 5.5], [7., 1.]]],
    );
    assert_eq!(
        narrowest_neck(std::slice::from_ref(&frame)).unwrap().width,
        0.5
    );
    assert_eq!(narrowest_gap(&[frame]).unwrap().width, 4.5);
}

#[test]
fn tips_are_no_necks() {
    let wedge = polygon(&[[0., 0.], [100., 0.], [100., 15.]], &[]);
    assert_eq!(narrowest_neck(&[wedge]), None);
    let bar = polygon(&[[0., 0.], [100., 0.], [100., 3.], [0., 3.]], &[]);
    assert_eq!(narrowest_neck(&[bar]).unwrap().width, 3.0);
}

#[test]
fn needles_are_no_necks_and_arms_are() {
    // The sides of the needle are nearly parallel up to its tip, which is cut off.
    let needle = polygon(
        &[
            [0., 0.],
            [100., 0.],
            [100., 50.],
            [0., 50.],
            [0., 25.9],
            [-40., 25.001],
            [-40., 25.],
            [0., 24.],
        ],
        &[],
    );
    let found = narrowest_neck(&[needle]).unwrap().width;
    assert!(found > 40.0, "{found}");
    // As wide at its end as at its root.
    let arm = polygon(
        &[
            [0., 0.],
            [100., 0.],
            [100., 50.],
            [0., 50.],
            [0., 26.],
            [-40., 26.],
            [-40., 25.],
            [0., 25.],
        ],
        &[],
    );
    assert_eq!(narrowest_neck(&[arm]).unwrap().width, 1.0);
}

#[test]
fn the_tip_of_a_slit_faces_what_is_beside_it() {
    // A narrow slit from above ends beside the steep side of a hole.
    let slit = [
        [0., 0.],
        [20., 0.],
        [20., 20.],
        [10.5, 20.],
        [10., 9.],
        [9.5, 20.],
        [0., 20.],
    ];
    let hole: &[[f64; 2]] = &[[10.0, 2.0], [5.0, 2.0], [9.0, 8.0]];
    let found = narrowest_neck(&[polygon(&slit, &[hole])]).unwrap();
    assert_eq!(
        (found.middle(), found.width),
        (Point::new(9.5, 8.5), 2f64.sqrt())
    );
    let beside: &[[f64; 2]] = &[[9.0, 4.0], [4.0, 4.0], [4.0, 14.0], [7.0, 14.0]];
    let found = narrowest_neck(&[polygon(&slit, &[beside])]).unwrap();
    assert_eq!(found.from, Point::new(10.0, 9.0));
    assert!(
        (found.width - 2.0 * 104f64.sqrt().recip() * 10.0).abs() < 1e-9,
        "{}",
        found.width
    );
}

#[test]
fn points_that_face_each_other_are_as_near_as_their_tips() {
    let left = polygon(&[[0., 0.], [10., 5.], [0., 10.]], &[]);
    let right = polygon(&[[10.5, 5.], [20., 0.], [20., 10.]], &[]);
    assert_eq!(narrowest_gap(&[left, right]).unwrap().width, 0.5);
}

#[test]
fn a_gap_between_two_parts_is_found_and_what_lies_behind_is_not() {
    let bar = |y: f64| polygon(&[[0., y], [50., y], [50., y + 2.], [0., y + 2.]], &[]);
    assert_eq!(
        narrowest_gap(&[bar(0.0), bar(2.25), bar(9.0)])
            .unwrap()
            .width,
        0.25
    );
    assert_eq!(narrowest_gap(&[bar(0.0), bar(9.0)]).unwrap().width, 7.0);
    assert_eq!(narrowest_gap(&[bar(0.0)]), None);
}

#[test]
fn round_rings_have_their_thickness() {
    let circle = |r: f64, x: f64, sign: f64| -> Ring {
        (0..200)
            .map(|i| {
                Point::unit(sign * std::f64::consts::TAU * f64::from(i) / 200.0) * r
                    + Point::new(x, 0.0)
            })
            .collect()
    };
    let ring = Polygon {
        outer: circle(10.0, 0.0, 1.0),
        holes: vec![circle(7.0, 1.0, -1.0)],
    };
    assert!((narrowest_neck(&[ring]).unwrap().width - 2.0).abs() < 0.01);
}
