//! Point sets of the whole plane, of which a window shows a part: for one seed the sites in a window
//! do not depend on the window, and a change of the density moves sites near the change only.

use super::ArrangementError;
use super::candidates::{Candidate, Candidates, Visitor};
use super::density::LocalDensity;
use super::error::LIMIT;
use crate::geometry::{Bounds, Point, Seed};

/// A site of a point set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Site {
    /// Where it is.
    pub position: Point,
    /// What it is known by in every window; the same one period further.
    pub key: Seed,
}

/// The least distance of sites of density 1 in a Poisson-disk set.
pub(super) const RADIUS: f64 = 0.8;

/// Candidates per site of a Poisson-disk set. After so many, random sequential packing of disks of
/// diameter 0.8/√d has reached 0.99 d (38 give 0.98 d, 60 give d; 1.09 d is where it jams).
const THROWS: f64 = 47.0;

/// The sites of a Poisson process in `window`, by position.
pub(super) fn poisson(density: &LocalDensity, window: &Bounds, seed: Seed) -> Result<Vec<Site>, ArrangementError> {
    let candidates = Candidates { density, ratio: 1.0, slices: 1, side: 2.0, seed };
    let mut all = All(Vec::new());
    candidates.visit(window, &mut all)?;
    Ok(by_position(all.0))
}

/// Makes every candidate a site.
struct All(Vec<Site>);

impl Visitor for All {
    fn has_covered(&self, _: &Bounds, _: f64) -> bool {
        false
    }

    fn refuses(&self, _: Point, _: f64) -> bool {
        false
    }

    fn take(&mut self, candidates: &[Candidate]) -> Result<(), ArrangementError> {
        self.0.extend(candidates.iter().map(|c| Site { position: c.position, key: c.key }));
        check_count(self.0.len())
    }
}

/// The sites of a Poisson-disk process in `window`, by position: random sequential packing, in
/// which candidates are taken in the order of their marks, and one is a site unless it is nearer
/// than the lesser of both radii to an earlier site. The radius is 0.8/√density at each.
///
/// The sites are those of the packing of the whole plane (Penrose 2001): what is outside can only
/// matter through chains of candidates in conflict. A margin around the window is packed too, and
/// every decision that could be otherwise for what lies outside of the margin is marked; if one
/// falls into the window, the margin grows. Chains die out exponentially; more than a few radii
/// are hardly ever needed.
pub(super) fn poisson_disk(density: &LocalDensity, window: &Bounds, seed: Seed) -> Result<Vec<Site>, ArrangementError> {
    let mut margin = MARGIN * RADIUS / density.range().0.sqrt();
    for _ in 0..24 {
        if let Some(sites) = Packing::run(density, window, margin, seed)? {
            return Ok(by_position(sites));
        }
        margin *= 1.5;
    }
    Err(ArrangementError::TooMany { what: "sites", count: f64::INFINITY })
}

/// The first margin in radii. Uncertain decisions become ten times rarer with every radius from the
/// margin's border.
const MARGIN: f64 = 8.0;

/// Slices and cells of the candidates' lattices; small cells are soon covered as a whole.
const SLICES: u32 = 4;
const SIDE: f64 = 1.0;

fn by_position(mut sites: Vec<Site>) -> Vec<Site> {
    sites.sort_by(|a, b| a.position.x.total_cmp(&b.position.x).then(a.position.y.total_cmp(&b.position.y)));
    sites
}

fn check_count(count: usize) -> Result<(), ArrangementError> {
    if count > LIMIT { Err(ArrangementError::TooMany { what: "sites", count: count as f64 }) } else { Ok(()) }
}

/// A candidate that is a site, or would be one for something that may lie outside.
struct Disk {
    site: Site,
    radius: f64,
    certain: bool,
    /// The next disk in the same bucket.
    next: u32,
}

const NONE: u32 = u32::MAX;

/// Random sequential packing of a box.
struct Packing {
    sample: Bounds,
    disks: Vec<Disk>,
    /// First disk of every bucket.
    heads: Vec<u32>,
    columns: usize,
    bucket: f64,
}

impl Packing {
    /// The sites in `window`, packing as far as `margin` around it; nothing when that is too little.
    fn run(
        density: &LocalDensity,
        window: &Bounds,
        margin: f64,
        seed: Seed,
    ) -> Result<Option<Vec<Site>>, ArrangementError> {
        let sample = window.grown(margin);
        let mut packing = Packing::new(sample, RADIUS / density.range().1.sqrt());
        Candidates { density, ratio: THROWS, slices: SLICES, side: SIDE, seed }.visit(&sample, &mut packing)?;
        packing.disks.retain(|disk| window.contains(disk.site.position));
        if packing.disks.iter().any(|disk| !disk.certain) {
            return Ok(None);
        }
        Ok(Some(packing.disks.into_iter().map(|disk| disk.site).collect()))
    }

