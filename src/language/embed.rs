//! Files beside a scene that become part of it: a picture becomes discs, and a table becomes bodies.
//!
//! The language finds the entries that name such files. The owner of an entry registers how its file is read.

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

pub use super::macros::{Door, FileRequest, told};

/// The place in a scene of an entry that names a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmbeddingPlace {
    /// As `atoms: NAME(..)`.
    Atoms,
    /// As `shape: NAME(..)`, or in a list there.
    Shape,
    /// The section `NAME`, a list.
    Section,
}

impl EmbeddingPlace {
    /// The field whose value is such an entry, or `None` for a section.
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
    /// The place of the entry.
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
    /// Reads the file of an entry; `entry` is the text in the brackets of that entry. `folder` is the folder of the
    /// file that holds the entry. All files are read through `door`.
    ///
    /// `None` if the entry itself is wrong: its section reports that mistake when it is read.
    ///
    /// # Errors
    /// An error if the file cannot be read, or does not suit the entry.
    fn embed(&mut self, entry: &str, folder: Option<&Path>, door: &Door) -> Result<Option<Embedded>, UnfitFile>;
}

/// The content of a file, in the form that the scene takes.
#[derive(Default)]
pub struct Embedded {
    /// Fields that are added to the entry: `discs: [..]`.
    pub fields: String,
    /// The work of reading these fields, in bytes.
    pub work: usize,
    /// A note for the card, of a file that was not read before.
    pub note: Option<String>,
    /// Data that stands beside the text, by a key that stands in the fields.
    pub data: Option<(u64, Arc<dyn Any + Send + Sync>)>,
}

/// Why a file does not do.
pub struct UnfitFile {
    /// The mistake.
    pub message: String,
    /// The remedy.
    pub help: String,
    /// The field that is to blame.
    pub field: &'static str,
}
