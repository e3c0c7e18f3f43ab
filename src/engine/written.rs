//! A value's canonical bytes as they are made, named and kept.

use std::io::{self, Write};

use fretwork_action::Data;
use fretwork_store::{Digest, Naming};

/// Bytes of a piece: enough that there are few, and little beside what they are pieces of.
const PIECE: usize = 1 << 20;

/// The canonical bytes of a value in pieces. A list that grows takes half as much again whenever it is moved to a larger
/// place, which large values have no room for.
pub struct Written {
    /// What the bytes are named by.
    pub digest: Digest,
    /// How many they are.
    pub len: usize,
    /// The bytes, where they are wanted and are not those of a file, which the value has itself.
    pieces: Vec<Vec<u8>>,
}

impl Written {
    /// The bytes of `data`; only their name where it is not to be kept.
    pub fn of(data: &Data, is_kept: bool) -> Written {
        if let Data::File(bytes) = data {
            return Written {
                digest: Digest::of(bytes),
                len: bytes.len(),
                pieces: Vec::new(),
            };
        }
        let mut pen = Pen {
            naming: Naming::default(),
            len: 0,
            is_kept,
            piece: Vec::with_capacity(PIECE),
            pieces: Vec::new(),
        };
        data.write(&mut pen).expect("memory takes all bytes");
        pen.end_piece();
        Written {
            digest: pen.naming.digest(),
            len: pen.len,
            pieces: pen.pieces,
        }
    }

    /// The bytes of `data`, one piece after the other.
    pub fn pieces<'a>(&'a self, data: &'a Data) -> Vec<&'a [u8]> {
        match data {
            Data::File(bytes) => vec![bytes],
            _ => self.pieces.iter().map(Vec::as_slice).collect(),
        }
    }
}

/// Takes the bytes of a value.
struct Pen {
    naming: Naming,
    len: usize,
    is_kept: bool,
    piece: Vec<u8>,
    pieces: Vec<Vec<u8>>,
}

impl Pen {
    fn end_piece(&mut self) {
        self.naming.add(&self.piece);
        self.len += self.piece.len();
        if self.is_kept {
            let next = Vec::with_capacity(PIECE);
            self.pieces.push(std::mem::replace(&mut self.piece, next));
        } else {
            self.piece.clear();
        }
    }
}

impl Write for Pen {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.piece.len() + bytes.len() > PIECE {
            self.end_piece();
        }
        self.piece.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_geometry::{CurveLabels, Curves, Point};
    use std::sync::Arc;

    #[test]
    fn pieces_are_the_whole() {
        let mut curves = Curves::new();
        let point = |i: u32| Point::new(f64::from(i), 1.0 / f64::from(i + 1));
        curves.push((0..200_000).map(point), CurveLabels::default());
        for data in [
            Data::Curves(Arc::new(curves)),
            Data::File(vec![7; 3 * PIECE].into()),
        ] {
            let mut whole = Vec::new();
            data.write(&mut whole).unwrap();
            assert!(whole.len() > 3 * PIECE - 1);
            let written = Written::of(&data, true);
            assert_eq!(written.pieces(&data).concat(), whole);
            assert_eq!(
                (written.digest, written.len),
                (Digest::of(&whole), whole.len())
            );
            let named = Written::of(&data, false);
            assert_eq!((named.digest, named.len), (written.digest, written.len));
        }
    }
}
