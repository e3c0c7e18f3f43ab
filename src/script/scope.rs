//! Where randomness comes from while a script runs. Every partition and mapping operator that is
//! constructed takes the next ordinal of the scope it is constructed in: the entry function, the
//! call of a mapper on a cell, or a function that is applied as an arrangement (rule R14 of the arrangement room).

use fretwork_geometry::{Point, Seed, Snap};

use crate::values::cell::{Cell, CellKind};

/// A scope. Its values depend on where it stands among the scopes around it and on nothing else.
#[derive(Clone, Debug)]
pub struct Scope {
    /// Unknown as long as nobody asks for the seed of the scope of a cell.
    seed: Option<Seed>,
    /// The cell that a mapper is called on, if this is the scope of such a call.
    cell: Option<Cell>,
    /// The seeds of the cells of each kind, for `random(cell, …)`.
    kinds: [Seed; 3],
    /// The last cell whose seed was asked for.
    last: Option<(Cell, Seed)>,
    constructions: i64,
    draws: u64,
    /// Functions that were applied as arrangements here; the same one gets the same seed again.
    applied: Vec<u64>,
}

impl Scope {
    /// The scope of an entry function with this seed.
    pub fn entry(seed: Seed) -> Scope {
        Scope::with(Some(seed), None, cell_seeds(seed))
    }

    /// The scope of a mapper's call on `cell`; `kinds` are the [`cell_seeds`] of the mapping operator.
    pub fn call(cell: Cell, kinds: [Seed; 3]) -> Scope {
        Scope::with(None, Some(cell), kinds)
    }

    fn with(seed: Option<Seed>, cell: Option<Cell>, kinds: [Seed; 3]) -> Scope {
        Scope {
            seed,
            cell,
            kinds,
            last: None,
            constructions: 0,
            draws: 0,
            applied: Vec::new(),
        }
    }

    /// The cell whose seed this scope needs before [`Scope::construct`], [`Scope::draw`] and
    /// [`Scope::apply`] have a meaning; see [`Scope::settle`].
    pub fn wanted(&self) -> Option<Cell> {
        self.cell.filter(|_| self.seed.is_none())
    }

    /// Tells the seed of the cell that was wanted.
    pub fn settle(&mut self, seed: Seed) {
        self.seed = Some(seed);
    }

    fn seed(&self) -> Seed {
        self.seed.unwrap_or(self.kinds[0])
    }

    /// The seed of the next construction.
    pub fn construct(&mut self) -> Seed {
        self.constructions += 1;
        self.seed().number(self.constructions - 1)
    }

    /// The scope in which the function known as `identity` is applied.
    pub fn apply(&mut self, identity: u64) -> Scope {
        let known = self.applied.iter().position(|known| *known == identity);
        let ordinal = known.unwrap_or_else(|| {
            self.applied.push(identity);
            self.applied.len() - 1
        });
        Scope::entry(self.seed().name("function").number(ordinal as i64))
    }

    /// The next value of this scope's stream, uniform in [0, 1).
    pub fn draw(&mut self) -> f64 {
        self.draws += 1;
        self.seed().name("stream").unit(self.draws - 1)
    }

    /// The seed of `cell`, whose position is asked for when it is not the last one.
    pub fn cell(
        &mut self,
        cell: Cell,
        position: impl FnOnce() -> Option<Point>,
        snap: Snap,
    ) -> Option<Seed> {
        if let Some((known, seed)) = self.last
            && known == cell
        {
            return Some(seed);
        }
        let seed = self.position(cell.kind, position()?, snap);
        self.last = Some((cell, seed));
        Some(seed)
    }

    /// The seed of a cell at `position`, which is rounded by `snap`.
    pub fn position(&self, kind: CellKind, position: Point, snap: Snap) -> Seed {
        self.kinds[kind as usize].at(position, snap)
    }
}

/// The seeds of the kinds of cells that the construction with this seed has.
pub fn cell_seeds(construction: Seed) -> [Seed; 3] {
    [CellKind::Vertex, CellKind::Edge, CellKind::Face].map(|kind| construction.name(kind.name()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_constructed_first_does_not_depend_on_what_is_constructed_below() {
        let seed = Seed::root(1).name("entry");
        let mut plain = Scope::entry(seed);
        let mut busy = Scope::entry(seed);
        let first = plain.construct();
        assert_eq!(first, busy.construct());
        let mut below = busy.apply(77);
        below.construct();
        below.draw();
        assert_eq!(plain.construct(), busy.construct());
        assert_ne!(first, plain.construct());
    }

    #[test]
    fn a_function_applied_again_finds_its_seed_again() {
        let mut scope = Scope::entry(Seed::root(1));
        let (first, other) = (scope.apply(5).construct(), scope.apply(6).construct());
        assert_ne!(first, other);
        assert_eq!(first, scope.apply(5).construct());
    }
}
