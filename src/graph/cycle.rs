//! The cycles of a directed graph, and an order of the nodes that lead to none.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;

/// The nodes that lead to no cycle, each after its successors and otherwise in the order of their
/// numbers; and a shortest cycle of every strongly connected component that has one. A cycle is a list
/// of nodes, each with the weight of the edge by which the cycle leaves it, and begins at its least node.
pub fn find_cycles(graph: &DiGraphMap<usize, usize>) -> (Vec<usize>, Vec<Vec<(usize, usize)>>) {
    let mut cycles: Vec<Vec<(usize, usize)>> = Vec::new();
    for component in tarjan_scc(graph) {
        let members: BTreeSet<usize> = component.into_iter().collect();
        let Some(&start) = members.first() else {
            continue;
        };
        if members.len() > 1 || graph.contains_edge(start, start) {
            cycles.push(shortest_cycle(graph, &members, start));
        }
    }
    cycles.sort();
    (order(graph), cycles)
}

/// A shortest cycle through `start` inside its component, by breadth-first search.
fn shortest_cycle(
    graph: &DiGraphMap<usize, usize>,
    members: &BTreeSet<usize>,
    start: usize,
) -> Vec<(usize, usize)> {
    let mut came_from: BTreeMap<usize, usize> = BTreeMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(node) = queue.pop_front() {
        for next in graph
            .neighbors(node)
            .filter(|n| members.contains(n))
            .collect::<BTreeSet<_>>()
        {
            if next == start {
                return walk_back(graph, &came_from, start, node);
            }
            if let Entry::Vacant(new) = came_from.entry(next) {
                new.insert(node);
                queue.push_back(next);
            }
        }
    }
    unreachable!("a strongly connected component leads back to its start")
}

fn walk_back(
    graph: &DiGraphMap<usize, usize>,
    came_from: &BTreeMap<usize, usize>,
    start: usize,
    last: usize,
) -> Vec<(usize, usize)> {
    let mut nodes = vec![last];
    while let Some(&node) = nodes.last().filter(|n| **n != start) {
        nodes.push(came_from[&node]);
    }
    nodes.reverse();
    let next = |i: usize| nodes[(i + 1) % nodes.len()];
    let weight = |i: usize| {
        graph
            .edge_weight(nodes[i], next(i))
            .copied()
            .expect("the cycle runs along edges")
    };
    (0..nodes.len()).map(|i| (nodes[i], weight(i))).collect()
}

/// Kahn's algorithm on the reversed graph, the least ready node first.
fn order(graph: &DiGraphMap<usize, usize>) -> Vec<usize> {
    let mut missing: BTreeMap<usize, usize> = graph
        .nodes()
        .map(|n| (n, graph.neighbors(n).count()))
        .collect();
    let mut ready: BTreeSet<usize> = missing
        .iter()
        .filter(|(_, m)| **m == 0)
        .map(|(n, _)| *n)
        .collect();
    let mut order = Vec::new();
    while let Some(node) = ready.pop_first() {
        order.push(node);
        for user in graph.neighbors_directed(node, petgraph::Direction::Incoming) {
            let count = missing.get_mut(&user).expect("every node is counted");
            *count -= 1;
            if *count == 0 {
                ready.insert(user);
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(edges: &[(usize, usize)]) -> DiGraphMap<usize, usize> {
        let mut graph = DiGraphMap::new();
        for (weight, (a, b)) in edges.iter().enumerate() {
            graph.add_edge(*a, *b, weight);
        }
        graph
    }

    #[test]
    fn the_whole_cycle_is_given_from_its_least_node() {
        let (order, cycles) = find_cycles(&graph(&[(3, 1), (1, 2), (2, 3), (4, 1), (5, 6)]));
        assert_eq!(cycles, [vec![(1, 1), (2, 2), (3, 0)]]);
        assert_eq!(order, [6, 5]);
    }

    #[test]
    fn a_node_that_needs_itself_is_a_cycle_and_shortcuts_are_taken() {
        let (_, cycles) = find_cycles(&graph(&[(7, 7), (1, 2), (2, 3), (3, 1), (2, 1)]));
        assert_eq!(cycles, [vec![(1, 1), (2, 4)], vec![(7, 0)]]);
    }
}
