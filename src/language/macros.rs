//! The macros that define the types of the language. One definition with docs, types and defaults gives
//! the struct, the code that reads it, and its description.

/// Defines a struct that is read from a map of fields.
///
/// A field is required unless it is an `Option` or has a default, which is written as a user would
/// write it. Groups after `+` share the map.
macro_rules! record {
    (
        $(#[doc = $doc:literal])*
        pub struct $name:ident {
            $( $(#[doc = $field_doc:literal])* $field:ident : $ty:ty $(= $default:expr)? ),* $(,)?
        }
        $( $(#[doc = $group_doc:literal])* + $group:ident : $group_ty:ty )*
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct $name {
            $( $(#[doc = $field_doc])* pub $field: $ty, )*
            $( $(#[doc = $group_doc])* pub $group: $group_ty, )*
        }

        impl $crate::record::Group for $name {
            fn describe(shape: &mut $crate::record::Shape, generator: &mut schemars::SchemaGenerator) {
                $(
                    let default = None::<$crate::Tree>$(.or(Some($crate::Tree::from($default))))?;
                    let name = $crate::record::plain(stringify!($field));
                    shape.field::<$ty>(name, concat!($($field_doc, "\n"),*), default, generator);
                )*
                $( <$group_ty as $crate::record::Group>::describe(shape, generator); )*
                let _ = (shape, generator);
            }

            fn read(fields: &mut $crate::record::Fields, cx: &mut $crate::Decoder) -> Option<Self> {
                $(
                    let default = None::<$crate::Tree>$(.or(Some($crate::Tree::from($default))))?;
                    let $field = fields.take::<$ty>($crate::record::plain(stringify!($field)), default, cx);
                )*
                $( let $group = <$group_ty as $crate::record::Group>::read(fields, cx); )*
                let _ = (fields, cx);
                Some($name { $($field: $field?,)* $($group: $group?,)* })
            }
        }

        $crate::macros::group_decode!($name, concat!($($doc, "\n"),*));
    };
}

/// Defines an enum of which a map holds exactly one: `{ name: value }`.
macro_rules! kinds {
    (
        $(#[doc = $doc:literal])*
        pub enum $name:ident {
            $( $(#[doc = $kind_doc:literal])* $kind:ident : $variant:ident($ty:ty) ),* $(,)?
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $( $(#[doc = $kind_doc])* $variant($ty), )*
        }

        impl $name {
            /// The kinds, as they are written.
            pub const KINDS: &[&str] = &[$($crate::record::plain(stringify!($kind))),*];

            /// The kind, as it is written.
            pub fn kind(&self) -> &'static str {
                match self {
                    $( $name::$variant(_) => $crate::record::plain(stringify!($kind)), )*
                }
            }
        }

        impl $crate::record::Group for $name {
            fn describe(shape: &mut $crate::record::Shape, generator: &mut schemars::SchemaGenerator) {
                $(
                    let name = $crate::record::plain(stringify!($kind));
                    shape.kind::<$ty>(name, concat!($($kind_doc, "\n"),*), generator);
                )*
                shape.exactly_one($name::KINDS.to_vec());
            }

            fn read(fields: &mut $crate::record::Fields, cx: &mut $crate::Decoder) -> Option<Self> {
                let kind = fields.only($name::KINDS, cx)?;
                $(
                    if kind == $crate::record::plain(stringify!($kind)) {
                        return fields.take::<$ty>(kind, None, cx).map($name::$variant);
                    }
                )*
                None
            }
        }

        $crate::macros::group_decode!($name, concat!($($doc, "\n"),*));
    };
}

/// How a group is read when it has a map of its own.
macro_rules! group_decode {
    ($name:ident, $doc:expr) => {
        impl $crate::Decode for $name {
            fn decode(tree: &$crate::Tree, cx: &mut $crate::Decoder) -> Option<Self> {
                $crate::record::decode_group(tree, cx)
            }
        }

        impl schemars::JsonSchema for $name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn schema_id() -> std::borrow::Cow<'static, str> {
                concat!(module_path!(), "::", stringify!($name)).into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let mut shape = $crate::record::Shape::default();
                <$name as $crate::record::Group>::describe(&mut shape, generator);
                shape.schema($doc)
            }
        }
    };
}

/// Defines an enum of words.
macro_rules! choice {
    (
        $(#[doc = $doc:literal])*
        pub enum $name:ident {
            $( $(#[doc = $word_doc:literal])* $word:ident : $variant:ident ),* $(,)?
        }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $( $(#[doc = $word_doc])* $variant, )*
        }

        impl $name {
            /// The words, as they are written.
            pub const WORDS: &[&str] = &[$(stringify!($word)),*];

            /// The word, as it is written.
            pub fn word(self) -> &'static str {
                match self {
                    $( $name::$variant => stringify!($word), )*
                }
            }

            /// What `word` means.
            pub fn from_word(word: &str) -> Option<$name> {
                match word {
                    $( stringify!($word) => Some($name::$variant), )*
                    _ => None,
                }
            }
        }

        impl $crate::Decode for $name {
            fn decode(tree: &$crate::Tree, cx: &mut $crate::Decoder) -> Option<Self> {
                let word = $crate::record::decode_word($name::WORDS, tree, cx)?;
                $name::from_word(word)
            }
        }

        impl schemars::JsonSchema for $name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn schema_id() -> std::borrow::Cow<'static, str> {
                concat!(module_path!(), "::", stringify!($name)).into()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let words = [$( (stringify!($word), concat!($($word_doc, "\n"),*)) ),*];
                $crate::record::choice_schema(concat!($($doc, "\n"),*), &words, generator)
            }
        }
    };
}

pub(crate) use {choice, group_decode, kinds, record};
