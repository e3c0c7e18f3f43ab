//! The part of a network that has to be noded again, taken out and put back.

use crate::planar_map::noding::bins::Cells;
use crate::planar_map::noding::exact::{Segment, before};
use crate::planar_map::noding::network::Network;
use crate::planar_map::noding::segments::Segments;
use crate::planar_map::noding::snap_grid::Site;

/// Where the pieces of an excerpt were taken from.
pub(in crate::planar_map) struct Excerpt {
    /// Segment, number of the piece along it, and whether it was turned round; ascending.
    taken: Vec<(u32, u32, bool)>,
}

impl Excerpt {
    /// All pieces near the pieces that end in `suspects`, as far as the same cells are near.
    pub fn around(suspects: &[u32], network: &Network, cells: &Cells) -> (Excerpt, Segments) {
        let Network { sites, routes } = network;
        let mut is_suspect = vec![false; sites.len()];
        suspects.iter().for_each(|v| is_suspect[*v as usize] = true);
        let segment =
            |piece: [u32; 2]| Segment::between(sites[piece[0] as usize], sites[piece[1] as usize]);
        let mut touched = vec![false; cells.len()];
        for v in suspects {
            touched[cells.owner(sites[*v as usize])] = true;
        }
        for piece in (0..routes.len()).flat_map(|i| routes.pieces(i)) {
            if piece.iter().any(|v| is_suspect[*v as usize]) {
                cells.near(&segment(piece).0, |cell| touched[cell] = true);
            }
        }
        let mut segments = Segments::default();
        let mut taken = Vec::new();
        for i in 0..routes.len() {
            for (k, piece) in (0u32..).zip(routes.pieces(i)) {
                let (piece, reversed) = segment(piece);
                let mut near = false;
                cells.near(&piece, |cell| near |= touched[cell]);
                if near {
                    segments.push([piece.a, piece.b], 0);
                    taken.push((i as u32, k, reversed));
                }
            }
        }
        (Excerpt { taken }, segments)
    }

    /// The network with its part replaced by what became of it, and the numbers in it of some nodes of the part.
    pub fn replace(self, network: Network, part: Network, nodes: &[u32]) -> (Network, Vec<u32>) {
        let (sites, of_old, of_part) = merged(&network.sites, &part.sites);
        let mut taken = self.taken.iter().enumerate().peekable();
        let routes = network.routes.renewed(|routes, i, renewed| {
            let first = renewed.len();
            for (k, piece) in (0u32..).zip(routes.pieces(i)) {
                match taken.next_if(|(_, t)| (t.0, t.1) == (i as u32, k)) {
                    None => renewed.extend(piece.map(|v| of_old[v as usize])),
                    Some((j, (.., false))) => {
                        renewed.extend(part.routes.of(j).iter().map(|v| of_part[*v as usize]))
                    }
                    Some((j, (.., true))) => {
                        renewed
                            .extend(part.routes.of(j).iter().rev().map(|v| of_part[*v as usize]));
                    }
                }
            }
            if renewed.len() == first {
                renewed.push(of_old[routes.of(i)[0] as usize]);
            }
        });
        (
            Network { sites, routes },
            nodes.iter().map(|v| of_part[*v as usize]).collect(),
        )
    }
}

/// Two lists of sites in reading order as one, and the places in it of each.
fn merged(p: &[Site], q: &[Site]) -> (Vec<Site>, Vec<u32>, Vec<u32>) {
    let (mut sites, mut of_p, mut of_q) = (Vec::with_capacity(p.len()), Vec::new(), Vec::new());
    let (mut i, mut j) = (0, 0);
    while i < p.len() || j < q.len() {
        let order = match (p.get(i), q.get(j)) {
            (Some(s), Some(t)) => before(*s, *t),
            (Some(_), None) => std::cmp::Ordering::Less,
            _ => std::cmp::Ordering::Greater,
        };
        let number = sites.len() as u32;
        sites.push(if order.is_le() { p[i] } else { q[j] });
        if order.is_le() {
            of_p.push(number);
            i += 1;
        }
        if order.is_ge() {
            of_q.push(number);
            j += 1;
        }
    }
    (sites, of_p, of_q)
}
