//! The blocks of a raster that were decoded lately. There is room for some of them; those that were asked for least lately
//! make room for others. What is in a block, and how it is decoded, is not known here.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A decoded block; none for one that has no samples.
pub type Decoded = Option<Vec<u8>>;

/// So many blocks a thread finds again without asking others: those around a corner.
const NEAR: usize = 4;

/// Blocks of more bytes than this are not kept by threads of their own.
const LARGEST_NEAR: usize = 4 << 20;

/// What a thread remembers of a block: the number of its shelf, its own, and its samples.
type Remembered = Option<(u64, usize, Arc<OnceLock<Decoded>>)>;

thread_local! {
    static LATELY: RefCell<[Remembered; NEAR]> = const { RefCell::new([None, None, None, None]) };
}

/// Decoded blocks, each by its number.
#[derive(Debug)]
pub struct Shelf {
    /// Another one for every shelf of the process.
    id: u64,
    /// The bytes of a block, and how many blocks there is room for.
    block: usize,
    room: usize,
    held: Mutex<Held>,
}

#[derive(Debug, Default)]
struct Held {
    /// The blocks, and when each was last asked for.
    blocks: BTreeMap<usize, (u64, Arc<OnceLock<Decoded>>)>,
    /// The numbers of the blocks by that time.
    by_use: BTreeMap<u64, usize>,
    uses: u64,
}

impl Held {
    fn block(&mut self, number: usize, room: usize) -> Arc<OnceLock<Decoded>> {
        self.uses += 1;
        let now = self.uses;
        let (last, block) = self.blocks.entry(number).or_default();
        let block = block.clone();
        self.by_use.remove(&std::mem::replace(last, now));
        self.by_use.insert(now, number);
        while self.blocks.len() > room
            && let Some((_, oldest)) = self.by_use.pop_first()
        {
            self.blocks.remove(&oldest);
        }
        block
    }
}

impl Shelf {
    /// An empty shelf for blocks of `block` bytes that take `bytes` at most, or what the blocks around a corner take.
    pub fn new(block: usize, bytes: usize) -> Shelf {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        Shelf {
            id: COUNT.fetch_add(1, Ordering::Relaxed),
            block,
            room: (bytes / block.max(1)).max(NEAR),
            held: Mutex::default(),
        }
    }

    /// How many bytes so many blocks take when as many of them are held as may be.
    pub fn most(&self, count: usize) -> usize {
        self.block.saturating_mul(count.min(self.room))
    }

    /// What `read` makes of a block, which `decode` gives if it is not held. `place` is the number of the block among those
    /// around a corner: a thread remembers one for each place.
    pub fn with<T>(
        &self,
        number: usize,
        place: usize,
        decode: impl FnOnce() -> Decoded,
        read: impl Fn(Option<&[u8]>) -> T,
    ) -> T {
        // What threads remember is beyond the room of the shelf, so of large blocks it is one.
        let place = if self.block > LARGEST_NEAR {
            0
        } else {
            place % NEAR
        };
        let known = LATELY.with_borrow(|lately| match &lately[place] {
            Some((id, own, block)) if *id == self.id && *own == number => {
                block.get().map(|samples| read(samples.as_deref()))
            }
            _ => None,
        });
        known.unwrap_or_else(|| {
            let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
            let block = held.block(number, self.room);
            drop(held);
            let value = read(block.get_or_init(decode).as_deref());
            LATELY.with_borrow_mut(|lately| lately[place] = Some((self.id, number, block)));
            value
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn blocks_make_room_for_others_and_come_back() {
        let shelf = Shelf::new(10, 60);
        assert_eq!((shelf.most(2), shelf.most(100)), (20, 60));
        let decoded = Cell::new(0);
        let read = |number: usize| {
            let decode = || {
                decoded.set(decoded.get() + 1);
                Some(vec![number as u8; 10])
            };
            // Always at the same place, so that the thread remembers the last one only.
            shelf.with(number, 0, decode, |samples| {
                samples.map(|samples| samples[9])
            })
        };
        for number in [0, 0, 1, 2, 3, 4, 5, 0, 5] {
            assert_eq!(read(number), Some(number as u8));
        }
        assert_eq!(decoded.get(), 6);
        // The seventh block takes the place of 1, which was asked for least lately.
        assert_eq!((read(6), read(0), decoded.get()), (Some(6), Some(0), 7));
        assert_eq!((read(1), decoded.get()), (Some(1), 8));
        assert_eq!(shelf.held.lock().unwrap().blocks.len(), 6);
    }

    #[test]
    fn threads_tell_the_blocks_of_rasters_apart() {
        let shelves = [Shelf::new(1, 1), Shelf::new(1, 1)];
        for round in 0..2 {
            for (value, shelf) in (0..).zip(&shelves) {
                let decode = || (value == 1).then(|| vec![7]);
                let found = shelf.with(3, 1, decode, |samples| samples.map(<[u8]>::len));
                assert_eq!(found, (value == 1).then_some(1), "{round}");
            }
        }
    }
}
