//! What nodes give.

use std::any::Any;
use std::fmt;
use std::io::{self, Write};
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Action;
use fretwork_geometry::{
    Curves, Cutout, Drawing, Facade, Model, Pixels, Region, Shell, SpaceCurve, SurfaceMesh, shell,
};
use fretwork_language::ValueType;

/// The value of a node.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Value {
    /// Data.
    Data(Data),
    /// A function of the plane or of regions, or a part of another node: its definition and inputs,
    /// which are put together where they are applied.
    Deferred(Arc<Action>),
}

/// Values that are made of data.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Data {
    /// A region.
    Region(Arc<Region>),
    /// A vector exemplar.
    Drawing(Arc<Drawing>),
    /// A raster exemplar.
    Pixels(Arc<Pixels>),
    /// What an arrangement gives for a region.
    Curves(Arc<Curves>),
    /// A curve in space.
    Curve(Arc<SpaceCurve>),
    /// Areas with proven counts, and what they lie on.
    Cutout(Arc<Cutout>),
    /// A surface.
    Surface(Arc<SurfaceMesh>),
    /// Closed meshes, named and placed.
    Solid(Arc<Model>),
    /// Sized, placed shapes.
    Facade(Arc<Facade>),
    /// A step on the way to a shell.
    ShellStep(Arc<shell::Step>),
    /// A pattern on a surface, made solid and analysed.
    Shell(Arc<Shell>),
    /// The stresses in a body, in a few numbers.
    Analysis(Arc<shell::AnalysedBody>),
    /// The bytes of an artifact.
    File(#[serde(with = "file")] Arc<[u8]>),
}

impl Data {
    /// Writes the canonical bytes, by whose digest values are compared. An artifact's are those of its file.
    ///
    /// # Errors
    /// What `into` says.
    pub fn write(&self, mut into: impl Write) -> io::Result<()> {
        match self {
            Data::File(bytes) => into.write_all(bytes),
            data => postcard::to_io(data, into)
                .map(drop)
                .map_err(|error| io::Error::other(error.to_string())),
        }
    }

    /// The value of a node of type `ty` with these canonical bytes. None where they are those of
    /// another type: whoever asked would not know what to do with it.
    pub fn decode(bytes: Vec<u8>, ty: ValueType) -> Option<Data> {
        if ty == ValueType::Artifact {
            return Some(Data::File(bytes.into()));
        }
        let data: Data = postcard::from_bytes(&bytes).ok()?;
        (data.value_type() == ty).then_some(data)
    }

    /// The type of the nodes that give it.
    fn value_type(&self) -> ValueType {
        match self {
            Data::Region(_) => ValueType::Region,
            Data::Drawing(_) => ValueType::VectorExemplar,
            Data::Pixels(_) => ValueType::RasterExemplar,
            Data::Curves(_) => ValueType::Arrangement,
            Data::Curve(_) => ValueType::Curve,
            Data::Cutout(_) => ValueType::Cutout,
            Data::Surface(_) => ValueType::Surface,
            Data::Solid(_) => ValueType::Solid,
            Data::Analysis(_) => ValueType::Analysis,
            Data::Facade(_) => ValueType::Facade,
            Data::ShellStep(_) => ValueType::ShellStep,
            Data::Shell(_) => ValueType::Shell,
            Data::File(_) => ValueType::Artifact,
        }
    }
}

/// Bytes that are written in one piece.
pub(crate) struct Bytes<'a>(pub &'a [u8]);

impl Serialize for Bytes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self.0)
    }
}

/// Bytes that are read in one piece.
pub(crate) struct ByteBuffer(pub Vec<u8>);

impl<'de> Deserialize<'de> for ByteBuffer {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ByteBuffer, D::Error> {
        struct Visitor;

        impl serde::de::Visitor<'_> for Visitor {
            type Value = ByteBuffer;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("bytes")
            }

            fn visit_bytes<E: serde::de::Error>(self, bytes: &[u8]) -> Result<ByteBuffer, E> {
                Ok(ByteBuffer(bytes.to_vec()))
            }

            fn visit_byte_buf<E: serde::de::Error>(self, bytes: Vec<u8>) -> Result<ByteBuffer, E> {
                Ok(ByteBuffer(bytes))
            }
        }

        deserializer.deserialize_byte_buf(Visitor)
    }
}

mod file {
    use std::sync::Arc;

    use serde::{Deserialize as _, Deserializer, Serialize as _, Serializer};

    pub fn serialize<S: Serializer>(bytes: &Arc<[u8]>, serializer: S) -> Result<S::Ok, S::Error> {
        super::Bytes(bytes).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Arc<[u8]>, D::Error> {
        super::ByteBuffer::deserialize(deserializer).map(|bytes| bytes.0.into())
    }
}

/// What was put together from an action, kept for its next use: a compiled script, a decoded
/// picture. It lasts until a file changes, for it may remember what it has read.
#[derive(Clone, Default)]
pub struct Memo(Arc<Mutex<Option<Kept>>>);

/// What is kept, and the revision of the files that it is from.
type Kept = (u64, Arc<dyn Any + Send + Sync>);

impl fmt::Debug for Memo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Memo")
    }
}

impl Memo {
    /// What was kept at `revision`, or what `make` gives, which is kept from then on.
    ///
    /// # Errors
    /// Those of `make`; they are not kept.
    pub fn get<T: Clone + Send + Sync + 'static, E>(
        &self,
        revision: u64,
        make: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        let kept = self
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        if let Some((from, any)) = kept
            && from == revision
            && let Some(value) = any.downcast_ref::<T>()
        {
            return Ok(value.clone());
        }
        let value = make()?;
        let kept = Some((
            revision,
            Arc::new(value.clone()) as Arc<dyn Any + Send + Sync>,
        ));
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = kept;
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_of_another_type_than_expected_is_none() {
        let curves = Data::Curves(Arc::default());
        let mut bytes = Vec::new();
        curves.write(&mut bytes).unwrap();
        assert!(Data::decode(bytes.clone(), ValueType::Arrangement).is_some());
        for ty in ValueType::ALL {
            let decoded = Data::decode(bytes.clone(), ty);
            assert!(decoded.is_none_or(|data| data.value_type() == ty), "{ty:?}");
        }
        assert!(Data::decode(vec![0xff; 9], ValueType::Region).is_none());
    }
}