    fn new(sample: Bounds, radius: f64) -> Packing {
        let bucket = radius.max((sample.width() * sample.height() / 4e6).sqrt());
        let columns = (sample.width() / bucket) as usize + 1;
        let rows = (sample.height() / bucket) as usize + 1;
        Packing { sample, disks: Vec::new(), heads: vec![NONE; columns * rows], columns, bucket }
    }

    fn throw(&mut self, candidate: &Candidate) {
        let (p, radius) = (candidate.position, RADIUS / candidate.density.sqrt());
        let unseen = !(self.sample.grown(-radius).contains(p));
        let Some(certain) = self.judge(p, radius, !unseen) else { return };
        let (column, row) = self.place(p);
        let head = &mut self.heads[row * self.columns + column];
        let site = Site { position: p, key: candidate.key };
        self.disks.push(Disk { site, radius, certain, next: *head });
        *head = (self.disks.len() - 1) as u32;
    }

    /// Nothing when a certain site is too near; otherwise whether it is certain that none is.
    fn judge(&self, p: Point, radius: f64, mut certain: bool) -> Option<bool> {
        let reach = Point::new(radius, radius);
        for disk in self.near(p - reach, p + reach) {
            let gap = disk.site.position - p;
            let least = radius.min(disk.radius);
            if gap.dot(gap) < least * least {
                if disk.certain {
                    return None;
                }
                certain = false;
            }
        }
        Some(certain)
    }

    /// The disks whose centres lie in the buckets that the box meets.
    fn near(&self, low: Point, high: Point) -> impl Iterator<Item = &Disk> {
        let ((left, bottom), (right, top)) = (self.place(low), self.place(high));
        let buckets = (bottom..=top).flat_map(move |row| (left..=right).map(move |column| row * self.columns + column));
        buckets.flat_map(|bucket| {
            let disk = |at: u32| self.disks.get(at as usize);
            std::iter::successors(disk(self.heads[bucket]), move |d| disk(d.next))
        })
    }

    /// Column and row of the bucket of `p`, or of the one nearest to it.
    fn place(&self, p: Point) -> (usize, usize) {
        let index = |v: f64, n: usize| ((v / self.bucket).max(0.0) as usize).min(n - 1);
        let from = p - self.sample.min;
        (index(from.x, self.columns), index(from.y, self.heads.len() / self.columns))
    }
}

impl Visitor for Packing {
    fn has_covered(&self, cell: &Bounds, cap: f64) -> bool {
        let (center, radius) = (cell.center(), RADIUS / cap.sqrt());
        let reach = Point::new(radius, radius);
        self.near(center - reach, center + reach).any(|disk| {
            let gap = disk.site.position - center;
            let far = Point::new(gap.x.abs() + cell.width() / 2.0, gap.y.abs() + cell.height() / 2.0);
            let least = radius.min(disk.radius);
            // A little less, for the rounding of places in the cell.
            disk.certain && far.dot(far) < least * least * (1.0 - 1e-9)
        })
    }

    fn refuses(&self, position: Point, density: f64) -> bool {
        self.judge(position, RADIUS / density.sqrt(), true).is_none()
    }

