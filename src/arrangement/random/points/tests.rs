//! Point sets: distances, windows, densities, tiles.

use super::*;
use crate::random::properties::Density;
use fretwork_geometry::{Field, Region};

fn plane(d: f64) -> LocalDensity {
    LocalDensity::new(&Density::Constant(d), &Region::of_area(vec![])).unwrap()
}

fn window(x: f64, y: f64, side: f64) -> Bounds {
    Bounds {
        min: Point::new(x, y),
        max: Point::new(x + side, y + side),
    }
}

fn field(d: impl Fn(Point) -> f64 + Send + Sync + 'static) -> Density {
    Density::Field(Field::new([0; 32], d))
}

fn local(density: &Density, part: &Bounds) -> LocalDensity {
    LocalDensity::new(density, &Region::rectangle(part.min, part.max)).unwrap()
}

type Process = fn(&LocalDensity, &Bounds, Seed) -> Result<Vec<Site>, ArrangementError>;
const BOTH: [Process; 2] = [poisson, poisson_disk];

fn within(sites: &[Site], part: &Bounds) -> Vec<Site> {
    sites
        .iter()
        .copied()
        .filter(|s| part.contains(s.position))
        .collect()
}

/// The least ratio of the distance of two sites to what it must be.
fn tightest(sites: &[Site], radius: impl Fn(Point) -> f64) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in sites.iter().enumerate() {
        for b in sites[i + 1..]
            .iter()
            .take_while(|b| b.position.x - a.position.x < 4.0 * radius(a.position))
        {
            let needed = radius(a.position).min(radius(b.position));
            least = least.min(a.position.distance(b.position) / needed);
        }
    }
    least
}

#[test]
fn counts_are_those_of_the_processes() {
    for (process, mean, variance) in [
        (BOTH[0], 1.0..1.0, 0.9..1.1),
        (BOTH[1], 0.985..0.995, 0.1..0.3),
    ] {
        let sites = process(&plane(0.25), &window(-10.0, 7.0, 300.0), Seed::root(5)).unwrap();
        let mut counts = vec![0.0; 50 * 50];
        for site in &sites {
            let cell = |v: f64| ((v / 6.0) as usize).min(49);
            counts[cell(site.position.x + 10.0) * 50 + cell(site.position.y - 7.0)] += 1.0;
        }
        let of_cell = sites.len() as f64 / 2500.0;
        let spread = counts
            .iter()
            .map(|c| (c - of_cell) * (c - of_cell))
            .sum::<f64>()
            / 2500.0;
        let error = 3.0 * (spread / 2500.0).sqrt();
        assert!(
            of_cell > 9.0 * mean.start - error && of_cell < 9.0 * mean.end + error,
            "{of_cell}"
        );
        assert!(
            variance.contains(&(spread / of_cell)),
            "{spread} around {of_cell}"
        );
    }
    let disks = poisson_disk(&plane(0.25), &window(0.0, 0.0, 100.0), Seed::root(6)).unwrap();
    let tightest = tightest(&disks, |_| 1.6);
    assert!((1.0..1.01).contains(&tightest), "{tightest}");
}

#[test]
fn windows_show_the_same_plane() {
    let densities = [
        Density::Constant(1.0),
        field(|p| 1.5 + libm::sin(p.x / 7.0)),
        field(|p| libm::exp(-p.length() / 20.0)),
    ];
    for (density, process) in densities.iter().flat_map(|d| BOTH.map(|p| (d, p))) {
        let whole = window(-30.0, -30.0, 70.0);
        let all = process(&local(density, &whole), &whole, Seed::root(9)).unwrap();
        for part in [
            window(-3.0, 2.0, 31.0),
            window(13.7, -11.1, 5.0),
            window(-29.0, -29.0, 12.0),
        ] {
            let shown = process(&local(density, &part), &part, Seed::root(9)).unwrap();
            assert!(!shown.is_empty());
            assert_eq!(shown, within(&all, &part));
        }
        assert_ne!(
            all,
            process(&local(density, &whole), &whole, Seed::root(10)).unwrap()
        );
    }
}

