//! The segments of the curves on their way through noding: stored by place, remembered in order.

use crate::planar_map::noding::bins::Cells;
use crate::planar_map::noding::exact::Segment;
use crate::planar_map::noding::snap_grid::Site;

/// Segments and the curves they are of. They are stored so that neighbours in the plane are neighbours in
/// memory, however the curves run.
#[derive(Default)]
pub(in crate::planar_map) struct Segments {
    pub by_place: Vec<Segment>,
    /// For every segment 2 × its curve, + 1 where the curve runs from b to a.
    pub curves: Vec<u32>,
    /// For every segment whether its curve begins ([`Segments::FIRST`]) and ends ([`Segments::LAST`]) with it.
    pub ends: Vec<u8>,
    /// The numbers of the segments in the order of the curves and along them; empty when that is
    /// the order in which they are stored.
    pub sequence: Vec<u32>,
}

impl Segments {
    /// A bit of `ends`.
    pub const FIRST: u8 = 1;
    /// A bit of `ends`.
    pub const LAST: u8 = 2;

    /// No segments, with room for some.
    pub fn with_capacity(most: usize) -> Segments {
        let (by_place, curves, ends) = (
            Vec::with_capacity(most),
            Vec::with_capacity(most),
            Vec::with_capacity(most),
        );
        Segments {
            by_place,
            curves,
            ends,
            sequence: Vec::new(),
        }
    }

    /// Adds a curve through sites; equal neighbours count once.
    pub fn push(&mut self, sites: impl IntoIterator<Item = Site>, curve: u32) {
        let first = self.by_place.len();
        let mut last = None;
        for site in sites {
            if let Some(from) = last.replace(site).filter(|from| *from != site) {
                let (segment, reversed) = Segment::between(from, site);
                self.by_place.push(segment);
                self.curves.push(2 * curve + u32::from(reversed));
                self.ends.push(0);
            }
        }
        if let [first, ..] = &mut self.ends[first..] {
            *first |= Segments::FIRST;
        }
        if let [.., last] = &mut self.ends[first..] {
            *last |= Segments::LAST;
        }
    }

    /// Stores segments of the same cell together, in the order of the cells.
    pub fn sort(&mut self, cells: &Cells) {
        let owners: Vec<u32> = self
            .by_place
            .iter()
            .map(|s| cells.owner(s.a) as u32)
            .collect();
        // Curves that run on from cell to cell are well as they are.
        if owners
            .windows(2)
            .filter(|w| w[0].abs_diff(w[1]) > 1)
            .count()
            * 4
            < owners.len()
        {
            return;
        }
        let mut next = vec![0u32; cells.len() + 1];
        owners.iter().for_each(|cell| next[*cell as usize + 1] += 1);
        for cell in 0..cells.len() {
            next[cell + 1] += next[cell];
        }
        let mut sorted = self.by_place.clone();
        let mut curves = self.curves.clone();
        let mut ends = self.ends.clone();
        self.sequence.clear();
        for (i, cell) in owners.into_iter().enumerate() {
            let place = &mut next[cell as usize];
            sorted[*place as usize] = self.by_place[i];
            curves[*place as usize] = self.curves[i];
            ends[*place as usize] = self.ends[i];
            self.sequence.push(*place);
            *place += 1;
        }
        (self.by_place, self.curves, self.ends) = (sorted, curves, ends);
    }
}
