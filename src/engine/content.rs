//! What is in a file, with the digest that stands for it. Of a file that is read by parts the digest is remembered in the
//! store beside the state of the file, so that it is read as a whole once and not by every build.

use std::io::Read as _;
use std::sync::Arc;

use super::world::{Opened, World};
use fretwork_action::{Content, Parts, PartsReader, ReadError};
use fretwork_store::{Digest, Hasher, LocalStore, Naming};

/// How many bytes of a file are held while its digest is worked out.
const PIECE: usize = 1 << 20;

/// What is in a file and the digest of its bytes. Equal when the digests are, and when a file that is read by parts is still
/// the one that was opened: one that was written anew must be opened again, whatever is in it.
#[derive(Clone, Debug)]
pub struct FileContent {
    /// What is in it.
    pub content: Content,
    /// The digest of all bytes.
    pub digest: Digest,
}

impl PartialEq for FileContent {
    fn eq(&self, other: &FileContent) -> bool {
        self.digest == other.digest && self.state() == other.state()
    }
}

impl Eq for FileContent {}

impl FileContent {
    /// What is in the file at `path`. `known` is what was found there before.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(
        world: &dyn World,
        path: &str,
        store: Option<&LocalStore>,
        known: Option<&FileContent>,
    ) -> Result<FileContent, ReadError> {
        match world.open(path)? {
            Opened::Bytes(bytes) => Ok(FileContent {
                digest: Digest::of(&bytes),
                content: Content::Bytes(bytes.into()),
            }),
            Opened::Parts(parts) => {
                let known = known
                    .filter(|known| parts.is_settled() && known.state() == Some(parts.state()));
                match known {
                    Some(known) => Ok(known.clone()),
                    None => FileContent::of_parts(parts, store),
                }
            }
        }
    }

    fn of_parts(
        parts: Arc<dyn Parts>,
        store: Option<&LocalStore>,
    ) -> Result<FileContent, ReadError> {
        let store = store.filter(|_| parts.is_settled());
        let mut name = Hasher::new("digest of a file");
        let name = name.part(parts.state()).digest();
        let noted = store.and_then(|store| store.note(&name));
        let noted = noted.and_then(|note| <[u8; 32]>::try_from(note).ok());
        let digest = match noted {
            Some(digest) => Digest::from_bytes(digest),
            None => {
                let digest = digest(&parts).map_err(|error| ReadError::Io(error.to_string()))?;
                if let Some(store) = store {
                    // Without the note the next build reads the file once more.
                    let _ = store.put_note(&name, digest.as_bytes());
                }
                digest
            }
        };
        let content = Content::Parts {
            parts,
            digest: *digest.as_bytes(),
        };
        Ok(FileContent { content, digest })
    }

    /// The state of a file that is read by parts.
    fn state(&self) -> Option<&[u8]> {
        match &self.content {
            Content::Bytes(_) => None,
            Content::Parts { parts, .. } => Some(parts.state()),
        }
    }

    /// All of its bytes.
    ///
    /// # Errors
    /// When it is too large to be held.
    pub fn whole(&self) -> Result<Arc<[u8]>, ReadError> {
        self.content.whole()
    }
}

/// The digest of all bytes, a piece of which is held at a time.
fn digest(parts: &Arc<dyn Parts>) -> std::io::Result<Digest> {
    let mut reader = PartsReader::new(parts.clone());
    let (mut naming, mut piece) = (Naming::default(), vec![0; PIECE]);
    loop {
        match reader.read(&mut piece)? {
            0 => return Ok(naming.digest()),
            count => naming.add(&piece[..count]),
        }
    }
}
