//! Point sets of the whole plane, of which a window shows a part: for one seed the sites in a window
//! do not depend on the window, and a change of the density moves sites near the change only.

use crate::error::ArrangementError;
use crate::limit::LIMIT;
use crate::random::candidates::{Candidate, Candidates, Visitor};
use crate::random::density::LocalDensity;
use fretwork_geometry::{Bounds, Point, Seed};

/// A site of a point set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Site {
    /// Where it is.
    pub position: Point,
    /// What it is known by in every window; the same one period further.
    pub key: Seed,
}

/// The least distance of sites of density 1 in a Poisson-disk set.
pub(crate) const RADIUS: f64 = 0.8;

/// Candidates per site of a Poisson-disk set. After so many, random sequential packing of disks of
/// diameter 0.8/√d has reached 0.99 d (38 give 0.98 d, 60 give d; 1.09 d is where it jams).
const THROWS: f64 = 47.0;

/// The sites of a Poisson process in `window`, by position.
pub(crate) fn poisson(
    density: &LocalDensity,
    window: &Bounds,
    seed: Seed,
) -> Result<Vec<Site>, ArrangementError> {
    let candidates = Candidates {
        density,
        ratio: 1.0,
        slices: 1,
        side: 2.0,
        seed,
    };
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
        self.0.extend(candidates.iter().map(|c| Site {
            position: c.position,
            key: c.key,
        }));
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
pub(crate) fn poisson_disk(
    density: &LocalDensity,
    window: &Bounds,
    seed: Seed,
) -> Result<Vec<Site>, ArrangementError> {
    let mut margin = MARGIN * RADIUS / density.range().0.sqrt();
    for _ in 0..24 {
        if let Some(sites) = Packing::run(density, window, margin, seed)? {
            return Ok(by_position(sites));
        }
        margin *= 1.5;
    }
    Err(ArrangementError::TooMany {
        what: "sites",
        count: f64::INFINITY,
    })
}

/// The first margin in radii. Uncertain decisions become ten times rarer with every radius from the
/// margin's border.
const MARGIN: f64 = 8.0;

/// Slices and cells of the candidates' lattices; small cells are soon covered as a whole.
const SLICES: u32 = 4;
const SIDE: f64 = 1.0;

fn by_position(mut sites: Vec<Site>) -> Vec<Site> {
    sites.sort_by(|a, b| {
        a.position
            .x
            .total_cmp(&b.position.x)
            .then(a.position.y.total_cmp(&b.position.y))
    });
    sites
}

fn check_count(count: usize) -> Result<(), ArrangementError> {
    if count > LIMIT {
        Err(ArrangementError::TooMany {
            what: "sites",
            count: count as f64,
        })
    } else {
        Ok(())
    }
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
        Candidates {
            density,
            ratio: THROWS,
            slices: SLICES,
            side: SIDE,
            seed,
        }
        .visit(&sample, &mut packing)?;
        packing
            .disks
            .retain(|disk| window.contains(disk.site.position));
        if packing.disks.iter().any(|disk| !disk.certain) {
            return Ok(None);
        }
        Ok(Some(
            packing.disks.into_iter().map(|disk| disk.site).collect(),
        ))
    }

    fn new(sample: Bounds, radius: f64) -> Packing {
        let bucket = radius.max((sample.width() * sample.height() / 4e6).sqrt());
        let columns = (sample.width() / bucket) as usize + 1;
        let rows = (sample.height() / bucket) as usize + 1;
        Packing {
            sample,
            disks: Vec::new(),
            heads: vec![NONE; columns * rows],
            columns,
            bucket,
        }
    }

    fn throw(&mut self, candidate: &Candidate) {
        let (p, radius) = (candidate.position, RADIUS / candidate.density.sqrt());
        let unseen = !(self.sample.grown(-radius).contains(p));
        let Some(certain) = self.judge(p, radius, !unseen) else {
            return;
        };
        let (column, row) = self.place(p);
        let head = &mut self.heads[row * self.columns + column];
        let site = Site {
            position: p,
            key: candidate.key,
        };
        self.disks.push(Disk {
            site,
            radius,
            certain,
            next: *head,
        });
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
        let buckets = (bottom..=top)
            .flat_map(move |row| (left..=right).map(move |column| row * self.columns + column));
        buckets.flat_map(|bucket| {
            let disk = |at: u32| self.disks.get(at as usize);
            std::iter::successors(disk(self.heads[bucket]), move |d| disk(d.next))
        })
    }

    /// Column and row of the bucket of `p`, or of the one nearest to it.
    fn place(&self, p: Point) -> (usize, usize) {
        let index = |v: f64, n: usize| ((v / self.bucket).max(0.0) as usize).min(n - 1);
        let from = p - self.sample.min;
        (
            index(from.x, self.columns),
            index(from.y, self.heads.len() / self.columns),
        )
    }
}

impl Visitor for Packing {
    fn has_covered(&self, cell: &Bounds, cap: f64) -> bool {
        let (center, radius) = (cell.center(), RADIUS / cap.sqrt());
        let reach = Point::new(radius, radius);
        self.near(center - reach, center + reach).any(|disk| {
            let gap = disk.site.position - center;
            let far = Point::new(
                gap.x.abs() + cell.width() / 2.0,
                gap.y.abs() + cell.height() / 2.0,
            );
            let least = radius.min(disk.radius);
            // A little less, for the rounding of places in the cell.
            disk.certain && far.dot(far) < least * least * (1.0 - 1e-9)
        })
    }

    fn refuses(&self, position: Point, density: f64) -> bool {
        self.judge(position, RADIUS / density.sqrt(), true)
            .is_none()
    }

    fn take(&mut self, candidates: &[Candidate]) -> Result<(), ArrangementError> {
        candidates
            .iter()
            .for_each(|candidate| self.throw(candidate));
        check_count(self.disks.len())
    }
}

#[cfg(test)]
mod tests;
