//! The operators of element textures as functions of scripts: tables 3.2 to 3.6 of Loi (2015) in
//! snake_case, with the meaning that `SEMANTICS.md` gives them. Here arguments are unpacked, checked and
//! handed to plain functions; geometry is in the modules beside this one.

pub(crate) mod arguments;
mod incidence;
mod labels;
mod mapping;
mod measures;
mod merging;
mod partitions;
mod placing;
mod properties;
mod randomness;
mod unbounded;

use std::sync::LazyLock;

use starlark::environment::{Globals, GlobalsBuilder};

/// Puts the operators, the constants of borders and the functions of every script among the globals.
pub(crate) fn register(builder: &mut GlobalsBuilder) {
    fretwork_script::register(builder);
    named(builder);
    for (name, value) in arguments::BORDERS {
        builder.set(name, value);
    }
    for (alias, name) in ALIASES {
        let operator = NAMED.iter().find(|(known, _)| *known == name);
        builder.set(alias, operator.expect("an alias stands for an operator").1);
    }
}

/// The functions of a title of the reference.
type Group = (&'static str, fn(&mut GlobalsBuilder));

/// All operators, as they are registered and explained.
pub(crate) const GROUPS: [Group; 9] = [
    ("What partitions are made of", properties::register),
    ("Partitions", partitions::register),
    ("Mapping", mapping::register),
    ("Merging and masks", merging::register),
    ("Neighbours", incidence::register),
    ("Labels and borders", labels::register),
    ("Places and curves", measures::register),
    ("Placing", placing::register),
    ("Random numbers", randomness::register),
];

fn named(builder: &mut GlobalsBuilder) {
    for (_, register) in GROUPS {
        register(builder);
    }
}

static NAMED: LazyLock<Globals> = LazyLock::new(|| GlobalsBuilder::new().with(named).build());

/// Other names of operators: those of tiled planar maps (chapter 4), which give the same here, and
/// older names of `is_boundary`.
pub(crate) const ALIASES: [(&str, &str); 17] = [
    ("stripes_partition_tpm", "stripes_partition"),
    ("grid_partition_tpm", "grid_partition"),
    ("map_to_vertices_tpm", "map_to_vertices"),
    ("map_to_edges_tpm", "map_to_edges"),
    ("map_to_faces_tpm", "map_to_faces"),
    ("ghost_map_to_vertices", "map_to_vertices"),
    ("ghost_map_to_edges", "map_to_edges"),
    ("ghost_map_to_faces", "map_to_faces"),
    ("ghost_map_to_vertices_tpm", "map_to_vertices"),
    ("ghost_map_to_edges_tpm", "map_to_edges"),
    ("ghost_map_to_faces_tpm", "map_to_faces"),
    ("merge", "union"),
    ("merge_tpm", "union"),
    ("union_tpm", "union"),
    ("inside_tpm", "inside"),
    ("outside_tpm", "outside"),
    ("is_outside", "is_boundary"),
];
