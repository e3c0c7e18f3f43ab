//! All co-optimal alignments of one candidate: those of the least error and, among these, of the most
//! columns (rule R9). They differ in what they demand of the sizes; alignments with the same demands
//! count as one. The lengths of wildcards are known here.
//!
//! The first pass expands the whole network up to the least error and keeps, at each vertex, every
//! parent that a best path comes from. The second pass goes over the vertices that lie on best paths,
//! from the start on, and collects the different sets of equations of the paths to each of them.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::align::network::Network;
use crate::align::place::{Passed, Place, State};
use crate::budget::Budget;
use crate::size::size_equations::SizeEquations;

/// A co-optimal alignment.
#[derive(Clone, Debug)]
pub struct CoOptimal {
    /// What it demands of the sizes.
    pub demands: SizeEquations,
    /// The places in all rows, at the start and after every column.
    pub path: Vec<Vec<Place>>,
}

/// The least error up to `bound`, and the alignments with it that have the most columns. At most
/// `most` different sets of equations are kept at each node. There are none if the budget runs out.
pub fn co_optimal(
    network: &Network,
    bound: i64,
    idle: &[bool],
    most: usize,
    budget: &mut Budget,
) -> (i64, Vec<CoOptimal>) {
    let network = &network.with_lower_bound(bound, budget);
    let row = &network.rows[0];
    let mut graph = Graph {
        network,
        spans_matter: row.steps(0, row.count()) + bound > network.longest,
        vertices: Vec::new(),
        index: HashMap::new(),
        open: BTreeMap::new(),
    };
    graph.add(network.start(), 0, None);
    // The vertices are taken in the order of their depth, which grows with every column.
    while let Some((_, ids)) = graph.open.pop_first() {
        for id in ids {
            let state = graph.vertices[id].state.clone();
            let columns = graph.vertices[id].columns + 1;
            let mut found = Vec::new();
            network.expand(&state, bound, budget, &mut |next, _| {
                found.push(next.clone())
            });
            for next in found {
                graph.add(next, columns, Some(id));
            }
            if budget.exhausted {
                return (0, Vec::new());
            }
        }
    }
    let Some(best) = graph.best() else {
        return (0, Vec::new());
    };
    let demands = graph.demands(&best.vertices, (idle, most), budget);
    (best.error, graph.collect(&best.ends, &demands))
}

/// A node of the network with the ends of the best paths to it.
struct Vertex {
    state: State,
    columns: usize,
    parents: Vec<usize>,
}

impl Vertex {
    /// The error and the columns, so that the best is the least.
    fn rank(&self) -> (i64, usize) {
        (self.state.error, usize::MAX - self.columns)
    }
}

/// What tells vertices apart: places, what was passed of transparent runs, and the span if it matters.
type Key = (Vec<Place>, Vec<Passed>, i64);

/// Where equations come from: a parent, and a number in the list of its sets of equations.
type Origin = Option<(usize, usize)>;

/// For each vertex: the different sets of equations of the best paths to it.
type Demands = BTreeMap<usize, Vec<(SizeEquations, Origin)>>;

/// The part of a network that can be reached with few errors.
struct Graph<'a> {
    network: &'a Network,
    vertices: Vec<Vertex>,
    index: HashMap<Key, usize>,
    /// The vertices that are not expanded yet, by depth.
    open: BTreeMap<usize, Vec<usize>>,
    /// Whether an alignment within the bound can be too long for the canvas.
    spans_matter: bool,
}

/// The best paths of a graph.
struct Best {
    error: i64,
    /// The vertices where they end.
    ends: Vec<usize>,
    /// All vertices that they lead over.
    vertices: BTreeSet<usize>,
}

impl Graph<'_> {
    /// Adds a path to a vertex if none that is known is better, and drops those that are worse.
    fn add(&mut self, state: State, columns: usize, parent: Option<usize>) {
        let span = if self.spans_matter { state.span } else { 0 };
        let key = (state.places.clone(), state.passed.clone(), span);
        let new = Vertex {
            state,
            columns,
            parents: parent.into_iter().collect(),
        };
        let Some(id) = self.index.get(&key).copied() else {
            let id = self.vertices.len();
            self.index.insert(key, id);
            self.open.entry(new.state.depth()).or_default().push(id);
            self.vertices.push(new);
            return;
        };
        let old = &mut self.vertices[id];
        match new.rank().cmp(&old.rank()) {
            Ordering::Less => *old = new,
            Ordering::Equal => old.parents.extend(parent),
            Ordering::Greater => {}
        }
    }

    /// The best paths; `None` if no path reaches the end.
    fn best(&self) -> Option<Best> {
        let all = 0..self.vertices.len();
        let ends: Vec<usize> = all
            .filter(|id| self.network.is_end(&self.vertices[*id].state.places))
            .collect();
        let rank = |id: &usize| self.vertices[*id].rank();
        let least = ends.iter().map(rank).min()?;
        let ends: Vec<usize> = ends.into_iter().filter(|id| rank(id) == least).collect();
        let mut vertices: BTreeSet<usize> = ends.iter().copied().collect();
        let mut stack = ends.clone();
        while let Some(id) = stack.pop() {
            for parent in &self.vertices[id].parents {
                if vertices.insert(*parent) {
                    stack.push(*parent);
                }
            }
        }
        Some(Best {
            error: least.0,
            ends,
            vertices,
        })
    }

    /// The sets of equations of the best paths to each of `vertices`, at most so many for each.
    fn demands(
        &self,
        vertices: &BTreeSet<usize>,
        (idle, most): (&[bool], usize),
        budget: &mut Budget,
    ) -> Demands {
        let mut order: Vec<usize> = vertices.iter().copied().collect();
        order.sort_by_key(|id| (self.vertices[*id].state.depth(), *id));
        let cost = 1 + self.network.rows.len() as u64;
        let mut demands = Demands::new();
        demands.insert(0, vec![(SizeEquations::default(), None)]);
        for id in order.into_iter().filter(|id| *id != 0) {
            let mut list: Vec<(SizeEquations, Origin)> = Vec::new();
            for parent in &self.vertices[id].parents {
                let column = [*parent, id].map(|id| &self.vertices[id].state.places[..]);
                let before = demands.get(parent).map_or(&[][..], |d| d);
                for (n, (before, _)) in before.iter().enumerate() {
                    if list.len() >= most || !budget.spend(cost) {
                        break;
                    }
                    let mut own = before.clone();
                    own.add_column(self.network, column, idle);
                    if !list.iter().any(|(other, _)| other.implied_by(&own)) {
                        list.retain(|(other, _)| !own.implied_by(other));
                        list.push((own, Some((*parent, n))));
                    }
                }
            }
            demands.insert(id, list);
        }
        demands
    }

    fn collect(&self, ends: &[usize], demands: &Demands) -> Vec<CoOptimal> {
        let mut found = Vec::new();
        for end in ends {
            for (own, origin) in demands.get(end).into_iter().flatten() {
                found.push(CoOptimal {
                    demands: own.clone(),
                    path: self.path(*end, *origin, demands),
                });
            }
        }
        found
    }

    fn path(&self, end: usize, origin: Origin, demands: &Demands) -> Vec<Vec<Place>> {
        let mut path = vec![self.vertices[end].state.places.clone()];
        let mut next = origin;
        while let Some((id, n)) = next {
            path.push(self.vertices[id].state.places.clone());
            next = demands
                .get(&id)
                .and_then(|list| list.get(n))
                .and_then(|(_, origin)| *origin);
        }
        path.reverse();
        path
    }
}