#[test]
fn sites_follow_the_density_and_change_near_its_changes() {
    let slope = |p: Point| 0.1 + 0.02 * p.x;
    let part = window(0.0, 0.0, 100.0);
    for process in BOTH {
        let sites = process(&local(&field(slope), &part), &part, Seed::root(3)).unwrap();
        for strip in 0..4 {
            let (low, high) = (25.0 * f64::from(strip), 25.0 * f64::from(strip + 1));
            let found = sites
                .iter()
                .filter(|s| (low..high).contains(&s.position.x))
                .count() as f64;
            let expected = 100.0 * 25.0 * slope(Point::new((low + high) / 2.0, 0.0));
            assert!(
                (found / expected - 1.0).abs() < 3.0 / expected.sqrt() + 0.02,
                "{found} for {expected}"
            );
        }
        let middle = Point::new(50.0, 50.0);
        let bump = move |p: Point| slope(p) * if p.distance(middle) < 5.0 { 2.0 } else { 1.0 };
        let edited = process(&local(&field(bump), &part), &part, Seed::root(3)).unwrap();
        let far = |sites: &[Site]| -> Vec<Site> {
            sites
                .iter()
                .copied()
                .filter(|s| s.position.distance(middle) > 15.0)
                .collect()
        };
        assert_eq!(far(&sites), far(&edited));
        assert_ne!(sites, edited);
    }
    let disks = poisson_disk(&local(&field(slope), &part), &part, Seed::root(3)).unwrap();
    assert!(tightest(&disks, |p| RADIUS / slope(p).sqrt()) >= 1.0);
}

#[test]
fn tiles_repeat() {
    let mut region = Region::rectangle(Point::new(5.0, 3.0), Point::new(29.0, 13.0));
    region.period = Some(Point::new(24.0, 10.0));
    for d in [0.5, 1.0, 3.0] {
        let density = LocalDensity::new(&Density::Constant(d), &region).unwrap();
        for process in BOTH {
            let tile = Bounds {
                min: Point::new(-2.0, -2.0),
                max: Point::new(22.0, 8.0),
            };
            let sites = process(&density, &tile, Seed::root(2)).unwrap();
            assert!((sites.len() as f64 - 240.0 * d).abs() < 4.0 * (240.0 * d).sqrt());
            let by = Point::new(48.0, -30.0);
            let further = Bounds {
                min: tile.min + by,
                max: tile.max + by,
            };
            let repeated = process(&density, &further, Seed::root(2)).unwrap();
            assert_eq!(repeated.len(), sites.len());
            for (a, b) in sites.iter().zip(&repeated) {
                assert!((a.position + by).distance(b.position) < 1e-9 && a.key == b.key);
            }
        }
    }
}

#[test]
fn densities_that_are_none_are_errors() {
    let empty = Region::of_area(vec![]);
    for d in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            LocalDensity::new(&Density::Constant(d), &empty),
            Err(ArrangementError::Density { .. })
        ));
        let hole = field(move |p| if p.x > 3.0 { d } else { 1.0 });
        for process in BOTH {
            let (part, beside) = (window(0.0, 0.0, 10.0), window(-10.0, 0.0, 10.0));
            let found = process(&local(&hole, &part), &part, Seed::root(1));
            assert!(
                matches!(found, Err(ArrangementError::Density { at: Some(_), .. })),
                "{d} {found:?}"
            );
            assert!(process(&local(&hole, &beside), &beside, Seed::root(1)).is_ok());
        }
    }
    for process in BOTH {
        let crowded = process(&plane(1e9), &window(0.0, 0.0, 10.0), Seed::root(1));
        assert!(matches!(crowded, Err(ArrangementError::TooMany { .. })));
        assert_eq!(
            process(&plane(1.0), &window(1e18, 0.0, 10.0), Seed::root(1)),
            Err(ArrangementError::Region)
        );
    }
}
