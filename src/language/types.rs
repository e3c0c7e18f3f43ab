//! What a value is: the types of the language, sets of them, and references that want one of a set.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Decode, Decoder, Tree};

/// The type of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum ValueType {
    /// Polygons with holes in the plane.
    Region,
    /// A drawn exemplar: polygons, open curves, labelled points.
    VectorExemplar,
    /// An exemplar of pixels.
    RasterExemplar,
    /// A curve by arc length.
    Curve,
    /// A triangle mesh.
    Surface,
    /// A function of the plane or of a surface.
    Field,
    /// A function from regions to planar maps.
    Arrangement,
    /// Polygons with a proven number of pieces and holes.
    Cutout,
    /// A layout of sized, placed shapes.
    Facade,
    /// Material, loads, supports, limits.
    ForceProfile,
    /// Surface voxels tagged solid or empty.
    Shell,
    /// What a step on the way to a shell gives.
    ShellStep,
    /// A closed triangle mesh.
    Solid,
    /// The stresses in a body.
    Analysis,
    /// A letter of facade patterns.
    Symbol,
    /// A facade pattern.
    Pattern,
    /// A layer of facades.
    Layer,
    /// A file to be written.
    Artifact,
}

impl ValueType {
    /// All types.
    pub const ALL: [ValueType; 18] = [
        ValueType::Region,
        ValueType::VectorExemplar,
        ValueType::RasterExemplar,
        ValueType::Curve,
        ValueType::Surface,
        ValueType::Field,
        ValueType::Arrangement,
        ValueType::Cutout,
        ValueType::Facade,
        ValueType::ForceProfile,
        ValueType::Shell,
        ValueType::ShellStep,
        ValueType::Solid,
        ValueType::Analysis,
        ValueType::Symbol,
        ValueType::Pattern,
        ValueType::Layer,
        ValueType::Artifact,
    ];

    /// The type in words, for messages.
    pub fn name(self) -> &'static str {
        match self {
            ValueType::Region => "region",
            ValueType::VectorExemplar => "vector exemplar",
            ValueType::RasterExemplar => "raster exemplar",
            ValueType::Curve => "curve",
            ValueType::Surface => "surface",
            ValueType::Field => "field",
            ValueType::Arrangement => "arrangement",
            ValueType::Cutout => "cutout",
            ValueType::Facade => "facade",
            ValueType::ForceProfile => "force profile",
            ValueType::Shell => "shell",
            ValueType::ShellStep => "step of a shell",
            ValueType::Solid => "solid",
            ValueType::Analysis => "analysis",
            ValueType::Symbol => "symbol",
            ValueType::Pattern => "pattern",
            ValueType::Layer => "layer",
            ValueType::Artifact => "artifact",
        }
    }
}

/// A set of types.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct TypeSet(u32);

impl TypeSet {
    /// The set of `types`.
    pub const fn of(types: &[ValueType]) -> TypeSet {
        let mut bits = 0;
        let mut n = 0;
        while n < types.len() {
            bits |= 1 << types[n] as u32;
            n += 1;
        }
        TypeSet(bits)
    }

    /// The types of both.
    pub const fn with(self, other: TypeSet) -> TypeSet {
        TypeSet(self.0 | other.0)
    }

    /// The types but for `ty`.
    pub const fn without(self, ty: ValueType) -> TypeSet {
        TypeSet(self.0 & !(1 << ty as u32))
    }

    /// Whether `ty` is in the set.
    pub const fn contains(self, ty: ValueType) -> bool {
        self.0 & (1 << ty as u32) != 0
    }

    /// Whether a type is in both sets.
    pub const fn intersects(self, other: TypeSet) -> bool {
        self.0 & other.0 != 0
    }

    /// The types in order.
    pub fn types(self) -> impl Iterator<Item = ValueType> {
        ValueType::ALL
            .into_iter()
            .filter(move |ty| self.contains(*ty))
    }

    /// The types in words: `region or arrangement`.
    pub fn describe(self) -> String {
        let names: Vec<&str> = self.types().map(ValueType::name).collect();
        match &*names {
            [most @ .., last] if !most.is_empty() => format!("{} or {last}", most.join(", ")),
            _ => names.concat(),
        }
    }
}

/// `noun` after `a` or `an`.
pub fn with_article(noun: &str) -> String {
    let article = if noun.starts_with(['a', 'e', 'i', 'o', 'u']) {
        "an"
    } else {
        "a"
    };
    format!("{article} {noun}")
}

/// What a reference wants.
pub trait Wanted: 'static {
    /// The types that fit.
    const TYPES: TypeSet;
    /// Those of them that only stand in for others: of several entries of one name theirs is not meant.
    const STAND_INS: TypeSet;
    /// What it is called in the reference page.
    const NAME: &'static str;
}

/// The name of another entry, bare or `section.name`, whose value is one that `T` wants.
pub struct Ref<T> {
    /// As written.
    pub name: Arc<str>,
    wanted: PhantomData<fn() -> T>,
}

impl<T: Wanted> Ref<T> {
    /// A reference to `name`.
    pub fn new(name: impl Into<Arc<str>>) -> Ref<T> {
        Ref {
            name: name.into(),
            wanted: PhantomData,
        }
    }

    /// The types that fit.
    pub fn wants(&self) -> TypeSet {
        T::TYPES
    }
}

