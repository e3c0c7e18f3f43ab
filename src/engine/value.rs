//! What nodes give: values with a digest, in memory or still in the store.

use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};

use super::stage::ReadLog;
use fretwork_arrangement::Arrangement;
use fretwork_geometry::{Curves, Cutout, Drawing, Facade, Field, Mesh, Model, Region, SpaceCurve};
use fretwork_store::Digest;

/// The value of a node.
#[derive(Clone, Debug)]
pub enum Value {
    /// A value that is made of data, and so can be kept.
    Data(Data),
    /// A function of the plane.
    Field(Field),
    /// A function of regions.
    Arrangement(Function),
    /// A part of another node, which reads its definition.
    Definition,
}

/// An arrangement that has not been applied yet.
#[derive(Clone, Debug)]
pub struct Function {
    /// The function.
    pub arrangement: Arrangement,
    /// What the scripts in it have read, and will have read when it has been applied.
    pub logs: Vec<ReadLog>,
}

impl Value {
    /// The region, if it is one.
    pub fn region(&self) -> Option<&Arc<Region>> {
        match self {
            Value::Data(Data::Region(region)) => Some(region),
            _ => None,
        }
    }
}

/// Values that can be written down.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Data {
    /// A region.
    Region(Arc<Region>),
    /// A vector exemplar.
    Drawing(Arc<Drawing>),
    /// What an arrangement gives for a region.
    Curves(Arc<Curves>),
    /// A curve in space.
    Curve(Arc<SpaceCurve>),
    /// Areas with proven counts, and what they lie on.
    Cutout(Arc<Cutout>),
    /// A surface.
    Surface(Arc<Mesh>),
    /// Closed meshes, named and placed.
    Solid(Arc<Model>),
    /// Sized, placed shapes.
    Facade(Arc<Facade>),
    /// The bytes of an artifact.
    File(#[serde(with = "bytes")] Arc<[u8]>),
}

impl Data {
    /// The canonical bytes, by whose digest values are compared.
    pub fn encode(&self) -> Vec<u8> {
        match self {
            // An artifact's digest is that of its file.
            Data::File(bytes) => bytes.to_vec(),
            data => {
                postcard::to_allocvec(data).expect("values hold nothing that cannot be written")
            }
        }
    }

    /// The value with these canonical bytes; `is_file` tells whether it is an artifact.
    pub fn decode(bytes: Vec<u8>, is_file: bool) -> Option<Data> {
        if is_file {
            Some(Data::File(bytes.into()))
        } else {
            postcard::from_bytes(&bytes).ok()
        }
    }
}

mod bytes {
    //! Artifacts are encoded as themselves, never inside another value.
    use std::sync::Arc;

    pub fn serialize<S: serde::Serializer>(bytes: &Arc<[u8]>, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_bytes(bytes)
    }

    pub fn deserialize<'de, D: serde::Deserializer<'de>>(d: D) -> Result<Arc<[u8]>, D::Error> {
        Vec::<u8>::deserialize(d).map(Arc::from)
    }

    use serde::Deserialize as _;
}

/// The digest of a value, and the value as soon as somebody has needed it. Equal when the digests
/// are.
#[derive(Clone, Debug)]
pub struct Handle {
    /// The digest of the canonical bytes; for a function, of everything it is made from.
    pub digest: Digest,
    slot: Arc<OnceLock<Value>>,
}

impl PartialEq for Handle {
    fn eq(&self, other: &Handle) -> bool {
        self.digest == other.digest
    }
}

impl Handle {
    /// A value that may be in the store.
    pub fn absent(digest: Digest) -> Handle {
        Handle {
            digest,
            slot: Arc::default(),
        }
    }

    /// A value at hand.
    pub fn present(digest: Digest, value: Value) -> Handle {
        Handle {
            digest,
            slot: Arc::new(OnceLock::from(value)),
        }
    }

    /// The value, if it is at hand.
    pub fn get(&self) -> Option<&Value> {
        self.slot.get()
    }

    /// Keeps `value` at hand.
    pub fn fill(&self, value: Value) -> &Value {
        self.slot.get_or_init(|| value)
    }
}