    fn take(&mut self, candidates: &[Candidate]) -> Result<(), ArrangementError> {
        candidates.iter().for_each(|candidate| self.throw(candidate));
        check_count(self.disks.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrangement::Density;
    use crate::geometry::{Field, Region};

    fn plane(d: f64) -> LocalDensity {
        LocalDensity::new(&Density::Constant(d), &Region::of_area(vec![])).unwrap()
    }

    fn window(x: f64, y: f64, side: f64) -> Bounds {
        Bounds { min: Point::new(x, y), max: Point::new(x + side, y + side) }
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
        sites.iter().copied().filter(|s| part.contains(s.position)).collect()
    }

    /// The least ratio of the distance of two sites to what it must be.
    fn tightest(sites: &[Site], radius: impl Fn(Point) -> f64) -> f64 {
        let mut least = f64::INFINITY;
        for (i, a) in sites.iter().enumerate() {
            for b in sites[i + 1..].iter().take_while(|b| b.position.x - a.position.x < 4.0 * radius(a.position)) {
                let needed = radius(a.position).min(radius(b.position));
                least = least.min(a.position.distance(b.position) / needed);
            }
        }
        least
    }

    #[test]
    fn counts_are_those_of_the_processes() {
        for (process, mean, variance) in [(BOTH[0], 1.0..1.0, 0.9..1.1), (BOTH[1], 0.985..0.995, 0.1..0.3)] {
            let sites = process(&plane(0.25), &window(-10.0, 7.0, 300.0), Seed::root(5)).unwrap();
            let mut counts = vec![0.0; 50 * 50];
            for site in &sites {
                let cell = |v: f64| ((v / 6.0) as usize).min(49);
                counts[cell(site.position.x + 10.0) * 50 + cell(site.position.y - 7.0)] += 1.0;
            }
            let of_cell = sites.len() as f64 / 2500.0;
            let spread = counts.iter().map(|c| (c - of_cell) * (c - of_cell)).sum::<f64>() / 2500.0;
            let error = 3.0 * (spread / 2500.0).sqrt();
            assert!(of_cell > 9.0 * mean.start - error && of_cell < 9.0 * mean.end + error, "{of_cell}");
            assert!(variance.contains(&(spread / of_cell)), "{spread} around {of_cell}");
        }
        let disks = poisson_disk(&plane(0.25), &window(0.0, 0.0, 100.0), Seed::root(6)).unwrap();
        let tightest = tightest(&disks, |_| 1.6);
        assert!((1.0..1.01).contains(&tightest), "{tightest}");
    }

    #[test]
    fn windows_show_the_same_plane() {
        let densities =
            [Density::Constant(1.0), field(|p| 1.5 + libm::sin(p.x / 7.0)), field(|p| libm::exp(-p.length() / 20.0))];
        for (density, process) in densities.iter().flat_map(|d| BOTH.map(|p| (d, p))) {
            let whole = window(-30.0, -30.0, 70.0);
            let all = process(&local(density, &whole), &whole, Seed::root(9)).unwrap();
            for part in [window(-3.0, 2.0, 31.0), window(13.7, -11.1, 5.0), window(-29.0, -29.0, 12.0)] {
                let shown = process(&local(density, &part), &part, Seed::root(9)).unwrap();
                assert!(!shown.is_empty());
                assert_eq!(shown, within(&all, &part));
            }
            assert_ne!(all, process(&local(density, &whole), &whole, Seed::root(10)).unwrap());
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
                let found = sites.iter().filter(|s| (low..high).contains(&s.position.x)).count() as f64;
                let expected = 100.0 * 25.0 * slope(Point::new((low + high) / 2.0, 0.0));
                assert!((found / expected - 1.0).abs() < 3.0 / expected.sqrt() + 0.02, "{found} for {expected}");
            }
            let middle = Point::new(50.0, 50.0);
            let bump = move |p: Point| slope(p) * if p.distance(middle) < 5.0 { 2.0 } else { 1.0 };
            let edited = process(&local(&field(bump), &part), &part, Seed::root(3)).unwrap();
            let far = |sites: &[Site]| -> Vec<Site> {
                sites.iter().copied().filter(|s| s.position.distance(middle) > 15.0).collect()
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
                let tile = Bounds { min: Point::new(-2.0, -2.0), max: Point::new(22.0, 8.0) };
                let sites = process(&density, &tile, Seed::root(2)).unwrap();
                assert!((sites.len() as f64 - 240.0 * d).abs() < 4.0 * (240.0 * d).sqrt());
                let by = Point::new(48.0, -30.0);
                let further = Bounds { min: tile.min + by, max: tile.max + by };
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
            assert!(matches!(LocalDensity::new(&Density::Constant(d), &empty), Err(ArrangementError::Density { .. })));
            let hole = field(move |p| if p.x > 3.0 { d } else { 1.0 });
            for process in BOTH {
                let (part, beside) = (window(0.0, 0.0, 10.0), window(-10.0, 0.0, 10.0));
                let found = process(&local(&hole, &part), &part, Seed::root(1));
                assert!(matches!(found, Err(ArrangementError::Density { at: Some(_), .. })), "{d} {found:?}");
                assert!(process(&local(&hole, &beside), &beside, Seed::root(1)).is_ok());
            }
        }
        for process in BOTH {
            let crowded = process(&plane(1e9), &window(0.0, 0.0, 10.0), Seed::root(1));
            assert!(matches!(crowded, Err(ArrangementError::TooMany { .. })));
            assert_eq!(process(&plane(1.0), &window(1e18, 0.0, 10.0), Seed::root(1)), Err(ArrangementError::Region));
        }
    }
}
