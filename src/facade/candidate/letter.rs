//! A letter of a word as the alignment reads it: a number, a length on the grid, and the flags that
//! rule R6 asks for.

/// A letter with its length and its flags. A transparent letter is never opaque, attached or
/// unoccludable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MeasuredLetter {
    /// The number of its symbol on the axis.
    pub symbol: usize,
    /// Its length.
    pub length: Length,
    /// Whether it hides whatever lies below it.
    pub opaque: bool,
    /// Whether an empty entry may not lie beside it.
    pub attached: bool,
    /// Whether only wholly opaque entries may cover it.
    pub unoccludable: bool,
    /// Whether it is not drawn, and may be cut.
    pub transparent: bool,
}

/// The preferred length of a letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Length {
    /// So many steps of the grid.
    Steps(i64),
    /// The length that the alignment finds for the wildcard of this number. Only transparent letters
    /// are wildcards.
    Wildcard(usize),
}