impl<T> Clone for Ref<T> {
    fn clone(&self) -> Ref<T> {
        Ref {
            name: self.name.clone(),
            wanted: PhantomData,
        }
    }
}

impl<T> std::fmt::Debug for Ref<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Ref({})", self.name)
    }
}

impl<T> PartialEq for Ref<T> {
    fn eq(&self, other: &Ref<T>) -> bool {
        self.name == other.name
    }
}

impl<T> Serialize for Ref<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name)
    }
}

impl<'de, T: Wanted> Deserialize<'de> for Ref<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Ref<T>, D::Error> {
        Arc::<str>::deserialize(deserializer).map(Ref::new)
    }
}

impl<T: Wanted> Decode for Ref<T> {
    fn decode(tree: &Tree, cx: &mut Decoder) -> Option<Ref<T>> {
        // An entry may be called `1` or `007`, which YAML reads as a number.
        let name = match tree.plain() {
            Tree::Text(name) if !name.trim().is_empty() => Some(name.clone()),
            Tree::Int(_) => tree.to_text(),
            _ => None,
        };
        let Some(name) = name else {
            return cx.mismatch(&format!("the name of {}", with_article(T::NAME)), tree);
        };
        cx.reference::<T>(&name, true)?;
        Some(Ref::new(name))
    }
}

impl<T: Wanted> JsonSchema for Ref<T> {
    fn schema_name() -> Cow<'static, str> {
        let words = T::NAME
            .split_whitespace()
            .map(|word| word[..1].to_uppercase() + &word[1..]);
        format!("NameOf{}", words.collect::<String>()).into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let doc = format!(
            "The name of {}, bare or as `section.name`. What fits: {}.",
            with_article(T::NAME),
            T::TYPES.describe()
        );
        json_schema!({ "title": T::NAME, "description": doc, "type": ["string", "integer"], "minLength": 1 })
    }
}

/// What references may want.
pub mod wants {
    use super::{TypeSet, ValueType as V, Wanted};

    /// Defines markers for [`Ref`](super::Ref).
    macro_rules! wanted {
        ($($(#[doc = $doc:literal])* $name:ident = $words:literal: $($ty:ident)|+ $(, else $($stand_in:ident)|+)?;)*) => {
            $(
                $(#[doc = $doc])*
                pub enum $name {}

                impl Wanted for $name {
                    const TYPES: TypeSet = TypeSet::of(&[$(V::$ty,)+ $($(V::$stand_in,)+)?]);
                    const STAND_INS: TypeSet = TypeSet::of(&[$($(V::$stand_in,)+)?]);
                    const NAME: &'static str = $words;
                }
            )*
        };
    }

    wanted! {
        /// A region, or the filled shape of a cutout in its place.
        Region = "region": Region, else Cutout;
        /// An exemplar of either sort.
        Exemplar = "exemplar": VectorExemplar | RasterExemplar;
        /// A drawn exemplar.
        VectorExemplar = "vector exemplar": VectorExemplar;
        /// An exemplar of pixels.
        RasterExemplar = "raster exemplar": RasterExemplar;
        /// A curve.
        Curve = "curve": Curve;
        /// A surface.
        Surface = "surface": Surface;
        /// A surface, or the sheet that the filled shape of a cutout or a region is without a thickness.
        Sheet = "surface or cutout": Surface, else Cutout | Region;
        /// A field.
        Field = "field": Field;
        /// An arrangement, or the outline of a region or a cutout in its place.
        Arrangement = "arrangement": Arrangement | Region, else Cutout;
        /// A cutout.
        Cutout = "cutout": Cutout;
        /// What can be drawn in the plane and made into pixels.
        Drawing = "drawing": Arrangement | Region | VectorExemplar | Cutout;
        /// A force profile.
        ForceProfile = "force profile": ForceProfile;
        /// A step on the way to a shell.
        ShellStep = "step of a shell": ShellStep;
        /// What has a volume of its own.
        Solid = "solid": Solid | Shell | Facade | Surface;
        /// What has a volume, or gets one by a thickness.
        Part = "part": Solid | Shell | Facade | Surface | Cutout, else Region;
        /// What has a volume, or gets one by a thickness where nothing else of its name does.
        Body = "body": Solid | Shell | Facade | Surface, else Cutout | Region;
        /// What an artifact can show.
        Product = "product": Region | VectorExemplar | RasterExemplar | Curve | Surface | Field | Arrangement | Cutout | Facade | Shell | Solid | Analysis;
        /// What a script can be handed.
        Argument = "argument": Region | VectorExemplar | Field | Arrangement, else Cutout;
        /// A symbol.
        Symbol = "symbol": Symbol;
        /// A pattern of symbols.
        Pattern = "pattern": Pattern;
        /// A layer of a facade.
        Layer = "layer": Layer;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_know_their_types() {
        let set = wants::Arrangement::TYPES;
        assert!(set.contains(ValueType::Region) && !set.contains(ValueType::Surface));
        assert_eq!(set.describe(), "region, arrangement or cutout");
        assert_eq!(wants::Arrangement::STAND_INS.describe(), "cutout");
        assert_eq!(wants::Sheet::STAND_INS.describe(), "region or cutout");
        assert_eq!(wants::Drawing::STAND_INS, TypeSet::default());
        assert!(set.intersects(wants::Drawing::TYPES) && !set.intersects(wants::Curve::TYPES));
        assert_eq!(wants::Product::TYPES.types().count(), 12);
    }
}
