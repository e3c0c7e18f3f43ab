//! fretwork is a compiler: a spec in YAML goes in, files that can be fabricated come out, and
//! everything between is a pure function of what is above it.
//!
//! The rooms, in the order in which data flows through them. Each is a package; its manifest says what
//! it may use.
//!
//! | room | what it does |
//! | --- | --- |
//! | [`diagnostic`] | what is wrong, where, and how it is shown |
//! | [`geometry`] | the kernel: points, curves, polygons, meshes, planar maps, fields, seeds |
//! | [`store`] | the action cache and its blobs |
//! | [`script`] | embedded Starlark: expressions, values, budgets |
//! | [`language`] | YAML text → typed nodes; schema and reference |
//! | [`graph`] | nodes → a named, typed, acyclic graph |
//! | [`source`] | foreign bytes → geometry, a file per format |
//! | [`action`] | what a stage is given and what it gives: plain data |
//! | [`primitive`] | regions, curves, surfaces, fields and exemplars from their kinds |
//! | [`arrangement`] | element textures |
//! | [`band`] | patterns along curves, panels |
//! | [`facade`] | layered facades |
//! | [`shell`] | pixel patterns on surfaces, in one piece and strong enough; finite elements |
//! | [`solid`] | extruded, turned and combined solids |
//! | [`wrap`] | drawings laid on surfaces |
//! | [`fabricate`] | geometry → bytes, a file per format |
//! | [`artifact`] | what a file shows: styles, sheets, elevations, measures |
//! | [`difference`] | what differs between two states of a file, in numbers and as a picture |
//! | [`stage`] | the one dispatch from a node to its room |
//! | [`engine`] | queries, firewalls, actions, scheduling: the only room that knows salsa |
//! | [`serve`] | the server of a page: who may ask, for what, how much; events |
//! | [`cli`] | one file per command; the only printing and reading of the disk |
//!
//! A build reads a spec and its includes, evaluates expressions behind a firewall of positions,
//! resolves names and plans jobs (a node, or an arrangement on a region). The engine gathers an
//! [`Action`](action::Action) for each: its definition, the values of its inputs, the bytes of its
//! files. It takes the value from memory, from the store, or from the [`stage`]. Values compare by the
//! digest of their canonical bytes, so one that comes out the same stops the rebuild there, in this
//! process and in the next. An action's name holds the [version](VERSIONS) of the rooms that make its
//! value, so an edit of one method leaves the results of the others valid.
//!
//! # The way of a band
//!
//! 1. [`language`] reads `bands.vine` into a `Band`, with the names of its exemplar and its curve.
//! 2. [`graph`] finds the two nodes; the engine's `definition` holds all three together.
//! 3. [`primitive::exemplar`] reads the SVG into a `Drawing`, [`primitive::curve`] makes a `SpaceCurve`.
//! 4. `engine::gather` puts both into the action of the band.
//! 5. [`stage::band`] takes the area that the drawing covers.
//! 6. [`band`] cuts it into pieces with portals, finds a sequence of them with the counts asked for, and
//!    lays it along the curve.
//! 7. The result is a [`Cutout`](geometry::Cutout), whose components and holes are counted once more.
//! 8. The artifact `vine.stl` gets it as its input: [`stage::artifact`] asks [`solid`] to thicken it.
//! 9. [`fabricate`] checks that the mesh is closed and writes the triangles.
//! 10. [`cli`] replaces the file in one step, if its bytes have changed.
//!
//! # The way of an arrangement
//!
//! 1. [`language`] reads `arrangements.seams` into a `Map`, whose script is text still.
//! 2. An arrangement is a function of regions. Its own job only puts it together, so that mistakes in
//!    the script are told at its node.
//! 3. An artifact that names `region: page` asks for a second job: the arrangement on that region.
//! 4. Inputs are applied to the same region by jobs of their own, but for those that a node applies to
//!    faces: these travel inside the action as definitions with inputs.
//! 5. [`stage::arrangement`] hands the action's values to [`arrangement::from_spec`].
//! 6. That compiles the script through [`script`] and returns a closure.
//! 7. Applied to the region, it builds the [`PlanarMap`](geometry::PlanarMap) of its partition, calls the
//!    mapper for each cell, and joins what comes back.
//! 8. Files that scripts load are read through the action, which notes them.
//! 9. The value is `Curves` with labels; [`artifact`] makes layers of them by the styles.
//! 10. [`fabricate`] makes up for the beam's width, orders the cuts and writes SVG or DXF.
//!
//! # The way of a facade
//!
//! 1. [`language`] reads symbols, patterns, layers and the facade, each a node.
//! 2. Symbols, patterns and layers have no values; their definitions are inputs of the facade's action.
//! 3. [`stage::description`] collects them by name into what the room takes.
//! 4. [`facade`] parses the patterns into trees and unrolls them into words, one axis at a time.
//! 5. Words become candidates, candidates are aligned, alignments are sized by a quadratic program.
//! 6. The best candidate under a growing tolerance gives the columns; the other axis gives the rows.
//! 7. Both together are a layout: sized, placed, visible cells.
//! 8. [`stage::facade`] puts boxes, meshes, textures and lines into the cells.
//! 9. GLB shows it as a scene; STL and 3MF as a solid on a back, flat or along a curve.
//! 10. [`artifact`] draws its elevation, from what is seen of each cell.

pub use fretwork_action as action;
pub use fretwork_arrangement as arrangement;
pub use fretwork_artifact as artifact;
pub use fretwork_band as band;
pub use fretwork_cli as cli;
pub use fretwork_diagnostic as diagnostic;
pub use fretwork_difference as difference;
pub use fretwork_engine as engine;
pub use fretwork_fabricate as fabricate;
pub use fretwork_facade as facade;
pub use fretwork_geometry as geometry;
pub use fretwork_graph as graph;
pub use fretwork_language as language;
pub use fretwork_primitive as primitive;
pub use fretwork_script as script;
pub use fretwork_serve as serve;
pub use fretwork_shell as shell;
pub use fretwork_solid as solid;
pub use fretwork_source as source;
pub use fretwork_stage as stage;
pub use fretwork_store as store;
pub use fretwork_wrap as wrap;

/// The versions of the rooms, which are digests of their source.
pub const VERSIONS: engine::Versions =
    engine::Versions(include!(concat!(env!("OUT_DIR"), "/versions.rs")));
