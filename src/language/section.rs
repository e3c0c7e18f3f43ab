//! The sections of a file, and what an entry of each becomes.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};

use super::kinds::{
    analyses::Analysis, arrangements::Arrangement, artifacts::Artifact, bands::Band, curves::Curve,
    exemplars::Exemplar, facades::Facade, fields::Field, force_profiles::ForceProfile,
    layers::Layer, panels::Panel, partitions::Partition, patterns::Pattern, regions::Region,
    shells::Shell, solids::Solid, surfaces::Surface, symbols::Symbol,
};
use super::types::{TypeSet, ValueType};
use super::{Decode, DecodeContext, Decoder, FileUse, Reference, Tree};
use fretwork_diagnostic::{Code, Diagnostic, nearest};

/// Defines the sections: name, variant, what an entry is.
macro_rules! sections {
    ($($(#[doc = $doc:literal])* $name:ident : $section:ident($ty:ident);)*) => {
        /// A section of a file.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        pub enum Section {
            $( $(#[doc = $doc])* $section, )*
        }

        /// An entry of a section with all that it says: lengths in the spec's unit, angles in
        /// radians, physical values in SI units. References are names still.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        pub enum Node {
            $( $(#[doc = $doc])* $ty($ty), )*
        }

        impl Section {
            /// All sections in the order of the language.
            pub const ALL: &[Section] = &[$(Section::$section),*];

            /// The key of the section in a file.
            pub fn name(self) -> &'static str {
                match self {
                    $( Section::$section => stringify!($name), )*
                }
            }

            /// The section whose key is `name`.
            pub fn named(name: &str) -> Option<Section> {
                match name {
                    $( stringify!($name) => Some(Section::$section), )*
                    _ => None,
                }
            }

            fn read(self, body: &Tree, cx: &mut Decoder) -> Option<Node> {
                match self {
                    $( Section::$section => <$ty as Decode>::decode(body, cx).map(Node::$ty), )*
                }
            }

            /// The JSON Schema of an entry, without what all entries share.
            pub(super) fn entry_schema(self, generator: &mut SchemaGenerator) -> Schema {
                match self {
                    $( Section::$section => <$ty as JsonSchema>::json_schema(generator), )*
                }
            }
        }

        impl Node {
            /// The section that the entry is from.
            pub fn section(&self) -> Section {
                match self {
                    $( Node::$ty(_) => Section::$section, )*
                }
            }
        }
    };
}

sections! {
    /// Small pieces of ornament.
    exemplars: Exemplars(Exemplar);
    /// Lines in the plane and in space.
    curves: Curves(Curve);
    /// Areas of the plane.
    regions: Regions(Region);
    /// Triangle meshes.
    surfaces: Surfaces(Surface);
    /// Functions of the plane and of surfaces.
    fields: Fields(Field);
    /// Arrangements that divide a region.
    partitions: Partitions(Partition);
    /// Element textures.
    arrangements: Arrangements(Arrangement);
    /// Patterns along curves.
    bands: Bands(Band);
    /// Patterns that fill a rectangle.
    panels: Panels(Panel);
    /// Letters of facade patterns.
    symbols: Symbols(Symbol);
    /// Words of symbols.
    patterns: Patterns(Pattern);
    /// Grids of shapes.
    layers: Layers(Layer);
    /// Layouts of shapes.
    facades: Facades(Facade);
    /// Materials, loads, supports.
    force_profiles: ForceProfiles(ForceProfile);
    /// Pixel patterns on surfaces.
    shells: Shells(Shell);
    /// Closed meshes.
    solids: Solids(Solid);
    /// Whether bodies are strong enough.
    analyses: Analyses(Analysis);
    /// Files that are made.
    artifacts: Artifacts(Artifact);
}

impl Section {
    /// Whether making the value of an entry may draw random values.
    pub fn is_random(self) -> bool {
        matches!(
            self,
            Section::Partitions
                | Section::Arrangements
                | Section::Bands
                | Section::Panels
                | Section::Shells
        )
    }

    /// The types that its entries may have.
    pub fn types(self) -> TypeSet {
        use ValueType as V;
        TypeSet::of(match self {
            Section::Exemplars => &[V::VectorExemplar, V::RasterExemplar],
            Section::Curves => &[V::Curve],
            Section::Regions => &[V::Region],
            Section::Surfaces => &[V::Surface],
            Section::Fields => &[V::Field],
            Section::Partitions => &[V::Arrangement],
            Section::Arrangements => &[V::Arrangement, V::Cutout],
            Section::Bands | Section::Panels => &[V::Cutout],
            Section::Symbols => &[V::Symbol],
            Section::Patterns => &[V::Pattern],
            Section::Layers => &[V::Layer],
            Section::Facades => &[V::Facade],
            Section::ForceProfiles => &[V::ForceProfile],
            Section::Shells => &[V::Shell],
            Section::Solids => &[V::Solid],
            Section::Analyses => &[V::Analysis],
            Section::Artifacts => &[V::Artifact],
        })
    }

    /// The kinds of its entries; empty where they have one kind that is not written.
    pub fn kinds(self) -> &'static [&'static str] {
        match self {
            Section::Exemplars => Exemplar::KINDS,
            Section::Curves => Curve::KINDS,
            Section::Regions => Region::KINDS,
            Section::Surfaces => Surface::KINDS,
            Section::Fields => Field::KINDS,
            Section::Partitions => Partition::KINDS,
            Section::Arrangements => Arrangement::KINDS,
            Section::Solids => Solid::KINDS,
            _ => &[],
        }
    }
}

impl Node {
    /// The kind as it is written; for sections of one kind, its name in the singular.
    pub fn kind_name(&self) -> &'static str {
        match self {
            Node::Exemplar(node) => node.kind(),
            Node::Curve(node) => node.kind(),
            Node::Region(node) => node.kind(),
            Node::Surface(node) => node.kind(),
            Node::Field(node) => node.kind(),
            Node::Partition(node) => node.kind(),
            Node::Arrangement(node) => node.kind(),
            Node::Band(_) => "band",
            Node::Panel(_) => "panel",
            Node::Symbol(_) => "symbol",
            Node::Pattern(_) => "pattern",
            Node::Layer(_) => "layer",
            Node::Facade(_) => "facade",
            Node::ForceProfile(_) => "force_profile",
            Node::Shell(_) => "shell",
            Node::Solid(node) => node.kind(),
            Node::Analysis(_) => "analysis",
            Node::Artifact(_) => "artifact",
        }
    }

    /// The type of its value.
    pub fn provides(&self) -> ValueType {
        match self {
            Node::Exemplar(node) => node.provides(),
            Node::Curve(_) => ValueType::Curve,
            Node::Region(_) => ValueType::Region,
            Node::Surface(_) => ValueType::Surface,
            Node::Field(_) => ValueType::Field,
            Node::Partition(_) => ValueType::Arrangement,
            Node::Arrangement(node) => node.provides(),
            Node::Band(_) | Node::Panel(_) => ValueType::Cutout,
            Node::Symbol(_) => ValueType::Symbol,
            Node::Pattern(_) => ValueType::Pattern,
            Node::Layer(_) => ValueType::Layer,
            Node::Facade(_) => ValueType::Facade,
            Node::ForceProfile(_) => ValueType::ForceProfile,
            Node::Shell(Shell::Whole(_)) => ValueType::Shell,
            Node::Shell(_) => ValueType::ShellStep,
            Node::Solid(_) => ValueType::Solid,
            Node::Analysis(_) => ValueType::Analysis,
            Node::Artifact(_) => ValueType::Artifact,
        }
    }
}

/// What the body of an entry says.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// The entry; nothing if it has errors.
    pub node: Option<Node>,
    /// The names that it uses, in the order of its fields.
    pub references: Vec<Reference>,
    /// The files that it uses, in the order of its fields.
    pub files: Vec<FileUse>,
    /// All errors and warnings.
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads the body of an entry of `section`, whose expressions have been replaced by their values.
pub fn decode(section: Section, body: &Tree, context: &DecodeContext) -> Decoded {
    let mut cx = Decoder::new(context);
    cx.scaled = section == Section::Artifacts && (context.is_scaled || body.get("scale").is_some());
    let node = match unknown_kind(section, body, &cx) {
        Some(unknown) => {
            cx.push(unknown);
            None
        }
        None => section.read(body, &mut cx),
    };
    let node = if cx.diagnostics.iter().any(Diagnostic::is_error) {
        None
    } else {
        node
    };
    Decoded {
        node,
        references: cx.references,
        files: cx.files,
        diagnostics: cx.diagnostics,
    }
}

/// The error for an entry whose only key is no kind of its section.
fn unknown_kind(section: Section, body: &Tree, cx: &Decoder) -> Option<Diagnostic> {
    let kinds = section.kinds();
    let [(key, _)] = body.as_map()? else {
        return None;
    };
    if kinds.is_empty() || kinds.contains(&&**key) {
        return None;
    }
    let unknown = Diagnostic::error(format!("`{key}` is not a kind of {}", section.name()))
        .about(Code::Field)
        .at(cx.key_span_of(key), "");
    Some(match nearest(key, kinds.iter().copied()) {
        Some(name) => unknown.help(format!("did you mean `{name}`?")),
        None => unknown.help(format!(
            "the kinds are {}",
            super::record::listed(kinds, "and")
        )),
    })
}
