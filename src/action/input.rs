//! Typed references: what a `Ref<T>` gives in a stage.

use std::sync::Arc;

use super::{Action, Data, Value};
use fretwork_geometry::{Curves, Cutout, Drawing, Pixels, Region, SpaceCurve, SurfaceMesh, shell};
use fretwork_language::{Node, Wanted, kinds, wants};

/// A marker of a reference whose value has a type of its own.
pub trait Input: Wanted {
    /// What the reference gives.
    type Value;

    /// The value as this type, if it is one.
    fn of(value: &Value) -> Option<Self::Value>;
}

/// An arrangement in a stage that reads one.
#[derive(Clone, Debug)]
pub enum Lines {
    /// A function of regions, to be put together and applied.
    Function(Arc<Action>),
    /// One that was applied already.
    Applied(Arc<Curves>),
    /// A region, whose outline they are.
    Outline(Arc<Region>),
}

impl Lines {
    /// The value as lines or as what gives lines, if it is such.
    pub fn of(value: &Value) -> Option<Lines> {
        match value {
            Value::Deferred(action) => Some(Lines::Function(action.clone())),
            Value::Data(Data::Curves(curves)) => Some(Lines::Applied(curves.clone())),
            value => wants::Region::of(value).map(Lines::Outline),
        }
    }
}

/// Markers whose references give one sort of data.
macro_rules! data {
    ($($wanted:ident => $variant:ident($ty:ty);)*) => {
        $(
            impl Input for wants::$wanted {
                type Value = Arc<$ty>;

                fn of(value: &Value) -> Option<Arc<$ty>> {
                    match value {
                        Value::Data(Data::$variant(data)) => Some(data.clone()),
                        _ => None,
                    }
                }
            }
        )*
    };
}

data! {
    VectorExemplar => Drawing(Drawing);
    RasterExemplar => Pixels(Pixels);
    Curve => Curve(SpaceCurve);
    Surface => Surface(SurfaceMesh);
    Cutout => Cutout(Cutout);
    ShellStep => ShellStep(shell::Step);
}

impl Input for wants::Region {
    type Value = Arc<Region>;

    /// A region, or the shape in which a cutout is cut flat.
    fn of(value: &Value) -> Option<Arc<Region>> {
        match value {
            Value::Data(Data::Region(region)) => Some(region.clone()),
            Value::Data(Data::Cutout(cutout)) => Some(Arc::new(Region::of_area(cutout.flat()))),
            _ => None,
        }
    }
}

impl Input for wants::Arrangement {
    type Value = Lines;

    fn of(value: &Value) -> Option<Lines> {
        Lines::of(value)
    }
}

impl Input for wants::Field {
    type Value = Arc<Action>;

    fn of(value: &Value) -> Option<Arc<Action>> {
        match value {
            Value::Deferred(action) => Some(action.clone()),
            Value::Data(_) => None,
        }
    }
}

/// A part of another node, which is its definition and the fields in it.
#[derive(Clone, Debug)]
pub struct Described<K> {
    /// The action of the part, with what it names in turn.
    pub action: Arc<Action>,
    /// Its fields.
    pub kind: K,
}

/// Markers whose references give parts of other nodes.
macro_rules! described {
    ($($wanted:ident => $kind:ty;)*) => {
        $(
            impl Input for wants::$wanted {
                type Value = Described<$kind>;

                fn of(value: &Value) -> Option<Described<$kind>> {
                    match value {
                        Value::Deferred(action) => match &action.definition.node {
                            Node::$wanted(kind) => Some(Described {
                                action: action.clone(),
                                kind: kind.clone(),
                            }),
                            _ => None,
                        },
                        Value::Data(_) => None,
                    }
                }
            }
        )*
    };
}

described! {
    ForceProfile => kinds::force_profiles::ForceProfile;
    Layer => kinds::layers::Layer;
    Pattern => kinds::patterns::Pattern;
    Symbol => kinds::symbols::Symbol;
}
