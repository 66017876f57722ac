//! Files beside a scene that become part of it: a picture becomes discs, a table becomes bodies.
//!
//! The language finds the entries that name such files. Their owners say how a file is read, and register it.

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

pub use super::expand::{Door, Wanted, told};

/// Where entries that name files stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmbeddingPlace {
    /// As `atoms: NAME(..)`.
    Atoms,
    /// As `shape: NAME(..)`, or in a list there.
    Shape,
    /// In the section `NAME`, a list.
    Section,
}

impl EmbeddingPlace {
    /// The field that such an entry is the value of, if it is one's.
    pub(crate) fn field(self) -> Option<&'static str> {
        match self {
            Self::Atoms => Some("atoms"),
            Self::Shape => Some("shape"),
            Self::Section => None,
        }
    }
}

/// An entry that names a file.
#[derive(Clone, Copy)]
pub struct Embedding {
    /// Its leading name, or its section.
    pub name: &'static str,
    /// Where it stands.
    pub place: EmbeddingPlace,
    /// The fields that people may write.
    pub fields: &'static [&'static str],
    /// Those that have to be there.
    pub required: &'static [&'static str],
    /// One correct use.
    pub example: &'static str,
    /// Makes what reads the files of one scene.
    pub reader: fn() -> Box<dyn Embed>,
}

/// Reads the files of one scene. It may remember those that it has read.
pub trait Embed {
    /// Reads the file of an entry, whose text `entry` is in its brackets. `folder` is the one of the file in which it stands;
    /// files are read through `door`.
    ///
    /// Nothing, if the entry is wrong in itself: its section tells that when it is read.
    ///
    /// # Errors
    /// When the file cannot be read, or cannot become what the entry asks for.
    fn embed(&mut self, entry: &str, folder: Option<&Path>, door: &Door) -> Result<Option<Embedded>, Unfit>;
}

/// What a file became.
#[derive(Default)]
pub struct Embedded {
    /// Fields that are added to the entry: `discs: [..]`.
    pub fields: String,
    /// How much work the reading of these fields is, in bytes.
    pub work: usize,
    /// A note for the card, of a file that was not read before.
    pub note: Option<String>,
    /// What is handed on beside the text, by a key that stands in the fields.
    pub data: Option<(u64, Arc<dyn Any + Send + Sync>)>,
}

/// Why a file does not do.
pub struct Unfit {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
    /// The field that is to blame.
    pub field: &'static str,
}
