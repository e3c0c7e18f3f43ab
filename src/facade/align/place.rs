//! The nodes of an alignment network: how far each row is read between two columns, and what was
//! paid up to there.

/// A length that no facade has, in steps. Sixteen of them can be added without an overflow.
pub const ENDLESS: i64 = i64::MAX / 16;

/// How far a row is read, packed into a number, because a search copies and compares many places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place(u32);

/// The meaning of a [`Place`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reading {
    /// The row is read up to this letter.
    Before(usize),
    /// The row is read up to this letter, and its next entry is empty.
    Gap(usize),
    /// A column border lies in the run of transparent letters that begins with this one.
    Inside(usize),
}

impl Place {
    /// The place of a reading.
    pub fn new(reading: Reading) -> Place {
        let (letter, kind) = match reading {
            Reading::Before(letter) => (letter, 0),
            Reading::Gap(letter) => (letter, 1),
            Reading::Inside(letter) => (letter, 2),
        };
        Place((letter as u32) << 2 | kind)
    }

    /// The meaning of the place.
    pub fn reading(self) -> Reading {
        match self.0 & 3 {
            0 => Reading::Before(self.letter()),
            1 => Reading::Gap(self.letter()),
            _ => Reading::Inside(self.letter()),
        }
    }

    /// The number of letters that are wholly read.
    pub fn letter(self) -> usize {
        (self.0 >> 2) as usize
    }

    /// Whether the place lies in a transparent run.
    pub fn is_inside(self) -> bool {
        self.0 & 3 == 2
    }
}

/// The lengths, in steps, that the columns since the begin of a transparent run can have together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Passed {
    /// The sum of the shortest entries.
    pub least: i64,
    /// The sum of the longest entries.
    pub most: i64,
    /// How much shorter the shortest entries could be made, at a cost of one for each step.
    pub spare: i64,
}

/// A node of the network: a place between two columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// The place in each row.
    pub places: Vec<Place>,
    /// What each row has passed of a transparent run; zero outside of one.
    pub passed: Vec<Passed>,
    /// The least and the greatest length that each wildcard can have at the error so far.
    pub lengths: Vec<(i64, i64)>,
    /// The error so far.
    pub error: i64,
    /// The sum of the longest entries so far.
    pub span: i64,
}

impl State {
    /// The number of letters read in all rows. Every column holds an opaque entry, so that it grows
    /// with each column of a path.
    pub fn depth(&self) -> usize {
        depth(&self.places)
    }
}

/// The number of letters read up to these places.
pub fn depth(places: &[Place]) -> usize {
    places.iter().map(|place| place.letter()).sum()
}

/// The part of a column in one row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Entry {
    /// Nothing: the row makes room for an opaque entry above it.
    Empty,
    /// The solid letters from the first number up to the second.
    Solid(usize, usize),
    /// A part of the transparent run that begins with this letter.
    Piece(usize),
}
